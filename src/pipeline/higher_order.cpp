// Triangles of the order, faces, optimiser, TIN.
//
// Orders count what the whole ground holds; of the triangles, those are candidates that lie on the surface
// and keep their orientation in the written coordinates.
#include "pipeline/higher_order.hpp"

#include "base/parallel.hpp"
#include "pipeline/std_order_error.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/geometry/predicates.hpp>
#include <thalweg/order/useful_triangles.hpp>

#include <algorithm>
#include <string>
#include <utility>

namespace thalweg {

void check_choice_by_faces(const LabellingConfig& labelling, const OutputConfig& output, bool simplified) {
  if (!labelling.by_faces()) return;
  const auto refuse = [&](bool asked, const std::string& what) {
    if (!asked) return;
    throw Error(
        ErrorCode::Unsupported,
        what + (labelling.order > 1 ? " is not available at orders above 1; take --order 1"
                : labelling.heuristic
                    ? " is not available with --method flip and hull; take --method exact"
                    : " is not available under sees-3vtx and empty-quad; take --definition sees-opp"));
  };
  refuse(!output.problem_path.empty(), "--dump-problem");
  refuse(!output.proof_path.empty(), "--proof");
  refuse(simplified, "simplification");
  require_face_criteria(labelling.criteria);
}

namespace {

/// Vertices at order 1 under definitions whose triangles are found by trying all pairs of vertices: 250
/// random ones take 4 s of processor time, 500 take 28 s, and the time grows with the third power. Flips take
/// the place of more.
constexpr std::size_t kMostListed = 500;

/// The ground's triangles, and those of the other diagonals of its first-order quadrilaterals: these have
/// order 1, for the ends of a Delaunay diagonal are in each other's circle then, and see what they must.
std::vector<OrderTriangle> triangles_of_flips(const Terrain& terrain, OrderDefinition definition,
                                              const Progress& progress) {
  std::vector<OrderTriangle> triangles;
  const auto add = [&](Triangle corners, std::uint32_t order) {
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    triangles.push_back({corners, order});
  };
  for (const Triangle& corners : terrain.ground.triangles()) add(corners, 0);
  for (const Quadrilateral& q :
       find_quadrilaterals(terrain.ground, {.definition = definition, .mode = terrain.mode}, progress)) {
    add({q.s, q.u, q.t}, 1);
    add({q.t, q.v, q.s}, 1);
  }
  std::sort(triangles.begin(), triangles.end());
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
  return triangles;
}

/// 1 for each face that has more triangulations than the optimiser lists.
std::vector<std::uint8_t> faces_too_large(const FixedFaces& faces, const Progress& progress) {
  constexpr std::size_t kBlock = 64, kSmall = 14, kMost = 20'000;
  std::vector<std::uint8_t> too_large(faces.faces.size(), 0);
  for_each_block(too_large.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      if (faces.faces.row(f).size() <= kSmall) continue;
      too_large[f] = list_triangulations(faces, f, {.most = kMost}) ? 0 : 1;
    }
  });
  return too_large;
}

std::optional<FixedFaces> narrow(const FixedFaces& faces, const Terrain& terrain, const Tin& surface,
                                 const Progress& progress) {
  const std::vector<std::uint8_t> too_large = faces_too_large(faces, progress);
  if (std::find(too_large.begin(), too_large.end(), 1) == too_large.end()) return std::nullopt;
  std::vector<std::uint8_t> dropped(faces.triangles.size(), 0);
  for (std::size_t f = 0; f < too_large.size(); ++f) {
    if (too_large[f] == 0) continue;
    for (const std::uint32_t t : faces.faces.row(f)) dropped[t] = 1;
  }
  const std::vector<OrderTriangle> kept = triangles_of_flips(terrain, OrderDefinition::SeesOpp, progress);
  const auto less = [](const OrderTriangle& a, const OrderTriangle& b) { return a.corners < b.corners; };
  std::vector<OrderTriangle> triangles;
  for (std::size_t t = 0; t < dropped.size(); ++t) {
    const OrderTriangle& triangle = faces.triangles[t];
    if (dropped[t] == 0 || std::binary_search(kept.begin(), kept.end(), triangle, less)) {
      triangles.push_back(triangle);
    }
  }
  return find_fixed_faces(surface, std::move(triangles), {}, progress);
}

}  // namespace

SurfaceFaces find_surface_faces(const Terrain& terrain, const Tin& surface, const LabellingConfig& labelling,
                                Progress& progress) {
  OrderTriangleOptions options{.definition = labelling.definition, .max_order = labelling.order};
  if (labelling.order == 1) options.exhaustive_limit = kMostListed;
  SurfaceFaces found;
  const ConstrainedOrder order(terrain.ground, terrain.mode);
  found.only_flips = labelling.order == 1 && !can_list_order_triangles(order, options);
  std::vector<OrderTriangle> triangles;
  if (found.only_flips) {
    triangles = triangles_of_flips(terrain, labelling.definition, progress);
  } else {
    triangles = find_useful_triangles(order, options, progress);
  }
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
  if (faces) {
    found.faces = std::move(*faces);
    if (labelling.order == 1 && !labelling.heuristic)
      found.narrowed = narrow(found.faces, terrain, surface, progress);
    return found;
  }
  throw no_triangulation(terrain, labelling, progress);
}

namespace {

/// Edges of one TIN that another one on the same vertices does not have, a < b, sorted.
std::vector<std::array<VertexId, 2>> find_new_edges(const Tin& tin, const Tin& delaunay,
                                                    const Progress& progress) {
  constexpr std::size_t kBlock = 1 << 14;
  std::vector<std::vector<std::array<VertexId, 2>>> parts(tin.halfedge_count() / kBlock + 1);
  for_each_block(tin.halfedge_count(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const HalfedgeId h{i};
      const VertexId a = tin.origin(h), b = tin.target(h);
      if (!tin.represents_edge(h) || delaunay.find_halfedge(a, b).valid()) continue;
      if (!delaunay.find_halfedge(b, a).valid())
        parts[begin / kBlock].push_back({std::min(a, b), std::max(a, b)});
    }
  });
  std::vector<std::array<VertexId, 2>> edges;
  for (const auto& part : parts) edges.insert(edges.end(), part.begin(), part.end());
  std::sort(edges.begin(), edges.end());
  return edges;
}

/// Bounds over more triangulations, and what tells of their faces.
void bound_by_all(const FaceOptimizeResult& all, FaceOptimizeResult& result) {
  take_bounds(all.criteria, all.bounds_alone, result.criteria);
  result.faces = all.faces;
  result.partial_faces = all.partial_faces;
  result.largest_face = all.largest_face;
}

}  // namespace

HigherOrderChoice choose_triangulations(const Tin& delaunay, const SurfaceFaces& faces,
                                        const OptimizeOptions& options, const LabellingConfig& labelling,
                                        Progress& progress) {
  const FaceOptimizeOptions choice_of{
      .common = options,
      .order_sum_after = labelling.least_orders ? std::optional<std::size_t>(1) : std::nullopt};
  FaceOptimizeResult result =
      labelling.heuristic
          ? optimize_faces_by(*labelling.heuristic, delaunay, faces.faces, choice_of, progress)
          : optimize_faces(delaunay, faces.narrowed ? *faces.narrowed : faces.faces, choice_of, progress);
  if (faces.narrowed) {
    FaceOptimizeOptions all = choice_of;
    all.bounds_alone = true;
    bound_by_all(optimize_faces(delaunay, faces.faces, all, progress), result);
  }
  HigherOrderChoice choice;
  choice.criteria = std::move(result.criteria);
  std::vector<std::size_t> histogram;
  for (const OrderTriangle& t : result.triangles) {
    choice.orders.push_back(static_cast<std::uint16_t>(t.order));
    if (t.order >= histogram.size()) histogram.resize(t.order + 1, 0);
    ++histogram[t.order];
  }
  choice.tin = std::move(result.tin);
  choice.new_edges = find_new_edges(choice.tin, delaunay, progress);
  choice.figures = {.definition = std::string(definition_name(labelling.definition)),
                    .order = labelling.order,
                    .only_flips = faces.only_flips,
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

}  // namespace thalweg
