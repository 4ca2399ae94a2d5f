// Ranks by coordinates alone, and what they cost.
#include "optimize/ties.hpp"

#include "base/buckets.hpp"
#include "base/parallel.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

namespace thalweg {

namespace {

constexpr std::size_t kBlock = 4096;

std::uint64_t splitmix64(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31U);
}

}  // namespace

std::int64_t tie_of(std::uint64_t rank, std::size_t count) {
  const int bits = 62 - static_cast<int>(std::bit_width(count));
  return static_cast<std::int64_t>(splitmix64(rank) >> (64 - bits));
}

namespace {

/// Quadrilaterals in the order of their corners.
class CornerOrder {
 public:
  CornerOrder(const Tin& tin, std::span<const Quadrilateral> quadrilaterals, const Progress& progress)
      : tin_(tin), quadrilaterals_(quadrilaterals), progress_(progress) {}

  /// By the x of the lowest corner; within a bucket the order is not made yet.
  [[nodiscard]] Buckets buckets() const {
    const auto [least, most] = std::minmax_element(tin_.points().begin(), tin_.points().end());
    const std::size_t count = quadrilaterals_.size();
    const BucketOfCoordinate bucket_of(least->x, most->x, count / 2 + 1);
    std::vector<std::uint32_t> bucket(count);
    for_each_block(count, kBlock, progress_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t q = begin; q < end; ++q) {
        bucket[q] = bucket_of(lowest(static_cast<std::uint32_t>(q)).x);
      }
    });
    return sort_into_buckets(bucket, count / 2 + 1);
  }

  void sort(std::span<std::uint32_t> items, std::vector<std::pair<Point2, std::uint32_t>>& keys) const {
    if (items.size() < 2) return;
    keys.clear();
    for (const std::uint32_t q : items) keys.emplace_back(lowest(q), q);
    std::sort(keys.begin(), keys.end(), [&](const auto& a, const auto& b) {
      if (a.first != b.first) return a.first < b.first;
      return a.second != b.second && corners(a.second) < corners(b.second);
    });
    for (std::size_t i = 0; i < items.size(); ++i) items[i] = keys[i].second;
  }

 private:
  [[nodiscard]] Point2 lowest(std::uint32_t q) const {
    const auto& [s, u, t, v, diagonal] = quadrilaterals_[q];
    return std::min({tin_.point(s), tin_.point(u), tin_.point(t), tin_.point(v)});
  }
  [[nodiscard]] std::array<Point2, 4> corners(std::uint32_t q) const {
    const auto& [s, u, t, v, diagonal] = quadrilaterals_[q];
    std::array<Point2, 4> sorted = {tin_.point(s), tin_.point(u), tin_.point(t), tin_.point(v)};
    std::sort(sorted.begin(), sorted.end());
    return sorted;
  }

  const Tin& tin_;
  std::span<const Quadrilateral> quadrilaterals_;
  const Progress& progress_;
};

}  // namespace

template <std::size_t Criteria>
std::vector<std::uint32_t> add_flips_and_ties(const Tin& tin, std::span<const Quadrilateral> quadrilaterals,
                                              std::vector<Cost<Criteria>>& unary, const Progress& progress) {
  const std::size_t count = quadrilaterals.size();
  std::vector<std::uint32_t> rank(count);
  if (count == 0) return rank;
  const CornerOrder order(tin, quadrilaterals, progress);
  Buckets sorted = order.buckets();
  for_each_block(sorted.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    std::vector<std::pair<Point2, std::uint32_t>> keys;
    for (std::size_t b = begin; b < end; ++b) order.sort(sorted.items(b), keys);
    for (std::size_t r = sorted.first[begin]; r < sorted.first[end]; ++r) {
      const std::uint32_t q = sorted.item[r];
      rank[q] = static_cast<std::uint32_t>(r);
      unary[q].level[Criteria] = 1;
      unary[q].level[Criteria + 1] = tie_of(r, count);
    }
  });
  return rank;
}

template std::vector<std::uint32_t> add_flips_and_ties(const Tin&, std::span<const Quadrilateral>,
                                                       std::vector<Cost<1>>&, const Progress&);
template std::vector<std::uint32_t> add_flips_and_ties(const Tin&, std::span<const Quadrilateral>,
                                                       std::vector<Cost<2>>&, const Progress&);
template std::vector<std::uint32_t> add_flips_and_ties(const Tin&, std::span<const Quadrilateral>,
                                                       std::vector<Cost<4>>&, const Progress&);

}  // namespace thalweg
