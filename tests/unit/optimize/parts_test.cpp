// The parts of the solver, each on cases whose answer is plain to see.
#include "optimize/blocks.hpp"
#include "optimize/bucket_elimination.hpp"
#include "optimize/cuts.hpp"
#include "optimize/elimination_order.hpp"
#include "optimize/max_flow.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace thalweg::test {
namespace {

TEST(Blocks, TwoTrianglesAndABridge) {
  const std::vector<NodePair> edges = {{0, 1}, {1, 2}, {2, 0}, {2, 3}, {3, 4}, {4, 5}, {5, 3}};
  const Blocks blocks = find_blocks(edges, 6);
  ASSERT_EQ(blocks.size.size(), 3U);
  EXPECT_EQ(blocks.size[blocks.block[3]], 1U);
  EXPECT_EQ(blocks.block[0], blocks.block[1]);
  EXPECT_EQ(blocks.block[0], blocks.block[2]);
  EXPECT_EQ(blocks.block[4], blocks.block[6]);
  EXPECT_NE(blocks.block[0], blocks.block[4]);
}

TEST(Blocks, ParallelEdgesAreNoBridges) {
  const Blocks blocks = find_blocks(std::vector<NodePair>{{0, 1}, {1, 0}, {1, 2}}, 3);
  EXPECT_EQ(blocks.block[0], blocks.block[1]);
  EXPECT_EQ(blocks.size[blocks.block[0]], 2U);
  EXPECT_EQ(blocks.size[blocks.block[2]], 1U);
}

TEST(EliminationOrder, ATreeHasWidthOneAndALatticeItsSide) {
  const std::vector<NodePair> star = {{0, 1}, {0, 2}, {0, 3}, {3, 4}};
  EXPECT_EQ(find_elimination_order(5, star, 1).width, 1U);
  std::vector<NodePair> lattice;
  constexpr std::uint32_t kSide = 6;
  for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
    if (i % kSide + 1 < kSide) lattice.emplace_back(i, i + 1);
    if (i + kSide < kSide * kSide) lattice.emplace_back(i, i + kSide);
  }
  const EliminationOrder order = find_elimination_order(kSide * kSide, lattice, 20);
  EXPECT_TRUE(order.complete);
  EXPECT_GE(order.width, kSide);
  EXPECT_LE(order.width, kSide + 1);
  EXPECT_FALSE(find_elimination_order(kSide * kSide, lattice, 3).complete);

  const std::vector<std::uint32_t> never(kSide * kSide, 0);
  const std::vector<std::uint32_t> removed = find_cutset(kSide * kSide, lattice, 3, never);
  std::erase_if(lattice, [&](const NodePair& edge) {
    return std::count(removed.begin(), removed.end(), edge.first) > 0 ||
           std::count(removed.begin(), removed.end(), edge.second) > 0;
  });
  EXPECT_TRUE(find_elimination_order(kSide * kSide, lattice, 3).complete);
}

TEST(EliminationOrder, TreeNumbersKeepSubtreesTogether) {
  const std::vector<NodePair> path = {{0, 5}, {5, 1}, {1, 4}, {4, 2}, {2, 3}};
  const EliminationOrder order = find_elimination_order(8, path, 8);
  std::vector<std::uint32_t> numbers = tree_numbers(order);
  for (std::size_t i = 0; i < order.order.size(); ++i) {
    if (order.scope_at(i).empty()) continue;
    EXPECT_LT(numbers[order.order[i]], numbers[order.scope_at(i)[0]]);
  }
  std::sort(numbers.begin(), numbers.end());
  for (std::uint32_t i = 0; i < numbers.size(); ++i) EXPECT_EQ(numbers[i], i);
}

TEST(MaxFlow, TextbookNetwork) {
  FlowNetwork network(6);
  network.add_arc(0, 1, 16);
  network.add_arc(0, 2, 13);
  network.add_arc(1, 3, 12);
  network.add_arc(2, 1, 4);
  network.add_arc(3, 2, 9);
  network.add_arc(2, 4, 14);
  network.add_arc(4, 3, 7);
  network.add_arc(3, 5, 20);
  network.add_arc(4, 5, 4);
  const Progress progress;
  EXPECT_EQ(network.maximise(0, 5, progress), 23);
}

TEST(Cuts, ALongCutBecomesAChain) {
  Cut cut;
  for (std::uint32_t q = 0; q < 7; ++q) cut.push_back({q, q % 2 == 0 ? Label::One : Label::Zero});
  const std::vector<std::uint32_t> numbers = {6, 5, 4, 3, 2, 1, 0};
  const std::vector<Clause> clauses = split_cuts(std::vector<Cut>{cut}, numbers, 7);
  ASSERT_EQ(clauses.size(), 5U);
  const std::vector<Cost<1>> unary = {{{5, 0, 0}}, {{-9, 0, 0}}, {{3, 0, 0}}, {{-8, 0, 0}},
                                      {{4, 0, 0}}, {{-7, 0, 0}}, {{6, 0, 0}}};
  const TermSum<1> sum{11, unary, {}, clauses};
  const EliminationOrder order = find_elimination_order(11, interactions(sum), 11);
  const Progress progress;
  const Minimum<1> minimum = minimise(sum, order, progress);
  EXPECT_EQ(minimum.value.level[0], -21);  // all odd ones at label 1 save 24, the cheapest even one costs 3
  EXPECT_EQ(minimum.label[2], Label::One);
}

TEST(Cuts, FailedCutsSeparateWhatIsNotConnected) {
  const std::vector<Link> links = {
      {0, 1, Label::One}, {1, 2, Label::One}, {2, 0, Label::Zero}, {3, 4, Label::One}, {}};
  const std::vector<Label> ones(5, Label::One), zeros(5, Label::Zero);
  EXPECT_TRUE(failed_cuts(links, 5, ones).empty());
  const std::vector<Cut> cuts = failed_cuts(links, 5, zeros);
  ASSERT_EQ(cuts.size(), 2U);  // around {1}, and between 3 and 4
  EXPECT_EQ(cuts[0].size() + cuts[1].size(), 3U);
}

TEST(BucketElimination, ReportsWhatCannotBeMet) {
  const std::vector<Cost<1>> unary(1);
  const std::vector<Clause> clauses = {{Literal{0, Label::One}}, {Literal{0, Label::Zero}}};
  const TermSum<1> sum{1, unary, {}, clauses};
  const Progress progress;
  EXPECT_TRUE(minimise(sum, find_elimination_order(1, interactions(sum), 1), progress).value.is_infeasible());
}

}  // namespace
}  // namespace thalweg::test
