#include "mesh/triangle_buckets.hpp"

#include "base/parallel.hpp"

#include <thalweg/base/error.hpp>

#include <algorithm>
#include <string>
#include <tuple>

namespace thalweg {

namespace {

constexpr std::size_t kSmallBucket = 16;
// About how many triangles tell the limits of ranges.
constexpr std::size_t kTrianglesSampled = 1024;

// By the other corners; of two triangles on the same side of an edge by where they come from.
bool comes_before(const Triangle& a, const Triangle& b) {
  return std::tie(a[1], a[2], a[0]) < std::tie(b[1], b[2], b[0]);
}

void sort_bucket(std::span<Triangle> bucket) {
  if (bucket.size() > kSmallBucket) return std::sort(bucket.begin(), bucket.end(), comes_before);
  for (std::size_t i = 1; i < bucket.size(); ++i) {
    const Triangle triangle = bucket[i];
    std::size_t at = i;
    for (; at > 0 && comes_before(triangle, bucket[at - 1]); --at) bucket[at] = bucket[at - 1];
    bucket[at] = triangle;
  }
}

}  // namespace

void check_counts(std::size_t triangles, std::size_t vertices) {
  constexpr std::size_t kMost = (std::size_t{1} << 30U) - 1;
  if (triangles <= kMost && vertices <= kMost) return;
  throw Error(ErrorCode::SizeLimit, "a TIN holds at most " + std::to_string(kMost) +
                                        " triangles and vertices, not " + std::to_string(triangles) +
                                        " and " + std::to_string(vertices) + "; split the area");
}

std::vector<std::size_t> even_limits(std::span<const TurnedTriangle> smallest, std::size_t vertex_count) {
  std::vector<std::size_t> sample;
  for (std::size_t t = 0; t < smallest.size(); t += smallest.size() / kTrianglesSampled + 1) {
    if (smallest[t].exists()) sample.push_back(smallest[t].index());
  }
  std::sort(sample.begin(), sample.end());
  const std::size_t ranges = sample.empty() ? 1 : range_count(vertex_count);
  std::vector<std::size_t> limits{0};
  for (std::size_t i = 1; i < ranges; ++i) limits.push_back(sample[i * sample.size() / ranges]);
  limits.push_back(vertex_count);
  return limits;
}

void BucketFiller::flush() {
  std::array<std::uint32_t, kMost> place;
  for (std::size_t i = 0; i < count_; ++i) {
    place[i] = buckets_.end[first_[i].index()]++;
    prefetch_to_write(&buckets_.triangles[place[i]]);
  }
  for (std::size_t i = 0; i < count_; ++i) buckets_.triangles[place[i]] = waiting_[i];
  count_ = 0;
}

void settle_buckets(TriangleBuckets buckets, std::size_t begin, std::size_t end,
                    std::span<TurnedTriangle> moved) {
  constexpr std::size_t kAhead = 16;
  const std::size_t limit = buckets.begin_of(end);
  for (std::size_t v = begin; v < end; ++v) {
    const std::size_t first = buckets.begin_of(v);
    sort_bucket(buckets.triangles.subspan(first, buckets.end[v] - first));
    for (std::size_t i = first; i < buckets.end[v]; ++i) {
      if (i + kAhead < limit) prefetch_to_write(&moved[buckets.triangles[i + kAhead][0].index() / 3]);
      const std::size_t taken = buckets.triangles[i][0].index();
      const std::size_t old = taken / 3;
      const auto corner = static_cast<std::uint32_t>(taken - 3 * old);
      buckets.triangles[i][0] = VertexId{v};
      moved[old] = {i, corner == 0 ? 0 : 3 - corner};
    }
  }
}

}  // namespace thalweg
