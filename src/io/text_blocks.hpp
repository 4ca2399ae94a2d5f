#pragma once

/// Text files in blocks of whole rows.

#include <cpl_vsi.h>

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace thalweg {

/// Reads a file, or what a GDAL virtual path stands for, from begin to end with bounded memory.
class TextBlocks {
 public:
  /// Opens the file; errors name `name`. Throws: Error{NotFound}, Error{Unreadable}.
  TextBlocks(const std::string& path, std::string name);

  /// The next rows, each of which ends with '\n'; empty at the file's end. Valid until the next call.
  /// Throws: Error{Unreadable} if reading fails; Error{BadFormat} for a row longer than 64 MiB.
  std::string_view next();
  /// How much of the file was read, 0 to 1; 0 where its size is unknown.
  [[nodiscard]] double fraction() const;
  /// Size in bytes; 0 where it is unknown.
  [[nodiscard]] double size() const { return size_; }

 private:
  struct Close {
    void operator()(VSILFILE* file) const { VSIFCloseL(file); }
  };
  void fill();

  std::string name_;
  std::unique_ptr<VSILFILE, Close> file_;
  std::vector<char> buffer_;
  std::size_t filled_ = 0;  // bytes in the buffer
  std::size_t handed_ = 0;  // bytes of it that the last block took
  bool at_end_ = false;
  double size_ = 0;
  double bytes_read_ = 0;
};

}  // namespace thalweg
