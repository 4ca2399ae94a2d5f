// ASCII alone: what std::tolower does is for the locale to say, which is the host's.
#include "base/lower_case.hpp"

#include <filesystem>

namespace thalweg {

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

std::string extension_of(std::string_view path) {
  return lower(std::filesystem::path(path).extension().string());
}

}  // namespace thalweg
