#pragma once

/// Sorting by a coordinate: first into buckets, whose order is that of the coordinate, then within each.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

namespace thalweg {

/// The bucket of a coordinate. Rounding is monotone, so what falls into a later bucket is not before what
/// falls into an earlier one.
class BucketOfCoordinate {
 public:
  /// Where the coordinates are too close for a scale, as denormal ones are, all are in the first bucket.
  BucketOfCoordinate(double low, double high, std::size_t buckets)
      : low_(low), last_(static_cast<double>(buckets - 1)) {
    const double per_unit = last_ / (high - low);
    if (std::isfinite(per_unit)) per_unit_ = per_unit;
  }
  std::uint32_t operator()(double coordinate) const {
    return static_cast<std::uint32_t>(std::min((coordinate - low_) * per_unit_, last_));
  }

 private:
  double low_, last_, per_unit_ = 0;
};

/// Numbers 0 to n - 1 by bucket, ascending in each.
struct Buckets {
  std::vector<std::uint32_t> first;  ///< of each bucket; then the end
  std::vector<std::uint32_t> item;
  [[nodiscard]] std::size_t size() const { return first.size() - 1; }
  [[nodiscard]] std::span<std::uint32_t> items(std::size_t bucket) {
    return std::span(item).subspan(first[bucket], first[bucket + 1] - first[bucket]);
  }
};

/// Complexity: linear in both numbers.
inline Buckets sort_into_buckets(std::span<const std::uint32_t> bucket_of, std::size_t buckets) {
  Buckets sorted{std::vector<std::uint32_t>(buckets + 1, 0), std::vector<std::uint32_t>(bucket_of.size())};
  for (const std::uint32_t bucket : bucket_of) ++sorted.first[bucket + 1];
  std::partial_sum(sorted.first.begin(), sorted.first.end(), sorted.first.begin());
  std::vector<std::uint32_t> next(sorted.first.begin(), sorted.first.end() - 1);
  for (std::uint32_t i = 0; i < bucket_of.size(); ++i) sorted.item[next[bucket_of[i]]++] = i;
  return sorted;
}

/// Numbers 0 to count - 1 by `coordinate(number)`, in so many buckets. Complexity: linear.
template <class Coordinate>
Buckets sort_into_buckets(std::size_t count, std::size_t buckets, const Coordinate& coordinate) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t i = 0; i < count; ++i) {
    low = std::min(low, coordinate(i));
    high = std::max(high, coordinate(i));
  }
  const BucketOfCoordinate bucket_of(low, high, buckets);
  std::vector<std::uint32_t> bucket(count);
  for (std::size_t i = 0; i < count; ++i) bucket[i] = bucket_of(coordinate(i));
  return sort_into_buckets(bucket, buckets);
}

}  // namespace thalweg
