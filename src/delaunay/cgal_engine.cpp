// The constrained Delaunay triangulation by CGAL, a second implementation of the same promise.
//
// 1. Insert the points in an order that keeps successive ones close (spatial_order.hpp), each walk starting
//    at the triangle of the point before.
// 2. Insert the constraint edges between vertices: the triangles that an edge crosses are replaced and the
//    hole is made Delaunay by flips. CGAL decides cocircular ties by a symbolic perturbation of the lifted
//    points, the rule that `in_circle_perturbed` shares, so the outcome is unique and no order matters.
// Based on: CGAL 5.5, package 2D Triangulations (Yvinec).
#include "engine.hpp"
#include "spatial_order.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>

namespace thalweg::detail {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Cdt =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, CGAL::No_constraint_intersection_tag>;

// A few milliseconds of work.
constexpr std::size_t kStepsBetweenChecks = 2048;

/// Indices of the points round by round, each along a Hilbert curve.
std::vector<std::uint32_t> insertion_order(std::span<const Point2> points, const Progress& progress) {
  const std::vector<std::uint32_t> order = hilbert_order(points, progress);
  const auto count = static_cast<std::uint32_t>(order.size());
  std::vector<std::uint32_t> rounds = in_rounds(count, [](std::uint32_t) { return true; });
  for (std::uint32_t& i : rounds) i = order[i];
  return rounds;
}

std::vector<Cdt::Vertex_handle> insert_points(Cdt& cdt, std::span<const Point2> points, Progress& progress) {
  const std::vector<std::uint32_t> order = insertion_order(points, progress);
  std::vector<Cdt::Vertex_handle> vertices(points.size());
  Cdt::Face_handle hint;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i % kStepsBetweenChecks == 0) {
      progress.advance(static_cast<double>(i) / static_cast<double>(order.size()));
    }
    const Point2 p = points[order[i]];
    const Cdt::Vertex_handle v = cdt.insert({p.x, p.y}, hint);
    v->info() = order[i];
    vertices[order[i]] = v;
    hint = v->face();
  }
  return vertices;
}

}  // namespace

Triangulated triangulate_by_cgal(std::span<const Point2> points, std::span<const DrawnEdge> edges,
                                 Progress& progress) {
  Triangulated result;
  Cdt cdt;
  const std::vector<Cdt::Vertex_handle> vertices = insert_points(cdt, points, progress);
  if (cdt.dimension() < 2) return result;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (i % kStepsBetweenChecks == 0) progress.check();
    try {
      cdt.insert_constraint(vertices[edges[i].ends.first], vertices[edges[i].ends.second]);
    } catch (const Cdt::Intersection_of_constraints_exception&) {
      result.crossing = edges[i].ends;
      return result;
    }
  }
  result.plain.reserve(2 * points.size());
  for (auto face = cdt.finite_faces_begin(); face != cdt.finite_faces_end(); ++face) {
    result.plain.push_back({VertexId{face->vertex(0)->info()}, VertexId{face->vertex(1)->info()},
                            VertexId{face->vertex(2)->info()}});
  }
  return result;
}

}  // namespace thalweg::detail
