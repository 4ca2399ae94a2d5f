#pragma once

/// First-order structure: the quadrilaterals whose diagonals may be chosen freely.

#include <thalweg/base/id.hpp>

namespace thalweg {

/// A strictly convex quadrilateral of two triangles of a TIN, whose four sides are fixed.
struct Quadrilateral {
  /// Corners counter-clockwise; the diagonal in the TIN is uv, the other st.
  VertexId s, u, t, v;
  /// The halfedge u -> v of the TIN: its apex is s, its twin's apex is t.
  HalfedgeId diagonal;
};

}  // namespace thalweg
