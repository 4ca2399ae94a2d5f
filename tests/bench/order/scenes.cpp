#include "scenes.hpp"

#include <thalweg/delaunay/triangulate.hpp>
#include <thalweg/geometry/predicates.hpp>

#include <cmath>
#include <map>
#include <random>
#include <utility>
#include <vector>

namespace thalweg::bench {

namespace {

struct Builder {
  std::vector<Point2> points;
  std::vector<ConstraintEdge> edges;
  std::mt19937_64 engine{20261122};

  double real(double high) { return high * (static_cast<double>(engine() >> 11) * 0x1p-53); }
  VertexId add(double x, double y) {
    points.push_back({x, y});
    return VertexId{points.size() - 1};
  }
  void connect(VertexId a, VertexId b) { edges.push_back({a, b, EdgeKind::Breakline}); }
};

Tin triangulated(const Builder& builder) {
  Progress progress;
  return triangulate(builder.points, std::vector<double>(builder.points.size(), 0.0), builder.edges,
                     progress);
}

// Constraint edges taken from the triangulation of the points alone: they would be there anyway where they
// are chosen; every second chosen edge is replaced by the other diagonal where that is possible.
void constrain_share(Builder& builder, double share) {
  const Tin tin = triangulated(builder);
  std::vector<bool> taken(tin.triangle_count(), false);
  for (std::size_t i = 0; i < tin.halfedge_count(); ++i) {
    const HalfedgeId h{i};
    if (!tin.represents_edge(h) || tin.on_rim(h) || builder.real(1) >= share) continue;
    const HalfedgeId twin = tin.twin(h);
    const std::size_t left = Tin::triangle_of(h).index();
    const std::size_t right = Tin::triangle_of(twin).index();
    if (taken[left] || taken[right]) continue;
    const Point2 s = tin.point(tin.apex(h)), t = tin.point(tin.apex(twin));
    const bool convex = cross_properly(s, t, tin.point(tin.origin(h)), tin.point(tin.target(h)));
    taken[left] = taken[right] = true;
    if (convex && builder.real(1) < 0.5) {
      builder.connect(tin.apex(h), tin.apex(twin));
    } else {
      builder.connect(tin.origin(h), tin.target(h));
    }
  }
}

void scatter(Builder& builder, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const double x = builder.real(1000);
    builder.add(x, builder.real(1000));
  }
}

Tin lattice(std::size_t points) {
  Builder builder;
  const auto side = static_cast<std::size_t>(std::sqrt(static_cast<double>(points)));
  for (std::size_t y = 0; y < side; ++y) {
    for (std::size_t x = 0; x < side; ++x) {
      builder.add(30 * static_cast<double>(x) + 500000, 30 * static_cast<double>(y) + 4000000);
    }
  }
  return triangulated(builder);
}

// A line every 20 of 1000 units, swinging, with a vertex every mean spacing of the points.
Tin polylines(std::size_t points) {
  Builder builder;
  scatter(builder, points);
  const double step = 1000 / std::sqrt(static_cast<double>(points));
  for (double base = 10; base < 1000; base += 20) {
    VertexId last;
    for (double x = 0; x < 1000; x += step) {
      const VertexId here = builder.add(x, base + 8 * std::sin(x / 17 + base));
      if (last.valid()) builder.connect(last, here);
      last = here;
    }
  }
  return triangulated(builder);
}

// Teeth: parallel constraint edges, each half of the width long, thousands of them; points between.
Tin comb(std::size_t points) {
  Builder builder;
  const std::size_t teeth = points / 20;
  for (std::size_t i = 0; i < teeth; ++i) {
    const double y = 1000 * (static_cast<double>(i) + 0.5) / static_cast<double>(teeth);
    const double start = builder.real(400);
    const VertexId left = builder.add(start, y);
    builder.connect(left, builder.add(start + 500, y));
  }
  scatter(builder, points - 2 * teeth);
  return triangulated(builder);
}

Tin make(Scene scene, std::size_t points) {
  Builder builder;
  switch (scene) {
    case Scene::Lattice:
      return lattice(points);
    case Scene::Polylines:
      return polylines(points);
    case Scene::Comb:
      return comb(points);
    case Scene::Random:
    case Scene::Random5:
    case Scene::Random20:
      break;
  }
  scatter(builder, points);
  if (scene == Scene::Random5) constrain_share(builder, 0.05);
  if (scene == Scene::Random20) constrain_share(builder, 0.2);
  return triangulated(builder);
}

}  // namespace

const Tin& ground(Scene scene, std::size_t points) {
  static std::map<std::pair<Scene, std::size_t>, Tin> made;
  const auto key = std::pair(scene, points);
  const auto found = made.find(key);
  return found != made.end() ? found->second : made.emplace(key, make(scene, points)).first->second;
}

}  // namespace thalweg::bench
