#pragma once

/// Buckets of triangles by their smallest id, for sorting them.

#include "base/prefetch.hpp"

#include <thalweg/mesh/tin.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace thalweg {

// Vertices, or triangles, that a thread takes at once.
inline constexpr std::size_t kVerticesAtOnce = 8192;

/// Throws: Error{SizeLimit} from 2^30 triangles or vertices on, of which TurnedTriangle could not tell.
void check_counts(std::size_t triangles, std::size_t vertices);

/// A side of a triangle of a source.
struct SourceSide {
  std::size_t triangle = 0;
  std::uint32_t side = 0;
};

/// What a triangle of a source has become: which one, and which of its corners the first corner is now.
/// Until that is known: its smallest id, and the corner that has it.
class TurnedTriangle {
 public:
  TurnedTriangle() = default;
  TurnedTriangle(std::size_t index, std::uint32_t corner)
      : value_(static_cast<std::uint32_t>(4 * index + corner)) {}
  [[nodiscard]] bool exists() const { return value_ != kNone; }
  /// Larger than all ids if it does not exist.
  [[nodiscard]] std::size_t index() const { return value_ >> 2U; }
  [[nodiscard]] std::uint32_t corner() const { return value_ & 3U; }
  /// What its halfedge of corner i is now.
  [[nodiscard]] HalfedgeId halfedge(std::uint32_t i) const {
    constexpr std::uint32_t kTurned = 0b01'00'10'01'00U;  // (corner + i) % 3, two bits each
    return HalfedgeId{3 * index() + (kTurned >> (2 * (corner() + i)) & 3U)};
  }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffU;
  std::uint32_t value_ = kNone;
};

/// Limits of ranges of ids that are the smallest one of about as many triangles each: if ids are strewn, low
/// ones are so often. `smallest`: of each triangle.
std::vector<std::size_t> even_limits(std::span<const TurnedTriangle> smallest, std::size_t vertex_count);

/// Buckets of triangles by their smallest ids, while they are filled and sorted.
struct TriangleBuckets {
  std::span<Triangle> triangles;
  std::span<std::uint32_t> end;  ///< for each id where its bucket ends
  [[nodiscard]] std::size_t begin_of(std::size_t v) const { return v == 0 ? 0 : end[v - 1]; }
};

/// Puts triangles into buckets: some at a time, so that memory is asked for before it is needed.
class BucketFiller {
 public:
  explicit BucketFiller(TriangleBuckets buckets) : buckets_(buckets) {}
  /// A triangle from its smallest id on, which is that of the corner of a triangle of a source. The bucket,
  /// which `end` says to end where it starts, grows.
  void add(SourceSide corner, const Triangle& triangle) {
    first_[count_] = triangle[0];
    // In place of the smallest id, which the bucket tells: where the triangle is in the source.
    waiting_[count_] = {VertexId{3 * corner.triangle + corner.side}, triangle[1], triangle[2]};
    prefetch_to_write(&buckets_.end[triangle[0].index()]);
    if (++count_ == kMost) flush();
  }
  /// To be called last.
  void flush();

 private:
  static constexpr std::size_t kMost = 64;

  TriangleBuckets buckets_;
  std::size_t count_ = 0;
  std::array<VertexId, kMost> first_;
  std::array<Triangle, kMost> waiting_;
};

/// Sorts the buckets of vertices [begin, end), and makes their triangles what they are to be; notes in
/// `moved` for each of the source what it is now.
void settle_buckets(TriangleBuckets buckets, std::size_t begin, std::size_t end,
                    std::span<TurnedTriangle> moved);

}  // namespace thalweg
