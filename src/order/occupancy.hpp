#pragma once

/// What lies in a triangle of any three vertices: the test of validity.

#include "order/ground.hpp"
#include "order/stamped_map.hpp"

#include <thalweg/order/constrained_order.hpp>

#include <cstdint>
#include <vector>

namespace thalweg::detail {

/// How much an inspection is to find out.
enum class Inspection : std::uint8_t {
  FirstFault,  ///< any fault ends it
  Lowest       ///< the fault that is named does not depend on the order of the search
};

/// Inspects triangles over a ground; scratch memory is reused.
class Occupancy {
 public:
  /// The fault of a triangle in any orientation.
  /// Complexity: the faces that it overlaps; linear for Lowest where it leaves the ground of a polygon.
  TriangleValidity inspect(const Ground& ground, const Triangle& triangle, Inspection inspection);

 private:
  void visit_faces(const Ground& ground, const Triangle& corners, TriangleId start, Inspection inspection);
  void search_everywhere(const Ground& ground, const Triangle& corners);
  void inspect_face(const Ground& ground, const Triangle& corners, std::uint32_t face);
  void note_vertex(const Ground& ground, const Triangle& corners, VertexId v);
  void note_crossing(const Tin& tin, HalfedgeId h);

  StampedMap faces_;
  std::vector<std::uint32_t> pending_;
  VertexId occupant_;
  VertexId crossing_low_, crossing_high_;
  bool left_ground_ = false;
};

}  // namespace thalweg::detail
