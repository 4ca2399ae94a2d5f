// Useful edges and greedy triangulations, against all triangulations of the oracle.
#include <thalweg/order/greedy_triangulation.hpp>
#include <thalweg/order/useful_edges.hpp>

#include <gtest/gtest.h>
#include <support/oracle/law_testing.hpp>
#include <support/oracle/triangulations.hpp>
#include <support/scene_tin.hpp>

#include <map>

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

std::map<Edge, int> useful_by_enumeration(const oracle::Enumeration& all, OrderDefinition definition) {
  auto useful = all.useful_orders(static_cast<oracle::Definition>(definition));
  std::erase_if(useful, [](const auto& entry) { return entry.second > static_cast<int>(kLargestOrder); });
  return useful;
}

TEST(UsefulEdges, AreThoseOfAllTriangulations) {
  for_each_scene(kStreams, 25, kSmall, [](const Oracle& oracle) {
    const oracle::Enumeration all = enumerate(oracle);
    const Library library(oracle);
    for (const OrderDefinition definition : kOrderDefinitions) {
      const auto found = useful_by_library(library, {.definition = definition, .max_order = kLargestOrder});
      const auto expected = useful_by_enumeration(all, definition);
      ASSERT_EQ(found.size(), expected.size()) << definition_name(definition);
      for (const auto& [edge, order] : found) {
        ASSERT_TRUE(order.has_value());
        ASSERT_TRUE(expected.contains(edge)) << edge.first << "-" << edge.second;
        ASSERT_EQ(*order, expected.at(edge))
            << definition_name(definition) << " " << edge.first << "-" << edge.second;
      }
    }
  });
}

// Without the search of faces: what the greedy triangulation decides is right, and nothing useful is missing.
TEST(UsefulEdges, AreNoneOtherByGreedyTriangulations) {
  for_each_scene(kStreams, 25, kSmall, [](const Oracle& oracle) {
    const oracle::Enumeration all = enumerate(oracle);
    const Library library(oracle);
    for (const OrderDefinition definition : kOrderDefinitions) {
      const auto found =
          useful_by_library(library, {.definition = definition, .max_order = kLargestOrder, .work_limit = 0});
      const auto expected = useful_by_enumeration(all, definition);
      for (const auto& [edge, order] : expected) {
        ASSERT_TRUE(found.contains(edge)) << definition_name(definition);
      }
      const bool exact = definition == OrderDefinition::Pathcon || definition == OrderDefinition::ConfEdge ||
                         definition == OrderDefinition::SeesOpp;
      for (const auto& [edge, order] : found) {
        ASSERT_TRUE(order.has_value() || !exact) << definition_name(definition);
        if (!order) continue;
        ASSERT_TRUE(expected.contains(edge)) << definition_name(definition);
        ASSERT_EQ(*order, expected.at(edge)) << definition_name(definition);
      }
    }
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
