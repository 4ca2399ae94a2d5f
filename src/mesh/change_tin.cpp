// A TIN from another one: under other ids, with other diagonals, with fewer triangles. What is next to what
// is known, or changes in a few places: nothing is searched.
#include "base/large_pages.hpp"
#include "base/parallel.hpp"
#include "mesh/link_triangles.hpp"

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

/// The side with halfedge h, or none.
SourceSide side_of(HalfedgeId h) {
  return {h.index() / 3, static_cast<std::uint32_t>(h.index() % 3)};
}

/// Triangles that change.
struct Changing {
  RawVector<Triangle> triangles;
  RawVector<HalfedgeId> twins;
  RawVector<EdgeKind> kinds;

  // As a source for sorting.
  [[nodiscard]] std::size_t size() const { return twins.size() / 3; }
  [[nodiscard]] bool exists(std::size_t /*t*/) const { return true; }
  [[nodiscard]] VertexId corner(std::size_t t, std::size_t i) const { return triangles[t][i]; }
  [[nodiscard]] SourceSide across(std::size_t t, std::size_t i) const { return side_of(twins[3 * t + i]); }
  [[nodiscard]] EdgeKind kind(std::size_t t, std::size_t i) const { return kinds[3 * t + i]; }
  void forget(std::size_t begin) {
    discard_pages(std::span(triangles).subspan(begin));
    discard_pages(std::span(twins).subspan(3 * begin));
    discard_pages(std::span(kinds).subspan(3 * begin));
  }
};

/// The triangles of a TIN for which `keep` is true, as a source for sorting.
struct Kept {
  const Tin& tin;
  const std::vector<bool>& keep;
  [[nodiscard]] std::size_t size() const { return tin.triangle_count(); }
  [[nodiscard]] bool exists(std::size_t t) const { return keep[t]; }
  [[nodiscard]] VertexId corner(std::size_t t, std::size_t i) const { return tin.triangle(TriangleId{t})[i]; }
  [[nodiscard]] SourceSide across(std::size_t t, std::size_t i) const {
    return side_of(tin.twin(HalfedgeId{3 * t + i}));
  }
  [[nodiscard]] EdgeKind kind(std::size_t t, std::size_t i) const { return tin.kind(HalfedgeId{3 * t + i}); }
};

/// An edge that comes to lie elsewhere.
struct Side {
  HalfedgeId twin;
  EdgeKind kind = EdgeKind::None;
};

Side side_at(const Changing& triangles, HalfedgeId h) {
  return {triangles.twins[h.index()], triangles.kinds[h.index()]};
}

void put_side(Changing& triangles, HalfedgeId h, const Side& side) {
  triangles.twins[h.index()] = side.twin;
  triangles.kinds[h.index()] = side.kind;
  if (side.twin.valid()) triangles.twins[side.twin.index()] = h;
}

void flip(Changing& triangles, HalfedgeId h) {
  const HalfedgeId other = triangles.twins[h.index()];
  const auto origin = [&](HalfedgeId g) { return triangles.triangles[g.index() / 3][g.index() % 3]; };
  const VertexId a = origin(h), b = origin(other);
  const VertexId c = origin(Tin::previous(h)), d = origin(Tin::previous(other));
  const Side ca = side_at(triangles, Tin::previous(h)), ad = side_at(triangles, Tin::next(other));
  const Side db = side_at(triangles, Tin::previous(other)), bc = side_at(triangles, Tin::next(h));
  const TriangleId left = Tin::triangle_of(h), right = Tin::triangle_of(other);
  triangles.triangles[left.index()] = {c, a, d};
  triangles.triangles[right.index()] = {d, b, c};
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
  RenumberedTin result;
  std::vector<Point2> points(tin.points_.size());
  std::vector<double> heights(tin.points_.size());
  for_each_block(number.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      points[number[v].index()] = tin.points_[v];
      heights[number[v].index()] = tin.heights_[v];
    }
  });
  Changing given{std::move(tin.triangles_), std::move(tin.twins_), std::move(tin.kinds_)};
  tin = {};
  const TriangleOrder sorted = sort_triangles(given, number, number.size(), progress);
  result.tin = {std::move(points), std::move(heights), link_triangles(given, sorted, number, progress)};
  result.place.resize(sorted.moved.size());
  for_each_block(result.place.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) result.place[t] = TriangleId{sorted.moved[t].index()};
  });
  return result;
}

FlippedTin flip_edges(Tin tin, std::span<const HalfedgeId> edges) {
  for (const HalfedgeId h : edges) {
    if (!tin.on_rim(h) && !tin.constrained(h)) continue;
    throw Error(ErrorCode::InvalidTin, "edge " + std::to_string(tin.origin(h).value()) + ", " +
                                           std::to_string(tin.target(h).value()) +
                                           " cannot be flipped: it is on the rim or constrained");
  }
  Changing changed{std::move(tin.triangles_), std::move(tin.twins_), std::move(tin.kinds_)};
  for (const HalfedgeId h : edges) flip(changed, h);
  const TriangleOrder sorted = sort_triangles(changed, {}, tin.vertex_count(), Progress());
  FlippedTin flipped{.tin = {std::move(tin.points_), std::move(tin.heights_),
                             link_triangles(changed, sorted, {}, Progress())},
                     .diagonals = {edges.begin(), edges.end()}};
  for (HalfedgeId& h : flipped.diagonals) h = sorted.moved[Tin::triangle_of(h).index()].halfedge(2);
  return flipped;
}

Tin keep_triangles(const Tin& tin, const std::vector<bool>& keep) {
  if (std::find(keep.begin(), keep.end(), false) == keep.end()) return tin;
  const Kept kept{tin, keep};
  const TriangleOrder sorted = sort_triangles(kept, {}, tin.vertex_count(), Progress());
  return {copy(tin.points()), copy(tin.heights()), link_triangles(kept, sorted, {}, Progress())};
}

Tin keep_triangles(Tin&& tin, const std::vector<bool>& keep) {
  if (std::find(keep.begin(), keep.end(), false) == keep.end()) return std::move(tin);
  return keep_triangles(std::as_const(tin), keep);
}

}  // namespace thalweg
