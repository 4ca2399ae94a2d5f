// Conditioning: valleys, then pits.
//
// Valleys. The vertices of a lake change together. Isotonic regression only where arcs are broken: the ends
// of broken arcs that touch are a pool; a pool is solved with the arcs between its own vertices; a pool that
// then breaks an arc to a vertex outside takes in what is near until it has twice its size, and is solved
// again. What comes out obeys all arcs and is best for fewer of them, so it is best for all. Where a pool of
// changed vertices needs more than the largest change it gets its heights back.
#include "base/release.hpp"
#include "terrain/depth_limit.hpp"
#include "terrain/isotonic.hpp"
#include "terrain/pit_removal.hpp"
#include "terrain/valley_lines.hpp"

#include <thalweg/terrain/condition.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace thalweg {

namespace {

/// The arcs of all drawn valleys that run downstream and of which an edge `is_wanted`.
template <class Wanted>
std::vector<DownArc> list_arcs(const Tin& tin, const Wanted& is_wanted) {
  std::vector<DownArc> arcs, on_line;
  for (const std::vector<VertexId>& line : trace_valleys(tin).lines) {
    on_line.clear();
    for (std::size_t k = 1; k < line.size(); ++k) on_line.push_back({line[k - 1].value(), line[k].value()});
    if (std::any_of(on_line.begin(), on_line.end(), is_wanted)) {
      arcs.insert(arcs.end(), on_line.begin(), on_line.end());
    }
  }
  return arcs;
}

/// Arcs both ways between the vertices of each lake, so that its water stays level. A lake is what level
/// triangles cover between edges of one.
class LakeTies {
 public:
  explicit LakeTies(const Tin& tin) : tin_(tin), visited_(tin.triangle_count(), 0) {}

  std::vector<DownArc> run() {
    for (std::size_t i = 0; i < tin_.halfedge_count(); ++i) {
      const HalfedgeId h{i};
      if (has(tin_.kind(h), EdgeKind::Lake) && is_new(Tin::triangle_of(h)) && flood(Tin::triangle_of(h)))
        tie();
    }
    return std::move(ties_);
  }

 private:
  [[nodiscard]] bool is_level(TriangleId t) const {
    const auto [a, b, c] = tin_.triangle(t);
    return tin_.height(a) == tin_.height(b) && tin_.height(b) == tin_.height(c);
  }
  [[nodiscard]] bool is_new(TriangleId t) {
    return is_level(t) && std::exchange(visited_[t.index()], 1) == 0;
  }

  /// False if edges of lakes, and the rim, do not close what is level.
  bool flood(TriangleId start) {
    bool closed = true;
    lake_.assign(1, start);
    for (std::size_t i = 0; i < lake_.size(); ++i) {
      for (std::size_t side = 0; side < 3; ++side) {
        const HalfedgeId h = Tin::halfedge(lake_[i], side);
        if (tin_.on_rim(h) || has(tin_.kind(h), EdgeKind::Lake)) continue;
        const TriangleId beyond = Tin::triangle_of(tin_.twin(h));
        closed = closed && is_level(beyond);
        if (is_new(beyond)) lake_.push_back(beyond);
      }
    }
    return closed;
  }

  void tie() {
    const std::uint32_t one = tin_.triangle(lake_.front())[0].value();
    for (const TriangleId t : lake_) {
      for (const VertexId v : tin_.triangle(t)) {
        ties_.push_back({one, v.value()});
        ties_.push_back({v.value(), one});
      }
    }
  }

  const Tin& tin_;
  std::vector<std::uint8_t> visited_;  // by triangle
  std::vector<TriangleId> lake_;
  std::vector<DownArc> ties_;
};

class ValleyRegression {
 public:
  ValleyRegression(std::span<const double> heights, std::span<const DownArc> arcs, ChangeNorm norm)
      : original_(heights),
        arcs_(arcs),
        norm_(norm),
        heights_(heights.begin(), heights.end()),
        pool_(heights.size(), kNone),
        place_(heights.size(), 0),
        start_(heights.size() + 1, 0) {
    for (const DownArc& arc : arcs) {
      ++start_[arc.above + 1];
      ++start_[arc.below + 1];
    }
    for (std::size_t i = 1; i < start_.size(); ++i) start_[i] += start_[i - 1];
    at_.resize(2 * arcs.size());
    std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
    for (std::uint32_t a = 0; a < arcs.size(); ++a) {
      at_[next[arcs[a].above]++] = a;
      at_[next[arcs[a].below]++] = a;
    }
  }

  std::vector<double> run(double max_change, const Progress& progress) {
    for (std::vector<std::uint32_t> broken = merge_broken(); !broken.empty(); broken = merge_broken()) {
      for (const std::uint32_t pool : broken) {
        progress.check();
        if (members_[pool].empty()) continue;  // another one grew over it
        grow(pool);
        solve(pool);
      }
    }
    if (max_change < std::numeric_limits<double>::infinity()) give_back(max_change);
    return std::move(heights_);
  }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffU;

  /// Puts both ends of each broken arc into one pool; returns these pools.
  std::vector<std::uint32_t> merge_broken() {
    std::vector<std::uint32_t> tops, pools;
    for (const DownArc& arc : arcs_) {
      if (!(heights_[arc.above] < heights_[arc.below])) continue;
      merge(arc.above, arc.below);
      tops.push_back(arc.above);
    }
    for (const std::uint32_t v : tops) pools.push_back(pool_[v]);
    std::sort(pools.begin(), pools.end());
    pools.erase(std::unique(pools.begin(), pools.end()), pools.end());
    return pools;
  }

  std::uint32_t pool_of(std::uint32_t v) {
    if (pool_[v] == kNone) {
      pool_[v] = static_cast<std::uint32_t>(members_.size());
      members_.push_back({v});
    }
    return pool_[v];
  }

  void merge(std::uint32_t a, std::uint32_t b) {
    std::uint32_t into = pool_of(a), from = pool_of(b);
    if (into == from) return;
    if (members_[into].size() < members_[from].size()) std::swap(into, from);
    join(into, from);
  }

  void join(std::uint32_t into, std::uint32_t from) {
    for (const std::uint32_t v : members_[from]) pool_[v] = into;
    members_[into].insert(members_[into].end(), members_[from].begin(), members_[from].end());
    release(members_[from]);
  }

  void grow(std::uint32_t pool) {
    const std::size_t wanted = 2 * members_[pool].size();
    for (std::size_t i = 0; i < members_[pool].size() && members_[pool].size() < wanted; ++i) {
      const std::uint32_t v = members_[pool][i];
      for (std::uint32_t k = start_[v]; k < start_[v + 1]; ++k) {
        const std::uint32_t other = other_end(at_[k], v);
        if (pool_[other] != pool) join(pool, pool_of(other));
      }
    }
  }

  [[nodiscard]] std::uint32_t other_end(std::uint32_t arc, std::uint32_t v) const {
    return arcs_[arc].above == v ? arcs_[arc].below : arcs_[arc].above;
  }

  void solve(std::uint32_t pool) {
    std::vector<std::uint32_t>& members = members_[pool];
    std::sort(members.begin(), members.end());
    std::vector<double> values;
    for (std::uint32_t i = 0; i < members.size(); ++i) {
      place_[members[i]] = i;
      values.push_back(original_[members[i]]);
    }
    std::vector<DownArc> within;
    for (const std::uint32_t v : members) {
      for (std::uint32_t k = start_[v]; k < start_[v + 1]; ++k) {
        const DownArc& arc = arcs_[at_[k]];
        if (arc.above == v && pool_[arc.below] == pool) within.push_back({place_[v], place_[arc.below]});
      }
    }
    const std::vector<double> best = regress_isotonic(values, within, norm_);
    for (std::size_t i = 0; i < members.size(); ++i) heights_[members[i]] = best[i];
  }

  /// Neighbours along valleys that changed are one case: it keeps all its changes, or none.
  void give_back(double max_change) {
    std::vector<std::uint8_t> seen(heights_.size(), 0);
    const auto changed = [&](std::uint32_t v) { return heights_[v] != original_[v]; };
    for (std::uint32_t first = 0; first < heights_.size(); ++first) {
      if (seen[first] != 0 || !changed(first)) continue;
      std::vector<std::uint32_t> together = {first};
      seen[first] = 1;
      bool too_much = false;
      for (std::size_t i = 0; i < together.size(); ++i) {
        const std::uint32_t v = together[i];
        too_much = too_much || !apart_at_most(heights_[v], original_[v], max_change);
        for (std::uint32_t k = start_[v]; k < start_[v + 1]; ++k) {
          const std::uint32_t other = other_end(at_[k], v);
          if (seen[other] != 0 || !changed(other)) continue;
          seen[other] = 1;
          together.push_back(other);
        }
      }
      if (!too_much) continue;
      for (const std::uint32_t v : together) heights_[v] = original_[v];
    }
  }

  std::span<const double> original_;
  std::span<const DownArc> arcs_;
  ChangeNorm norm_;
  std::vector<double> heights_;
  std::vector<std::uint32_t> pool_;                  // by vertex
  std::vector<std::vector<std::uint32_t>> members_;  // by pool
  std::vector<std::uint32_t> place_;                 // by vertex, in its pool
  std::vector<std::uint32_t> start_, at_;            // by vertex: its arcs
};

bool asked(const ConditionOptions& options, ConditionStep step) {
  return std::find(options.steps.begin(), options.steps.end(), step) != options.steps.end();
}

double sum_of_changes(std::span<const double> before, std::span<const double> after) {
  double sum = 0;
  for (std::size_t i = 0; i < before.size(); ++i) sum += std::abs(after[i] - before[i]);
  return sum;
}

/// Choosing pit by pit looks at one pit only; so with both Fill and Breach all pits by one of them are tried
/// too. What leaves fewer pits wins, then what changes less.
PitRemoval remove_pits_best(const Tin& tin, std::span<const VertexId> outlets, const PitRules& rules,
                            const Progress& progress) {
  PitRemoval best = remove_pits(tin, outlets, rules, progress);
  if (!rules.fill || !rules.breach) return best;
  double least = sum_of_changes(rules.original, best.heights);
  for (const bool fill : {true, false}) {
    PitRules one = rules;
    one.fill = fill;
    one.breach = !fill;
    PitRemoval other = remove_pits(tin, outlets, one, progress);
    const double sum = sum_of_changes(rules.original, other.heights);
    if (other.left > best.left || (other.left == best.left && !(sum < least))) continue;
    least = sum;
    best = std::move(other);
  }
  return best;
}

ConditionResult condition_along(const Tin& tin, std::span<const VertexId> outlets,
                                const ConditionOptions& options, std::span<const DownArc> arcs,
                                const Progress& progress) {
  const double max_change = options.max_change.value_or(std::numeric_limits<double>::infinity());
  ConditionResult result;
  std::vector<std::uint8_t> touched(tin.vertex_count(), 0);
  std::vector<DownArc> with_ties = arcs.empty() ? std::vector<DownArc>() : LakeTies(tin).run();
  with_ties.insert(with_ties.end(), arcs.begin(), arcs.end());
  result.heights = ValleyRegression(tin.heights(), with_ties, options.norm).run(max_change, progress);
  if (asked(options, ConditionStep::Fill) || asked(options, ConditionStep::Breach)) {
    PitRemoval removal = remove_pits_best(tin.with_heights(std::move(result.heights)), outlets,
                                          {.fill = asked(options, ConditionStep::Fill),
                                           .breach = asked(options, ConditionStep::Breach),
                                           .max_change = max_change,
                                           .original = tin.heights(),
                                           .valleys = arcs},
                                          progress);
    result.heights = std::move(removal.heights);
    touched = std::move(removal.touched);
    result.filled = removal.filled;
    result.breached = removal.breached;
    result.left = removal.left;
  }
  for (std::size_t i = 0; i < touched.size(); ++i) {
    const VertexId v{i};
    if (result.heights[i] == tin.height(v)) continue;
    const auto step =
        touched[i] == 0 ? ConditionStep::MonotoneValleys : static_cast<ConditionStep>(touched[i] - 1);
    result.changes.push_back(
        {.vertex = v, .before = tin.height(v), .after = result.heights[i], .step = step});
  }
  return result;
}

/// Within the limit. The directions that lines of rings, the arcs from `first_arcs` on, get from changes
/// without it may ask for changes that are given back, and those of other lines with them; so it is tried
/// without them too. What leaves fewer rising edges wins, then what changes less.
ConditionResult condition_within(const Tin& tin, std::span<const VertexId> outlets,
                                 const ConditionOptions& options, std::span<const DownArc> arcs,
                                 std::size_t first_arcs, const Progress& progress) {
  ConditionResult with = condition_along(tin, outlets, options, arcs, progress);
  if (arcs.size() == first_arcs) return with;
  ConditionResult without = condition_along(tin, outlets, options, arcs.first(first_arcs), progress);
  const auto cost = [&](const ConditionResult& result) {
    const std::vector<double>& z = result.heights;
    const auto rises = [&](const DownArc& arc) { return z[arc.above] < z[arc.below]; };
    std::size_t rising = 0;  // as lines run then
    list_arcs(tin.with_heights(z), [&](const DownArc& arc) {
      rising += rises(arc) ? 1 : 0;
      return false;
    });
    const auto first = arcs.first(first_arcs);
    return std::tuple(std::count_if(first.begin(), first.end(), rises), rising,
                      sum_of_changes(tin.heights(), z));
  };
  return cost(without) < cost(with) ? std::move(without) : std::move(with);
}

}  // namespace

ConditionResult condition_heights(const Tin& tin, std::span<const VertexId> outlets,
                                  const ConditionOptions& options, const Progress& progress) {
  if (!asked(options, ConditionStep::MonotoneValleys)) {
    return condition_along(tin, outlets, options, {}, progress);
  }
  std::vector<DownArc> arcs = list_arcs(tin, [](const DownArc&) { return true; });
  const std::size_t first_arcs = arcs.size();
  ConditionOptions unlimited = options;
  unlimited.max_change.reset();
  for (;;) {
    ConditionResult result = condition_along(tin, outlets, unlimited, arcs, progress);
    // A line of a ring whose ends were level may have a direction now. All arcs hold, so a whole line more,
    // which runs down, makes no cycle.
    const std::vector<DownArc> more = list_arcs(
        tin.with_heights(result.heights),
        [&heights = result.heights](const DownArc& arc) { return heights[arc.above] < heights[arc.below]; });
    if (more.empty() && !options.max_change) return result;
    if (more.empty()) return condition_within(tin, outlets, options, arcs, first_arcs, progress);
    arcs.insert(arcs.end(), more.begin(), more.end());
  }
}

}  // namespace thalweg
