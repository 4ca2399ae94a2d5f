// Lines from constraint edges; words for kinds.
#include "io/edge_chains.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace thalweg {
namespace {

ConstraintEdge edge(std::size_t a, std::size_t b, EdgeKind kind) {
  return {VertexId{a}, VertexId{b}, kind};
}

std::vector<std::vector<std::uint32_t>> ids(const std::vector<EdgeChain>& chains) {
  std::vector<std::vector<std::uint32_t>> lists;
  for (const EdgeChain& chain : chains) {
    lists.emplace_back();
    for (const VertexId v : chain.vertices) lists.back().push_back(v.value());
  }
  return lists;
}

TEST(EdgeChains, LinesEndAtJunctionsAndWhereTheKindChanges) {
  std::vector<ConstraintEdge> edges = {edge(1, 2, EdgeKind::Valley), edge(0, 1, EdgeKind::Valley),
                                       edge(2, 3, EdgeKind::Valley), edge(2, 4, EdgeKind::Valley),
                                       edge(4, 5, EdgeKind::Ridge),  edge(7, 6, EdgeKind::Ridge),
                                       edge(8, 7, EdgeKind::Ridge),  edge(6, 8, EdgeKind::Ridge)};
  const std::vector<std::vector<std::uint32_t>> expected = {{4, 5}, {6, 7, 8, 6}, {0, 1, 2}, {2, 3}, {2, 4}};
  EXPECT_EQ(ids(chain_edges(edges)), expected);
  std::reverse(edges.begin(), edges.end());
  for (ConstraintEdge& e : edges) std::swap(e.a, e.b);
  EXPECT_EQ(ids(chain_edges(edges)), expected);
}

TEST(EdgeChains, LoopThroughAJunctionComesBackToIt) {
  const std::vector<ConstraintEdge> edges = {edge(0, 1, EdgeKind::Lake), edge(1, 2, EdgeKind::Lake),
                                             edge(2, 0, EdgeKind::Lake), edge(0, 3, EdgeKind::Lake)};
  const std::vector<std::vector<std::uint32_t>> expected = {{0, 1, 2, 0}, {0, 3}};
  EXPECT_EQ(ids(chain_edges(edges)), expected);
}

TEST(EdgeChains, NoEdges) {
  EXPECT_TRUE(chain_edges({}).empty());
}

TEST(EdgeKindWords, RoundTrip) {
  for (std::uint8_t bits = 1; bits < 64; ++bits) {
    const auto kind = static_cast<EdgeKind>(bits);
    EXPECT_EQ(parse_kind_words(kind_words(kind)), kind);
  }
  EXPECT_EQ(kind_words(EdgeKind::None), "none");
  EXPECT_EQ(kind_words(EdgeKind::Valley | EdgeKind::Boundary), "valley+boundary");
  for (const char* wrong : {"", "river", "valley+", "+valley", "Valley", "none", "valley+river"}) {
    EXPECT_EQ(parse_kind_words(wrong), std::nullopt) << wrong;
  }
}

}  // namespace
}  // namespace thalweg
