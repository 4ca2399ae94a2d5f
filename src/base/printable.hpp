#pragma once

/// Text of files in messages.

#include <string>
#include <string_view>

namespace thalweg {

/// The text as one line that does nothing to a terminal: line breaks and tabs become blanks, other control
/// characters, and bytes that are no UTF-8, \xNN. Complexity: linear.
std::string printable(std::string_view text);

}  // namespace thalweg
