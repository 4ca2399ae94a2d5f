// Hilbert and insertion orders.
//
// 1. A point's cell in a 2^28 x 2^28 grid over the bounding box; the curve's key of a cell comes from the two
//    bits a level, of which `flip` and `swap` say how the curve runs in the quarter at hand.
// 2. Rounds (Amenta, Choi, Rote, Incremental constructions con BRIO, 2003): a mixed index decides a point's
//    round, so a round is a random sample as far as the pattern of the input is concerned.
// 3. Sort by (round, key, index).
#include "spatial_order.hpp"

#include <base/parallel.hpp>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <bit>

namespace thalweg {

namespace {

constexpr unsigned kLevels = 28;
constexpr unsigned kRoundBits = 64 - 2 * kLevels;
constexpr std::size_t kBlock = 1 << 14;

struct Keyed {
  std::uint64_t key;
  std::uint32_t index;
  bool operator<(const Keyed& other) const {
    return key != other.key ? key < other.key : index < other.index;
  }
};

std::uint64_t hilbert_key(std::uint32_t x, std::uint32_t y) {
  std::uint64_t key = 0;
  std::uint32_t flip = 0;
  std::uint32_t swap = 0;
  for (unsigned level = kLevels; level-- > 0;) {
    std::uint32_t a = (x >> level) & 1U;
    std::uint32_t b = (y >> level) & 1U;
    const std::uint32_t change = ((a ^ b) & swap) ^ flip;
    a ^= change;
    b ^= change;
    key = key << 2U | ((3 * a) ^ b);
    flip ^= a & (b ^ 1U);
    swap ^= b ^ 1U;
  }
  return key;
}

// splitmix64: Steele, Lea, Flood, Fast splittable pseudorandom number generators, 2014.
std::uint64_t mix(std::uint64_t value) {
  value += 0x9e3779b97f4a7c15U;
  value = (value ^ (value >> 30U)) * 0xbf58476d1ce4e5b9U;
  value = (value ^ (value >> 27U)) * 0x94d049bb133111ebU;
  return value ^ (value >> 31U);
}

std::uint64_t insertion_round(std::size_t index) {
  constexpr std::uint64_t kLast = (1U << kRoundBits) - 1;
  return kLast - static_cast<std::uint64_t>(std::countr_zero(mix(index) | 1ULL << 62U)) / 2;
}

template <class Round>
std::vector<std::uint32_t> ordered(std::span<const Point2> points, const Progress& progress,
                                   const Round& round) {
  const Box2 box = bounding_box(points);
  const double side = std::max(box.width(), box.height());
  const double scale = side > 0 ? (1U << kLevels) / side : 0;
  const auto cell = [scale](double offset) {
    return static_cast<std::uint32_t>(std::min(offset * scale, double{(1U << kLevels) - 1}));
  };
  std::vector<Keyed> keyed(points.size());
  for_each_block(points.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint64_t key = hilbert_key(cell(points[i].x - box.x_min), cell(points[i].y - box.y_min));
      keyed[i] = {round(i) << (2 * kLevels) | key, static_cast<std::uint32_t>(i)};
    }
  });
  tbb::parallel_sort(keyed.begin(), keyed.end());
  std::vector<std::uint32_t> order(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = keyed[i].index;
  return order;
}

}  // namespace

std::vector<std::uint32_t> hilbert_order(std::span<const Point2> points, const Progress& progress) {
  return ordered(points, progress, [](std::size_t) { return std::uint64_t{0}; });
}

std::vector<std::uint32_t> insertion_order(std::span<const Point2> points, const Progress& progress) {
  return ordered(points, progress, insertion_round);
}

}  // namespace thalweg
