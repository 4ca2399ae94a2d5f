#pragma once

/// The eight definitions of the constrained order of a triangle.
///
/// Based on: R. I. Silveira, M. van Kreveld, Towards a Definition of Higher Order Constrained Delaunay
/// Triangulations, 2009, section 2. t = uvw is a valid triangle, C its circumcircle, p a vertex inside C; p
/// lies beyond exactly one side of t, say uv, and w is its opposite vertex. The order of t is the number of p
/// counted.

#include <array>
#include <cstdint>
#include <string_view>

namespace thalweg {

/// When p counts; from strong to weak, conf-edge aside, which lies between sees-triang and sees-opp.
enum class OrderDefinition : std::uint8_t {
  Std,         ///< always
  Pathcon,     ///< a path inside C that no constraint edge meets joins p to the interior of t
  SeesTriang,  ///< p sees a point of the open side uv, and uv is no constraint edge
  SeesVtx,     ///< as SeesTriang, and p sees u, v or w
  ConfEdge,    ///< p sees some r inside C or in {u, v, w}, and pr meets the interior of t
  SeesOpp,     ///< uv is no constraint edge and p sees w
  Sees3vtx,    ///< as SeesOpp, and p sees u and v
  EmptyQuad    ///< as Sees3vtx, and the closed triangle uvp holds no other vertex
};

inline constexpr std::array<OrderDefinition, 8> kOrderDefinitions = {
    OrderDefinition::Std,      OrderDefinition::Pathcon,  OrderDefinition::SeesTriang,
    OrderDefinition::SeesVtx,  OrderDefinition::ConfEdge, OrderDefinition::SeesOpp,
    OrderDefinition::Sees3vtx, OrderDefinition::EmptyQuad};

/// Name as on the command line: std, pathcon, sees-triang, sees-vtx, conf-edge, sees-opp, sees-3vtx,
/// empty-quad.
std::string_view definition_name(OrderDefinition definition);

/// The definition of that name. Throws: Error{Usage} that lists the names.
OrderDefinition parse_definition(std::string_view name);

}  // namespace thalweg
