// Hilbert and insertion orders.
//
// 1. A point's cell in a 2^28 x 2^28 grid over the bounding box; the curve's key of a cell comes from the two
//    bits a level, of which `flip` and `swap` say how the curve runs in the quarter at hand. A table does
//    four levels at once.
// 2. Sort by the key's upper half, digit by digit, then those that share it by the rest and the index.
// 3. Rounds (Amenta, Choi, Rote, Incremental constructions con BRIO, 2003): a mixed index decides a vertex'
//    round, so a round is a random sample as far as the pattern of the input is concerned.
#include "spatial_order.hpp"

#include "base/large_pages.hpp"
#include "base/parallel.hpp"

#include <thalweg/base/raw_vector.hpp>

#include <algorithm>
#include <array>
#include <bit>

namespace thalweg {

namespace {

constexpr unsigned kLevels = 28;
constexpr unsigned kLevelsAtOnce = 4;
constexpr std::size_t kBlock = 1 << 14;

/// What four levels of the curve give, by (flip, swap, four bits of x, four bits of y): eight bits of the
/// key, above them the new flip and swap.
using CurveTable = std::array<std::uint16_t, 1 << (2 + 2 * kLevelsAtOnce)>;

constexpr CurveTable make_curve() {
  CurveTable table{};
  for (std::uint32_t entry = 0; entry < table.size(); ++entry) {
    std::uint32_t flip = entry >> 9U & 1U;
    std::uint32_t swap = entry >> 8U & 1U;
    std::uint32_t key = 0;
    for (unsigned level = kLevelsAtOnce; level-- > 0;) {
      std::uint32_t a = entry >> (kLevelsAtOnce + level) & 1U;
      std::uint32_t b = entry >> level & 1U;
      const std::uint32_t change = ((a ^ b) & swap) ^ flip;
      a ^= change;
      b ^= change;
      key = key << 2U | ((3 * a) ^ b);
      flip ^= a & (b ^ 1U);
      swap ^= b ^ 1U;
    }
    table[entry] = static_cast<std::uint16_t>(flip << 9U | swap << 8U | key);
  }
  return table;
}

constexpr CurveTable kCurve = make_curve();

/// The key of a cell in a grid of so many levels.
template <unsigned Levels>
std::uint64_t hilbert_key(std::uint32_t x, std::uint32_t y) {
  constexpr std::uint32_t kDigit = (1U << kLevelsAtOnce) - 1;
  std::uint64_t key = 0;
  std::uint32_t state = 0;
  for (unsigned level = Levels; level > 0;) {
    level -= kLevelsAtOnce;
    const std::uint32_t entry = kCurve[state << 8U | (x >> level & kDigit) << 4U | (y >> level & kDigit)];
    key = key << 8U | (entry & 0xffU);
    state = entry >> 8U;
  }
  return key;
}

struct Keyed {
  std::uint64_t key;
  std::uint32_t index;
  bool operator<(const Keyed& other) const {
    return key != other.key ? key < other.key : index < other.index;
  }
};

/// A point's cell in a grid of fewer levels.
struct CoarselyKeyed {
  std::uint32_t key;
  std::uint32_t index;
};

constexpr unsigned kDigitBits = 11;
constexpr std::uint32_t kBuckets = 1U << kDigitBits;

/// Sorts by `digit_of(item)` below kBuckets, and leaves the order of those that share it. `other`: room for
/// as many.
template <class Item, class DigitOf>
void sort_by_digit(RawVector<Item>& items, RawVector<Item>& other, const Progress& progress,
                   const DigitOf& digit_of) {
  const std::size_t ranges = range_count(items.size());
  std::vector<std::array<std::size_t, kBuckets>> start(ranges);  // each range's part of each bucket
  const auto in_ranges = [&](const auto& body) {
    for_each_block(ranges, 1, progress, [&](std::size_t i, std::size_t) {
      const std::size_t begin = items.size() * i / ranges, end = items.size() * (i + 1) / ranges;
      body(std::span(items).subspan(begin, end - begin), start[i]);
    });
  };
  in_ranges([&](std::span<const Item> range, auto& count) {
    count.fill(0);
    for (const Item& item : range) ++count[digit_of(item)];
  });
  std::size_t next = 0;
  for (std::size_t bucket = 0; bucket < kBuckets; ++bucket) {
    for (auto& of_range : start) next += std::exchange(of_range[bucket], next);
  }
  in_ranges([&](std::span<const Item> range, auto& place) {
    for (const Item& item : range) other[place[digit_of(item)]++] = item;
  });
  std::swap(items, other);
}

// By the upper 33 of the 56 bits, then what is equal in them by the rest.
void sort_by_key(RawVector<Keyed>& keyed, const Progress& progress) {
  constexpr unsigned kFirstBit = 23, kDigits = 3;
  RawVector<Keyed> other(keyed.size());
  for (unsigned digit = 0; digit < kDigits; ++digit) {
    sort_by_digit(keyed, other, progress, [digit](const Keyed& k) {
      return k.key >> (kFirstBit + digit * kDigitBits) & (kBuckets - 1);
    });
  }
  for (std::size_t begin = 0; begin < keyed.size();) {
    std::size_t end = begin + 1;
    while (end < keyed.size() && keyed[end].key >> kFirstBit == keyed[begin].key >> kFirstBit) ++end;
    if (end - begin > 1) std::sort(keyed.begin() + begin, keyed.begin() + end);
    begin = end;
  }
}

template <class Item>
std::vector<std::uint32_t> indices_of(const RawVector<Item>& items, const Progress& progress) {
  std::vector<std::uint32_t> indices;
  reserve_large(indices, items.size());
  indices.resize(items.size());
  for_each_block(items.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) indices[i] = items[i].index;
  });
  return indices;
}

/// The grid over the points' bounding box.
class Grid {
 public:
  explicit Grid(std::span<const Point2> points) : box_(bounding_box(points)) {
    const double side = std::max(box_.width(), box_.height());
    scale_ = side > 0 ? (1U << kLevels) / side : 0;
  }
  [[nodiscard]] std::uint32_t column(Point2 p) const { return cell(p.x - box_.x_min); }
  [[nodiscard]] std::uint32_t row(Point2 p) const { return cell(p.y - box_.y_min); }

 private:
  [[nodiscard]] std::uint32_t cell(double offset) const {  // infinite where the box is wider than all numbers
    constexpr std::uint32_t kLast = (1U << kLevels) - 1;
    return offset * scale_ < kLast ? static_cast<std::uint32_t>(offset * scale_) : kLast;
  }

  Box2 box_;
  double scale_ = 0;
};

}  // namespace

std::vector<std::uint32_t> hilbert_order(std::span<const Point2> points, const Progress& progress) {
  const Grid grid(points);
  RawVector<Keyed> keyed(points.size());
  for_each_block(points.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      keyed[i] = {hilbert_key<kLevels>(grid.column(points[i]), grid.row(points[i])),
                  static_cast<std::uint32_t>(i)};
    }
  });
  if (!std::is_sorted(keyed.begin(), keyed.end())) sort_by_key(keyed, progress);
  return indices_of(keyed, progress);
}

std::vector<std::uint32_t> coarse_hilbert_order(std::span<const Point2> points, const Progress& progress) {
  constexpr unsigned kCoarseLevels = 12, kSpare = 2 * kCoarseLevels - 2 * kDigitBits;
  const Grid grid(points);
  RawVector<CoarselyKeyed> keyed(points.size()), other(points.size());
  for_each_block(points.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    constexpr unsigned kFiner = kLevels - kCoarseLevels;
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint64_t key =
          hilbert_key<kCoarseLevels>(grid.column(points[i]) >> kFiner, grid.row(points[i]) >> kFiner);
      keyed[i] = {static_cast<std::uint32_t>(key >> kSpare), static_cast<std::uint32_t>(i)};
    }
  });
  sort_by_digit(keyed, other, progress, [](const CoarselyKeyed& k) { return k.key & (kBuckets - 1); });
  sort_by_digit(keyed, other, progress, [](const CoarselyKeyed& k) { return k.key >> kDigitBits; });
  return indices_of(keyed, progress);
}

std::size_t insertion_round(std::uint32_t index) {
  // splitmix64: Steele, Lea, Flood, Fast splittable pseudorandom number generators, 2014.
  std::uint64_t value = index + 0x9e3779b97f4a7c15U;
  value = (value ^ (value >> 30U)) * 0xbf58476d1ce4e5b9U;
  value = (value ^ (value >> 27U)) * 0x94d049bb133111ebU;
  value ^= value >> 31U;
  const auto earlier = static_cast<std::size_t>(std::countr_zero(value | 1ULL << 62U)) / 4;
  return kInsertionRounds - 1 - std::min(earlier, kInsertionRounds - 1);
}

std::vector<std::uint32_t> insertion_order(std::span<const Point2> points, const Progress& progress) {
  const std::vector<std::uint32_t> order = hilbert_order(points, progress);
  const auto count = static_cast<std::uint32_t>(order.size());
  std::vector<std::uint32_t> rounds = in_rounds(count, [](std::uint32_t) { return true; });
  for (std::uint32_t& i : rounds) i = order[i];
  return rounds;
}

}  // namespace thalweg
