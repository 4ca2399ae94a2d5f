// Hilbert and insertion orders.
//
// 1. A point's cell in a 2^28 x 2^28 grid over the bounding box; the curve's key of a cell comes from the two
//    bits a level, of which `flip` and `swap` say how the curve runs in the quarter at hand. A table does
//    four levels at once.
// 2. Sort by the key's upper 33 bits, digit by digit, then the few that share them by the rest and the index.
// 3. Rounds (Amenta, Choi, Rote, Incremental constructions con BRIO, 2003): a mixed index decides a vertex'
//    round, so a round is a random sample as far as the pattern of the input is concerned.
#include "spatial_order.hpp"

#include "base/large_pages.hpp"
#include "base/ordered_blocks.hpp"
#include "base/parallel.hpp"
#include "base/splitmix.hpp"

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

/// The upper bits of a point's key, and below them its index: what there is to sort, in one word.
constexpr unsigned kIndexBits = 31, kUpperBits = 64 - kIndexBits;
constexpr std::uint64_t pack(std::uint64_t key, std::size_t index) {
  return key >> (2 * kLevels - kUpperBits) << kIndexBits | index;
}
constexpr std::uint32_t index_in(std::uint64_t packed) {
  return static_cast<std::uint32_t>(packed & ((std::uint64_t{1} << kIndexBits) - 1));
}

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

/// The grid over the points' bounding box.
class Grid {
 public:
  explicit Grid(std::span<const Point2> points) : box_(bounding_box(points)) {
    const double side = std::max(box_.width(), box_.height());
    scale_ = side > 0 ? (1U << kLevels) / side : 0;
  }
  [[nodiscard]] std::uint64_t key(Point2 p) const { return hilbert_key<kLevels>(column(p), row(p)); }
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

/// From the order of upper bits to that of keys.
class Settler {
 public:
  Settler(std::span<const Point2> points, const Grid& grid, std::span<const std::uint64_t> packed,
          std::span<std::uint32_t> indices)
      : points_(points), grid_(grid), packed_(packed), indices_(indices) {}

  /// Writes the indices of [begin, end); those that share their upper bits where the first of them lies.
  /// Appends the points that share a key.
  void settle(std::size_t begin, std::size_t end, std::vector<std::uint32_t>& crowded) const {
    std::vector<Keyed> run;
    for (std::size_t i = begin; i < end;) {
      std::size_t last = i + 1;
      while (last < packed_.size() && same(i, last)) ++last;
      if (i > 0 && same(i - 1, i)) {
        // Part of a run that began before.
      } else if (last == i + 1) {
        indices_[i] = index_in(packed_[i]);
      } else {
        settle_run(i, last, run, crowded);
      }
      i = last;
    }
  }

 private:
  [[nodiscard]] bool same(std::size_t i, std::size_t j) const {
    return packed_[i] >> kIndexBits == packed_[j] >> kIndexBits;
  }
  void settle_run(std::size_t begin, std::size_t end, std::vector<Keyed>& run,
                  std::vector<std::uint32_t>& crowded) const {
    run.clear();
    for (const std::uint64_t item : packed_.subspan(begin, end - begin)) {
      run.push_back({grid_.key(points_[index_in(item)]), index_in(item)});
    }
    std::sort(run.begin(), run.end());
    for (std::size_t j = 0; j < run.size(); ++j) {
      indices_[begin + j] = run[j].index;
      const bool shared =
          (j > 0 && run[j - 1].key == run[j].key) || (j + 1 < run.size() && run[j + 1].key == run[j].key);
      if (shared) crowded.push_back(run[j].index);
    }
  }

  std::span<const Point2> points_;
  const Grid& grid_;
  std::span<const std::uint64_t> packed_;
  std::span<std::uint32_t> indices_;
};

}  // namespace

CurveOrder order_along_curve(std::span<const Point2> points, const Progress& progress) {
  const Grid grid(points);
  RawVector<std::uint64_t> packed(points.size());
  for_each_block(points.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) packed[i] = pack(grid.key(points[i]), i);
  });
  if (!std::is_sorted(packed.begin(), packed.end())) {
    RawVector<std::uint64_t> other(points.size());
    for (unsigned bit = kIndexBits; bit < kIndexBits + kUpperBits; bit += kDigitBits) {
      sort_by_digit(packed, other, progress,
                    [bit](std::uint64_t item) { return item >> bit & (kBuckets - 1); });
    }
  }
  CurveOrder order;
  reserve_large(order.indices, points.size());
  order.indices.resize(points.size());
  const Settler settler(points, grid, packed, order.indices);
  order.crowded = list_in_order<std::uint32_t>(
      points.size(), kBlock, progress,
      [&](std::size_t begin, std::size_t end, std::vector<std::uint32_t>& crowded) {
        settler.settle(begin, end, crowded);
      });
  return order;
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
  std::vector<std::uint32_t> indices(keyed.size());
  for_each_block(keyed.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) indices[i] = keyed[i].index;
  });
  return indices;
}

std::size_t insertion_round(std::uint32_t index) {
  const auto earlier = static_cast<std::size_t>(std::countr_zero(splitmix64(index) | 1ULL << 62U)) / 4;
  return kInsertionRounds - 1 - std::min(earlier, kInsertionRounds - 1);
}

}  // namespace thalweg
