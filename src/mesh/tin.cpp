// The flat TIN.
//
// 1. Triangles are sorted (sort_triangles.hpp).
// 2. Where fans are asked for, halfedges are bucketed by their origin. Large fans are sorted by target and
//    bisected, so that a hub of many triangles costs no more than other vertices.
// 3. Where neighbours are not known, the twin of a -> b is looked up in the fan of a.
#include "base/parallel.hpp"
#include "base/release.hpp"
#include "mesh/link_triangles.hpp"
#include "mesh/used_vertices.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/mesh/tin.hpp>

#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <numeric>
#include <span>
#include <string>
#include <utility>

namespace thalweg {

namespace {

// Up to here reading on beats bisection.
constexpr std::size_t kFewEdges = 32;
// Vertices that a thread takes at once.
constexpr std::size_t kBlock = 8192;

std::string describe(const Triangle& t) {
  return std::to_string(t[0].value()) + ", " + std::to_string(t[1].value()) + ", " +
         std::to_string(t[2].value());
}

void check_corners(const Triangle& t, std::size_t vertex_count) {
  for (const VertexId v : t) {
    if (v.index() < vertex_count) continue;
    throw Error(ErrorCode::InvalidTin, "triangle " + describe(t) + " names a vertex that does not exist");
  }
  if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) {
    throw Error(ErrorCode::InvalidTin, "triangle " + describe(t) + " repeats a vertex");
  }
}

/// Triangles to be sorted, and no more.
struct PlainTriangles {
  std::span<const Triangle> triangles;
  [[nodiscard]] std::size_t size() const { return triangles.size(); }
  [[nodiscard]] bool exists(std::size_t /*t*/) const { return true; }
  [[nodiscard]] VertexId corner(std::size_t t, std::size_t i) const { return triangles[t][i]; }
};

void check_heights(std::span<const double> heights, std::span<const Point2> points) {
  if (heights.size() == points.size()) return;
  throw Error(ErrorCode::InvalidTin, "a TIN needs as many heights as points");
}

}  // namespace

Tin::Tin(std::vector<Point2> points, std::vector<double> heights, std::vector<Triangle> triangles,
         std::span<const ConstraintEdge> constraints)
    : points_(std::move(points)), heights_(std::move(heights)) {
  check_heights(heights_, points_);
  for (const Triangle& t : triangles) check_corners(t, points_.size());
  const PlainTriangles given{triangles};
  triangles_ = place_triangles(given, sort_triangles(given, {}, points_.size(), Progress()), {}, Progress());
  release(triangles);
  link_halfedges();
  kinds_.assign(halfedge_count(), EdgeKind::None);
  mark_constraints(constraints);
}

Tin::Tin(std::vector<Point2> points, std::vector<double> heights, LinkedTriangles triangles)
    : points_(std::move(points)),
      heights_(std::move(heights)),
      triangles_(std::move(triangles.corners)),
      twins_(std::move(triangles.twins)),
      kinds_(std::move(triangles.kinds)),
      edge_count_(triangles.edge_count) {
  check_heights(heights_, points_);
}

Tin::Fans Tin::list_fans() const {
  Fans fans{.first = std::vector<std::uint32_t>(points_.size() + 1, 0),
            .outgoing = RawVector<HalfedgeId>(halfedge_count())};
  const auto for_each_halfedge = [&](const auto& body) {
    for_each_range(points_.size(), Progress(), [&](std::size_t begin, std::size_t end) {
      const VertexId low{begin}, high{end};
      for (std::size_t t = 0; t < triangles_.size(); ++t) {
        for (std::size_t side = 0; side < 3; ++side) {
          const VertexId v = triangles_[t][side];
          if (v >= low && v < high) body(v, 3 * t + side);
        }
      }
    });
  };
  const auto list = [&] {
    for_each_halfedge([&](VertexId v, std::size_t) { ++fans.first[v.index() + 1]; });
    std::partial_sum(fans.first.begin(), fans.first.end(), fans.first.begin());
    std::vector<std::uint32_t> fill(fans.first.begin(), fans.first.end() - 1);
    for_each_halfedge([&](VertexId v, std::size_t h) { fans.outgoing[fill[v.index()]++] = HalfedgeId{h}; });
    for_each_block(points_.size(), kBlock, Progress(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        const auto from = fans.outgoing.begin() + fans.first[v],
                   to = fans.outgoing.begin() + fans.first[v + 1];
        if (static_cast<std::size_t>(to - from) <= kFewEdges) continue;
        std::sort(from, to, [&](HalfedgeId g, HalfedgeId h) {
          return std::pair(target(g), g) < std::pair(target(h), h);
        });
      }
    });
  };
  tbb::this_task_arena::isolate(list);  // a thread that waits here must not ask for fans again
  return fans;
}

void Tin::link_halfedges() {
  // The triangles around a vertex hold all halfedges that leave it and all that reach it, so a small fan
  // finds its own twins without a look at others.
  twins_.resize(halfedge_count());
  fans();  // on all threads, before they ask for it
  std::atomic<std::size_t> rim = 0;
  std::atomic<std::uint32_t> repeated = HalfedgeId::kInvalid;  // the smallest one, whatever thread finds it
  const auto report_repeated = [&](HalfedgeId h) {
    std::uint32_t least = repeated;
    while (h.value() < least && !repeated.compare_exchange_weak(least, h.value())) {
    }
  };
  const auto link_small_fan = [&](std::span<const HalfedgeId> fan) {
    std::array<VertexId, kFewEdges> targets;
    std::array<VertexId, kFewEdges> apexes;
    for (std::size_t i = 0; i < fan.size(); ++i) {
      targets[i] = target(fan[i]);
      apexes[i] = apex(fan[i]);
    }
    for (std::size_t i = 0; i < fan.size(); ++i) {
      HalfedgeId twin;
      for (std::size_t j = 0; j < fan.size(); ++j) {
        if (apexes[j] == targets[i]) twin = previous(fan[j]);
        if (j < i && targets[j] == targets[i]) report_repeated(fan[i]);
      }
      twins_[fan[i].index()] = twin;
    }
  };
  const auto link_large_fan = [&](VertexId v) {
    for (const HalfedgeId h : outgoing(v)) {
      if (find_halfedge(v, target(h)) != h) report_repeated(h);
      twins_[h.index()] = find_halfedge(target(h), v);
    }
  };
  for_each_block(points_.size(), kBlock, Progress(), [&](std::size_t begin, std::size_t end) {
    std::size_t on_rim = 0;
    for (std::size_t v = begin; v < end; ++v) {
      const std::span<const HalfedgeId> fan = outgoing(VertexId{v});
      if (fan.size() <= kFewEdges) {
        link_small_fan(fan);
      } else {
        link_large_fan(VertexId{v});
      }
      for (const HalfedgeId h : fan) on_rim += twins_[h.index()].valid() ? 0 : 1;
    }
    rim += on_rim;
  });
  if (repeated != HalfedgeId::kInvalid) {
    const HalfedgeId bad{repeated.load()};
    throw Error(ErrorCode::InvalidTin, "two triangles lie on the same side of edge " +
                                           std::to_string(origin(bad).value()) + ", " +
                                           std::to_string(target(bad).value()));
  }
  edge_count_ = (halfedge_count() + rim) / 2;
}

void Tin::mark_constraints(std::span<const ConstraintEdge> constraints) {
  for (const ConstraintEdge& edge : constraints) {
    bool found = false;
    for (const auto& [from, to] : {std::pair(edge.a, edge.b), std::pair(edge.b, edge.a)}) {
      const HalfedgeId h = from.index() < points_.size() ? find_halfedge(from, to) : HalfedgeId{};
      if (!h.valid()) continue;
      kinds_[h.index()] = kinds_[h.index()] | edge.kind;
      found = true;
    }
    if (!found) {
      throw Error(ErrorCode::InvalidTin, "constraint edge " + std::to_string(edge.a.value()) + ", " +
                                             std::to_string(edge.b.value()) + " is no edge of a triangle");
    }
  }
}

HalfedgeId Tin::find_halfedge(VertexId a, VertexId b) const {
  const std::span<const HalfedgeId> fan = outgoing(a);
  const auto at = fan.size() <= kFewEdges
                      ? std::find_if(fan.begin(), fan.end(), [&](HalfedgeId h) { return target(h) == b; })
                      : std::lower_bound(fan.begin(), fan.end(), b,
                                         [&](HalfedgeId h, VertexId v) { return target(h) < v; });
  return at != fan.end() && target(*at) == b ? *at : HalfedgeId{};
}

std::vector<std::uint8_t> used_vertices(std::span<const Triangle> triangles, std::size_t vertex_count) {
  std::vector<std::uint8_t> used(vertex_count, 0);
  for_each_block(triangles.size(), kBlock, Progress(), [&](std::size_t begin, std::size_t end) {
    for (const Triangle& triangle : triangles.subspan(begin, end - begin)) {
      for (const VertexId v : triangle) std::atomic_ref(used[v.index()]).store(1, std::memory_order_relaxed);
    }
  });
  return used;
}

std::vector<std::uint8_t> Tin::vertices_in_triangles() const {
  return used_vertices(triangles_, vertex_count());
}

std::vector<bool> Tin::rim_vertices() const {
  std::vector<bool> rim(vertex_count(), true);
  for (const Triangle& triangle : triangles_) {
    for (const VertexId v : triangle) rim[v.index()] = false;
  }
  for (std::size_t i = 0; i < halfedge_count(); ++i) {
    const HalfedgeId h{i};
    if (!on_rim(h)) continue;
    rim[origin(h).index()] = true;
    rim[target(h).index()] = true;
  }
  return rim;
}

std::vector<ConstraintEdge> Tin::constraint_edges() const {
  // Most stretches have none, and are passed over without a look at each.
  constexpr std::size_t kStretch = 64;
  std::vector<ConstraintEdge> edges;
  for (std::size_t begin = 0; begin < kinds_.size(); begin += kStretch) {
    const std::size_t end = std::min(begin + kStretch, kinds_.size());
    const auto any = std::accumulate(kinds_.begin() + begin, kinds_.begin() + end, EdgeKind::None,
                                     [](EdgeKind a, EdgeKind b) { return a | b; });
    for (std::size_t i = begin; i < end && any != EdgeKind::None; ++i) {
      const HalfedgeId h{i};
      if (!constrained(h) || !represents_edge(h)) continue;
      const auto [low, high] = std::minmax({origin(h), target(h)});
      edges.push_back({low, high, kind(h)});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const ConstraintEdge& a, const ConstraintEdge& b) {
    return std::pair(a.a, a.b) < std::pair(b.a, b.b);
  });
  return edges;
}

Tin Tin::with_heights(std::vector<double> heights) const {
  check_heights(heights, points_);
  Tin tin = *this;
  tin.heights_ = std::move(heights);
  return tin;
}

}  // namespace thalweg
