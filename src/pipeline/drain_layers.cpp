// Layers of hydrology. Points on edges are put at their share of the edge's way between the coordinates that
// came in, so borders lie on the edges of the TIN as written.
#include "pipeline/drain_layers.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace thalweg {

namespace {

using Field = FeatureLayer::Field;

Point2 written(const LoadedTin& loaded, VertexId v) {
  return loaded.written.empty() ? loaded.tin.point(v) : loaded.plane.without_jump(loaded.written[v.index()]);
}

Point2 written(const LoadedTin& loaded, const FlowPoint& p) {
  if (p.vertex.valid()) return written(loaded, p.vertex);
  if (loaded.written.empty() || !p.edge.valid()) return p.xy;
  const Point2 a = written(loaded, loaded.tin.origin(p.edge)), b = written(loaded, loaded.tin.target(p.edge));
  return {a.x + p.along * (b.x - a.x), a.y + p.along * (b.y - a.y)};
}

std::string sink_word(Sink::Kind kind) {
  switch (kind) {
    case Sink::Kind::Pit:
      return "pit";
    case Sink::Kind::Lake:
      return "lake";
    case Sink::Kind::Outlet:
      return "rim";
    case Sink::Kind::Given:
      return "outlet";
  }
  return "pit";
}

FieldValue whole(std::size_t value) {
  return static_cast<std::int64_t>(value);
}

double square_metres(const LoadedTin& loaded, double area) {
  const double unit = loaded.plane.metres_per_unit();
  return area * unit * unit;
}

}  // namespace

FeatureLine line_of(const LoadedTin& loaded, std::span<const FlowPoint> points) {
  FeatureLine line;
  for (const FlowPoint& p : points) {
    const Point2 xy = written(loaded, p);
    if (!line.xy.empty() && line.xy.back() == xy) continue;
    line.xy.push_back(xy);
    line.z.push_back(p.z);
  }
  if (line.xy.size() == 1) {  // a path that ends where it starts
    line.xy.push_back(line.xy.front());
    line.z.push_back(line.z.front());
  }
  return line;
}

FeatureLine ring_of(const LoadedTin& loaded, const CatchmentRing& points) {
  FeatureLine ring;
  for (const FlowPoint& p : points) {
    const Point2 xy = written(loaded, p);
    if (ring.xy.empty() || ring.xy.back() != xy) ring.xy.push_back(xy);
  }
  while (ring.xy.size() > 1 && ring.xy.back() == ring.xy.front()) ring.xy.pop_back();
  return ring;
}

FeatureLayer pit_layer(const LoadedTin& loaded, const PitTable& table) {
  FeatureLayer layer{.name = "pits",
                     .geometry = FeatureGeometry::Point,
                     .has_z = true,
                     .fields = {{"sink", FieldType::Integer},
                                {"kind", FieldType::Text},
                                {"vertex", FieldType::Integer},
                                {"vertices", FieldType::Integer},
                                {"z", FieldType::Real},
                                {"spill_z", FieldType::Real},
                                {"spill_vertex", FieldType::Integer},
                                {"spill_x", FieldType::Real},
                                {"spill_y", FieldType::Real},
                                {"spills_into", FieldType::Integer},
                                {"fill_z", FieldType::Real},
                                {"depth_m", FieldType::Real},
                                {"area_m2", FieldType::Real},
                                {"volume_m3", FieldType::Real},
                                {"catchment_area_m2", FieldType::Real}},
                     .features = {}};
  for (const Pit& pit : table.pits) {
    const Point2 spill = written(loaded, pit.spill_vertex);
    FieldValue into;
    if (pit.spills_into) into = whole(table.pits[*pit.spills_into].sink.index());
    layer.features.push_back(
        {{{{{written(loaded, pit.vertex)}, {pit.height}}}},
         {whole(pit.sink.index()), std::string(pit.lake ? "lake" : "interior"), whole(pit.vertex.index()),
          whole(pit.vertices), pit.height, pit.spill_height, whole(pit.spill_vertex.index()), spill.x,
          spill.y, into, pit.fill_height, pit.depth_m, pit.area_m2, pit.volume_m3, pit.catchment_area_m2}});
  }
  return layer;
}

FeatureLayer path_layer(const LoadedTin& loaded, const SurfaceFlow& flow, std::span<const SeededPath> paths) {
  FeatureLayer layer{.name = "flow_paths",
                     .geometry = FeatureGeometry::Line,
                     .has_z = true,
                     .fields = {{"seed", FieldType::Integer},
                                {"sink", FieldType::Integer},
                                {"kind", FieldType::Text},
                                {"length_m", FieldType::Real},
                                {"fall_m", FieldType::Real}},
                     .features = {}};
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const FlowPath& path = paths[i].path;
    double length = 0;
    for (std::size_t k = 1; k < path.points.size(); ++k) {
      length += std::hypot(path.points[k].xy.x - path.points[k - 1].xy.x,
                           path.points[k].xy.y - path.points[k - 1].xy.y);
    }
    FeatureLine line = line_of(loaded, path.points);
    if (!path.points.front().vertex.valid()) line.xy.front() = loaded.plane.without_jump(paths[i].written);
    const double fall = path.points.front().z - path.points.back().z;
    layer.features.push_back(
        {{{std::move(line)}},
         {whole(i), whole(path.sink.index()), sink_word(flow.sinks()[path.sink.index()].kind),
          length * loaded.plane.metres_per_unit(), fall * loaded.plane.vertical_metres_per_unit()}});
  }
  return layer;
}

FeatureLayer network_layer(const LoadedTin& loaded, const SurfaceFlow& flow, std::span<const Reach> network) {
  FeatureLayer layer{.name = "network",
                     .geometry = FeatureGeometry::Line,
                     .has_z = true,
                     .fields = {{"kind", FieldType::Text},
                                {"strahler", FieldType::Integer},
                                {"area_m2", FieldType::Real},
                                {"drawn", FieldType::Integer},
                                {"sink", FieldType::Integer}},
                     .features = {}};
  for (const Reach& reach : network) {
    const bool channel = reach.channel.valid();
    const bool drawn = channel && has(loaded.tin.kind(reach.channel), EdgeKind::Valley);
    const std::string kind = !channel ? "surface" : flow.is_valley(reach.channel) ? "valley" : "edge";
    layer.features.push_back({{{line_of(loaded, reach.points)}},
                              {kind, whole(reach.strahler), square_metres(loaded, reach.area),
                               whole(drawn ? 1 : 0), whole(reach.sink.index())}});
  }
  return layer;
}

FeatureLayer catchment_layer(const LoadedTin& loaded, const SurfaceFlow& flow,
                             std::span<const Catchment> catchments, std::span<const double> area_m2) {
  FeatureLayer layer{.name = "catchments",
                     .geometry = FeatureGeometry::Polygon,
                     .fields = {{"sink", FieldType::Integer},
                                {"kind", FieldType::Text},
                                {"vertex", FieldType::Integer},
                                {"area_m2", FieldType::Real}},
                     .features = {}};
  for (const Catchment& catchment : catchments) {
    const Sink& sink = flow.sinks()[catchment.group];
    Feature feature{
        {},
        {whole(catchment.group), sink_word(sink.kind), whole(sink.vertex.index()), area_m2[catchment.group]}};
    for (const CatchmentPolygon& polygon : catchment.polygons) {
      std::vector<FeatureLine> rings{ring_of(loaded, polygon.outer)};
      if (rings.front().xy.size() < 3) continue;
      for (const CatchmentRing& hole : polygon.holes) {
        FeatureLine ring = ring_of(loaded, hole);
        if (ring.xy.size() > 2) rings.push_back(std::move(ring));
      }
      feature.parts.push_back(std::move(rings));
    }
    if (!feature.parts.empty()) layer.features.push_back(std::move(feature));
  }
  return layer;
}

FeatureLayer inconsistency_layer(const LoadedTin& loaded, const Consistency& consistency) {
  FeatureLayer layer{.name = "inconsistencies",
                     .geometry = FeatureGeometry::Line,
                     .has_z = true,
                     .fields = {{"kind", FieldType::Text}, {"rise_m", FieldType::Real}},
                     .features = {}};
  for (const Inconsistency& place : consistency.places) {
    const bool rises = place.kind == Inconsistency::Kind::ValleyRises;
    const FeatureLine line{{written(loaded, place.from), written(loaded, place.to)},
                           {loaded.tin.height(place.from), loaded.tin.height(place.to)}};
    FieldValue rise;
    if (rises) rise = place.rise_m;
    layer.features.push_back({{{line}}, {std::string(rises ? "valley rises" : "ridge crossed"), rise}});
  }
  return layer;
}

}  // namespace thalweg
