// Numbers by coordinates alone, for what everything else leaves open.
#include "optimize/ties.hpp"

#include "base/parallel.hpp"
#include "base/splitmix.hpp"

#include <thalweg/geometry/point.hpp>

#include <algorithm>
#include <bit>
#include <vector>

namespace thalweg {

namespace {

constexpr std::size_t kBlock = 4096;

std::int64_t cut_to_fit(std::uint64_t bits, std::size_t count) {
  return static_cast<std::int64_t>(bits >> (2 + static_cast<unsigned>(std::bit_width(count))));
}

Box2 box_of(std::span<const Point2> points, const Progress& progress) {
  std::vector<Box2> parts((points.size() + kBlock - 1) / kBlock);
  for_each_block(points.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (const Point2 p : points.subspan(begin, end - begin)) parts[begin / kBlock].add(p);
  });
  Box2 box;
  for (const Box2& part : parts) {
    box.add({part.x_min, part.y_min});
    box.add({part.x_max, part.y_max});
  }
  return box;
}

}  // namespace

std::int64_t tie_of(std::uint64_t rank, std::size_t count) {
  return cut_to_fit(splitmix64(rank), count);
}

void find_ties(const Tin& tin, std::span<const Quadrilateral> quadrilaterals, std::span<std::int64_t> ties,
               const Progress& progress) {
  const Box2 box = box_of(tin.points(), progress);
  const double per_width = 1 / box.width(), per_height = 1 / box.height();
  const auto number_of = [&](VertexId v) {
    const Point2 p = tin.point(v);
    const auto x = std::bit_cast<std::uint64_t>((p.x - box.x_min) * per_width);
    const auto y = std::bit_cast<std::uint64_t>((p.y - box.y_min) * per_height);
    const std::uint64_t mixed = x * 0xbf58476d1ce4e5b9U + (y ^ (y >> 32U)) * 0x94d049bb133111ebU;
    return (mixed ^ (mixed >> 29U)) * 0xbf58476d1ce4e5b9U;
  };
  for_each_block(quadrilaterals.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t q = begin; q < end; ++q) {
      const HalfedgeId diagonal = quadrilaterals[q].diagonal;
      const std::uint64_t ends = number_of(tin.origin(diagonal)) + number_of(tin.target(diagonal));
      ties[q] = cut_to_fit(splitmix64(ends), quadrilaterals.size()) | 1;
    }
  });
}

}  // namespace thalweg
