// Useful edges and greedy triangulations, against all triangulations of the oracle.
#include <thalweg/order/greedy_triangulation.hpp>
#include <thalweg/order/useful_edges.hpp>

#include <gtest/gtest.h>
#include <support/oracle/law_testing.hpp>
#include <support/oracle/triangulations.hpp>
#include <support/scene_tin.hpp>

#include <map>
#include <string>

namespace thalweg {
namespace {

using oracle::Corners;
using oracle::Edge;
using oracle::kStreams;
using oracle::Oracle;
using oracle::SceneOptions;

constexpr SceneOptions kSmall{.fewest = 4, .most = 9, .constraints = 6};
constexpr std::size_t kLargestOrder = 4;

struct Library {
  explicit Library(const Oracle& oracle)
      : ground(test::ground_of(oracle.scene())), order(ground, test::mode_of(oracle.scene())) {}
  Tin ground;
  ConstrainedOrder order;
};

std::map<Edge, std::optional<int>> useful_by_library(const Library& library, UsefulEdgeOptions options) {
  Progress progress;
  std::map<Edge, std::optional<int>> useful;
  for (const UsefulEdge& edge : find_useful_edges(library.order, options, progress)) {
    const Edge ends{static_cast<int>(edge.a.value()), static_cast<int>(edge.b.value())};
    useful[ends] = edge.order ? std::optional<int>(static_cast<int>(*edge.order)) : std::nullopt;
  }
  return useful;
}

std::map<Edge, int> useful_by_enumeration(const oracle::Enumeration& all, OrderDefinition definition,
                                          std::size_t k) {
  auto useful = all.useful_orders(static_cast<oracle::Definition>(definition));
  std::erase_if(useful, [&](const auto& entry) { return entry.second > static_cast<int>(k); });
  return useful;
}

void expect_same(const std::map<Edge, std::optional<int>>& found, const std::map<Edge, int>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (const auto& [edge, order] : found) {
    ASSERT_TRUE(order.has_value());
    ASSERT_TRUE(expected.contains(edge)) << edge.first << "-" << edge.second;
    ASSERT_EQ(*order, expected.at(edge)) << edge.first << "-" << edge.second;
  }
}

// No useful edge is missing, and what is decided is right: all of it, if `exact`.
void expect_no_contradiction(const std::map<Edge, std::optional<int>>& found,
                             const std::map<Edge, int>& expected, bool exact) {
  for (const auto& [edge, order] : expected) ASSERT_TRUE(found.contains(edge));
  for (const auto& [edge, order] : found) {
    ASSERT_TRUE(order.has_value() || !exact);
    if (!order) continue;
    ASSERT_TRUE(expected.contains(edge));
    ASSERT_EQ(*order, expected.at(edge));
  }
}

using Law = void (*)(const oracle::Enumeration&, const Library&, OrderDefinition, std::size_t k);

// Holds a law against each scene, under each definition, for each k.
void for_each_order(const Law& law) {
  for_each_scene(kStreams, 25, kSmall, [&](const Oracle& oracle) {
    const oracle::Enumeration all = enumerate(oracle);
    const Library library(oracle);
    for (const OrderDefinition definition : kOrderDefinitions) {
      for (std::size_t k = 0; k <= kLargestOrder && !testing::Test::HasFailure(); ++k) {
        SCOPED_TRACE(std::string(definition_name(definition)) + ", k = " + std::to_string(k));
        law(all, library, definition, k);
      }
    }
  });
}

TEST(UsefulEdges, AreThoseOfAllTriangulations) {
  for_each_order(
      [](const oracle::Enumeration& all, const Library& library, OrderDefinition definition, std::size_t k) {
        const auto found = useful_by_library(library, {.definition = definition, .max_order = k});
        expect_same(found, useful_by_enumeration(all, definition, k));
      });
}

// Without the search of faces: what the greedy triangulation decides is right, and nothing useful is missing.
TEST(UsefulEdges, AreNoneOtherByGreedyTriangulations) {
  for_each_order(
      [](const oracle::Enumeration& all, const Library& library, OrderDefinition definition, std::size_t k) {
        const auto found =
            useful_by_library(library, {.definition = definition, .max_order = k, .work_limit = 0});
        const bool exact = definition == OrderDefinition::Pathcon ||
                           definition == OrderDefinition::ConfEdge || definition == OrderDefinition::SeesOpp;
        expect_no_contradiction(found, useful_by_enumeration(all, definition, k), exact);
      });
}

TEST(GreedyTriangulation, IsTheOracles) {
  for_each_scene(
      kStreams, 25, SceneOptions{.fewest = 4, .most = 14, .constraints = 8}, [](const Oracle& oracle) {
        const Library library(oracle);
        for (const Edge& edge : oracle::edges_of(oracle.valid_triangles())) {
          const Tin greedy =
              greedy_triangulation(library.order, test::vertex(edge.first), test::vertex(edge.second));
          std::vector<Triangle> expected;
          for (const Corners& t : greedy_triangles(oracle, edge)) {
            expected.push_back(test::triangle(t));
          }
          std::sort(expected.begin(), expected.end());
          ASSERT_TRUE(std::equal(expected.begin(), expected.end(), greedy.triangles().begin(),
                                 greedy.triangles().end()))
              << edge.first << "-" << edge.second;
        }
      });
}

}  // namespace
}  // namespace thalweg
