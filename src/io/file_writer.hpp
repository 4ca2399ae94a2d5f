#pragma once

/// Buffered writing of large files, with every error seen.

#include <bit>
#include <charconv>
#include <cstddef>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace thalweg {

/// The open descriptor of this process that a path or a link stands for (/dev/stdout, /proc/self/fd/3).
std::optional<int> descriptor_of(const std::string& path);

/// Writes bytes, text and numbers to a file through one buffer of 1 MiB.
/// Throws (all): Error{WriteFailed} naming the output.
class FileWriter {
 public:
  /// Creates or truncates `path`, or goes on where an open descriptor stands; errors name `target`, the file
  /// that the user asked for.
  FileWriter(const std::string& path, std::string target);
  ~FileWriter();
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;

  void text(std::string_view text) {
    if (text.size() > kSize) return write_through(text);
    std::memcpy(room(text.size()), text.data(), text.size());
    used_ += text.size();
  }
  void character(char c) {
    *room(1) = c;
    ++used_;
  }
  /// Shortest decimal text that reads back as the same value.
  template <class Number>
  void number(Number value) {
    constexpr std::size_t kLongest = 32;
    char* const begin = room(kLongest);
    used_ += static_cast<std::size_t>(std::to_chars(begin, begin + kLongest, value).ptr - begin);
  }
  /// The value's bytes, least significant first.
  template <class Number>
  void little_endian(Number value) {
    static_assert(std::is_arithmetic_v<Number>);
    char* const begin = room(sizeof(Number));
    std::memcpy(begin, &value, sizeof(Number));
    if constexpr (std::endian::native == std::endian::big) {
      for (std::size_t i = 0; i < sizeof(Number) / 2; ++i) std::swap(begin[i], begin[sizeof(Number) - 1 - i]);
    }
    used_ += sizeof(Number);
  }
  /// Writes what is buffered and closes the file. Without it the file is not whole.
  void close();

 private:
  static constexpr std::size_t kSize = std::size_t{1} << 20U;
  char* room(std::size_t bytes) {
    if (used_ + bytes > kSize) flush();
    return buffer_.get() + used_;
  }
  void flush();
  void write_through(std::string_view bytes);
  [[noreturn]] void fail(int error) const;

  std::string target_;
  std::unique_ptr<char[]> buffer_;
  std::size_t used_ = 0;
  int file_ = -1;
};

}  // namespace thalweg
