// Buffered writing over a plain descriptor: a short write is continued, anything else is an error with its
// reason. A descriptor that is open already is duplicated: opened by its name, a file would be truncated
// under those who write to it, and a socket cannot be.
#include "io/file_writer.hpp"

#include <thalweg/base/error.hpp>

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

namespace thalweg {

std::optional<int> descriptor_of(const std::string& path) {
  namespace fs = std::filesystem;
  constexpr int kMostLinks = 40;
  std::error_code broken;
  const fs::path open = "/proc/" + std::to_string(::getpid()) + "/fd";
  fs::path name = fs::absolute(path, broken);
  for (int i = 0; i < kMostLinks && !broken; ++i) {
    if (fs::canonical(name.parent_path(), broken) == open) {
      const std::string digits = name.filename().string();
      int descriptor = -1;
      const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), descriptor);
      if (error == std::errc() && end == digits.data() + digits.size() && descriptor >= 0) return descriptor;
    }
    const fs::path next = fs::read_symlink(name, broken);
    name = name.parent_path() / next;
  }
  return std::nullopt;
}

FileWriter::FileWriter(const std::string& path, std::string target)
    : target_(std::move(target)), buffer_(new char[kSize]) {
  const std::optional<int> opened = descriptor_of(path);
  file_ = opened ? ::fcntl(*opened, F_DUPFD_CLOEXEC, 0)
                 : ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file_ < 0) fail(errno);
}

FileWriter::~FileWriter() {
  if (file_ >= 0) ::close(file_);
}

void FileWriter::fail(int error) const {
  const std::string reason = std::generic_category().message(error);
  const bool full = error == ENOSPC || error == EDQUOT || error == EFBIG;
  throw Error(ErrorCode::WriteFailed, target_ + ": could not be written whole (" + reason + "); " +
                                          (full ? "free some space or choose another place"
                                                : "choose another place or check the device") +
                                          "; no partial file is left");
}

void FileWriter::write_through(std::string_view bytes) {
  if (used_ > 0) flush();
  while (!bytes.empty()) {
    const ssize_t written = ::write(file_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail(written < 0 ? errno : ENOSPC);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void FileWriter::flush() {
  const std::string_view bytes(buffer_.get(), used_);
  used_ = 0;
  write_through(bytes);
}

void FileWriter::close() {
  flush();
  if (::close(std::exchange(file_, -1)) != 0) fail(errno);
}

}  // namespace thalweg
