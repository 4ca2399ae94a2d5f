#pragma once

/// Constrained orders of a set of points and lines: of given triangles, and the first-order structure.

#include <thalweg/base/progress.hpp>
#include <thalweg/delaunay/ground.hpp>
#include <thalweg/io/source.hpp>
#include <thalweg/order/constrained_order.hpp>
#include <thalweg/order/definition.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace thalweg {

struct OrderConfig {
  std::vector<SourceSpec> points;  ///< x and y suffice
  std::vector<LineSource> lines;
  ReadOptions read = {.heights = HeightRule::Optional};
  GroundOptions ground = {.crossing = CrossingRule::Error};
  OrderDefinition definition = OrderDefinition::SeesOpp;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::string quadrilaterals_path;  ///< CSV s,u,t,v,delaunay; empty: none
  bool overwrite = false;
};

/// One triangle's answer.
struct TriangleOrders {
  std::array<std::uint32_t, 3> corners{};
  TriangleValidity validity;
  std::array<std::size_t, kOrderDefinitions.size()> orders{};  ///< as kOrderDefinitions; valid triangles only
};

struct OrderResult {
  std::size_t vertices = 0;
  std::size_t triangles = 0;
  std::size_t constraint_edges = 0;
  std::size_t quadrilaterals = 0;  ///< counted where they were asked for
  bool quadrilaterals_listed = false;
  std::string definition;
  std::vector<TriangleOrders> asked;
};

/// Triangulates the sources and answers. Ids are those of the ground: points in file order, a duplicate with
/// its first, then line vertices, then crossings. Throws: Error{Usage} for an id out of range or repeated;
/// what reading and triangulating throw.
OrderResult order_points(const OrderConfig& config, Progress& progress);

/// {"triangle", "valid", "orders"} for one triangle asked, an array for several, else counts.
std::string to_json(const OrderResult& result);
std::string to_text(const OrderResult& result);

}  // namespace thalweg
