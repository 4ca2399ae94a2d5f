// Catchments as polygons.
//
// 1. Every border gives a directed segment to the ground on its left, the reverse one to that on its right.
//    Ends are vertices and ends of pieces, by number, so segments chain without a look at coordinates; where
//    a ground touches itself at a point the next segment is the first clockwise from the one that comes in.
// 2. The segments of each group are sorted by where they start, and chained, on all threads.
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

/// Chains the segments of one group after another.
class Chainer {
 public:
  Chainer(const FlowGraph& graph, const CatchmentBorders& borders) : graph_(graph), borders_(borders) {}

  /// `segments`: all of one group.
  Catchment chain(std::span<const BorderSegment> segments) {
    segments_.clear();
    for (const BorderSegment& s : segments) {
      borders_.ask_for(graph_, s.from);
      segments_.push_back({rank(s.from), s.from, s.to});
    }
    std::sort(segments_.begin(), segments_.end(), [&](const Ranked& a, const Ranked& b) {
      return a.rank == b.rank ? rank(a.to) < rank(b.to) : a.rank < b.rank;
    });
    list_starts();
    used_.assign(segments.size(), 0);
    place_.assign(segments.size(), kNowhere);
    for (std::size_t start = 0; start < segments_.size(); ++start) {
      if (used_[start] != 0) continue;
      path_.clear();
      std::size_t first = first_from(segments_[start].from);
      for (std::size_t s = start; s < segments_.size(); s = next_of(segments_[s], first)) {
        used_[s] = 1;
        // The first segment from a point stands for the point.
        if (place_[first] != kNowhere) close(place_[first]);
        place_[first] = static_cast<std::uint32_t>(path_.size());
        path_.push_back({first, borders_.point(graph_, segments_[s].from)});
        first = first_from(segments_[s].to);
      }
      close(0);
    }
    return collect(segments.front().group);
  }

 private:
  static constexpr std::uint32_t kNowhere = 0xffffffffU;

  struct Ranked {
    std::uint64_t rank = 0;  // of `from`
    std::uint32_t from = 0, to = 0;
  };
  struct Passed {
    std::size_t first = 0;
    FlowPoint point;
  };

  [[nodiscard]] std::uint64_t rank(std::uint32_t point) const { return borders_.rank(graph_, point); }

  [[nodiscard]] std::size_t slot_of(std::uint32_t point) const {
    constexpr std::uint32_t kSpread = 0x9e3779b9U;  // 2^32 over the golden ratio: neighbours lie far apart
    return point * kSpread >> shift_;
  }

  /// Fills `slots_`, a table of the first segment from each point, by number.
  void list_starts() {
    shift_ = 32U - static_cast<unsigned>(std::bit_width(2 * segments_.size()));
    slots_.assign(std::size_t{1} << (32U - shift_), kNowhere);
    for (std::size_t s = 0; s < segments_.size(); ++s) {
      if (s > 0 && segments_[s - 1].from == segments_[s].from) continue;
      std::size_t slot = slot_of(segments_[s].from);
      while (slots_[slot] != kNowhere) slot = slot + 1 == slots_.size() ? 0 : slot + 1;
      slots_[slot] = static_cast<std::uint32_t>(s);
    }
  }

  /// The end if there is none.
  [[nodiscard]] std::size_t first_from(std::uint32_t point) const {
    std::size_t slot = slot_of(point);
    while (slots_[slot] != kNowhere && segments_[slots_[slot]].from != point) {
      slot = slot + 1 == slots_.size() ? 0 : slot + 1;
    }
    return slots_[slot] == kNowhere ? segments_.size() : slots_[slot];
  }

  // The segment that goes on from `segment`, or the end. `first`: from its end.
  [[nodiscard]] std::size_t next_of(const Ranked& segment, std::size_t first) const {
    const auto starts_here = [&](std::size_t s) {
      return s < segments_.size() && segments_[s].from == segment.to;
    };
    if (starts_here(first) && !starts_here(first + 1)) return used_[first] == 0 ? first : segments_.size();
    std::size_t best = segments_.size();
    double least = 0;
    const Point2 here = borders_.point(graph_, segment.to).xy;
    const auto direction = [&](std::uint32_t to) {
      const Point2 p = borders_.point(graph_, to).xy;
      return std::atan2(p.y - here.y, p.x - here.x);
    };
    for (std::size_t s = first; starts_here(s); ++s) {
      if (used_[s] != 0) continue;
      double turn = direction(segment.from) - direction(segments_[s].to);  // clockwise
      if (turn <= 0) turn += 2 * std::numbers::pi;
      if (best == segments_.size() || turn < least) {
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
      ring.push_back(path_[i].point);
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
  std::vector<Ranked> segments_;
  std::vector<std::uint32_t> slots_;
  unsigned shift_ = 0;
  std::vector<std::uint8_t> used_;
  std::vector<std::uint32_t> place_;  // in the path, by the first segment from a point
  std::vector<Passed> path_;
  std::vector<CatchmentRing> rings_;
};

/// Sorts segments by group, groups in the order in which they come, so that near ones are near; returns where
/// each group's begin, then the end. `groups`: those that there are, ascending.
std::vector<std::size_t> sort_by_group(LargeVector<BorderSegment>& segments,
                                       std::span<const std::uint32_t> groups) {
  constexpr std::uint32_t kUnseen = 0xffffffffU;
  const bool plain = !groups.empty() && groups.back() < 2 * groups.size();  // then no search for its place
  std::vector<std::uint32_t> number(plain ? groups.back() + 1 : groups.size(), kUnseen);
  const auto number_of = [&](std::uint32_t group) -> std::uint32_t& {
    return number[plain ? group
                        : static_cast<std::size_t>(std::lower_bound(groups.begin(), groups.end(), group) -
                                                   groups.begin())];
  };
  std::vector<std::size_t> first(1, 0);
  for (const BorderSegment& s : segments) {
    std::uint32_t& known = number_of(s.group);
    if (known == kUnseen) {
      known = static_cast<std::uint32_t>(first.size() - 1);
      first.push_back(0);
    }
    ++first[known + 1];
  }
  for (std::size_t g = 1; g < first.size(); ++g) first[g] += first[g - 1];
  std::vector<std::size_t> next(first.begin(), first.end() - 1);
  LargeVector<BorderSegment> sorted(segments.size());
  for (const BorderSegment& s : segments) sorted[next[number_of(s.group)]++] = s;
  segments = std::move(sorted);
  return first;
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
  CatchmentBorders borders = find_borders(graph, group_of_sink, progress);
  progress.advance(0.5);
  const std::vector<std::size_t> first = sort_by_group(borders.segments, without_repeats(group_of_sink));
  std::vector<Catchment> catchments(first.size() - 1);
  for_each_block(catchments.size(), kGroups, progress, {0.6, 1}, [&](std::size_t begin, std::size_t end) {
    Chainer chainer(graph, borders);
    for (std::size_t g = begin; g < end; ++g) {
      catchments[g] = chainer.chain(
          std::span<const BorderSegment>(borders.segments).subspan(first[g], first[g + 1] - first[g]));
    }
  });
  std::erase_if(catchments, [](const Catchment& catchment) { return catchment.polygons.empty(); });
  std::sort(catchments.begin(), catchments.end(),
            [](const Catchment& a, const Catchment& b) { return a.group < b.group; });
  progress.advance(1);
  return catchments;
}

}  // namespace thalweg
