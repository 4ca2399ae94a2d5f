#pragma once

/// What criteria of water measure, written a second time.

#include "verify/plain_criteria.hpp"
#include "verify/plain_delaunay.hpp"
#include "verify/plain_pits.hpp"

#include <span>

namespace thalweg::verify {

/// The sum of depths of pits, in metres. With quadrilaterals: the least that any choice of their diagonals
/// can give, all of them there at once. Complexity: sorting edges by height.
PlainValue pit_depth(const PlainMesh& mesh, PlainScale scale,
                     std::span<const PlainQuadrilateral> quadrilaterals = {});

/// Between sets of vertices that edges up to some height connect, whatever diagonals are chosen: what each
/// diagonal of that height connects. A labelling has the least depth of pits exactly if it connects all that
/// the diagonals could.
PlainPlateaus find_spill_links(const PlainMesh& delaunay, std::span<const PlainQuadrilateral> quadrilaterals);

/// How both sides of the drawn valley ab fall: it drains if the ground rises from it on one side at least,
/// falls on none, and the edge is not level. `certain`: no other correct reading of the coordinates in the
/// file could say otherwise. Triangle a, b, l is on its left, b, a, r on its right.
struct PlainValley {
  bool drawn = false;
  bool drains = false;
  bool certain = true;
};
PlainValley look_at_valley(const PlainMesh& mesh, Index a, Index b, Index l, Index r);

}  // namespace thalweg::verify
