#include "fuzz/mutant.hpp"

#include <array>
#include <string_view>

namespace thalweg::fuzz {

namespace {

constexpr std::array<std::string_view, 18> kHurtful{
    "nan",     "inf",   "-1",         "0",  "4294967295", "4294967296",           "1e300",
    "-1e-320", "1e999", "2147483648", "\n", "\"",         "99999999999999999999", "(",
    "EMPTY",   "1e15",  "\xff\xfe",   ""};

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

}  // namespace

void Mutants::change(std::string& bytes) {
  constexpr std::size_t kLongest = 16;
  const std::size_t at = below(bytes.size() + 1);
  const std::size_t length = below(std::min(kLongest, bytes.size() - at) + 1);
  switch (below(8)) {
    case 0:
      if (at < bytes.size()) bytes[at] = static_cast<char>(engine_());
      break;
    case 1:
      if (at < bytes.size()) bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
      break;
    case 2:
      bytes.erase(at, length);
      break;
    case 3:
      bytes.insert(at, bytes.substr(at, length));
      break;
    case 4: {
      const std::string& other = inputs_[below(inputs_.size())];
      bytes.insert(at, other.substr(below(other.size() + 1), kLongest));
      break;
    }
    case 5:
      bytes.insert(at, kHurtful[below(kHurtful.size())]);
      break;
    case 6: {
      std::size_t begin = at;
      while (begin < bytes.size() && !is_digit(bytes[begin])) ++begin;
      std::size_t end = begin;
      while (end < bytes.size() && is_digit(bytes[end])) ++end;
      if (begin < end) bytes.replace(begin, end - begin, kHurtful[below(kHurtful.size())]);
      break;
    }
    default:
      if (below(8) == 0) bytes.resize(at);
      break;
  }
}

std::string Mutants::next() {
  std::string bytes = inputs_[below(inputs_.size())];
  const std::size_t changes = 1 + below(6);
  for (std::size_t i = 0; i < changes; ++i) change(bytes);
  return bytes;
}

}  // namespace thalweg::fuzz
