#pragma once

/// Words that are the same in capitals and small letters.

#include <string>
#include <string_view>

namespace thalweg {

/// The text with the capitals of ASCII made small, whatever the locale. Complexity: linear.
std::string lower(std::string_view text);

/// The extension of a path with its dot, in small letters; empty if there is none.
std::string extension_of(std::string_view path);

}  // namespace thalweg
