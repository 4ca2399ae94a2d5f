// Files in memory: read in blocks, so that what is allocated follows what was really there, not what was
// claimed.
#include "io/file_content.hpp"

#include "io/tin_format.hpp"

#include <thalweg/io/crs.hpp>

#include <cpl_vsi.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>

namespace thalweg {

namespace {

struct CloseFile {
  void operator()(VSILFILE* file) const { VSIFCloseL(file); }
};
using FileHandle = std::unique_ptr<VSILFILE, CloseFile>;

FileHandle open_file(const std::string& path) {
  VSIStatBufL status;
  if (VSIStatL(path.c_str(), &status) != 0) {
    const bool layer = path.find("|layername=") != std::string::npos;
    throw Error(ErrorCode::NotFound,
                path + (layer ? ": a TIN is all layers of its file; leave |layername= away"
                              : ": there is no such file; check the path"));
  }
  if (VSI_ISDIR(status.st_mode)) {
    throw Error(ErrorCode::Unreadable, path + ": is a folder; name the file in it");
  }
  FileHandle file(VSIFOpenL(path.c_str(), "rb"));
  if (!file) throw Error(ErrorCode::Unreadable, path + ": cannot be opened; check its permissions");
  return file;
}

constexpr bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

std::string_view trimmed(std::string_view text) {
  const auto space = [](char c) { return is_blank(c) || c == '\n' || c == '\0'; };
  while (!text.empty() && space(text.front())) text.remove_prefix(1);
  while (!text.empty() && space(text.back())) text.remove_suffix(1);
  return text;
}

}  // namespace

FileContent::FileContent(const std::string& path) {
  const FileHandle file = open_file(path);
  constexpr std::size_t kBlock = std::size_t{1} << 24U;
  VSIFSeekL(file.get(), 0, SEEK_END);
  std::size_t capacity = std::max<std::size_t>(VSIFTellL(file.get()), 1);
  VSIFSeekL(file.get(), 0, SEEK_SET);
  data_.reset(new char[capacity]);
  while (true) {
    if (size_ == capacity) {
      char probe = 0;
      if (VSIFReadL(&probe, 1, 1, file.get()) == 0) break;
      auto larger = std::unique_ptr<char[]>(new char[2 * capacity]);
      std::memcpy(larger.get(), data_.get(), size_);
      data_ = std::move(larger);
      capacity *= 2;
      data_[size_++] = probe;
    }
    const std::size_t wanted = std::min(kBlock, capacity - size_);
    const std::size_t got = VSIFReadL(data_.get() + size_, 1, wanted, file.get());
    size_ += got;
    if (got < wanted && VSIFEofL(file.get()) == 0) {
      throw Error(ErrorCode::Unreadable, path + ": reading stopped at byte " + std::to_string(size_) +
                                             "; check the device it lies on");
    }
    if (got < wanted) break;
  }
}

std::string read_head(const std::string& path, std::size_t most) {
  const FileHandle file = open_file(path);
  std::string head(most, '\0');
  head.resize(VSIFReadL(head.data(), 1, most, file.get()));
  return head;
}

std::string read_prj_sidecar(const std::string& path) {
  constexpr std::size_t kLongest = std::size_t{1} << 20U;
  VSIStatBufL status;
  const std::string sidecar = sidecar_path(path);
  if (VSIStatL(sidecar.c_str(), &status) != 0 || VSI_ISDIR(status.st_mode)) return {};
  return std::string(trimmed(read_head(sidecar, kLongest)));
}

bool keeps_prj(const std::string& prj, const std::string& wkt, const std::string& target, Overwrite mode) {
  namespace fs = std::filesystem;
  if (!fs::exists(prj)) return false;
  if (!wkt.empty() && means_same_crs(read_prj_sidecar(prj), wkt)) return true;
  if (mode == Overwrite::No) return false;
  for (const char* extension : {".shp", ".asc", ".bil", ".flt"}) {
    const fs::path other = fs::path(prj).replace_extension(extension);
    if (other == fs::path(target) || !fs::exists(other)) continue;
    throw Error(ErrorCode::Usage, prj + ": is the CRS of " + other.string() + ", and not that of " + target +
                                      "; give the output another name, or remove that");
  }
  return false;
}

std::string_view TextScanner::take_word() {
  word_start_ = position_;
  while (position_ < text_.size() && !is_blank(text_[position_]) && text_[position_] != '\n') ++position_;
  return text_.substr(word_start_, position_ - word_start_);
}

std::string_view TextScanner::word() {
  while (position_ < text_.size() && is_blank(text_[position_])) ++position_;
  return take_word();
}

bool TextScanner::line_ended() {
  while (position_ < text_.size() && is_blank(text_[position_])) ++position_;
  return position_ == text_.size() || text_[position_] == '\n';
}

std::string_view TextScanner::word_anywhere() {
  while (position_ < text_.size() && (is_blank(text_[position_]) || text_[position_] == '\n')) ++position_;
  return take_word();
}

std::string_view TextScanner::rest_of_line() {
  const std::size_t start = position_;
  position_ = std::min(text_.find('\n', start), text_.size());
  return trimmed(text_.substr(start, position_ - start));
}

bool TextScanner::next_line() {
  const std::size_t end = text_.find('\n', position_);
  position_ = end == std::string_view::npos ? text_.size() : end + 1;
  word_start_ = position_;
  return position_ < text_.size();
}

double TextScanner::fraction() const {
  return text_.empty() ? 1 : static_cast<double>(position_) / static_cast<double>(text_.size());
}

double TextScanner::number(std::string_view what) {
  const std::string_view text = word();
  const std::optional<double> value = parse_number(text);
  if (!value) {
    fail(ErrorCode::BadFormat,
         text.empty() ? "the line ends before " + std::string(what)
                      : "'" + std::string(text.substr(0, 40)) + "' is no number (" + std::string(what) + ")");
  }
  if (!std::isfinite(*value)) {
    fail(ErrorCode::BadCoordinate, std::string(what) + " is " + std::string(text) + "; it has to be finite");
  }
  return *value;
}

std::int64_t TextScanner::integer(std::string_view what) {
  const std::string_view text = word();
  const std::optional<std::int64_t> value = parse_integer(text);
  if (!value) {
    fail(ErrorCode::BadFormat, text.empty() ? "the line ends before " + std::string(what)
                                            : "'" + std::string(text.substr(0, 40)) + "' is no integer (" +
                                                  std::string(what) + ")");
  }
  return *value;
}

void TextScanner::fail(ErrorCode code, const std::string& message) const {
  const auto lines =
      std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(word_start_), '\n');
  throw Error(code, file_ + " line " + std::to_string(lines + 1) + ": " + message);
}

std::optional<double> parse_number(std::string_view word) {
  if (word.size() > 1 && word.front() == '+' && word[1] != '-') word.remove_prefix(1);
  double value = 0;
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  if (error == std::errc::result_out_of_range) {
    const bool tiny = word.find("e-") != std::string_view::npos || word.find("E-") != std::string_view::npos;
    return tiny ? 0 : std::numeric_limits<double>::infinity();
  }
  if (error != std::errc{} || stop != end) return std::nullopt;
  return value;
}

std::optional<std::int64_t> parse_integer(std::string_view word) {
  std::int64_t value = 0;
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  if (error != std::errc{} || stop != end) return std::nullopt;
  return value;
}

}  // namespace thalweg
