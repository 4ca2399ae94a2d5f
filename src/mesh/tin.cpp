// The flat TIN.
//
// 1. Triangles are sorted (sort_triangles.cpp).
// 2. Halfedges are bucketed by their origin: a vertex' fan. Large fans are sorted by target and bisected, so
//    that a hub of many triangles costs no more than other vertices.
// 3. Where neighbours are not known, the twin of a -> b is looked up in the fan of a.
#include "base/parallel.hpp"
#include "base/release.hpp"
#include "sort_triangles.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/mesh/tin.hpp>

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
  triangles_ = sort_triangles(triangles, {}, points_.size(), Progress()).triangles;
  release(triangles);
  list_fans(Progress());
  link_halfedges();
  kinds_.assign(halfedge_count(), EdgeKind::None);
  mark_constraints(constraints);
}

Tin::Tin(std::vector<Point2> points, std::vector<double> heights, LinkedTriangles linked,
         std::span<const ConstraintEdge> constraints, const Progress& progress)
    : points_(std::move(points)), heights_(std::move(heights)) {
  check_heights(heights_, points_);
  take(std::move(linked), progress);
  mark_constraints(constraints);
}

RawVector<HalfedgeId> Tin::take(LinkedTriangles linked, const Progress& progress) {
  SortedTriangles sorted = sort_triangles(linked.corners, linked.number, points_.size(), progress);
  triangles_ = std::move(sorted.triangles);
  release(linked.corners);
  release(linked.number);
  twins_.resize(halfedge_count());
  kinds_.resize(halfedge_count());
  if (linked.kinds.empty()) std::ranges::fill(kinds_, EdgeKind::None);
  std::atomic<std::size_t> rim = 0;
  for_each_block(triangles_.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    std::size_t on_rim = 0;
    for (std::size_t given = 3 * begin; given < 3 * end; ++given) {
      const HalfedgeId twin = linked.twins[given];
      const std::size_t h = sorted.now(HalfedgeId{given}).index();
      twins_[h] = twin.valid() ? sorted.now(twin) : HalfedgeId{};
      on_rim += twin.valid() ? 0 : 1;
      if (!linked.kinds.empty()) kinds_[h] = linked.kinds[given];
    }
    rim += on_rim;
  });
  edge_count_ = (halfedge_count() + rim) / 2;
  linked = {};
  list_fans(progress);
  return std::move(sorted.moved);
}

void Tin::list_fans(const Progress& progress) {
  first_outgoing_.assign(points_.size() + 1, 0);
  outgoing_.resize(halfedge_count());
  const auto for_each_halfedge = [&](const auto& body) {
    for_each_range(points_.size(), progress, [&](std::size_t begin, std::size_t end) {
      const VertexId low{begin}, high{end};
      for (std::size_t t = 0; t < triangles_.size(); ++t) {
        for (std::size_t side = 0; side < 3; ++side) {
          const VertexId v = triangles_[t][side];
          if (v >= low && v < high) body(v, 3 * t + side);
        }
      }
    });
  };
  for_each_halfedge([&](VertexId v, std::size_t) { ++first_outgoing_[v.index() + 1]; });
  for (std::size_t v = 0; v < points_.size(); ++v) first_outgoing_[v + 1] += first_outgoing_[v];
  std::vector<std::uint32_t> fill(first_outgoing_.begin(), first_outgoing_.end() - 1);
  for_each_halfedge([&](VertexId v, std::size_t h) { outgoing_[fill[v.index()]++] = HalfedgeId{h}; });
  for_each_block(points_.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const std::span<HalfedgeId> fan(outgoing_.begin() + first_outgoing_[v],
                                      outgoing_.begin() + first_outgoing_[v + 1]);
      if (fan.size() <= kFewEdges) continue;
      std::sort(fan.begin(), fan.end(), [&](HalfedgeId g, HalfedgeId h) {
        return std::pair(target(g), g) < std::pair(target(h), h);
      });
    }
  });
}

void Tin::link_halfedges() {
  // The triangles around a vertex hold all halfedges that leave it and all that reach it, so a small fan
  // finds its own twins without a look at others.
  twins_.resize(halfedge_count());
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

std::vector<bool> Tin::rim_vertices() const {
  std::vector<bool> rim(vertex_count(), false);
  for (std::size_t v = 0; v < vertex_count(); ++v) rim[v] = outgoing(VertexId{v}).empty();
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
