// Sorting triangles.
//
// 1. Buckets by the smallest id. Each thread fills those of a range of ids, so no two write to the same
//    place.
// 2. Each bucket, a part of one fan, is sorted by the other corners.
#include "sort_triangles.hpp"

#include "base/parallel.hpp"

#include <algorithm>
#include <tuple>

namespace thalweg {

namespace {

// Vertices that a thread takes at once.
constexpr std::size_t kBlock = 8192;
constexpr std::size_t kSmallBucket = 16;

/// A triangle in the bucket of its smallest id.
struct Entry {
  VertexId second, third;
  HalfedgeId taken;
  bool operator<(const Entry& other) const {
    return std::tie(second, third, taken) < std::tie(other.second, other.third, other.taken);
  }
};

struct Buckets {
  RawVector<Entry> entries;
  std::vector<std::uint32_t> end;  ///< for each id: where its bucket ends
  [[nodiscard]] std::size_t begin_of(std::size_t v) const { return v == 0 ? 0 : end[v - 1]; }
};

std::size_t smallest(VertexId a, VertexId b, VertexId c) {
  return b < a ? (c < b ? 2 : 1) : (c < a ? 2 : 0);
}

/// Limits of ranges of ids that are the smallest one of about as many triangles each: if ids are strewn, low
/// ones are so often.
template <class Rename>
std::vector<std::size_t> even_limits(std::span<const Triangle> corners, std::size_t vertex_count,
                                     const Rename& renamed) {
  constexpr std::size_t kSample = 1024;
  std::vector<VertexId> sample;
  for (std::size_t t = 0; t < corners.size(); t += corners.size() / kSample + 1) {
    sample.push_back(std::min({renamed(corners[t][0]), renamed(corners[t][1]), renamed(corners[t][2])}));
  }
  std::sort(sample.begin(), sample.end());
  const std::size_t ranges = sample.empty() ? 1 : range_count(vertex_count);
  std::vector<std::size_t> limits{0};
  for (std::size_t i = 1; i < ranges; ++i) limits.push_back(sample[i * sample.size() / ranges].index());
  limits.push_back(vertex_count);
  return limits;
}

template <class Rename>
Buckets fill_buckets(std::span<const Triangle> corners, std::size_t vertex_count, const Progress& progress,
                     const Rename& renamed) {
  Buckets buckets{.entries = RawVector<Entry>(corners.size()),
                  .end = std::vector<std::uint32_t>(vertex_count + 1, 0)};
  const std::vector<std::size_t> limits = even_limits(corners, vertex_count, renamed);
  const auto in_ranges = [&](const auto& body) {
    for_each_block(limits.size() - 1, 1, progress, [&](std::size_t range, std::size_t) {
      const VertexId low{limits[range]}, high{limits[range + 1]};
      for (std::size_t t = 0; t < corners.size(); ++t) {
        const VertexId a = renamed(corners[t][0]), b = renamed(corners[t][1]), c = renamed(corners[t][2]);
        const VertexId first = std::min({a, b, c});
        if (first >= low && first < high) body(t, a, b, c);
      }
    });
  };
  in_ranges([&](std::size_t, VertexId a, VertexId b, VertexId c) {
    ++buckets.end[std::min({a, b, c}).index() + 1];
  });
  for (std::size_t v = 0; v < vertex_count; ++v) buckets.end[v + 1] += buckets.end[v];
  in_ranges([&](std::size_t t, VertexId a, VertexId b, VertexId c) {  // starts move on and become ends
    const std::size_t corner = smallest(a, b, c);
    const VertexId first = corner == 0 ? a : corner == 1 ? b : c;
    const VertexId second = corner == 0 ? b : corner == 1 ? c : a;
    const VertexId third = corner == 0 ? c : corner == 1 ? a : b;
    buckets.entries[buckets.end[first.index()]++] = {second, third, HalfedgeId{3 * t + corner}};
  });
  return buckets;
}

void sort_bucket(std::span<Entry> bucket) {
  if (bucket.size() > kSmallBucket) return std::sort(bucket.begin(), bucket.end());
  for (std::size_t i = 1; i < bucket.size(); ++i) {
    const Entry entry = bucket[i];
    std::size_t at = i;
    for (; at > 0 && entry < bucket[at - 1]; --at) bucket[at] = bucket[at - 1];
    bucket[at] = entry;
  }
}

}  // namespace

SortedTriangles sort_triangles(std::span<const Triangle> corners, std::span<const VertexId> number,
                               std::size_t vertex_count, const Progress& progress) {
  Buckets buckets =
      number.empty()
          ? fill_buckets(corners, vertex_count, progress, [](VertexId v) { return v; })
          : fill_buckets(corners, vertex_count, progress, [&](VertexId v) { return number[v.index()]; });
  SortedTriangles sorted;
  sorted.triangles.resize(corners.size());
  sorted.moved.resize(corners.size());
  for_each_block(vertex_count, kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const std::size_t first = buckets.begin_of(v);
      sort_bucket(std::span(buckets.entries).subspan(first, buckets.end[v] - first));
      for (std::size_t i = first; i < buckets.end[v]; ++i) {
        const Entry& entry = buckets.entries[i];
        const std::size_t old = entry.taken.index() / 3, corner = entry.taken.index() - 3 * old;
        Triangle& triangle = sorted.triangles[i];
        triangle[0] = VertexId{v};
        triangle[1] = entry.second;
        triangle[2] = entry.third;
        sorted.moved[old] = HalfedgeId{3 * i + (corner == 0 ? 0 : 3 - corner)};
      }
    }
  });
  return sorted;
}

}  // namespace thalweg
