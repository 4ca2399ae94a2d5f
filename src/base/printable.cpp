// A text is copied character by character; what is no character of UTF-8, or controls a terminal, is spelt
// out.
#include "base/printable.hpp"

#include <array>
#include <cstdint>

namespace thalweg {

namespace {

std::uint8_t byte_at(std::string_view text, std::size_t i) {
  return static_cast<std::uint8_t>(text[i]);
}

/// Bytes of the character of UTF-8 that the text starts with; 0 if it starts with none. Too long spellings,
/// surrogates, and what is beyond Unicode are none (the table 3-7 of the Unicode standard).
std::size_t character_length(std::string_view text) {
  const std::uint8_t first = byte_at(text, 0);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || text.size() < length) return 0;
  const std::uint8_t low = first == 0xe0 ? 0xa0 : first == 0xf0 ? 0x90 : 0x80;
  const std::uint8_t high = first == 0xed ? 0x9f : first == 0xf4 ? 0x8f : 0xbf;
  if (byte_at(text, 1) < low || byte_at(text, 1) > high) return 0;
  for (std::size_t i = 2; i < length; ++i) {
    if ((byte_at(text, i) & 0xc0U) != 0x80) return 0;
  }
  return length;
}

/// C0, DEL, and C1, which UTF-8 spells as C2 80 ... C2 9F.
bool is_control(std::string_view character) {
  const std::uint8_t first = byte_at(character, 0);
  return first < 0x20 || first == 0x7f || (first == 0xc2 && byte_at(character, 1) < 0xa0);
}

}  // namespace

std::string printable(std::string_view text) {
  constexpr std::array kDigits{'0', '1', '2', '3', '4', '5', '6', '7',
                               '8', '9', 'a', 'b', 'c', 'd', 'e', 'f'};
  std::string line;
  line.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    const std::string_view character = text.substr(0, length == 0 ? 1 : length);
    text.remove_prefix(character.size());
    if (character == "\n" || character == "\r" || character == "\t") {
      line += ' ';
    } else if (length > 0 && !is_control(character)) {
      line += character;
    } else {
      for (std::size_t i = 0; i < character.size(); ++i) {
        line += "\\x";
        line += kDigits[byte_at(character, i) >> 4U];
        line += kDigits[byte_at(character, i) & 15U];
      }
    }
  }
  return line;
}

}  // namespace thalweg
