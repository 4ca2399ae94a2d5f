#include "mesh/triangle_buckets.hpp"

#include "base/parallel.hpp"

#include <thalweg/base/error.hpp>

#include <algorithm>
#include <numeric>
#include <string>

namespace thalweg {

namespace {

// About how many triangles tell the limits of ranges.
constexpr std::size_t kTrianglesSampled = 1024;

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

RawVector<std::uint32_t> first_places(const TriangleBuckets& buckets, std::span<const VertexId> number) {
  if (number.empty()) return {};
  RawVector<std::uint32_t> first(number.size() + 1, 0);
  for (std::size_t v = 0; v < number.size(); ++v) {
    first[number[v].index() + 1] = static_cast<std::uint32_t>(buckets.of(v).size());
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  return first;
}

}  // namespace thalweg
