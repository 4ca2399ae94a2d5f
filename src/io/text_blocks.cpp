// Text files in blocks of whole rows.
//
// The buffer holds the beginning of a row that the last block cut off, then as many new bytes as fit. Only if
// no row ends in it the buffer grows.
#include "io/text_blocks.hpp"

#include "io/gdal_session.hpp"

#include <thalweg/base/error.hpp>

#include <cpl_vsi.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

namespace thalweg {

namespace {

constexpr std::size_t kBlock = std::size_t{1} << 20U;  // large against a read's cost, small against caches
constexpr std::size_t kLongestRow = std::size_t{64} << 20U;  // no table has such rows; other files do

/// Size in bytes; 0 where asking for it would read the whole file.
double cheap_size(const std::string& path) {
  if (path.find("/vsigzip/") != std::string::npos || path.find("/vsistdin") != std::string::npos) return 0;
  VSIStatBufL stat;
  return VSIStatExL(path.c_str(), &stat, VSI_STAT_SIZE_FLAG) == 0 ? static_cast<double>(stat.st_size) : 0;
}

}  // namespace

TextBlocks::TextBlocks(const std::string& path, std::string name) : name_(std::move(name)) {
  GdalSession session;
  VSIStatBufL stat{};
  const bool exists = path.find("/vsistdin") != std::string::npos ||
                      VSIStatExL(path.c_str(), &stat, VSI_STAT_EXISTS_FLAG | VSI_STAT_NATURE_FLAG) == 0;
  if (!exists) throw Error(ErrorCode::NotFound, name_ + ": there is no such file");
  file_.reset(VSIFOpenExL(path.c_str(), "rb", 1));
  if (!file_ || VSI_ISDIR(stat.st_mode)) {
    throw Error(ErrorCode::Unreadable, name_ + " cannot be opened as a file" + session.reason());
  }
  size_ = cheap_size(path);
  buffer_.resize(kBlock);
}

void TextBlocks::fill() {
  const std::size_t wanted = buffer_.size() - filled_;
  GdalSession session;
  const std::size_t got = VSIFReadL(buffer_.data() + filled_, 1, wanted, file_.get());
  filled_ += got;
  bytes_read_ += static_cast<double>(got);
  // Compressed files may give less than was asked for before their end: the end is where nothing more comes.
  at_end_ = got == 0;
  const bool stopped = at_end_ && (bytes_read_ < size_ || VSIFEofL(file_.get()) == 0);
  if (session.failed() || stopped) {
    throw Error(ErrorCode::Unreadable, name_ + " cannot be read to its end" + session.reason());
  }
}

std::string_view TextBlocks::next() {
  std::memmove(buffer_.data(), buffer_.data() + handed_, filled_ - handed_);
  filled_ -= std::exchange(handed_, 0);
  while (true) {
    if (!at_end_) fill();
    if (at_end_ && filled_ > 0 && buffer_[filled_ - 1] != '\n') {
      if (filled_ == buffer_.size()) buffer_.push_back('\n');
      buffer_[filled_++] = '\n';
    }
    handed_ = filled_;
    while (handed_ > 0 && buffer_[handed_ - 1] != '\n') --handed_;
    if (handed_ > 0 || at_end_) return {buffer_.data(), handed_};
    if (buffer_.size() >= kLongestRow) {
      throw Error(ErrorCode::BadFormat, name_ + ": a row is longer than 64 MiB; this is no table of points");
    }
    buffer_.resize(2 * buffer_.size());
  }
}

double TextBlocks::fraction() const {
  return size_ > 0 ? std::min(1.0, bytes_read_ / size_) : 0;
}

}  // namespace thalweg
