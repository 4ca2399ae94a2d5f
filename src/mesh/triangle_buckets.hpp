#pragma once

/// Buckets of triangles by their smallest id, for sorting them.

#include <thalweg/mesh/tin.hpp>

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace thalweg {

// What a thread takes at once.
inline constexpr std::size_t kVerticesAtOnce = 8192;
inline constexpr std::size_t kTrianglesAtOnce = 8192;

/// Throws: Error{SizeLimit} from 2^30 triangles or vertices on, of which TurnedTriangle could not tell.
void check_counts(std::size_t triangles, std::size_t vertices);

/// A side of a triangle of a source.
struct SourceSide {
  std::size_t triangle = 0;
  std::uint32_t side = 0;
};

/// What a triangle of a source has become: which one, and which of its corners the first corner is now.
/// Until that is known: the vertex with its smallest id, and which corner that is.
class TurnedTriangle {
 public:
  TurnedTriangle() = default;
  TurnedTriangle(std::size_t index, std::uint32_t corner)
      : value_(static_cast<std::uint32_t>(4 * index + corner)) {}
  [[nodiscard]] bool exists() const { return value_ != kNone; }
  /// Larger than all if it does not exist.
  [[nodiscard]] std::size_t index() const { return value_ >> 2U; }
  [[nodiscard]] std::uint32_t corner() const { return value_ & 3U; }
  /// Which corner its corner i is now.
  [[nodiscard]] std::uint32_t turned(std::uint32_t i) const {
    constexpr std::uint32_t kTurned = 0b01'00'10'01'00U;  // (corner + i) % 3, two bits each
    return kTurned >> (2 * (corner() + i)) & 3U;
  }
  /// Which corner it was that is corner i now.
  [[nodiscard]] std::uint32_t corner_before(std::uint32_t i) const {
    constexpr std::uint32_t kTurned = 0b10'01'00'10'01'00U;  // (3 + i - corner) % 3
    return kTurned >> (2 * (3 + i - corner())) & 3U;
  }
  /// What its halfedge of corner i is now.
  [[nodiscard]] HalfedgeId halfedge(std::uint32_t i) const { return HalfedgeId{3 * index() + turned(i)}; }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffU;
  std::uint32_t value_ = kNone;
};

/// A triangle of a source from its smallest id on: its second id, by which those with the same smallest one
/// are sorted, and where it is.
class TurnedSide {
 public:
  TurnedSide() = default;
  TurnedSide(VertexId second, std::size_t triangle, std::uint32_t corner)
      : value_(std::uint64_t{second.value()} << 32U | (4 * triangle + corner)) {}
  [[nodiscard]] std::uint32_t second() const { return static_cast<std::uint32_t>(value_ >> 32U); }
  [[nodiscard]] std::size_t triangle() const { return (value_ & 0xffffffffU) >> 2U; }
  /// That of the triangle of the source at which it now starts.
  [[nodiscard]] std::uint32_t corner() const { return static_cast<std::uint32_t>(value_ & 3U); }
  friend bool operator<(const TurnedSide& a, const TurnedSide& b) { return a.value_ < b.value_; }

 private:
  std::uint64_t value_ = 0;
};

/// Limits of ranges of vertices that have the smallest id of about as many triangles each: if ids are strewn,
/// low ones are so often. `smallest`: of each triangle.
std::vector<std::size_t> even_limits(std::span<const TurnedTriangle> smallest, std::size_t vertex_count);

/// Triangles by the vertices that have their smallest ids.
struct TriangleBuckets {
  std::span<TurnedSide> sides;
  std::span<const std::uint32_t> end;  ///< for each vertex where its bucket ends
  [[nodiscard]] std::size_t count() const { return end.size(); }
  [[nodiscard]] std::size_t begin_of(std::size_t v) const { return v == 0 ? 0 : end[v - 1]; }
  [[nodiscard]] std::span<TurnedSide> of(std::size_t v) const {
    return sides.subspan(begin_of(v), end[v] - begin_of(v));
  }
};

/// Where the triangles of each bucket come to lie, by the number of its vertex; nothing if there are none.
RawVector<std::uint32_t> first_places(const TriangleBuckets& buckets, std::span<const VertexId> number);

/// Sorts a bucket. Of sides with the same second id the third decides, of which `third(side)` tells.
template <class Third>
void sort_bucket(std::span<TurnedSide> bucket, const Third& third) {
  constexpr std::size_t kSmallBucket = 16;
  if (bucket.size() > kSmallBucket) {
    std::sort(bucket.begin(), bucket.end());
  } else {
    for (std::size_t i = 1; i < bucket.size(); ++i) {
      const TurnedSide side = bucket[i];
      std::size_t at = i;
      for (; at > 0 && side < bucket[at - 1]; --at) bucket[at] = bucket[at - 1];
      bucket[at] = side;
    }
  }
  const auto same = [](const TurnedSide& a, const TurnedSide& b) { return a.second() == b.second(); };
  if (std::adjacent_find(bucket.begin(), bucket.end(), same) == bucket.end()) return;
  std::stable_sort(bucket.begin(), bucket.end(), [&](const TurnedSide& a, const TurnedSide& b) {
    return std::pair(a.second(), third(a)) < std::pair(b.second(), third(b));
  });
}

}  // namespace thalweg
