// Conditioning against its laws: a plain flood, all isotonic values on few heights, and the optimality
// conditions of least squares.
#include "support/terrains.hpp"

#include <thalweg/delaunay/triangulate.hpp>
#include <thalweg/terrain/condition.hpp>
#include <thalweg/terrain/consistency.hpp>
#include <thalweg/terrain/pits.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

namespace thalweg {
namespace {

using enum ConditionStep;

Tin with(const Tin& tin, std::vector<double> heights, std::span<const ConstraintEdge> constraints) {
  return {{tin.points().begin(), tin.points().end()},
          std::move(heights),
          {tin.triangles().begin(), tin.triangles().end()},
          constraints};
}

/// The TIN with some of its edges drawn as valleys.
Tin draw_valleys(const Tin& tin, double share, test::Random& random) {
  std::vector<ConstraintEdge> valleys;
  for (std::size_t i = 0; i < tin.halfedge_count(); ++i) {
    const HalfedgeId h{i};
    if (!tin.represents_edge(h) || random.real(0, 1) > share) continue;
    valleys.push_back({tin.origin(h), tin.target(h), EdgeKind::Breakline | EdgeKind::Valley});
  }
  return with(tin, {tin.heights().begin(), tin.heights().end()}, valleys);
}

std::size_t count_interior(const Tin& tin, const std::vector<double>& heights) {
  return find_pits(with(tin, heights, tin.constraint_edges())).interior;
}

/// The flood by relaxation until nothing falls: the least greatest height on any way to the rim.
std::vector<double> plain_flood(const Tin& tin) {
  const std::vector<bool> rim = tin.rim_vertices();
  std::vector<double> level(tin.vertex_count(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < level.size(); ++i) {
    if (rim[i]) level[i] = tin.height(VertexId{i});
  }
  for (bool falls = true; falls;) {
    falls = false;
    for (const Triangle& t : tin.triangles()) {
      for (const VertexId a : t) {
        for (const VertexId b : t) {
          const double over = std::max(tin.height(a), level[b.index()]);
          if (!(over < level[a.index()])) continue;
          level[a.index()] = over;
          falls = true;
        }
      }
    }
  }
  return level;
}

double sum_of_changes(const ConditionResult& result) {
  double sum = 0;
  for (const HeightChange& change : result.changes) sum += std::abs(change.after - change.before);
  return sum;
}

struct PlainValleys {
  std::vector<std::pair<std::size_t, std::size_t>> arcs;
  bool level = false;  // a line of a ring has level ends, so no direction
};

using PlainLine = std::vector<std::size_t>;

/// The least sum of changes with which a line does not rise and stays at `level` or above: tried out on all
/// its heights.
double plain_fall(const Tin& tin, const PlainLine& line,
                  double level = std::numeric_limits<double>::lowest()) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  std::map<double, double>
      least;  // of the vertices from the last one back, by the height of the first of them
  if (level > std::numeric_limits<double>::lowest()) least[level] = 0;
  for (const std::size_t v : line) {
    const double z = tin.height(VertexId{v});
    least[z] = z < level ? kNever : 0;
  }
  for (auto v = line.rbegin(); v != line.rend(); ++v) {
    double below = kNever;
    for (auto& [here, sum] : least) {
      below = std::min(below, sum);
      sum = below + std::abs(here - tin.height(VertexId{*v}));
    }
  }
  double best = line.empty() ? 0 : kNever;
  for (const auto& [here, sum] : least) best = std::min(best, sum);
  return best;
}

/// Drawn valleys traced anew from pairs of vertices; every way out of a net is tried.
class PlainNets {
 public:
  explicit PlainNets(const Tin& tin) : tin_(tin) {
    std::map<std::size_t, std::set<std::size_t>> next;
    for (const ConstraintEdge& edge : tin.constraint_edges()) {
      next[edge.a.index()].insert(edge.b.index());
      next[edge.b.index()].insert(edge.a.index());
    }
    std::set<std::size_t> passed;
    const auto trace = [&](std::size_t end) {
      for (const std::size_t at : next[end]) {
        PlainLine line = {end, at};
        while (line.back() != end && next[line.back()].size() == 2) {
          const std::set<std::size_t>& on = next[line.back()];
          line.push_back(*on.begin() == line[line.size() - 2] ? *on.rbegin() : *on.begin());
        }
        passed.insert(line.begin(), line.end());
        if (line.front() < line.back()) lines_.push_back(line);
        if (line.front() == line.back() && line[1] < line[line.size() - 2]) add_ring(line);
      }
    };
    for (const auto& [end, ways] : next) {
      if (ways.size() != 2) trace(end);
    }
    for (const auto& [start, ways] : next) {
      if (passed.contains(start)) continue;
      std::size_t highest = start;  // of a ring by itself
      for (std::size_t before = start, at = *ways.begin(); at != start;) {
        highest = rank(highest) < rank(at) ? at : highest;
        const std::set<std::size_t>& on = next[at];
        before = std::exchange(at, *on.begin() == before ? *on.rbegin() : *on.begin());
      }
      trace(highest);
    }
    for (const PlainLine& line : lines_) at_back_[line] = reach(line.back(), &line);
  }

  PlainValleys run() {
    PlainValleys valleys;
    std::set<std::size_t> seen;
    for (const PlainLine& line : lines_) {
      if (seen.contains(line.front())) continue;
      const std::set<std::size_t> net = reach(line.front(), nullptr);
      seen.insert(net.begin(), net.end());
      direct(net, valleys);
    }
    return valleys;
  }

 private:
  [[nodiscard]] std::tuple<double, Point2> rank(std::size_t v) const {
    return {tin_.height(VertexId{v}), tin_.point(VertexId{v})};
  }

  /// A ring from its first vertex around to it: as two lines to its lowest vertex, or from its highest one.
  void add_ring(const PlainLine& ring) {
    const auto before = [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); };
    const auto [low, high] = std::minmax_element(ring.begin() + 1, ring.end() - 1, before);
    const auto parts = [&](PlainLine::const_iterator at) {
      PlainLine back(std::make_reverse_iterator(ring.end()), std::make_reverse_iterator(at));
      return std::vector{PlainLine(ring.begin(), at + 1), std::move(back)};
    };
    double down = 0, up = 0;
    for (const PlainLine& line : parts(low)) down += plain_fall(tin_, line);
    for (const PlainLine& line : parts(high)) up += plain_fall(tin_, PlainLine(line.rbegin(), line.rend()));
    const double here = tin_.height(VertexId{ring.front()});
    const bool can_rise = tin_.height(VertexId{*high}) > here;
    const bool runs_down = tin_.height(VertexId{*low}) < here && (down < up || !can_rise);
    for (PlainLine& line : parts(runs_down ? low : high)) lines_.push_back(std::move(line));
  }

  /// The ends of lines that hang together with v, without one of the lines.
  [[nodiscard]] std::set<std::size_t> reach(std::size_t v, const PlainLine* without) const {
    std::set<std::size_t> found = {v};
    for (bool grows = true; grows;) {
      grows = false;
      for (const PlainLine& line : lines_) {
        if (&line == without || found.contains(line.front()) == found.contains(line.back())) continue;
        found.insert({line.front(), line.back()});
        grows = true;
      }
    }
    return found;
  }

  /// The line so that it ends nearer to the way out; empty: it is in a ring.
  [[nodiscard]] PlainLine towards(std::size_t out, const PlainLine& line) const {
    const std::set<std::size_t>& at_back = at_back_.at(line);
    if (at_back.contains(line.front())) return {};
    return at_back.contains(out) ? line : PlainLine(line.rbegin(), line.rend());
  }

  /// What a line takes to fall from both ends to a vertex.
  [[nodiscard]] double fall_into(const PlainLine& line, std::size_t middle) const {
    const PlainLine left(line.begin(), line.begin() + static_cast<std::ptrdiff_t>(middle));
    const PlainLine right(line.rbegin(), line.rend() - static_cast<std::ptrdiff_t>(middle) - 1);
    std::set<double> levels;
    for (const std::size_t v : line) levels.insert(tin_.height(VertexId{v}));
    double best = std::numeric_limits<double>::infinity();
    for (const double level : levels) {
      double sum = std::abs(level - tin_.height(VertexId{line[middle]}));
      for (const PlainLine& part : {left, right}) sum += plain_fall(tin_, part, level);
      best = std::min(best, sum);
    }
    return best;
  }

  void direct(const std::set<std::size_t>& net, PlainValleys& valleys) const {
    using Rank = std::tuple<double, double, double, double>;
    std::optional<Rank> best;
    std::vector<PlainLine> chosen;
    const auto consider = [&](std::size_t out, std::size_t outlet, const PlainLine* split, double more,
                              std::vector<PlainLine> parts) {
      double total = more;
      for (const PlainLine& line : lines_) {
        if (!net.contains(line.front()) || &line == split) continue;
        // Lines on either side of one that is split run to its end there.
        const bool beyond = split != nullptr && at_back_.at(*split).contains(line.front());
        const PlainLine run = towards(beyond ? split->back() : out, line);
        total += plain_fall(tin_, run);
        if (!run.empty()) parts.push_back(run);
      }
      const Point2 p = tin_.point(VertexId{outlet});
      const Rank rank{std::round(total * 1e6), tin_.height(VertexId{outlet}), p.x, p.y};
      if (best && *best <= rank) return;
      best = rank;
      chosen = std::move(parts);
    };
    for (const std::size_t out : net) consider(out, out, nullptr, 0, {});
    for (const PlainLine& line : lines_) {
      if (!net.contains(line.front()) || towards(line.front(), line).empty()) continue;
      const double whole =
          std::min(plain_fall(tin_, line), plain_fall(tin_, PlainLine(line.rbegin(), line.rend())));
      for (std::size_t m = 1; m + 1 < line.size(); ++m) {
        const double sum = fall_into(line, m);
        if (!(sum < whole / 2 - 1e-9)) continue;
        const auto at = line.begin() + static_cast<std::ptrdiff_t>(m);
        consider(line.front(), line[m], &line, sum,
                 {PlainLine(line.begin(), at + 1), PlainLine(line.rbegin(), std::make_reverse_iterator(at))});
      }
    }
    for (const PlainLine& run : chosen) add(run, valleys);
    for (const PlainLine& line : lines_) {
      if (!net.contains(line.front()) || !towards(line.front(), line).empty()) continue;
      const double fall = tin_.height(VertexId{line.front()}) - tin_.height(VertexId{line.back()});
      valleys.level |= fall == 0;
      if (fall > 0) add(line, valleys);
      if (fall < 0) add(PlainLine(line.rbegin(), line.rend()), valleys);
    }
  }

  static void add(const PlainLine& run, PlainValleys& valleys) {
    for (std::size_t i = 1; i < run.size(); ++i) valleys.arcs.emplace_back(run[i - 1], run[i]);
  }

  const Tin& tin_;
  std::vector<PlainLine> lines_;
  std::map<PlainLine, std::set<std::size_t>>
      at_back_;  // ends that hang together with its last one without it
};

PlainValleys plain_valleys(const Tin& tin) {
  return PlainNets(tin).run();
}

/// The least sum of changes over all isotonic values among the heights themselves.
double least_sum(const Tin& tin, const std::vector<std::pair<std::size_t, std::size_t>>& arcs) {
  const std::set<double> levels(tin.heights().begin(), tin.heights().end());
  std::vector<double> value(tin.vertex_count());
  double best = std::numeric_limits<double>::infinity();
  const std::function<void(std::size_t, double)> choose = [&](std::size_t v, double sum) {
    if (sum >= best) return;
    if (v == value.size()) {
      best = sum;
      return;
    }
    for (const double level : levels) {
      value[v] = level;
      const bool holds = std::all_of(arcs.begin(), arcs.end(), [&](const auto& arc) {
        return std::max(arc.first, arc.second) > v || value[arc.first] >= value[arc.second];
      });
      if (holds) choose(v + 1, sum + std::abs(level - tin.height(VertexId{v})));
    }
  };
  choose(0, 0);
  return best;
}

TEST(ConditionLaws, FillAloneIsTheFlood) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < 150; ++i) {
    const Tin tin = test::random_terrain(i, random);
    const ConditionResult result = condition_heights(tin, {}, {.steps = {Fill}}, Progress());
    EXPECT_EQ(result.heights, plain_flood(tin)) << i;
    EXPECT_EQ(result.left, 0U);
  }
}

TEST(ConditionLaws, NoPitIsLeftAndTheSumIsAtMostThatOfOneWay) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  std::size_t breached = 0, filled = 0;
  for (int i = 0; i < 300; ++i) {
    const Tin tin = test::random_terrain(i, random);
    double least = sum_of_changes(condition_heights(tin, {}, {.steps = {Fill}}, Progress()));
    for (const std::vector<ConditionStep>& steps : {std::vector{Breach}, std::vector{Fill, Breach}}) {
      const ConditionResult result = condition_heights(tin, {}, {.steps = steps}, Progress());
      EXPECT_EQ(count_interior(tin, result.heights), 0U) << i;
      EXPECT_EQ(result.left, 0U);
      if (steps.size() == 1) {
        for (const HeightChange& change : result.changes) EXPECT_LT(change.after, change.before);
        least = std::min(least, sum_of_changes(result));
        continue;
      }
      EXPECT_LE(sum_of_changes(result), least * (1 + 1e-12)) << i;
      breached += result.breached;
      filled += result.filled;
    }
  }
  EXPECT_GT(breached, 100U);
  EXPECT_GT(filled, 100U);
}

TEST(ConditionLaws, OnlyListedHeightsChange) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < 100; ++i) {
    const Tin tin = draw_valleys(test::random_terrain(i, random), 0.1, random);
    std::optional<double> limit;
    if (i % 2 == 0) limit = random.real(0, 2);
    const ConditionResult result = condition_heights(
        tin, {}, {.steps = {MonotoneValleys, Fill, Breach}, .norm = ChangeNorm::Sum, .max_change = limit},
        Progress());
    std::vector<double> expected(tin.heights().begin(), tin.heights().end());
    for (const HeightChange& change : result.changes) {
      EXPECT_EQ(change.before, expected[change.vertex.index()]);
      EXPECT_NE(change.before, change.after);
      if (limit) {
        EXPECT_LE(std::abs(change.after - change.before), *limit);
      }
      expected[change.vertex.index()] = change.after;
    }
    EXPECT_EQ(result.heights, expected);
  }
}

TEST(ConditionLaws, NoValleyRises) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  std::size_t broken = 0;
  for (int i = 0; i < 200; ++i) {
    const Tin tin = draw_valleys(test::random_terrain(i, random), random.real(0, 0.4), random);
    const auto arcs = plain_valleys(tin).arcs;
    for (const ChangeNorm norm : {ChangeNorm::Sum, ChangeNorm::Squares}) {
      for (const std::vector<ConditionStep>& steps :
           {std::vector{MonotoneValleys}, std::vector{MonotoneValleys, Fill},
            std::vector{MonotoneValleys, Breach}, std::vector{MonotoneValleys, Fill, Breach}}) {
        const ConditionResult result =
            condition_heights(tin, {}, {.steps = steps, .norm = norm, .max_change = {}}, Progress());
        for (const auto& [a, b] : arcs) {
          EXPECT_GE(result.heights[a], result.heights[b]) << i;
          broken += tin.height(VertexId{a}) < tin.height(VertexId{b}) ? 1 : 0;
        }
        if (steps.size() > 1) {
          const std::size_t pits = count_interior(tin, result.heights);
          EXPECT_EQ(pits, result.left) << i;
          if (steps[1] == Fill) {
            EXPECT_EQ(pits, 0U) << i;
          }
        }
        const Tin after = with(tin, result.heights, tin.constraint_edges());
        Progress progress;
        EXPECT_EQ(check_consistency(after, {}).rising_edges, 0U);
      }
    }
  }
  EXPECT_GT(broken, 1000U);
}

TEST(ConditionLaws, SumOfChangesInValleysIsTheLeastOfAll) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  int changed = 0;
  for (int i = 0; i < 200; ++i) {
    std::vector<Point2> points;
    std::vector<double> heights;
    for (int k = 0; k < 8; ++k) {
      points.push_back({random.real(0, 10), random.real(0, 10)});
      heights.push_back(i % 2 == 0 ? random.integer(0, 3) : random.real(0, 10));
    }
    Progress progress;
    const Tin tin = draw_valleys(triangulate(std::move(points), std::move(heights), {}, progress),
                                 random.real(0.2, 0.8), random);
    const ConditionResult result = condition_heights(tin, {}, {.steps = {MonotoneValleys}}, Progress());
    const PlainValleys valleys = plain_valleys(tin);
    const double least = least_sum(tin, valleys.arcs);
    EXPECT_GE(sum_of_changes(result), least - 1e-9) << i;
    if (!valleys.level) {
      EXPECT_NEAR(sum_of_changes(result), least, 1e-9) << i;
    }
    changed += result.changes.empty() ? 0 : 1;
  }
  EXPECT_GT(changed, 50);
}

// x is the projection of z on the cone of isotonic values exactly if (z - x).x = 0 and (z - x).u <= 0 for all
// isotonic u. The cone is made of indicators of sets that hold with each vertex all that is above it, and of
// both signs of the constant.
TEST(ConditionLaws, SquaresInValleysAreTheLeastOfAll) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  int checked = 0;
  for (int i = 0; i < 200; ++i) {
    std::vector<Point2> points;
    std::vector<double> heights;
    for (int k = 0; k < 10; ++k) {
      points.push_back({random.real(0, 10), random.real(0, 10)});
      heights.push_back(i % 2 == 0 ? random.integer(0, 3) : random.real(0, 10));
    }
    Progress progress;
    const Tin tin = draw_valleys(triangulate(std::move(points), std::move(heights), {}, progress),
                                 random.real(0.2, 0.8), random);
    const PlainValleys valleys = plain_valleys(tin);
    if (valleys.level) continue;
    ++checked;
    const ConditionResult result = condition_heights(
        tin, {}, {.steps = {MonotoneValleys}, .norm = ChangeNorm::Squares, .max_change = {}}, Progress());
    double along = 0;
    for (std::size_t v = 0; v < result.heights.size(); ++v) {
      along += (tin.height(VertexId{v}) - result.heights[v]) * result.heights[v];
    }
    EXPECT_NEAR(along, 0, 1e-9);
    for (unsigned set = 0; set < 1U << tin.vertex_count(); ++set) {
      const bool closed = std::all_of(valleys.arcs.begin(), valleys.arcs.end(), [&](const auto& arc) {
        return (set >> arc.second & 1U) == 0 || (set >> arc.first & 1U) != 0;
      });
      if (!closed) continue;
      double gain = 0;
      for (std::size_t v = 0; v < result.heights.size(); ++v) {
        if ((set >> v & 1U) != 0) gain += tin.height(VertexId{v}) - result.heights[v];
      }
      EXPECT_LE(gain, 1e-9) << i;
      if (set + 1 == 1U << tin.vertex_count()) {
        EXPECT_NEAR(gain, 0, 1e-9) << i;
      }
    }
  }
  EXPECT_GT(checked, 100);
}

}  // namespace
}  // namespace thalweg
