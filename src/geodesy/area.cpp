// Area on the ellipsoid by C. Karney's formulas for geodesic polygons ("Algorithms for geodesics", 2013,
// section 6), as GeographicLib has them: they are exact to round-off for edges of any length, and they
// count a pole that a loop encloses.
#include "position.hpp"

#include <thalweg/geodesy/area.hpp>

#include <GeographicLib/Geodesic.hpp>
#include <GeographicLib/PolygonArea.hpp>

namespace thalweg {

double geodesic_area_m2(std::span<const Point2> lonlat_deg, std::span<const std::vector<VertexId>> rim_loops,
                        Ellipsoid ellipsoid) {
  const GeographicLib::Geodesic geodesic(ellipsoid.equatorial_radius_m, ellipsoid.flattening);
  double sum = 0;
  for (const std::vector<VertexId>& loop : rim_loops) {
    GeographicLib::PolygonArea polygon(geodesic);
    for (const VertexId v : loop) {
      const Point2 p = lonlat_deg[v.index()];
      check_position(p, v.index());
      polygon.AddPoint(p.y, p.x);
    }
    double perimeter = 0;
    double area = 0;
    polygon.Compute(false, true, perimeter, area);
    sum += area;
  }
  return sum;
}

}  // namespace thalweg
