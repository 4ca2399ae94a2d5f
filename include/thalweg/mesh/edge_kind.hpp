#pragma once

/// What a constraint edge is; bits, because one edge can be several things.

#include <cstdint>

namespace thalweg {

/// Bits as written to files: 1 breakline, 2 ridge, 4 valley, 8 boundary, 16 hole, 32 lake. None: no
/// constraint.
enum class EdgeKind : std::uint8_t {
  None = 0,
  Breakline = 1,
  Ridge = 2,
  Valley = 4,
  Boundary = 8,
  Hole = 16,
  Lake = 32
};

constexpr EdgeKind operator|(EdgeKind a, EdgeKind b) {
  return static_cast<EdgeKind>(static_cast<std::uint8_t>(a) | static_cast<std::uint8_t>(b));
}
constexpr EdgeKind operator&(EdgeKind a, EdgeKind b) {
  return static_cast<EdgeKind>(static_cast<std::uint8_t>(a) & static_cast<std::uint8_t>(b));
}
constexpr bool has(EdgeKind kind, EdgeKind bit) {
  return (kind & bit) != EdgeKind::None;
}
constexpr bool is_constraint(EdgeKind kind) {
  return kind != EdgeKind::None;
}

}  // namespace thalweg
