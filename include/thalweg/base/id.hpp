#pragma once

/// Strong 32-bit ids: an index into one kind of array, with no conversion between kinds.

#include <compare>
#include <cstddef>
#include <cstdint>

namespace thalweg {

/// Index of an element of the kind `Tag`. Default-constructed ids are invalid.
template <class Tag>
class Id {
 public:
  static constexpr std::uint32_t kInvalid = 0xffffffffU;
  constexpr Id() = default;
  constexpr explicit Id(std::size_t index) : value_(static_cast<std::uint32_t>(index)) {}
  [[nodiscard]] constexpr std::size_t index() const { return value_; }
  [[nodiscard]] constexpr std::uint32_t value() const { return value_; }
  [[nodiscard]] constexpr bool valid() const { return value_ != kInvalid; }
  constexpr auto operator<=>(const Id&) const = default;

 private:
  std::uint32_t value_ = kInvalid;
};

using VertexId = Id<struct VertexTag>;
using TriangleId = Id<struct TriangleTag>;
/// Halfedge 3 t + i runs from corner i to corner (i + 1) % 3 of triangle t, which lies to its left.
using HalfedgeId = Id<struct HalfedgeTag>;

}  // namespace thalweg
