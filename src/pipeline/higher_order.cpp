// Triangles of the order, faces, optimiser, TIN.
//
// Orders count what the whole ground holds; of the triangles, those are candidates that lie on the surface
// and keep their orientation in the written coordinates.
#include "pipeline/higher_order.hpp"

#include "pipeline/std_order_error.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/geometry/predicates.hpp>
#include <thalweg/order/order_triangles.hpp>

#include <algorithm>
#include <string>
#include <utility>

namespace thalweg {

FixedFaces find_surface_faces(const Terrain& terrain, const Tin& surface, const LabellingConfig& labelling,
                              Progress& progress) {
  const ConstrainedOrder order(terrain.ground, terrain.mode);
  std::vector<OrderTriangle> triangles = find_order_triangles(
      order, {.definition = labelling.definition, .max_order = labelling.order}, progress);
  progress.advance(0.6);
  if (surface.triangle_count() < terrain.ground.triangle_count()) {
    triangles = keep_on_surface(surface, std::move(triangles), progress);
  }
  if (!terrain.continuous.empty()) {
    std::erase_if(triangles, [&](const OrderTriangle& t) {
      const auto at = [&](std::size_t i) { return terrain.continuous[t.corners[i].index()]; };
      return orientation(at(0), at(1), at(2)) <= 0;
    });
  }
  auto faces = find_fixed_faces(surface, std::move(triangles), {}, progress);
  progress.advance(0.9);
  if (faces) return std::move(*faces);
  throw no_triangulation(terrain, labelling, progress);
}

HigherOrderChoice choose_triangulations(const Tin& delaunay, const FixedFaces& faces,
                                        const OptimizeOptions& options, const LabellingConfig& labelling,
                                        Progress& progress) {
  FaceOptimizeResult result = optimize_faces(
      delaunay, faces,
      {.common = options,
       .order_sum_after = labelling.least_orders ? std::optional<std::size_t>(1) : std::nullopt},
      progress);
  HigherOrderChoice choice;
  choice.criteria = std::move(result.criteria);
  std::vector<Triangle> triangles;
  std::vector<std::size_t> histogram;
  for (const OrderTriangle& t : result.triangles) {
    triangles.push_back(t.corners);
    choice.orders.push_back(static_cast<std::uint16_t>(t.order));
    if (t.order >= histogram.size()) histogram.resize(t.order + 1, 0);
    ++histogram[t.order];
  }
  choice.tin = Tin({delaunay.points().begin(), delaunay.points().end()},
                   {delaunay.heights().begin(), delaunay.heights().end()}, std::move(triangles),
                   delaunay.constraint_edges());
  for (std::size_t i = 0; i < choice.tin.halfedge_count(); ++i) {
    const HalfedgeId h{i};
    const VertexId a = choice.tin.origin(h), b = choice.tin.target(h);
    if (!choice.tin.represents_edge(h) || delaunay.find_halfedge(a, b).valid()) continue;
    if (!delaunay.find_halfedge(b, a).valid()) choice.new_edges.push_back({std::min(a, b), std::max(a, b)});
  }
  std::sort(choice.new_edges.begin(), choice.new_edges.end());
  choice.figures = {.definition = std::string(definition_name(labelling.definition)),
                    .order = labelling.order,
                    .faces = result.faces,
                    .partial_faces = result.partial_faces,
                    .largest_face = result.largest_face,
                    .labels = result.labels,
                    .most_labels = result.most_labels,
                    .new_edges = choice.new_edges.size(),
                    .order_histogram = std::move(histogram),
                    .fixed_by_elimination = result.fixed_by_elimination,
                    .pieces = result.pieces,
                    .largest_piece = result.largest_piece,
                    .width = result.width};
  return choice;
}

std::vector<std::uint16_t> renumbered_orders(const Tin& tin, const std::vector<std::uint16_t>& orders,
                                             const std::vector<VertexId>& number) {
  std::vector<std::pair<Triangle, std::uint16_t>> moved;
  moved.reserve(orders.size());
  for (std::size_t t = 0; t < orders.size(); ++t) {
    Triangle corners = tin.triangle(TriangleId{t});
    for (VertexId& v : corners) v = number[v.index()];
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    moved.emplace_back(corners, orders[t]);
  }
  std::sort(moved.begin(), moved.end());
  std::vector<std::uint16_t> renumbered;
  renumbered.reserve(moved.size());
  for (const auto& [corners, order] : moved) renumbered.push_back(order);
  return renumbered;
}

}  // namespace thalweg
