// Ranks by coordinates alone, and what they cost.
#include "optimize/ties.hpp"

#include "base/buckets.hpp"
#include "base/parallel.hpp"
#include "base/prefetch.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

namespace thalweg {

namespace {

constexpr std::size_t kBlock = 4096;
constexpr std::size_t kAhead = 16;  ///< what will be visited at random is asked for so much earlier

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
      : tin_(tin), quadrilaterals_(quadrilaterals), lowest_(quadrilaterals.size()) {
    for_each_block(quadrilaterals.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
      for (std::size_t q = begin; q < end; ++q) {
        const auto& [s, u, t, v, diagonal] = quadrilaterals_[q];
        lowest_[q] = std::min({tin_.point(s), tin_.point(u), tin_.point(t), tin_.point(v)});
      }
    });
  }

  /// By the x of the lowest corner; within a bucket the order is not made yet.
  [[nodiscard]] Buckets buckets() const {
    const std::size_t count = lowest_.size();
    return sort_into_buckets(count, count / 2 + 1, [&](std::size_t q) { return lowest_[q].x; });
  }

  using Key = std::pair<Point2, std::uint32_t>;

  void prefetch_key(std::uint32_t q) const { prefetch(&lowest_[q]); }

  void sort(std::span<std::uint32_t> items, std::vector<Key>& keys) const {
    if (items.size() < 2) return;
    keys.clear();
    for (const std::uint32_t q : items) keys.emplace_back(lowest_[q], q);
    if (keys.size() > kFew &&
        std::ranges::all_of(keys, [&](const Key& key) { return key.first.x == keys.front().first.x; })) {
      sort_column(keys);
    } else {
      sort_keys(keys);
    }
    for (std::size_t i = 0; i < items.size(); ++i) items[i] = keys[i].second;
  }

 private:
  static constexpr std::size_t kFew = 32;  ///< up to here buckets do not pay

  void sort_keys(std::span<Key> keys) const {
    std::sort(keys.begin(), keys.end(), [&](const Key& a, const Key& b) {
      if (a.first != b.first) return a.first < b.first;
      return a.second != b.second && corners(a.second) < corners(b.second);
    });
  }

  /// A column of a lattice: keys that differ in y only.
  void sort_column(std::vector<Key>& keys) const {
    const Buckets buckets =
        sort_into_buckets(keys.size(), keys.size(), [&](std::size_t i) { return keys[i].first.y; });
    std::vector<Key> sorted;
    sorted.reserve(keys.size());
    for (const std::uint32_t i : buckets.item) sorted.push_back(keys[i]);
    for (std::size_t b = 0; b < buckets.size(); ++b) {
      sort_keys(std::span(sorted).subspan(buckets.first[b], buckets.first[b + 1] - buckets.first[b]));
    }
    keys = std::move(sorted);
  }

  [[nodiscard]] std::array<Point2, 4> corners(std::uint32_t q) const {
    const auto& [s, u, t, v, diagonal] = quadrilaterals_[q];
    std::array<Point2, 4> sorted = {tin_.point(s), tin_.point(u), tin_.point(t), tin_.point(v)};
    std::sort(sorted.begin(), sorted.end());
    return sorted;
  }

  const Tin& tin_;
  std::span<const Quadrilateral> quadrilaterals_;
  std::vector<Point2> lowest_;
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
  const auto item_at = [&](std::size_t r) { return sorted.item[std::min(r, count - 1)]; };
  for_each_block(sorted.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    std::vector<CornerOrder::Key> keys;
    for (std::size_t b = begin; b < end; ++b) {
      for (const std::size_t more : {0, 1}) order.prefetch_key(item_at(sorted.first[b] + kAhead + more));
      order.sort(sorted.items(b), keys);
    }
    for (std::size_t r = sorted.first[begin]; r < sorted.first[end]; ++r) {
      const std::uint32_t q = sorted.item[r], ahead = item_at(r + kAhead);
      prefetch_to_write(&rank[ahead]);
      prefetch_to_write(&unary[ahead]);
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
