// The constrained Delaunay triangulation, by CGAL, copied to a flat Tin.
//
// 1. Insert the points in an order that keeps successive ones close (spatial_order.hpp), each walk starting
// at
//    the triangle of the point before.
// 2. Insert the constraint edges between vertices: the triangles that an edge crosses are replaced and the
// hole
//    is made Delaunay by flips. CGAL decides cocircular ties by a symbolic perturbation of the lifted points,
//    the rule that theory and `in_circle_perturbed` share, so the outcome is unique and no order matters.
// 3. Copy the finite triangles as triples of ids.
// Based on: CGAL 5.5, package 2D Triangulations (Yvinec).
#include "spatial_order.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/delaunay/triangulate.hpp>

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <string>
#include <utility>

namespace thalweg {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Cdt =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, CGAL::No_constraint_intersection_tag>;

// A few milliseconds of work.
constexpr std::size_t kStepsBetweenChecks = 2048;

std::string describe(Point2 p) {
  return "(" + std::to_string(p.x) + ", " + std::to_string(p.y) + ")";
}

std::vector<Cdt::Vertex_handle> insert_points(Cdt& cdt, std::span<const Point2> points, Progress& progress) {
  progress.start_phase("triangulating points");
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
  progress.advance(1);
  return vertices;
}

void insert_constraints(Cdt& cdt, std::span<const Cdt::Vertex_handle> vertices,
                        std::span<const Point2> points, std::span<const ConstraintEdge> constraints,
                        Progress& progress) {
  progress.start_phase("inserting lines");
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  edges.reserve(constraints.size());
  for (const ConstraintEdge& edge : constraints) {
    edges.push_back(std::minmax(edge.a.value(), edge.b.value()));
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (i % kStepsBetweenChecks == 0) {
      progress.advance(static_cast<double>(i) / static_cast<double>(edges.size()));
    }
    const auto [a, b] = edges[i];
    try {
      cdt.insert_constraint(vertices[a], vertices[b]);
    } catch (const Cdt::Intersection_of_constraints_exception&) {
      throw Error(ErrorCode::InvalidTin, "the constraint edge from " + describe(points[a]) + " to " +
                                             describe(points[b]) + " crosses another one");
    }
  }
  progress.advance(1);
}

std::vector<Triangle> copy_triangles(const Cdt& cdt) {
  std::vector<Triangle> triangles;
  triangles.reserve(2 * cdt.number_of_vertices());
  for (auto face = cdt.finite_faces_begin(); face != cdt.finite_faces_end(); ++face) {
    triangles.push_back({VertexId{face->vertex(0)->info()}, VertexId{face->vertex(1)->info()},
                         VertexId{face->vertex(2)->info()}});
  }
  return triangles;
}

}  // namespace

Tin triangulate(std::vector<Point2> points, std::vector<double> heights,
                std::span<const ConstraintEdge> constraints, Progress& progress) {
  if (points.size() < 3) {
    throw Error(ErrorCode::TooFewPoints,
                "a triangulation needs three distinct points, there are " + std::to_string(points.size()));
  }
  std::vector<Triangle> triangles;
  {
    Cdt cdt;
    const std::vector<Cdt::Vertex_handle> vertices = insert_points(cdt, points, progress);
    if (cdt.dimension() < 2) {
      throw Error(ErrorCode::Collinear, "all " + std::to_string(points.size()) +
                                            " points lie on one line, from " + describe(points.front()) +
                                            "; a triangulation needs a point beside it");
    }
    insert_constraints(cdt, vertices, points, constraints, progress);
    triangles = copy_triangles(cdt);
  }
  return {std::move(points), std::move(heights), std::move(triangles), constraints};
}

}  // namespace thalweg
