// Pits one after the other, from the highest bottom to the lowest.
//
// 1. Fill: from the bottom take the lowest vertex that borders on what was taken; the level is the highest
//    one so far. The first vertex below the level, or a way out, ends it: all below the level rise to it.
//    Pits inside had higher bottoms and are gone, so ground below the level drains to lower ground for good.
// 2. Breach: the cheapest way (Dijkstra) from the bottom along edges to lower ground or a way out, where each
//    vertex costs what lowering it to the bottom's height adds to its change. Where valleys shall hold, a
//    vertex that is lowered below the next one of its valley takes that one along: the way goes on there.
// 3. With both, the one that adds less to the sum of changes.
//
// Based on: Barnes, Lehman, Mulla, "Priority-flood", 2014 (the order of the flood); Lindsay, "Efficient
// hybrid breaching-filling sink removal methods", 2016 (least-cost breaching); here on the edges of a TIN, a
// choice for each pit, and nothing drained by an invented slope.
#include "terrain/pit_removal.hpp"

#include "terrain/depth_limit.hpp"

#include <thalweg/terrain/pits.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

namespace thalweg {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

struct Entry {
  double key = 0;
  Point2 point;
  VertexId vertex;
};

/// The least key first; equal ones by (x, y), so that ids do not matter.
struct Later {
  bool operator()(const Entry& a, const Entry& b) const {
    if (a.key != b.key) return a.key > b.key;
    return a.point.x != b.point.x ? a.point.x > b.point.x : a.point.y > b.point.y;
  }
};

using Queue = std::priority_queue<Entry, std::vector<Entry>, Later>;

struct Raise {
  std::vector<VertexId> vertices;
  double level = 0;
  double cost = kNever;
};

struct Way {
  std::vector<VertexId> vertices;
  double cost = kNever;
};

class Remover {
 public:
  Remover(const Tin& tin, std::span<const VertexId> outlets, const PitRules& rules)
      : tin_(tin),
        rules_(rules),
        way_out_(tin.vertex_count(), 0),
        lake_(tin.vertex_count(), 0),
        seen_(tin.vertex_count(), 0),
        cost_(tin.vertex_count(), 0),
        parent_(tin.vertex_count()),
        below_start_(tin.vertex_count() + 1, 0) {
    result_.heights.assign(tin.heights().begin(), tin.heights().end());
    result_.touched.assign(tin.vertex_count(), 0);
    const std::vector<bool> rim = tin.rim_vertices();
    for (std::size_t i = 0; i < rim.size(); ++i) way_out_[i] = rim[i] ? 1 : 0;
    for (const VertexId v : outlets) way_out_[v.index()] = 1;
    for (std::size_t i = 0; i < tin.halfedge_count(); ++i) {
      const HalfedgeId h{i};
      if (has(tin.kind(h), EdgeKind::Lake)) lake_[tin.origin(h).index()] = lake_[tin.target(h).index()] = 1;
    }
    for (const DownArc& arc : rules.valleys) ++below_start_[arc.above + 1];
    for (std::size_t i = 1; i < below_start_.size(); ++i) below_start_[i] += below_start_[i - 1];
    below_.resize(rules.valleys.size());
    std::vector<std::uint32_t> next(below_start_.begin(), below_start_.end() - 1);
    for (const DownArc& arc : rules.valleys) below_[next[arc.above]++] = arc.below;
  }

  PitRemoval run(const Progress& progress) {
    for (const VertexId bottom : list_bottoms()) {
      progress.check();
      remove(bottom);
    }
    return std::move(result_);
  }

 private:
  [[nodiscard]] double height(VertexId v) const { return result_.heights[v.index()]; }
  /// What moving a vertex to `level` adds to the sum of changes.
  [[nodiscard]] double added(VertexId v, double level) const {
    const double from = rules_.original[v.index()];
    return std::abs(level - from) - std::abs(height(v) - from);
  }
  [[nodiscard]] bool allowed(VertexId v, double level) const {
    return apart_at_most(level, rules_.original[v.index()], rules_.max_change);
  }

  /// A vertex of each interior pit, the highest first; lakes that are pits become ways out.
  std::vector<VertexId> list_bottoms() {
    const PitSummary pits = find_pits(tin_);
    Queue queue;
    for (std::size_t i = 0; i < tin_.vertex_count(); ++i) {
      const VertexId v{i};
      if (pits.is_pit[i] == static_cast<std::uint8_t>(PitKind::Lake)) way_out_[i] = 1;
      if (pits.is_pit[i] != static_cast<std::uint8_t>(PitKind::Interior) || way_out_[i] != 0) continue;
      queue.push({-height(v), tin_.point(v), v});
    }
    std::vector<VertexId> bottoms;
    ++round_;
    for (; !queue.empty(); queue.pop()) {
      const VertexId v = queue.top().vertex;
      if (seen_[v.index()] == round_) continue;  // on the plateau of one that is listed
      bottoms.push_back(v);
      std::vector<VertexId> plateau = {v};
      seen_[v.index()] = round_;
      while (!plateau.empty()) {
        const VertexId at = plateau.back();
        plateau.pop_back();
        for_each_neighbour(at, [&](VertexId other) {
          if (height(other) != height(at) || seen_[other.index()] == round_) return;
          seen_[other.index()] = round_;
          plateau.push_back(other);
        });
      }
    }
    return bottoms;
  }

  template <class Visit>
  void for_each_neighbour(VertexId v, const Visit& visit) const {
    for (const HalfedgeId out : tin_.outgoing(v)) {
      visit(tin_.target(out));
      const HalfedgeId in = Tin::previous(out);
      if (tin_.on_rim(in)) visit(tin_.origin(in));
    }
  }

  void remove(VertexId bottom) {
    const Raise raise = flood(bottom);
    if (raise.vertices.empty()) return;  // it drains by now
    Way way;
    if (rules_.breach) way = find_way(bottom, rules_.fill ? raise.cost : kNever);
    if (way.cost < kNever && (!rules_.fill || way.cost < raise.cost)) {
      move(way.vertices, height(bottom), ConditionStep::Breach);
      ++result_.breached;
    } else if (rules_.fill && raise.cost < kNever) {
      move(raise.vertices, raise.level, ConditionStep::Fill);
      ++result_.filled;
    } else {
      ++result_.left;
    }
  }

  void move(std::span<const VertexId> vertices, double level, ConditionStep step) {
    for (const VertexId v : vertices) {
      if (height(v) == level) continue;
      result_.heights[v.index()] = level;
      result_.touched[v.index()] = static_cast<std::uint8_t>(1 + static_cast<std::uint8_t>(step));
    }
  }

  Raise flood(VertexId bottom) {
    Raise raise{.vertices = {}, .level = height(bottom), .cost = 0};
    std::vector<VertexId> taken;
    Queue queue;
    ++round_;
    const auto offer = [&](VertexId v) {
      if (seen_[v.index()] == round_) return;
      seen_[v.index()] = round_;
      queue.push({height(v), tin_.point(v), v});
    };
    offer(bottom);
    while (!queue.empty()) {
      const VertexId v = queue.top().vertex;
      queue.pop();
      if (height(v) < raise.level) break;
      raise.level = height(v);
      if (way_out_[v.index()] != 0) break;
      taken.push_back(v);
      for_each_neighbour(v, offer);
    }
    for (const VertexId v : taken) {
      if (!(height(v) < raise.level)) continue;
      raise.vertices.push_back(v);
      raise.cost += allowed(v, raise.level) ? added(v, raise.level) : kNever;
    }
    return raise;
  }

  Way find_way(VertexId bottom, double most) {
    const double level = height(bottom);
    Queue queue;
    ++round_;  // seen: has a cost; round_ + 1: settled
    const std::uint32_t open = round_, settled = ++round_;
    const auto offer = [&](VertexId v, double cost, VertexId from) {
      const std::size_t i = v.index();
      if (height(v) > level) {
        if (lake_[i] != 0 || !allowed(v, level)) return;
        cost += std::max(0.0, added(v, level));
      }
      if (seen_[i] == settled || (seen_[i] == open && cost_[i] <= cost) || cost >= most) return;
      seen_[i] = open;
      cost_[i] = cost;
      parent_[i] = from;
      queue.push({cost, tin_.point(v), v});
    };
    offer(bottom, 0, VertexId());
    while (!queue.empty()) {
      const VertexId v = queue.top().vertex;
      queue.pop();
      if (seen_[v.index()] == settled) continue;
      seen_[v.index()] = settled;
      const auto [along, count] = drags(v, level);
      if (count == 0 && (height(v) < level || way_out_[v.index()] != 0)) return trace(v, level);
      if (count == 1) offer(along, cost_[v.index()], v);
      if (count == 0) for_each_neighbour(v, [&](VertexId next) { offer(next, cost_[v.index()], v); });
    }
    return {};
  }

  /// The vertices next in valleys that would be above `v` at `level`, but for the one before it on the way.
  [[nodiscard]] std::pair<VertexId, std::size_t> drags(VertexId v, double level) const {
    std::pair<VertexId, std::size_t> found{VertexId(), 0};
    if (!(height(v) > level)) return found;
    for (std::uint32_t i = below_start_[v.index()]; i < below_start_[v.index() + 1]; ++i) {
      const VertexId next{static_cast<std::size_t>(below_[i])};
      if (!(height(next) > level) || next == parent_[v.index()]) continue;
      found.first = next;
      ++found.second;
    }
    return found;
  }

  [[nodiscard]] Way trace(VertexId end, double level) const {
    Way way{.vertices = {}, .cost = 0};
    for (VertexId v = end; v.valid(); v = parent_[v.index()]) {
      if (!(height(v) > level)) continue;
      way.vertices.push_back(v);
      way.cost += added(v, level);
    }
    return way;
  }

  const Tin& tin_;
  const PitRules& rules_;
  std::vector<std::uint8_t> way_out_, lake_;
  std::vector<std::uint32_t> seen_;
  std::vector<double> cost_;
  std::vector<VertexId> parent_;
  std::vector<std::uint32_t> below_start_, below_;
  std::uint32_t round_ = 0;
  PitRemoval result_;
};

}  // namespace

PitRemoval remove_pits(const Tin& tin, std::span<const VertexId> outlets, const PitRules& rules,
                       const Progress& progress) {
  return Remover(tin, outlets, rules).run(progress);
}

}  // namespace thalweg
