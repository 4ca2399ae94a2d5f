#include "bench/delaunay/inputs.hpp"

#include "bench/fractal_terrain.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Spatial_sort_traits_adapter_2.h>
#include <CGAL/property_map.h>
#include <CGAL/spatial_sort.h>
#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <fstream>
#include <optional>
#include <random>
#include <string>
#include <utility>

namespace thalweg::bench {
namespace {

void add_lines(Survey& survey, double side) {
  const auto& xy = survey.points.xy;
  const double scale = std::min(1.0, std::sqrt(static_cast<double>(xy.size()) / 1e6));
  const auto columns = static_cast<std::size_t>(std::ceil(250 * scale));
  const auto rows = static_cast<std::size_t>(std::ceil(200 * scale));
  std::vector<std::optional<std::pair<std::size_t, std::size_t>>> ends(columns * rows);
  for (std::size_t i = 0; i < xy.size(); ++i) {
    const auto along = [side](double value, std::size_t cells) {
      return std::min(cells - 1, static_cast<std::size_t>(value / side * static_cast<double>(cells)));
    };
    auto& cell = ends[along(xy[i].y, rows) * columns + along(xy[i].x, columns)];
    if (!cell) cell.emplace(i, i);
    if (xy[i].x < xy[cell->first].x) cell->first = i;
    if (xy[i].x > xy[cell->second].x) cell->second = i;
  }
  const auto& z = survey.points.z;
  for (const auto& cell : ends) {
    if (!cell || cell->first == cell->second) continue;
    const auto [a, b] = *cell;
    survey.lines.push_back({.kind = EdgeKind::Breakline,
                            .xy = {xy[a], xy[b]},
                            .z = {z[a], z[b]},
                            .source = 0,
                            .feature = static_cast<std::int64_t>(survey.lines.size()),
                            .part = 0});
  }
}

/// A line of /proc/self/status, in bytes.
double status_bytes(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with(key)) return 1024 * std::stod(line.substr(key.size() + 1));
  }
  return 0;
}

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<Kernel>;

Seconds seconds_of_cgal_points(const Survey& survey) {
  std::vector<Kernel::Point_2> points;
  points.reserve(survey.points.xy.size());
  for (const Point2 p : survey.points.xy) points.emplace_back(p.x, p.y);
  const Seconds start = Seconds::now();
  Triangulation cdt;
  cdt.insert(points.begin(), points.end());
  const Seconds seconds = Seconds::now() - start;
  return cdt.number_of_vertices() == 0 ? Seconds{} : seconds;
}

/// As inserting a range does it, but each vertex is kept for the edges: finding it again would cost more.
Seconds seconds_of_cgal_edges(const Survey& survey, const std::vector<ConstraintEdge>& edges) {
  using Numbered = std::pair<Kernel::Point_2, std::uint32_t>;
  std::vector<Numbered> points;
  points.reserve(survey.points.xy.size());
  for (const Point2 p : survey.points.xy) {
    points.emplace_back(Kernel::Point_2(p.x, p.y), static_cast<std::uint32_t>(points.size()));
  }
  const Seconds start = Seconds::now();
  Triangulation cdt;
  using Traits = CGAL::Spatial_sort_traits_adapter_2<Kernel, CGAL::First_of_pair_property_map<Numbered>>;
  CGAL::spatial_sort(points.begin(), points.end(), Traits());
  std::vector<Triangulation::Vertex_handle> vertices(points.size());
  Triangulation::Face_handle hint;
  for (const auto& [point, number] : points) {
    const auto vertex = cdt.insert(point, hint);
    hint = vertex->face();
    vertices[number] = vertex;
  }
  for (const ConstraintEdge& edge : edges) {
    cdt.insert_constraint(vertices[edge.a.index()], vertices[edge.b.index()]);
  }
  const Seconds seconds = Seconds::now() - start;
  return cdt.number_of_vertices() == 0 ? Seconds{} : seconds;
}

}  // namespace

Survey make_survey(InputKind kind, std::size_t points) {
  const Pattern pattern = kind == InputKind::Lattice    ? Pattern::Lattice
                          : kind == InputKind::Jittered ? Pattern::Jittered
                                                        : Pattern::Random;
  TerrainPoints terrain = fractal_terrain(pattern, points);
  Survey survey;
  survey.sources = {{"points", ""}};
  survey.points.runs = {{0, 0}};
  survey.points.xy = std::move(terrain.xy);
  survey.points.z = std::move(terrain.z);
  if (kind == InputKind::Lattice) {
    for (Point2& p : survey.points.xy) p = {500000 + p.x, 5200000 + p.y};
  }
  if (kind == InputKind::Lines) add_lines(survey, kSpacing * std::round(std::sqrt(points)));
  return survey;
}

std::vector<ConstraintEdge> line_edges(const Survey& survey) {
  const auto& xy = survey.points.xy;
  std::vector<std::uint32_t> order(xy.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::uint32_t>(i);
  if (!survey.lines.empty()) {
    std::ranges::sort(order, {}, [&xy](std::uint32_t i) { return std::pair(xy[i].x, xy[i].y); });
  }
  const auto find = [&](Point2 p) {
    const auto it = std::ranges::lower_bound(order, std::pair(p.x, p.y), {},
                                             [&xy](std::uint32_t i) { return std::pair(xy[i].x, xy[i].y); });
    return VertexId{*it};
  };
  std::vector<ConstraintEdge> edges;
  for (const SurveyLine& line : survey.lines) {
    edges.push_back({.a = find(line.xy[0]), .b = find(line.xy[1]), .kind = line.kind});
  }
  return edges;
}

Seconds seconds_of_cgal(const Survey& survey, const std::vector<ConstraintEdge>& edges) {
  return edges.empty() ? seconds_of_cgal_points(survey) : seconds_of_cgal_edges(survey, edges);
}

double start_peak() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";
  return status_bytes("VmRSS");
}

double peak_bytes() {
  return status_bytes("VmHWM");
}

}  // namespace thalweg::bench
