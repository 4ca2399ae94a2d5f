// Distinct positions.
//
// 1. All positions, points first, then line vertices, are sorted by (x, y, index). Without snapping these are
//    only those points that share a cell of the curve along which all are put in order, or that are near a
//    line.
// 2. Points without snapping: each run of equal positions is one group.
// 3. With snapping a sweep in that order keeps the representatives within reach in x, sorted by y; two of
//    them are farther apart than the reach, so a window of reach by reach holds only a few. First the points:
//    each joins the first representative within reach, or becomes one. Then the line vertices: each takes the
//    nearest point's representative within reach; the others are swept among themselves as points were. Their
//    reach is at least a quarter of a pixel: with noding, which bends by less than 0.75 pixels, a line stays
//    within a pixel of what was drawn.
// 4. A group's name is its smallest index; groups are numbered in order of their names.
#include "merge.hpp"

#include "base/buckets.hpp"
#include "base/large_pages.hpp"
#include "base/ordered_blocks.hpp"
#include "base/parallel.hpp"
#include "box_tree.hpp"
#include "noding.hpp"
#include "provenance.hpp"
#include "spatial_order.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/base/raw_vector.hpp>

#include <fmt/format.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <optional>
#include <span>
#include <tuple>

namespace thalweg {

namespace {

constexpr double kLargest = 1e15;
constexpr std::size_t kBlock = 4096;  // buckets that a thread takes at once

struct Placed {
  Point2 xy;
  std::uint32_t index = 0;
  bool operator<(const Placed& other) const {
    return std::tie(xy.x, xy.y, index) < std::tie(other.xy.x, other.xy.y, other.index);
  }
};

bool fit(Point2 p, double z) {
  return std::abs(p.x) <= kLargest && std::abs(p.y) <= kLargest && std::abs(z) <= kLargest;
}

[[noreturn]] void refuse(const std::string& what, Point2 p, double z) {
  throw Error(ErrorCode::BadCoordinate,
              fmt::format("{}: coordinates ({}, {}, {}) must be finite and within 1e15; filter or repair it",
                          what, p.x, p.y, z));
}

void check_size(std::size_t positions) {
  constexpr std::size_t kMost = (std::size_t{1} << 31U) - 1;
  if (positions <= kMost) return;
  throw Error(ErrorCode::SizeLimit,
              fmt::format("there are {} points and vertices of lines, more than {}; split the area",
                          positions, kMost));
}

void check_coordinates(const Survey& survey, const Progress& progress) {
  const std::vector<Point2>& xy = survey.points.xy;
  const std::vector<double>& heights = survey.points.z;
  const auto unfit = list_in_order<std::size_t>(
      xy.size(), kBlock, progress, [&](std::size_t begin, std::size_t end, std::vector<std::size_t>& found) {
        for (std::size_t i = begin; i < end; ++i) {
          if (!fit(xy[i], heights[i])) found.push_back(i);
        }
      });
  if (!unfit.empty()) {
    const std::size_t i = unfit.front();
    refuse(describe_point(survey, i), xy[i], heights[i]);
  }
  for (std::size_t l = 0; l < survey.lines.size(); ++l) {
    const SurveyLine& line = survey.lines[l];
    for (std::size_t i = 0; i < line.xy.size(); ++i) {
      const double z = line.z.empty() ? 0 : line.z[i];
      if (!fit(line.xy[i], z)) refuse(describe_line_vertex(survey, l, i), line.xy[i], z);
    }
  }
}

// Representatives with x in a moving range, sorted by (y, x).
class Window {
 public:
  explicit Window(double reach) : reach_(reach) {}
  void add(const Placed& p) {
    by_y_.emplace(std::pair(p.xy.y, p.xy.x), p);
    by_x_.push_back(p);
  }
  void drop_below(double x) {
    for (; oldest_ < by_x_.size() && by_x_[oldest_].xy.x < x; ++oldest_) {
      by_y_.erase({by_x_[oldest_].xy.y, by_x_[oldest_].xy.x});
    }
  }
  // The representative within reach of p that comes first under `less(candidate, best)`.
  template <class Less>
  [[nodiscard]] std::optional<Placed> best_near(Point2 p, const Less& less) const {
    std::optional<Placed> best;
    for (auto it = by_y_.lower_bound({p.y - reach_, -2 * kLargest}); it != by_y_.end(); ++it) {
      if (it->first.first > p.y + reach_) break;
      if (squared_distance(it->second.xy, p) > reach_ * reach_) continue;
      if (!best || less(it->second, *best)) best = it->second;
    }
    return best;
  }
  static double squared_distance(Point2 p, Point2 q) {
    return (p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y);
  }

 private:
  double reach_;
  std::map<std::pair<double, double>, Placed> by_y_;
  std::vector<Placed> by_x_;
  std::size_t oldest_ = 0;
};

// For each index of `sorted` the index of its representative is set: the first of those within reach.
// Returns the representatives.
std::vector<Placed> merge_within(std::span<const Placed> sorted, double snap,
                                 LargeVector<std::uint32_t>& representative) {
  std::vector<Placed> kept;
  Window window(snap);
  for (const Placed& p : sorted) {
    window.drop_below(p.xy.x - snap);
    const std::optional<Placed> near = window.best_near(p.xy, std::less<>());
    representative[p.index] = near ? near->index : p.index;
    if (near) continue;
    kept.push_back(p);
    window.add(p);
  }
  return kept;
}

// The same for equal positions alone.
void merge_equal(std::span<const Placed> sorted, LargeVector<std::uint32_t>& representative,
                 const Progress& progress) {
  for_each_block(sorted.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (i > 0 && sorted[i - 1].xy == sorted[i].xy) continue;  // it belongs to one before
      for (std::size_t j = i; j < sorted.size() && sorted[j].xy == sorted[i].xy; ++j) {
        representative[sorted[j].index] = sorted[i].index;
      }
    }
  });
}

std::vector<Placed> merge_in_order(std::span<const Placed> sorted, double snap,
                                   LargeVector<std::uint32_t>& representative, const Progress& progress) {
  if (snap > 0) return merge_within(sorted, snap, representative);
  merge_equal(sorted, representative, progress);
  std::vector<Placed> kept;
  std::ranges::copy_if(sorted, std::back_inserter(kept),
                       [&](const Placed& p) { return representative[p.index] == p.index; });
  return kept;
}

// Assigns the line vertices that are near a point's representative; returns the others, still sorted.
std::vector<Placed> join_points(std::span<const Placed> sorted, std::span<const Placed> points, double snap,
                                LargeVector<std::uint32_t>& representative) {
  std::vector<Placed> others;
  Window window(snap);
  std::size_t next = 0;
  for (const Placed& p : sorted) {
    for (; next < points.size() && points[next].xy.x <= p.xy.x + snap; ++next) {
      if (points[next].xy.x >= p.xy.x - snap) window.add(points[next]);
    }
    window.drop_below(p.xy.x - snap);
    const auto nearer = [&p](const Placed& a, const Placed& b) {
      const double d_a = Window::squared_distance(a.xy, p.xy);
      const double d_b = Window::squared_distance(b.xy, p.xy);
      return d_a != d_b ? d_a < d_b : a < b;
    };
    if (const auto near = window.best_near(p.xy, nearer)) {
      representative[p.index] = near->index;
    } else {
      others.push_back(p);
    }
  }
  return others;
}

// Points whose positions may be those of others, or within reach of a line vertex: all that are, few more.
std::vector<std::uint32_t> points_to_merge(std::span<const Point2> points, std::span<const Point2> on_lines,
                                           std::span<const std::uint32_t> crowded, double reach,
                                           const Progress& progress) {
  std::vector<std::uint32_t> found;
  if (!on_lines.empty()) {
    std::vector<Segment> spots;
    for (const Point2 p : on_lines) spots.push_back({p, p});
    const TouchedSquares near_lines(spots, reach);
    found = list_in_order<std::uint32_t>(
        points.size(), kBlock, progress,
        [&](std::size_t begin, std::size_t end, std::vector<std::uint32_t>& near) {
          for (std::size_t i = begin; i < end; ++i) {
            if (near_lines.may_meet(box_around(points[i], 0))) near.push_back(static_cast<std::uint32_t>(i));
          }
        });
  }
  std::ranges::copy_if(crowded, std::back_inserter(found),
                       [&](std::uint32_t i) { return i < points.size(); });
  tbb::parallel_sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

std::vector<std::uint32_t> range(std::size_t begin, std::size_t end) {
  std::vector<std::uint32_t> numbers(end - begin);
  std::iota(numbers.begin(), numbers.end(), static_cast<std::uint32_t>(begin));
  return numbers;
}

// The positions with these indices, sorted.
RawVector<Placed> sort_places(std::span<const Point2> positions, std::span<const std::uint32_t> indices,
                              const Progress& progress) {
  const std::size_t count = indices.size();
  if (count == 0) return {};
  Buckets buckets =
      sort_into_buckets(count, count / 2 + 1, [&](std::size_t i) { return positions[indices[i]].x; });
  RawVector<Placed> placed(count);
  for_each_block(buckets.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const auto from = placed.begin() + buckets.first[b];
      auto to = from;
      for (const std::uint32_t i : buckets.items(b)) *to++ = {positions[indices[i]], indices[i]};
      std::sort(from, to);
    }
  });
  return placed;
}

// For each index the index whose position it takes.
LargeVector<std::uint32_t> find_representatives(std::span<const Point2> all, std::size_t point_count,
                                                std::span<const std::uint32_t> crowded, double snap,
                                                double line_snap, const Progress& progress) {
  LargeVector<std::uint32_t> representative(all.size());
  std::iota(representative.begin(), representative.end(), 0U);
  const std::vector<std::uint32_t> to_merge =
      snap > 0
          ? range(0, point_count)
          : points_to_merge(all.first(point_count), all.subspan(point_count), crowded, line_snap, progress);
  const std::vector<Placed> points =
      merge_in_order(sort_places(all, to_merge, progress), snap, representative, progress);
  if (point_count == all.size()) return representative;
  const RawVector<Placed> vertices = sort_places(all, range(point_count, all.size()), progress);
  merge_in_order(join_points(vertices, points, line_snap, representative), line_snap, representative,
                 progress);
  return representative;
}

// A group that is not named after its representative.
struct Renamed {
  std::uint32_t name = 0;
  std::uint32_t representative = 0;
};

// Puts the smallest index of its group in the place of each representative.
std::vector<Renamed> name_groups(LargeVector<std::uint32_t>& representative, const Progress& progress) {
  const auto joined = list_in_order<std::uint32_t>(
      representative.size(), kBlock, progress,
      [&](std::size_t begin, std::size_t end, std::vector<std::uint32_t>& found) {
        for (std::size_t i = begin; i < end; ++i) {
          if (representative[i] != i) found.push_back(static_cast<std::uint32_t>(i));
        }
      });
  std::vector<Renamed> renamed;
  for (const std::uint32_t i : joined) {
    const std::uint32_t chosen = representative[i];
    if (i > chosen || representative[chosen] != chosen) continue;
    renamed.push_back({i, chosen});
    representative[chosen] = i;
  }
  for (const std::uint32_t i : joined) representative[i] = representative[representative[i]];
  return renamed;
}

// How many groups have names before each block of indices; then all.
std::vector<std::size_t> groups_before(std::span<const std::uint32_t> name, const Progress& progress) {
  std::vector<std::size_t> before((name.size() + kBlock - 1) / kBlock + 1);
  for_each_block(name.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    std::size_t& count = before[begin / kBlock + 1];
    for (std::size_t i = begin; i < end; ++i) count += name[i] == i ? 1 : 0;
  });
  std::partial_sum(before.begin(), before.end(), before.begin());
  return before;
}

// Where each line's vertices start among those of all; then the end.
std::vector<std::size_t> first_vertices(std::span<const SurveyLine> lines) {
  std::vector<std::size_t> first{0};
  for (const SurveyLine& line : lines) first.push_back(first.back() + line.xy.size());
  return first;
}

// Points, then line vertices.
std::vector<Point2> all_positions(const Survey& survey, std::size_t count) {
  std::vector<Point2> all;
  reserve_large(all, count);
  all.insert(all.end(), survey.points.xy.begin(), survey.points.xy.end());
  for (const SurveyLine& line : survey.lines) all.insert(all.end(), line.xy.begin(), line.xy.end());
  return all;
}

// Numbers the groups of `all` in the order of their names. `merged` knows where lines start.
void number_groups(std::span<const Point2> all, std::size_t point_count, LargeVector<std::uint32_t>& name,
                   MergedVertices& merged, const Progress& progress) {
  const auto origin_of = [&](std::size_t i) {
    if (i < point_count) return VertexOrigin{VertexOrigin::Kind::Point, static_cast<std::uint32_t>(i), 0};
    const auto& first = merged.first_of_line;
    const auto line = std::ranges::upper_bound(first, i - point_count) - first.begin() - 1;
    return VertexOrigin{VertexOrigin::Kind::LineVertex, static_cast<std::uint32_t>(line),
                        static_cast<std::uint32_t>(i - point_count - first[line])};
  };
  const std::vector<Renamed> renamed = name_groups(name, progress);
  const std::vector<std::size_t> before = groups_before(name, progress);
  reserve_large(merged.xy, before.back());
  merged.xy.resize(before.back());
  reserve_large(merged.origins, before.back());
  merged.origins.resize(before.back());
  for_each_block(all.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    std::size_t next = before[begin / kBlock];
    for (std::size_t i = begin; i < end; ++i) {
      if (name[i] != i) continue;
      merged.xy[next] = all[i];
      merged.origins[next] = origin_of(i);
      merged.number(i) = static_cast<std::uint32_t>(next++);
    }
  });
  for_each_block(all.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (name[i] != i) merged.number(i) = merged.number(name[i]);
    }
  });
  for (const auto& [first, representative] : renamed) {
    merged.xy[merged.number(first)] = all[representative];
    merged.origins[merged.number(first)] = origin_of(representative);
  }
  merged.point_count = before[point_count / kBlock];
  for (std::size_t i = point_count / kBlock * kBlock; i < point_count; ++i) {
    merged.point_count += name[i] == i ? 1 : 0;
  }
}

}  // namespace

MergedVertices merge_vertices(const Survey& survey, const GroundOptions& options, Progress& progress) {
  progress.start_phase("merging points");
  check_coordinates(survey, progress);
  MergedVertices merged;
  const std::size_t point_count = survey.points.xy.size();
  merged.first_of_line = first_vertices(survey.lines);
  check_size(point_count + merged.first_of_line.back());
  std::vector<Point2> with_lines;
  if (!survey.lines.empty()) with_lines = all_positions(survey, point_count + merged.first_of_line.back());
  const std::span<const Point2> all = survey.lines.empty() ? survey.points.xy : with_lines;
  if (int exponent = 0; options.resolution != 0 && !(std::isfinite(options.resolution) &&
                                                     std::frexp(options.resolution, &exponent) == 0.5)) {
    throw Error(ErrorCode::Usage,
                fmt::format("the resolution has to be 0 or a power of two, not {}", options.resolution));
  }
  merged.pixel = snapping_pixel(all, options.resolution);
  merged.of_point.resize(point_count);
  merged.of_line_vertex.resize(all.size() - point_count);
  CurveOrder order = order_along_curve(all, progress);
  LargeVector<std::uint32_t> name = find_representatives(all, point_count, order.crowded, options.snap,
                                                         std::max(options.snap, merged.pixel / 4), progress);
  progress.advance(0.5);

  number_groups(all, point_count, name, merged, progress);
  if (merged.xy.size() < all.size()) {
    std::erase_if(order.indices, [&](std::uint32_t i) { return name[i] != i; });
    for (std::uint32_t& i : order.indices) i = merged.number(i);
  }
  merged.along_curve = std::move(order.indices);
  progress.advance(1);
  return merged;
}

}  // namespace thalweg
