#pragma once

/// Constrained orders of a set of points and lines: of given triangles, and the first-order structure.

#include <thalweg/base/progress.hpp>
#include <thalweg/delaunay/ground.hpp>
#include <thalweg/io/source.hpp>
#include <thalweg/order/constrained_order.hpp>
#include <thalweg/order/definition.hpp>
#include <thalweg/order/std_order.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace thalweg {

struct OrderResult;

struct OrderConfig {
  std::vector<SourceSpec> points;  ///< x and y suffice
  std::vector<LineSource> lines;   ///< heights play no part, and may be missing or disagree
  ReadOptions read = {.heights = HeightRule::Optional};
  GroundOptions ground = {.crossing = CrossingRule::Error};
  OrderDefinition definition = OrderDefinition::SeesOpp;
  std::size_t max_order = 1;  ///< of what is listed and counted
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::string triangles_path;       ///< CSV a,b,c,order of all valid triangles; empty: none
  std::string edges_path;           ///< CSV a,b,order of all useful edges; empty: none
  std::string quadrilaterals_path;  ///< CSV s,u,t,v,delaunay; empty: none
  std::string conflicts_path;       ///< CSV a,b,c,d,crossing of edges that exclude each other; empty: none
  std::string picture_path;         ///< .png, .svg or .pdf of the one triangle; empty: none
  bool census = false;              ///< count triangles and useful edges under every definition
  bool overwrite = false;
  /// Told the result when all files are whole, before they get their names: what it throws leaves none.
  std::function<void(const OrderResult&)> announce;
};

/// One triangle's answer.
struct TriangleOrders {
  std::array<std::uint32_t, 3> corners{};
  TriangleValidity validity;
  std::array<std::size_t, kOrderDefinitions.size()> orders{};  ///< as kOrderDefinitions; valid triangles only
};

/// How many triangles and useful edges there are of order at most `order`.
struct CensusRow {
  OrderDefinition definition = OrderDefinition::Std;
  std::size_t order = 0;
  std::size_t triangles = 0;
  std::size_t edges = 0;
  std::size_t unknown_edges = 0;  ///< of which it is not known whether they are useful at the largest order
};

struct OrderResult {
  std::size_t vertices = 0;
  std::size_t triangles = 0;
  std::size_t constraint_edges = 0;
  std::string definition;
  std::size_t max_order = 1;
  /// Counts of what was listed.
  std::optional<std::size_t> quadrilaterals, order_triangles, useful_edges, unknown_edges, conflicts,
      undecided_faces;
  std::vector<CensusRow> census;       ///< by definition, then order
  std::vector<std::string> not_taken;  ///< definitions that the census leaves out, and why
  /// Under Std with constraint edges, and in a census with them.
  std::optional<StdOrderInterval> std_order;
  Triangle worst_triangle{};  ///< of `std_order`
  std::vector<TriangleOrders> asked;
};

/// Triangulates the sources and answers. Ids are those of the ground: points in file order, a duplicate with
/// its first, then line vertices, then crossings. Throws: Error{Usage} for an id out of range or repeated,
/// or a picture without exactly one triangle;
/// {SizeLimit} if a list has no method for so many vertices; what reading and triangulating throw.
OrderResult order_points(const OrderConfig& config, Progress& progress);

/// {"triangle", "valid", "orders"} for one triangle asked, an array for several, else counts.
std::string to_json(const OrderResult& result);
std::string to_text(const OrderResult& result);

}  // namespace thalweg
