// Catchments as polygons.
//
// 1. Every border gives a directed segment to the ground on its left, the reverse one to that on its right.
//    Ends are points by number, so segments chain without a look at coordinates; where a ground touches
//    itself at a point the next segment is the first clockwise from the one that comes in.
// 2. The segments of each group are chained, on all threads: first from the first point, then from the first
//    of those that are left, and so on.
// 3. A chain that meets a point again closes a ring there. Rings that run clockwise are holes of the smallest
//    ring around them.
#include "base/parallel.hpp"
#include "terrain/catchment_borders.hpp"

#include <thalweg/terrain/catchments.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <utility>

namespace thalweg {

namespace {

double doubled_area(const CatchmentRing& ring) {
  double sum = 0;
  const Point2 o = ring.front().xy;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point2 p = ring[i].xy, q = ring[i + 1 == ring.size() ? 0 : i + 1].xy;
    sum += (p.x - o.x) * (q.y - o.y) - (p.y - o.y) * (q.x - o.x);
  }
  return sum;
}

bool holds(const CatchmentRing& ring, Point2 p) {
  bool inside = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point2 a = ring[i].xy, b = ring[i + 1 == ring.size() ? 0 : i + 1].xy;
    if ((a.y > p.y) == (b.y > p.y)) continue;
    if (p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
  }
  return inside;
}

/// A part of a border with the ground at hand to its left.
struct DirectedSegment {
  std::uint32_t from = 0, to = 0;
};

/// Chains the segments of one group after another.
class Chainer {
 public:
  Chainer(const FlowGraph& graph, const CatchmentBorders& borders) : graph_(graph), borders_(borders) {}

  /// `segments`: all of one group.
  Catchment chain(std::uint32_t group, std::span<const DirectedSegment> segments) {
    segments_ = segments;
    list_starts();
    used_.assign(segments.size(), 0);
    place_.assign(segments.size(), kNowhere);
    unused_ = segments.size();
    std::uint32_t first = 0;
    for (std::uint32_t s = 1; s < segments.size(); ++s) first = is_before(s, first) ? s : first;
    chain_from(first);
    if (unused_ > 0) {
      order_.clear();
      for (std::uint32_t s = 0; s < segments.size(); ++s) {
        if (used_[s] == 0) order_.push_back(s);
      }
      std::sort(order_.begin(), order_.end(),
                [&](std::uint32_t s, std::uint32_t t) { return is_before(s, t); });
      for (const std::uint32_t s : order_) {
        if (used_[s] == 0) chain_from(s);
      }
    }
    return collect(group);
  }

 private:
  static constexpr std::uint32_t kNowhere = 0xffffffffU;

  struct Passed {
    std::uint32_t first = 0;
    std::uint32_t point = 0;
  };

  [[nodiscard]] bool is_before(std::uint32_t s, std::uint32_t t) const {
    const DirectedSegment &a = segments_[s], &b = segments_[t];
    return a.from != b.from ? borders_.is_before(graph_, a.from, b.from)
                            : borders_.is_before(graph_, a.to, b.to);
  }

  [[nodiscard]] std::size_t slot_of(std::uint32_t point) const {
    constexpr std::uint32_t kSpread = 0x9e3779b9U;  // 2^32 over the golden ratio: neighbours lie far apart
    return point * kSpread >> shift_;
  }

  /// The slot of the segment that stands for the point, or the empty one where it would be.
  [[nodiscard]] std::uint32_t& slot_from(std::uint32_t point) {
    std::size_t slot = slot_of(point);
    while (slots_[slot] != kNowhere && segments_[slots_[slot]].from != point) {
      slot = slot + 1 == slots_.size() ? 0 : slot + 1;
    }
    return slots_[slot];
  }

  /// Fills `slots_`, a table of one segment from each point, by number, and `next_`, the others from it.
  void list_starts() {
    shift_ = 32U - static_cast<unsigned>(std::bit_width(2 * segments_.size()));
    slots_.assign(std::size_t{1} << (32U - shift_), kNowhere);
    next_.resize(segments_.size());
    for (std::uint32_t s = 0; s < segments_.size(); ++s) {
      borders_.ask_for(graph_, segments_[s].from);
      std::uint32_t& first = slot_from(segments_[s].from);
      next_[s] = first;
      first = s;
    }
  }

  void chain_from(std::uint32_t start) {
    path_.clear();
    std::uint32_t first = slot_from(segments_[start].from);
    for (std::uint32_t s = start; s != kNowhere; s = next_of(segments_[s], first)) {
      used_[s] = 1;
      --unused_;
      if (place_[first] != kNowhere) close(place_[first]);
      place_[first] = static_cast<std::uint32_t>(path_.size());
      path_.push_back({first, segments_[s].from});
      first = slot_from(segments_[s].to);
    }
    close(0);
  }

  // The segment that goes on from `segment`, or kNowhere. `first`: from its end.
  [[nodiscard]] std::uint32_t next_of(const DirectedSegment& segment, std::uint32_t first) const {
    if (first == kNowhere) return kNowhere;
    if (next_[first] == kNowhere) return used_[first] == 0 ? first : kNowhere;
    std::uint32_t best = kNowhere;
    double least = 0;
    const Point2 here = borders_.point(graph_, segment.to).xy;
    const auto direction = [&](std::uint32_t to) {
      const Point2 p = borders_.point(graph_, to).xy;
      return std::atan2(p.y - here.y, p.x - here.x);
    };
    for (std::uint32_t s = first; s != kNowhere; s = next_[s]) {
      if (used_[s] != 0) continue;
      double turn = direction(segment.from) - direction(segments_[s].to);  // clockwise
      if (turn <= 0) turn += 2 * std::numbers::pi;
      if (best == kNowhere || turn < least || (turn == least && is_before(s, best))) {
        best = s;
        least = turn;
      }
    }
    return best;
  }

  void close(std::size_t begin) {
    CatchmentRing ring;
    ring.reserve(path_.size() - begin);
    for (std::size_t i = begin; i < path_.size(); ++i) {
      place_[path_[i].first] = kNowhere;
      ring.push_back(borders_.point(graph_, path_[i].point));
    }
    path_.resize(begin);
    if (ring.size() > 2) rings_.push_back(std::move(ring));
  }

  Catchment collect(std::uint32_t group) {
    Catchment catchment{group, {}};
    std::vector<CatchmentRing> holes;
    std::vector<double> area;
    for (CatchmentRing& ring : rings_) {
      const double doubled = doubled_area(ring);
      if (doubled > 0) {
        catchment.polygons.push_back({std::move(ring), {}});
        area.push_back(doubled);
      } else {
        holes.push_back(std::move(ring));
      }
    }
    for (CatchmentRing& hole : holes) {
      const Point2 p{(hole[0].xy.x + hole[1].xy.x) / 2, (hole[0].xy.y + hole[1].xy.y) / 2};
      std::size_t around = 0;
      bool found = area.size() == 1;
      for (std::size_t i = 0; i < area.size() && area.size() > 1; ++i) {
        if (found && area[i] >= area[around]) continue;
        if (!holds(catchment.polygons[i].outer, p)) continue;
        around = i;
        found = true;
      }
      if (found) catchment.polygons[around].holes.push_back(std::move(hole));
    }
    rings_.clear();
    return catchment;
  }

  const FlowGraph& graph_;
  const CatchmentBorders& borders_;
  std::span<const DirectedSegment> segments_;
  std::vector<std::uint32_t> slots_, next_, order_;
  unsigned shift_ = 0;
  std::size_t unused_ = 0;
  std::vector<std::uint8_t> used_;
  std::vector<std::uint32_t> place_;  // in the path, by the segment that stands for a point
  std::vector<Passed> path_;
  std::vector<CatchmentRing> rings_;
};

/// Segments by group, groups in the order in which they come, so that near ones are near.
struct SegmentsByGroup {
  RawVector<DirectedSegment> segments;
  std::vector<std::size_t> first;  ///< of each group; then the end
  std::vector<std::uint32_t> groups;
};

/// `groups`: those that there are, ascending.
SegmentsByGroup sort_by_group(std::span<const BorderSegment> borders, std::span<const std::uint32_t> groups) {
  constexpr std::uint32_t kUnseen = 0xffffffffU;
  const bool plain = !groups.empty() && groups.back() < 2 * groups.size();  // then no search for its place
  std::vector<std::uint32_t> number(plain ? groups.back() + 1 : groups.size(), kUnseen);
  const auto number_of = [&](std::uint32_t group) -> std::uint32_t& {
    return number[plain ? group
                        : static_cast<std::size_t>(std::lower_bound(groups.begin(), groups.end(), group) -
                                                   groups.begin())];
  };
  SegmentsByGroup sorted;
  std::vector<std::size_t>& first = sorted.first;
  first.push_back(0);
  for (const BorderSegment& s : borders) {
    for (const std::uint32_t group : {s.left, s.right}) {
      if (group == kOutside) continue;
      std::uint32_t& known = number_of(group);
      if (known == kUnseen) {
        known = static_cast<std::uint32_t>(sorted.groups.size());
        sorted.groups.push_back(group);
        first.push_back(0);
      }
      ++first[known + 1];
    }
  }
  for (std::size_t g = 1; g < first.size(); ++g) first[g] += first[g - 1];
  std::vector<std::size_t> next(first.begin(), first.end() - 1);
  sorted.segments.resize(first.back());
  for (const BorderSegment& s : borders) {
    if (s.left != kOutside) sorted.segments[next[number_of(s.left)]++] = {s.from, s.to};
    if (s.right != kOutside) sorted.segments[next[number_of(s.right)]++] = {s.to, s.from};
  }
  return sorted;
}

std::vector<std::uint32_t> without_repeats(std::span<const std::uint32_t> group_of_sink) {
  std::vector<std::uint32_t> groups(group_of_sink.begin(), group_of_sink.end());
  std::sort(groups.begin(), groups.end());
  groups.erase(std::unique(groups.begin(), groups.end()), groups.end());
  return groups;
}

}  // namespace

std::vector<Catchment> outline_catchments(const SurfaceFlow& flow,
                                          std::span<const std::uint32_t> group_of_sink, Progress& progress) {
  constexpr std::size_t kGroups = 64;
  progress.start_phase("outline catchments");
  const FlowGraph& graph = flow.graph();
  const CatchmentBorders borders = find_borders(graph, group_of_sink, progress);
  progress.advance(0.5);
  const SegmentsByGroup sorted = sort_by_group(borders.segments, without_repeats(group_of_sink));
  const std::span<const DirectedSegment> segments = sorted.segments;
  std::vector<Catchment> catchments(sorted.groups.size());
  for_each_block(catchments.size(), kGroups, progress, {0.6, 1}, [&](std::size_t begin, std::size_t end) {
    Chainer chainer(graph, borders);
    for (std::size_t g = begin; g < end; ++g) {
      catchments[g] = chainer.chain(sorted.groups[g],
                                    segments.subspan(sorted.first[g], sorted.first[g + 1] - sorted.first[g]));
    }
  });
  std::erase_if(catchments, [](const Catchment& catchment) { return catchment.polygons.empty(); });
  std::sort(catchments.begin(), catchments.end(),
            [](const Catchment& a, const Catchment& b) { return a.group < b.group; });
  progress.advance(1);
  return catchments;
}

}  // namespace thalweg
