// Ranks by coordinates alone, and what they cost.
#include "optimize/ties.hpp"

#include "base/parallel.hpp"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <bit>

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

template <std::size_t Criteria>
std::vector<std::uint32_t> add_flips_and_ties(const Tin& tin, std::span<const Quadrilateral> quadrilaterals,
                                              std::vector<Cost<Criteria>>& unary, const Progress& progress) {
  using Corners = std::array<Point2, 4>;
  const auto sorted_corners = [&](std::uint32_t q) {
    const auto& [s, u, t, v, diagonal] = quadrilaterals[q];
    Corners corners = {tin.point(s), tin.point(u), tin.point(t), tin.point(v)};
    std::sort(corners.begin(), corners.end());
    return corners;
  };
  struct Key {
    Point2 lowest;
    std::uint32_t quadrilateral;
  };
  const std::size_t count = quadrilaterals.size();
  std::vector<Key> keys(count);
  for_each_block(count, kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t q = begin; q < end; ++q) {
      const auto& [s, u, t, v, diagonal] = quadrilaterals[q];
      keys[q] = {std::min({tin.point(s), tin.point(u), tin.point(t), tin.point(v)}),
                 static_cast<std::uint32_t>(q)};
    }
  });
  tbb::parallel_sort(keys.begin(), keys.end(), [&](const Key& a, const Key& b) {
    if (a.lowest != b.lowest) return a.lowest < b.lowest;
    return a.quadrilateral != b.quadrilateral &&
           sorted_corners(a.quadrilateral) < sorted_corners(b.quadrilateral);
  });
  std::vector<std::uint32_t> rank(count);
  for_each_block(count, kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r) {
      const std::uint32_t q = keys[r].quadrilateral;
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
