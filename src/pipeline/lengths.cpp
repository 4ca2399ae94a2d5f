// One list of edges, the rim's first; one way to measure it for the plane, one for the ellipsoid; sums in
// double-double, so that they do not depend on the order of edges.
#include "pipeline/lengths.hpp"

#include "base/double_double.hpp"

#include <thalweg/geodesy/geodesic.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace thalweg {

namespace {

using Edge = std::pair<VertexId, VertexId>;

constexpr std::array<const char*, 6> kKinds{"breakline", "ridge", "valley", "boundary", "hole", "lake"};

// The rim's edges, then the constraint edges.
std::vector<Edge> edges_of(const Tin& tin) {
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < tin.halfedge_count(); ++i) {
    const HalfedgeId h{i};
    if (tin.on_rim(h)) edges.emplace_back(tin.origin(h), tin.target(h));
  }
  for (const ConstraintEdge& edge : tin.constraint_edges()) edges.emplace_back(edge.a, edge.b);
  return edges;
}

ReportLengths sums_of(const Tin& tin, std::span<const double> lengths_m) {
  const std::vector<ConstraintEdge> constraints = tin.constraint_edges();
  const std::size_t rim_edges = lengths_m.size() - constraints.size();
  DoubleDouble rim;
  std::array<DoubleDouble, kKinds.size()> constraint;
  for (std::size_t i = 0; i < rim_edges; ++i) rim.add(lengths_m[i]);
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    for (std::size_t bit = 0; bit < kKinds.size(); ++bit) {
      if (has(constraints[i].kind, static_cast<EdgeKind>(1U << bit)))
        constraint[bit].add(lengths_m[rim_edges + i]);
    }
  }
  ReportLengths sums;
  sums.rim_m = rim.value();
  std::transform(constraint.begin(), constraint.end(), sums.constraint_m.begin(),
                 [](const DoubleDouble& sum) { return sum.value(); });
  return sums;
}

}  // namespace

ReportLengths plane_lengths(const Tin& tin, double metres_per_unit) {
  std::vector<double> lengths;
  for (const auto& [a, b] : edges_of(tin)) {
    const Point2 p = tin.point(a), q = tin.point(b);
    lengths.push_back(std::hypot(q.x - p.x, q.y - p.y) * metres_per_unit);
  }
  return sums_of(tin, lengths);
}

ReportLengths geodesic_lengths(const Tin& tin, std::span<const Point2> lonlat_deg, Ellipsoid ellipsoid) {
  return sums_of(tin, geodesic_lengths_m(lonlat_deg, edges_of(tin), ellipsoid));
}

nlohmann::ordered_json lengths_json(const ReportLengths& lengths) {
  nlohmann::ordered_json json{{"rim", lengths.rim_m}};
  for (std::size_t i = 0; i < kKinds.size(); ++i) json[kKinds[i]] = lengths.constraint_m[i];
  return json;
}

std::string lengths_text(const ReportLengths& lengths) {
  std::string text = fmt::format("rim {:.1f}", lengths.rim_m);
  for (std::size_t i = 0; i < kKinds.size(); ++i) {
    if (lengths.constraint_m[i] > 0) text += fmt::format(", {} {:.1f}", kKinds[i], lengths.constraint_m[i]);
  }
  return text;
}

}  // namespace thalweg
