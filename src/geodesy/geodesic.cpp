// Lengths and areas on the ellipsoid by C. Karney's formulas ("Algorithms for geodesics", 2013; section 6 for
// polygons), as GeographicLib has them: they are exact to round-off for edges of any length, and areas
// count a pole that a loop encloses.
#include "position.hpp"

#include <thalweg/geodesy/geodesic.hpp>

#include <GeographicLib/Geodesic.hpp>
#include <GeographicLib/PolygonArea.hpp>

#include <algorithm>

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

std::vector<double> geodesic_lengths_m(std::span<const Point2> lonlat_deg,
                                       std::span<const std::pair<VertexId, VertexId>> edges,
                                       Ellipsoid ellipsoid) {
  const GeographicLib::Geodesic geodesic(ellipsoid.equatorial_radius_m, ellipsoid.flattening);
  std::vector<double> lengths;
  lengths.reserve(edges.size());
  for (const auto& [a, b] : edges) {
    for (const VertexId v : {a, b}) check_position(lonlat_deg[v.index()], v.index());
    const auto [from, to] = std::minmax(lonlat_deg[a.index()], lonlat_deg[b.index()]);
    geodesic.Inverse(from.y, from.x, to.y, to.x, lengths.emplace_back());
  }
  return lengths;
}

}  // namespace thalweg
