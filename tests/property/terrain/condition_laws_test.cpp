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
#include <set>
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
  bool level = false;  // a line has level ends, so no direction
};

/// Arcs of drawn valleys downstream, traced anew from pairs of vertices.
PlainValleys plain_valleys(const Tin& tin) {
  std::map<std::size_t, std::set<std::size_t>> next;
  for (const ConstraintEdge& edge : tin.constraint_edges()) {
    next[edge.a.index()].insert(edge.b.index());
    next[edge.b.index()].insert(edge.a.index());
  }
  PlainValleys valleys;
  for (const auto& [end, ways] : next) {
    if (ways.size() == 2) continue;
    for (std::size_t at : ways) {
      std::vector<std::pair<std::size_t, std::size_t>> line = {{end, at}};
      std::size_t before = end;
      while (next[at].size() == 2) {
        const std::size_t on = *next[at].begin() == before ? *next[at].rbegin() : *next[at].begin();
        line.emplace_back(at, on);
        before = std::exchange(at, on);
      }
      const double from = tin.height(VertexId{end}), to = tin.height(VertexId{at});
      valleys.level |= from == to && end != at;
      if (from > to) valleys.arcs.insert(valleys.arcs.end(), line.begin(), line.end());
    }
  }
  return valleys;
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
