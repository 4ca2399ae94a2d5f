// The solver on abstract problems against trying every labelling.
#include "optimize/solver.hpp"

#include "optimize/piece.hpp"
#include "optimize/roof_duality.hpp"
#include "optimize/small_piece.hpp"
#include "support/random_labelling.hpp"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace thalweg::test {
namespace {

template <std::size_t Criteria>
void expect_exact(const Labelling<Criteria>& problem) {
  const Progress progress;
  const Solution<Criteria> solution = solve<Criteria>(problem, {}, progress);
  EXPECT_TRUE(connects_all(problem, solution.label));
  EXPECT_EQ(plain_cost(problem, solution.label), solution.value);
  EXPECT_EQ(solution.value, plain_minimum(problem));
  EXPECT_EQ(solution.bound, solution.value);
}

template <std::size_t Criteria>
bool expect_bracket(const Labelling<Criteria>& problem, std::uint32_t width, std::uint64_t effort) {
  const Progress progress;
  const Solution<Criteria> solution = solve<Criteria>(problem, {width, effort}, progress);
  const Cost<Criteria> best = plain_minimum(problem);
  EXPECT_TRUE(connects_all(problem, solution.label));
  EXPECT_EQ(plain_cost(problem, solution.label), solution.value);
  EXPECT_FALSE(best < solution.bound);
  EXPECT_FALSE(solution.value < best);
  return solution.value == best;
}

TEST(Solver, FindsTheLeastCost) {
  Random random;
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < 400 && !HasFailure(); ++i) {
    const LabellingShape shape{.variables = random.integer<std::size_t>(0, 10),
                               .pairs_per_variable = random.real(0.3, 2.5),
                               .range = random.integer(1, 8)};
    expect_exact(random_labelling<1>(shape, random));
    expect_exact(random_labelling<2>(shape, random));
  }
}

TEST(Solver, FindsTheLeastCostThatConnects) {
  Random random;
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < 1000 && !HasFailure(); ++i) {
    const LabellingShape shape{.variables = random.integer<std::size_t>(1, 10),
                               .pairs_per_variable = random.real(0, 2),
                               .nodes = random.integer<std::size_t>(1, 7),
                               .range = random.integer(1, 8)};
    expect_exact(random_labelling<1>(shape, random));
  }
}

TEST(Solver, FindsTheLeastCostWithTables) {
  Random random;
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < 400 && !HasFailure(); ++i) {
    const LabellingShape shape{.variables = random.integer<std::size_t>(1, 10),
                               .pairs_per_variable = random.real(0, 2),
                               .nodes = random.integer<std::size_t>(0, 5),
                               .tables = random.integer<std::size_t>(1, 8),
                               .range = random.integer(1, 8)};
    expect_exact(random_labelling<1>(shape, random));
    expect_exact(random_labelling<2>(shape, random));
  }
}

TEST(Solver, SpansWithoutWeights) {
  Random random;
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < 200 && !HasFailure(); ++i) {
    const LabellingShape shape{
        .variables = 10, .pairs_per_variable = 0, .nodes = random.integer<std::size_t>(2, 8)};
    expect_exact(random_labelling<1>(shape, random));
  }
}

TEST(Solver, BracketsWhatIsTooWide) {
  Random random;
  SCOPED_TRACE(random.trace());
  int met = 0, all = 0;
  for (int i = 0; i < 300 && !HasFailure(); ++i) {
    const LabellingShape shape{.variables = 10,
                               .pairs_per_variable = random.real(1, 4),
                               .nodes = random.integer<std::size_t>(0, 5),
                               .tables = i % 3 == 0 ? random.integer<std::size_t>(1, 5) : 0,
                               .range = 20};
    for (const std::uint32_t width : {1U, 2U, 3U}) {
      met += expect_bracket(random_labelling<1>(shape, random), width, 20000) ? 1 : 0;
      ++all;
    }
  }
  EXPECT_GT(met, all * 8 / 10);
}

/// All variables but some that are fixed at random, as one piece.
template <std::size_t Criteria>
bool expect_same_as_general(const Labelling<Criteria>& problem, SmallPiece<Criteria>& small, Random& random) {
  Reduction fixed;
  std::vector<std::uint32_t> open, index(problem.size());
  for (std::uint32_t q = 0; q < problem.size(); ++q) {
    fixed.label.push_back(
        std::array{Label::Zero, Label::One, Label::Open}[random.integer<std::size_t>(0, 2)]);
    if (q % 3 != 0) fixed.label.back() = Label::Open;
    if (fixed.label.back() == Label::Open) open.push_back(q);
  }
  std::shuffle(open.begin(), open.end(), random.engine());
  for (std::uint32_t i = 0; i < open.size(); ++i) index[open[i]] = i;
  const Labelling<Criteria> piece = restrict_to<Criteria>(problem, fixed, {}, {open, index});
  const auto width = random.integer<std::uint32_t>(1, SmallPiece<Criteria>::kMostWidth);
  const auto exact = solve_exactly(piece, width, Progress());
  const bool solved = small.solve(problem, fixed, {open, index}, width);
  if (piece.neighbour.empty()) {
    EXPECT_FALSE(solved);
    return false;
  }
  EXPECT_EQ(solved, exact.has_value());
  if (!solved || !exact) return false;
  EXPECT_TRUE(std::ranges::equal(small.label(), exact->label));
  EXPECT_EQ(small.width(), exact->width);
  EXPECT_EQ(small.table_entries(), exact->table_entries);
  return true;
}

TEST(SmallPiece, IsSolvedAsAnyOther) {
  Random random;
  SCOPED_TRACE(random.trace());
  SmallPiece<1> one;
  SmallPiece<2> two;
  std::size_t solved = 0;
  for (int i = 0; i < 500 && !HasFailure(); ++i) {
    const LabellingShape shape{.variables = random.integer<std::size_t>(1, SmallPiece<1>::kMostVariables),
                               .pairs_per_variable = random.real(0, 2),
                               .range = random.integer(0, 8)};
    solved += expect_same_as_general(random_labelling<1>(shape, random), one, random) ? 1 : 0;
    solved += expect_same_as_general(random_labelling<2>(shape, random), two, random) ? 1 : 0;
  }
  EXPECT_GT(solved, 400U);
}

/// Problems that have nothing to do with each other, and one that is all of them.
struct ManyProblems {
  std::vector<Labelling<1>> problem;
  std::vector<std::vector<std::uint32_t>> variables;  ///< their numbers in the whole

  [[nodiscard]] Labelling<1> whole(std::size_t count) const {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> from(count);  // problem and variable
    for (std::uint32_t p = 0; p < problem.size(); ++p) {
      for (std::uint32_t q = 0; q < variables[p].size(); ++q) from[variables[p][q]] = {p, q};
    }
    std::vector<std::uint32_t> first_node;
    Labelling<1> all;
    for (const Labelling<1>& part : problem) {
      first_node.push_back(all.node_count);
      all.node_count += part.node_count;
    }
    for (const auto& [p, q] : from) {
      const Labelling<1>& part = problem[p];
      all.unary.push_back(part.unary[q]);
      for (std::size_t i = part.first[q]; i < part.first[q + 1]; ++i) {
        all.neighbour.push_back(variables[p][part.neighbour[i]]);
        all.weight.push_back(part.weight[i]);
      }
      all.first.push_back(static_cast<std::uint32_t>(all.neighbour.size()));
      const Link link = part.has_link(q) ? part.link[q] : Link{};
      all.link.push_back(link.exists() ? Link{first_node[p] + link.a, first_node[p] + link.b, link.helpful()}
                                       : Link{});
    }
    all.tables.index(count);
    return all;
  }
};

// Parts of one problem lie in one block of variables, or across the borders of blocks.
TEST(Solver, SolvesManyProblemsAsEachByItself) {
  Random random;
  SCOPED_TRACE(random.trace());
  constexpr std::uint32_t kCount = 150'000;
  for (const std::uint32_t apart : {8U, 40'000U, kCount}) {
    std::vector<std::uint32_t> numbers(kCount);
    std::iota(numbers.begin(), numbers.end(), 0U);
    for (std::uint32_t begin = 0; begin < kCount; begin += apart) {
      std::shuffle(numbers.begin() + begin, numbers.begin() + std::min(kCount, begin + apart),
                   random.engine());
    }
    ManyProblems many;
    Cost<1> least;
    for (std::uint32_t begin = 0; begin < kCount;) {
      const LabellingShape shape{
          .variables = std::min<std::size_t>(random.integer<std::size_t>(1, 8), kCount - begin),
          .pairs_per_variable = random.real(0, 2),
          .nodes = random.integer<std::size_t>(0, 4),
          .range = random.integer(1, 8)};
      many.problem.push_back(random_labelling<1>(shape, random));
      least += plain_minimum(many.problem.back());
      many.variables.emplace_back(numbers.begin() + begin, numbers.begin() + begin + shape.variables);
      begin += static_cast<std::uint32_t>(shape.variables);
    }
    const Labelling<1> problem = many.whole(kCount);
    const Progress progress;
    const Solution<1> solution = solve<1>(problem, {}, progress);
    EXPECT_EQ(solution.value, least);
    EXPECT_EQ(solution.bound, least);
    const Solution<1> by_one = tbb::task_arena(1).execute([&] { return solve<1>(problem, {}, progress); });
    EXPECT_EQ(by_one.label, solution.label);
    EXPECT_EQ(by_one.figures.pieces, solution.figures.pieces);
    EXPECT_EQ(by_one.figures.fixed_by_elimination, solution.figures.fixed_by_elimination);
  }
}

TEST(Solver, TiesThroughoutKeepLabelsZero) {
  // Neighbours on a lattice that had better agree, and nothing else: wide, with two optima.
  constexpr std::uint32_t kSide = 30;
  Labelling<1> problem;
  for (std::uint32_t q = 0; q < kSide * kSide; ++q) {
    for (const auto& [neighbour, there] :
         {std::pair{q - 1, q % kSide != 0}, std::pair{q + 1, (q + 1) % kSide != 0},
          std::pair{q - kSide, q >= kSide}, std::pair{q + kSide, q + kSide < kSide * kSide}}) {
      if (!there) continue;
      problem.neighbour.push_back(neighbour);
      problem.weight.push_back({-2});
    }
    problem.first.push_back(static_cast<std::uint32_t>(problem.neighbour.size()));
    const auto degree = problem.first[q + 1] - problem.first[q];
    problem.unary.push_back({{degree, 1, 7}});
  }
  problem.tables.index(problem.size());
  const Solution<1> solution = solve<1>(problem, {8, 2'000'000'000}, Progress());
  EXPECT_EQ(std::ranges::count(solution.label, Label::One), 0);
  EXPECT_EQ(solution.bound, solution.value);
  EXPECT_LT(solution.figures.table_entries, 1'000'000U);
}

TEST(RoofDuality, FixesWhatEveryOptimumHas) {
  Random random;
  SCOPED_TRACE(random.trace());
  const Progress progress;
  std::size_t fixed = 0;
  for (int i = 0; i < 400 && !HasFailure(); ++i) {
    const LabellingShape shape{.variables = random.integer<std::size_t>(1, 9),
                               .pairs_per_variable = random.real(0, 2),
                               .nodes = random.integer<std::size_t>(0, 5),
                               .range = random.integer(1, 8)};
    Labelling<1> problem = random_labelling<1>(shape, random);
    const std::int64_t best = plain_minimum(problem).level[0];
    const RoofDual dual = find_roof_dual(problem, progress);
    EXPECT_LE(dual.bound, best);
    for (std::size_t q = 0; q < problem.size(); ++q) {
      if (dual.label[q] == Label::Open) continue;
      ++fixed;
      Labelling<1> other_way =
          problem;  // with the other label made so dear that it costs more than all the rest
      const std::int64_t dear = 1000;
      other_way.unary.levels()[q][0] += dual.label[q] == Label::One ? dear : -dear;
      const std::int64_t with_other =
          plain_minimum(other_way).level[0] + (dual.label[q] == Label::One ? 0 : dear);
      EXPECT_GT(with_other, best);
    }
  }
  EXPECT_GT(fixed, 400U);
}

}  // namespace
}  // namespace thalweg::test
