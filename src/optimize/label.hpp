#pragma once

#include <cstdint>

namespace thalweg {

/// The choice of a variable; Open: not made yet.
enum class Label : std::uint8_t { Zero = 0, One = 1, Open = 2 };

constexpr Label other(Label label) {
  return label == Label::Zero ? Label::One : Label::Zero;
}

}  // namespace thalweg
