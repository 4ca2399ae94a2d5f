// A TIN from another one: under other ids, with other diagonals, with fewer triangles. What is next to what
// is known, or changes in a few places: nothing is searched.
#include "base/parallel.hpp"
#include "base/release.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/mesh/change_tin.hpp>

#include <algorithm>
#include <string>
#include <utility>

namespace thalweg {

namespace {

constexpr std::size_t kBlock = 8192;

void check_numbers(std::span<const VertexId> number, std::size_t vertex_count) {
  std::vector<bool> seen(vertex_count, false);
  bool sound = number.size() == vertex_count;
  for (std::size_t v = 0; v < number.size() && sound; ++v) {
    sound = number[v].index() < vertex_count && !seen[number[v].index()];
    if (sound) seen[number[v].index()] = true;
  }
  if (!sound) throw Error(ErrorCode::InvalidTin, "new vertex ids must be a permutation of the old ones");
}

template <class Value>
std::vector<Value> copy(std::span<const Value> values) {
  return {values.begin(), values.end()};
}

bool any_constraint(std::span<const EdgeKind> kinds) {
  return std::ranges::any_of(kinds, [](EdgeKind kind) { return kind != EdgeKind::None; });
}

/// An edge that comes to lie elsewhere.
struct Side {
  HalfedgeId twin;
  EdgeKind kind = EdgeKind::None;
};

Side side_at(const LinkedTriangles& triangles, HalfedgeId h) {
  return {triangles.twins[h.index()], triangles.kinds[h.index()]};
}

void put_side(LinkedTriangles& triangles, HalfedgeId h, const Side& side) {
  triangles.twins[h.index()] = side.twin;
  triangles.kinds[h.index()] = side.kind;
  if (side.twin.valid()) triangles.twins[side.twin.index()] = h;
}

void flip(LinkedTriangles& triangles, HalfedgeId h) {
  const HalfedgeId other = triangles.twins[h.index()];
  const auto origin = [&](HalfedgeId g) { return triangles.corners[g.index() / 3][g.index() % 3]; };
  const VertexId a = origin(h), b = origin(other);
  const VertexId c = origin(Tin::previous(h)), d = origin(Tin::previous(other));
  const Side ca = side_at(triangles, Tin::previous(h)), ad = side_at(triangles, Tin::next(other));
  const Side db = side_at(triangles, Tin::previous(other)), bc = side_at(triangles, Tin::next(h));
  const TriangleId left = Tin::triangle_of(h), right = Tin::triangle_of(other);
  triangles.corners[left.index()] = {c, a, d};
  triangles.corners[right.index()] = {d, b, c};
  put_side(triangles, Tin::halfedge(left, 0), ca);
  put_side(triangles, Tin::halfedge(left, 1), ad);
  put_side(triangles, Tin::halfedge(right, 0), db);
  put_side(triangles, Tin::halfedge(right, 1), bc);
  put_side(triangles, Tin::halfedge(left, 2), {Tin::halfedge(right, 2)});
  triangles.kinds[Tin::halfedge(right, 2).index()] = EdgeKind::None;
}

}  // namespace

RenumberedTin renumber(Tin tin, std::span<const VertexId> number, const Progress& progress) {
  check_numbers(number, tin.vertex_count());
  release(tin.outgoing_);
  RenumberedTin result;
  Tin& renumbered = result.tin;
  renumbered.points_.resize(tin.points_.size());
  renumbered.heights_.resize(tin.points_.size());
  for_each_block(number.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      renumbered.points_[number[v].index()] = tin.points_[v];
      renumbered.heights_[number[v].index()] = tin.heights_[v];
    }
  });
  release(tin.points_);
  release(tin.heights_);
  if (!any_constraint(tin.kinds_)) release(tin.kinds_);
  const RawVector<HalfedgeId> moved = renumbered.take({.corners = std::move(tin.triangles_),
                                                       .twins = std::move(tin.twins_),
                                                       .kinds = std::move(tin.kinds_),
                                                       .number = {number.begin(), number.end()}},
                                                      progress);
  result.place.resize(moved.size());
  std::ranges::transform(moved, result.place.begin(), &Tin::triangle_of);
  return result;
}

Tin flip_edges(Tin tin, std::span<const HalfedgeId> edges) {
  for (const HalfedgeId h : edges) {
    if (!tin.on_rim(h) && !tin.constrained(h)) continue;
    throw Error(ErrorCode::InvalidTin, "edge " + std::to_string(tin.origin(h).value()) + ", " +
                                           std::to_string(tin.target(h).value()) +
                                           " cannot be flipped: it is on the rim or constrained");
  }
  release(tin.outgoing_);
  LinkedTriangles changed{.corners = std::move(tin.triangles_),
                          .twins = std::move(tin.twins_),
                          .kinds = std::move(tin.kinds_),
                          .number = {}};
  for (const HalfedgeId h : edges) flip(changed, h);
  tin.take(std::move(changed), Progress());
  return tin;
}

Tin keep_triangles(const Tin& tin, const std::vector<bool>& keep) {
  if (std::find(keep.begin(), keep.end(), false) == keep.end()) return tin;
  const TinArrays arrays = tin.arrays();
  std::vector<TriangleId> place(keep.size());
  LinkedTriangles kept;
  for (std::size_t t = 0; t < keep.size(); ++t) {
    if (!keep[t]) continue;
    place[t] = TriangleId{kept.corners.size()};
    kept.corners.push_back(arrays.triangles[t]);
  }
  kept.twins.reserve(3 * kept.corners.size());
  kept.kinds.reserve(3 * kept.corners.size());
  for (std::size_t h = 0; h < arrays.twins.size(); ++h) {
    if (!keep[h / 3]) continue;
    const HalfedgeId twin = arrays.twins[h];
    const TriangleId across = twin.valid() ? place[twin.index() / 3] : TriangleId{};
    kept.twins.push_back(across.valid() ? Tin::halfedge(across, twin.index() % 3) : HalfedgeId{});
    kept.kinds.push_back(arrays.kinds[h]);
  }
  return {copy(arrays.points), copy(arrays.heights), std::move(kept), {}, Progress()};
}

Tin keep_triangles(Tin&& tin, const std::vector<bool>& keep) {
  if (std::find(keep.begin(), keep.end(), false) == keep.end()) return std::move(tin);
  return keep_triangles(std::as_const(tin), keep);
}

}  // namespace thalweg
