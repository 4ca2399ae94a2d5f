#pragma once

/// The criteria, each written a second time from its definition in the README.

#include "verify/plain_mesh.hpp"
#include "verify/plain_reference.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace thalweg::verify {

/// Metres per unit of the plane and of heights.
struct PlainScale {
  double horizontal = 1;
  double vertical = 1;
};

enum class Depends : std::uint8_t { OnTriangle, OnEdge, OnVertex, OnPlateau };
enum class Combines : std::uint8_t { Sum, Largest, Smallest };

/// One criterion, or a weighted sum of several.
struct PlainCriterion {
  struct Part {
    double weight = 1;
    std::string name;
  };
  std::vector<Part> parts;
  Depends depends = Depends::OnTriangle;  ///< of sums of several: OnEdge if any part is
  Combines combines = Combines::Sum;
  bool maximised = false;
  bool counts = false;  ///< a whole number
  const PlainReference* reference = nullptr;
  double term_unit = 1;  ///< terms are counted in so many of the criterion's units
};

/// The criterion of that name ("edge-length", "2*edge-length+0.5*normal-angle-sum"), if it is known here and
/// has the reference that it needs.
std::optional<PlainCriterion> plain_criterion(const std::string& name, const PlainReference* reference);

/// Terms in steps of 2^-32 of their unit, each rounded once. Triangles are counter-clockwise; the edge ab has
/// triangle a, b, l on its left and b, a, r on its right.
std::int64_t triangle_term(const PlainMesh& mesh, PlainScale scale, const PlainCriterion& criterion, Index a,
                           Index b, Index c);
std::int64_t edge_term(const PlainMesh& mesh, PlainScale scale, const PlainCriterion& criterion, Index a,
                       Index b, Index l, Index r);
/// What meets at a vertex. An edge is convex where the surface is strictly a ridge, reflex where a valley.
struct PlainRing {
  std::size_t edges = 0, convex = 0, reflex = 0;
  bool on_rim = false;
};
std::int64_t vertex_term(const PlainCriterion& criterion, const PlainRing& ring);
/// Whether a part of the criterion depends on vertices.
bool has_vertex_part(const PlainCriterion& criterion);
/// +1 if the surface is convex along the edge ab, -1 if reflex, 0 if flat, decided exactly; l and r as above.
int bend(const PlainMesh& mesh, Index a, Index b, Index l, Index r);
/// By vertex: whether it is on the rim.
std::vector<bool> rim_of(const PlainMesh& mesh);

/// What no diagonal changes and no triangle or edge holds, rounded once.
std::int64_t constant_term(const PlainMesh& mesh, PlainScale scale, const PlainCriterion& criterion);

struct PlainValue {
  long double value = 0;
  /// By how much another correct computation may differ: each term is rounded to a step, and may be to the
  /// next one.
  long double tolerance = 0;
};
PlainValue value_of(const PlainMesh& mesh, PlainScale scale, const PlainCriterion& criterion);

/// Pits: sets of vertices of equal height connected by edges, without lower neighbour. On the rim: an outlet.
struct PlainPits {
  std::size_t interior = 0, boundary = 0, lake = 0;
};
PlainPits count_pits(const PlainMesh& mesh);

}  // namespace thalweg::verify
