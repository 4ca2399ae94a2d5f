#pragma once

/// Values out of arbitrary bytes; zeros when they have run out.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace thalweg::fuzz {

class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  [[nodiscard]] bool empty() const { return bytes_.empty(); }
  [[nodiscard]] std::string_view rest() const { return bytes_; }

  template <class T>
  T take() {
    T value{};
    const std::size_t size = bytes_.size() < sizeof(T) ? bytes_.size() : sizeof(T);
    std::memcpy(&value, bytes_.data(), size);
    bytes_.remove_prefix(size);
    return value;
  }
  /// One of 0 ... count - 1.
  std::size_t pick(std::size_t count) { return take<std::uint8_t>() % count; }
  bool flag() { return pick(2) == 1; }

 private:
  std::string_view bytes_;
};

}  // namespace thalweg::fuzz
