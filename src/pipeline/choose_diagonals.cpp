// Structure, conditioning, choice.
//
// Structure. The first-order quadrilaterals are found on the whole ground (orders count what the points and
// constraint edges say, whether or not a triangle is part of the surface). Those of which both triangles are
// surface, and which are strictly convex in the written coordinates too, may be flipped.
//
// Conditioning. Drawn valleys are edges of every triangulation, so where they alone are made monotone that
// comes before the choice. Pits depend on it: diagonals are chosen first, which removes pits at no height's
// expense; what is left is filled or breached on that triangulation, which then has none; then diagonals are
// chosen again, for the new heights. Pits come first among the criteria, so none comes back, and all that is
// reported is of the heights that are written.
#include "pipeline/choose_diagonals.hpp"

#include "pipeline/condition_tin.hpp"
#include "pipeline/higher_order.hpp"
#include "pipeline/outlets.hpp"
#include "pipeline/proof_file.hpp"
#include "pipeline/reference.hpp"
#include "pipeline/std_order_error.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/geometry/predicates.hpp>
#include <thalweg/mesh/change_tin.hpp>
#include <thalweg/order/order_tin.hpp>

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <utility>

namespace thalweg {

namespace {

std::vector<std::uint32_t> surface_indices(const std::vector<bool>& keep) {
  std::vector<std::uint32_t> index(keep.size(), TriangleId::kInvalid);
  std::uint32_t next = 0;
  for (std::size_t t = 0; t < keep.size(); ++t) {
    if (keep[t]) index[t] = next++;
  }
  return index;
}

bool convex_as_written(const Quadrilateral& q, std::span<const Point2> written) {
  if (written.empty()) return true;
  const auto at = [&](VertexId v) { return written[v.index()]; };
  return orientation(at(q.s), at(q.u), at(q.t)) > 0 && orientation(at(q.t), at(q.v), at(q.s)) > 0;
}

// Triangles keep their order and their first corner when others are dropped, so halfedges map by triangle.
std::vector<Quadrilateral> on_surface(std::vector<Quadrilateral> found, const Terrain& terrain) {
  if (terrain.whole() && terrain.continuous.empty()) return found;
  const std::vector<std::uint32_t> index = surface_indices(terrain.keep);
  std::vector<Quadrilateral> kept;
  for (Quadrilateral q : found) {
    const TriangleId left = Tin::triangle_of(q.diagonal);
    const TriangleId right = Tin::triangle_of(terrain.ground.twin(q.diagonal));
    if (!terrain.keep[left.index()] || !terrain.keep[right.index()]) continue;
    if (!convex_as_written(q, terrain.continuous)) continue;
    q.diagonal = Tin::halfedge(TriangleId{index[left.index()]}, q.diagonal.index() % 3);
    kept.push_back(q);
  }
  return kept;
}

// Under Std constraint edges give the constrained Delaunay triangulation an order of its own, and up to 1 no
// triangulation has a lower one: what is asked for may not exist.
std::vector<Triangle> find_of_order_1(const Terrain& terrain, const LabellingConfig& labelling,
                                      Progress& progress) {
  if (labelling.definition != OrderDefinition::Std || labelling.order > 1) return {};
  const TinOrders orders =
      find_tin_orders(terrain.ground, {.definition = OrderDefinition::Std, .mode = terrain.mode}, progress);
  if (orders.max_order > labelling.order) throw no_triangulation(terrain, labelling, progress);
  std::vector<Triangle> found;  // in order, as those of a TIN are
  for (std::size_t t = 0; t < orders.orders.size(); ++t) {
    if (orders.orders[t] == 1 && terrain.keep[t]) found.push_back(terrain.ground.triangle(TriangleId{t}));
  }
  return found;
}

void choose_first_order(Labelled& labelled, const Terrain& terrain, const RunContext& run,
                        const std::string& proof_path, Progress& progress) {
  std::optional<ProofFile> proof;
  if (!proof_path.empty()) {
    proof.emplace(proof_path, run.output.proof_path,
                  ProofSubject{labelled.delaunay, terrain.written, terrain.number, labelled.quadrilaterals,
                               run.labelling});
    labelled.options.proof = &proof->stages();
  }
  labelled.result =
      optimize_first_order(labelled.delaunay, labelled.quadrilaterals, labelled.options, progress);
  labelled.options.proof = nullptr;
  if (proof) proof->finish();
  labelled.flips.clear();
  labelled.new_diagonals.clear();
  for (std::size_t q = 0; q < labelled.quadrilaterals.size(); ++q) {
    if (labelled.result.flipped[q] == 0) continue;
    labelled.flips.push_back(labelled.quadrilaterals[q].diagonal);
    labelled.new_diagonals.push_back({labelled.quadrilaterals[q].s, labelled.quadrilaterals[q].t});
  }
}

void choose_higher_order(Labelled& labelled, const SurfaceFaces& faces, const LabellingConfig& labelling,
                         Progress& progress) {
  HigherOrderChoice choice =
      choose_triangulations(labelled.delaunay, faces, labelled.options, labelling, progress);
  labelled.result.criteria = std::move(choice.criteria);
  labelled.tin = std::move(choice.tin);
  labelled.new_diagonals = std::move(choice.new_edges);
  labelled.orders = std::move(choice.orders);
  labelled.higher_order = std::move(choice.figures);
}

/// Gives the Delaunay TIN the heights that conditioning of a triangulation of its vertices leaves.
void condition(Labelled& labelled, const Tin& triangulation, const RunContext& run, Progress& progress) {
  std::vector<VertexId> outlets;
  if (!run.outlets.empty()) {
    const TriangleGrid grid(triangulation);
    for (const Point2 place : run.outlets) {
      outlets.push_back(outlet_at(place, triangulation, grid, run.plane));
    }
  }
  ConditionedTin conditioned =
      condition_tin(triangulation, run.plane.vertical_metres_per_unit(), outlets, run.condition, progress);
  const std::span<const double> heights = conditioned.tin.heights();
  labelled.delaunay = labelled.delaunay.with_heights({heights.begin(), heights.end()});
  labelled.changes = std::move(conditioned.changes);
  labelled.conditioned = conditioned.report;
}

/// What may be chosen from. Takes the ground out of the terrain.
SurfaceFaces find_structure(Labelled& labelled, Terrain& terrain, const RunContext& run, Progress& progress) {
  labelled.of_order_1 = find_of_order_1(terrain, run.labelling, progress);
  if (run.labelling.by_faces()) {
    labelled.delaunay = keep_triangles(terrain.ground, terrain.keep);
    SurfaceFaces faces = find_surface_faces(terrain, labelled.delaunay, run.labelling, progress);
    terrain.ground = {};
    return faces;
  }
  if (run.labelling.order == 1) {
    labelled.quadrilaterals = on_surface(
        find_quadrilaterals(terrain.ground, {.definition = run.labelling.definition, .mode = terrain.mode},
                            progress),
        terrain);
    labelled.barred = labelled.quadrilaterals.size();
    bar_diagonals(terrain.ground, terrain.left_out, terrain.error_limit, labelled.quadrilaterals, progress);
    labelled.barred -= labelled.quadrilaterals.size();
  }
  labelled.delaunay = keep_triangles(std::move(terrain.ground), terrain.keep);
  return {};
}

void set_options(Labelled& labelled, const RunContext& run, Progress& progress) {
  labelled.options = {.criteria = run.labelling.criteria,
                      .horizontal_metres_per_unit = run.plane.metres_per_unit(),
                      .vertical_metres_per_unit = run.plane.vertical_metres_per_unit()};
  if (run.labelling.effort) labelled.options.effort = *run.labelling.effort;
  if (!run.labelling.reference) return;
  const ReferencePoints reference = read_reference(*run.labelling.reference, run.crs, run.plane, progress);
  labelled.reference = std::make_unique<const Reference>(reference.points, reference.heights);
  labelled.options.reference = labelled.reference.get();
}

}  // namespace

Labelled choose_diagonals(Terrain& terrain, const RunContext& run, PhaseSeconds& seconds,
                          Progress& progress) {
  Labelled labelled;
  seconds.triangulate += run.watch.lap();

  progress.start_phase("orders");
  const SurfaceFaces faces = find_structure(labelled, terrain, run, progress);
  progress.advance(1);
  seconds.orders = run.watch.lap();

  progress.start_phase("optimize");
  set_options(labelled, run, progress);
  const auto choose = [&](const std::string& proof_path) {
    if (run.labelling.by_faces()) {
      choose_higher_order(labelled, faces, run.labelling, progress);
    } else {
      choose_first_order(labelled, terrain, run, proof_path, progress);
    }
  };
  if (run.condition.changes_pits()) {
    choose({});
    const Tin chosen = run.labelling.by_faces() ? std::move(labelled.tin)
                                                : flip_edges(labelled.delaunay, labelled.flips).tin;
    condition(labelled, chosen, run, progress);
  } else if (!run.condition.steps.empty()) {
    condition(labelled, labelled.delaunay, run, progress);
  }
  choose(run.outputs.proof);
  progress.advance(1);
  seconds.optimize = run.watch.lap();
  return labelled;
}

}  // namespace thalweg
