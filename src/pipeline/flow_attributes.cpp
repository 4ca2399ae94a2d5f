// Values read off the flow: all channels are reaches of a network without a least area.
#include "pipeline/flow_attributes.hpp"

#include "base/lower_case.hpp"

#include <thalweg/base/error.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace thalweg {

namespace {

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();
enum class WaterEdge : std::uint8_t { None = 0, Valley = 1, Ridge = 2 };

/// By halfedge: the number of its edge.
std::vector<std::uint32_t> number_edges(const Tin& tin) {
  std::vector<std::uint32_t> number(tin.halfedge_count());
  std::uint32_t next = 0;
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (!tin.represents_edge(HalfedgeId{i})) continue;
    number[i] = next++;
    if (const HalfedgeId twin = tin.twin(HalfedgeId{i}); twin.valid()) number[twin.index()] = number[i];
  }
  return number;
}

struct Attributes {
  std::vector<TinAttribute> vertex, edge;
};

/// By vertex: the number of its catchment, or no value.
std::vector<double> catchments_of_vertices(const Tin& tin, const FlowView& view) {
  std::vector<double> number(tin.vertex_count(), kNoValue);
  for (std::size_t v = 0; v < number.size(); ++v) {
    const SinkId sink = view.flow.sink_of(VertexId{v});
    if (sink.valid()) number[v] = view.end_of_sink[sink.index()];
  }
  // By vertex on a border: the first catchment there, and whether its own is one of them.
  std::vector<double> beside(number.size(), kNoValue);
  std::vector<std::uint8_t> is_there(number.size(), 0);
  const auto look_at = [&](std::uint32_t group, const CatchmentRing& ring) {
    for (const FlowPoint& p : ring) {
      if (!p.vertex.valid()) continue;
      const std::size_t v = p.vertex.index();
      if (std::isnan(beside[v])) beside[v] = group;
      if (number[v] == group) is_there[v] = 1;
    }
  };
  for (const Catchment& catchment : view.catchments) {
    for (const CatchmentPolygon& polygon : catchment.polygons) {
      look_at(catchment.group, polygon.outer);
      for (const CatchmentRing& hole : polygon.holes) look_at(catchment.group, hole);
    }
  }
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (is_there[v] == 0 && !std::isnan(beside[v])) number[v] = beside[v];
  }
  return number;
}

/// By vertex: how deep it lies below the level to which its pit is filled.
std::vector<double> depths_of_water(const LoadedTin& loaded, const FlowView& view) {
  std::vector<double> level(view.flow.sinks().size(), -std::numeric_limits<double>::infinity());
  for (const Pit& pit : view.pits.pits) level[pit.sink.index()] = pit.fill_height;
  std::vector<double> depth;
  for (std::size_t v = 0; v < loaded.tin.vertex_count(); ++v) {
    const SinkId sink = view.flow.sink_of(VertexId{v});
    const double water = sink.valid() ? level[sink.index()] - loaded.tin.heights()[v] : 0;
    depth.push_back(std::max(water, 0.0) * loaded.plane.vertical_metres_per_unit());
  }
  return depth;
}

Attributes find_attributes(const LoadedTin& loaded, const FlowView& view, Progress& progress) {
  const Tin& tin = loaded.tin;
  const double metres = loaded.plane.metres_per_unit(), square = metres * metres;
  const std::size_t vertices = tin.vertex_count(), edges = tin.edge_count();
  Attributes found;
  found.vertex = {
      {"catchment", "number of the catchment, as in the layer catchments of thalweg drain", "1",
       catchments_of_vertices(tin, view)},
      {"fill_depth", "depth of water if all pits were full", "m", {}},
      {"upstream_area", "area upstream of the channels that end here", "m2", std::vector(vertices, 0.0)}};
  found.edge = {
      {"water", "0 none, 1 valley: both sides drain into it, 2 ridge", "1", std::vector(edges, 0.0)},
      {"upstream_area", "area upstream of the lower end of a channel", "m2", std::vector(edges, kNoValue)},
      {"strahler", "Strahler order of a channel", "1", std::vector(edges, kNoValue)}};
  found.vertex[1].values = depths_of_water(loaded, view);
  const std::vector<std::uint32_t> number = number_edges(tin);
  for (std::size_t i = 0; i < number.size(); ++i) {
    const HalfedgeId h{i};
    if (!tin.represents_edge(h)) continue;
    const WaterEdge water = view.flow.is_valley(h)  ? WaterEdge::Valley
                            : view.flow.is_ridge(h) ? WaterEdge::Ridge
                                                    : WaterEdge::None;
    found.edge[0].values[number[i]] = static_cast<double>(water);
  }
  for (const Reach& reach : find_network(view.flow, view.spilling, 0, progress)) {
    if (!reach.channel.valid()) continue;
    const std::uint32_t edge = number[reach.channel.index()];
    found.edge[1].values[edge] = reach.area * square;
    found.edge[2].values[edge] = reach.strahler;
    found.vertex[2].values[reach.points.back().vertex.index()] += reach.area * square;
  }
  return found;
}

}  // namespace

void check_mesh_path(const std::string& path) {
  const std::string extension = extension_of(path);
  if (extension == ".nc" || extension == ".gpkg") return check_write_options(path, {});
  throw Error(ErrorCode::Usage,
              "--mesh writes .nc (UGRID) or .gpkg, which hold values of edges, not '" + path + "'");
}

void write_flow_mesh(const LoadedTin& loaded, const FlowView& flow, const DrainConfig& config,
                     PendingOutputs& outputs, Progress& progress) {
  const Attributes attributes = find_attributes(loaded, flow, progress);
  const std::vector<std::uint8_t> pits = loaded.inner_pits();
  TinView view = loaded.view(pits);
  view.vertex_attributes = attributes.vertex;
  view.edge_attributes = attributes.edge;
  write_tin(config.mesh_path, view, {}, outputs, config.overwrite ? Overwrite::Yes : Overwrite::No, progress);
}

}  // namespace thalweg
