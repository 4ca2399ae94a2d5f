#pragma once

/// The terms of many edges, computed together.

#include "optimize/declaration.hpp"
#include "optimize/labelled_faces.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <type_traits>
#include <vector>

namespace thalweg {

/// A vector that keeps its elements when emptied, and has room before it is filled.
template <class T>
class Pile {
 public:
  /// Empties it. Pre of `add`: no more than `most` are added.
  void clear(std::size_t most) {
    if (storage_.size() < most) storage_.resize(most);
    size_ = 0;
  }
  std::uint32_t add(const T& value) {
    storage_[size_] = value;
    return static_cast<std::uint32_t>(size_++);
  }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::span<T> all() { return std::span(storage_).first(size_); }

 private:
  std::vector<T> storage_;
  std::size_t size_ = 0;
};

/// The edges of a block of quadrilaterals, or of triangles. Each quadrilateral's four triangles are made
/// once, and values are computed in one go. A body is what a term sees of a triangle: all of it, or its
/// normal. One batch serves block after block.
template <class Body>
class EdgeBatch {
 public:
  EdgeBatch(const LabelledFaces& faces, const Declaration& declaration, std::span<const std::uint32_t> first)
      : faces_(faces), declaration_(declaration), first_(first) {}

  /// The edges that a label of the quadrilaterals decides; those to an earlier one are left to its block.
  template <class Block>
  void pass_quadrilaterals(std::uint32_t begin, std::uint32_t end, Block& block);
  /// The edges that no label decides and that the triangles represent.
  template <class Block>
  void pass_triangles(std::size_t begin, std::size_t end, Block& block);

 private:
  std::uint32_t add(HalfedgeId h) { return triangles_.add(faces_.tin.triangle(Tin::triangle_of(h))); }
  std::uint32_t add_flipped(std::uint32_t q, bool at_s_u) {
    const auto& [s, u, t, v, diagonal] = faces_.quadrilaterals[q];
    return triangles_.add(at_s_u ? Triangle{s, u, t} : Triangle{t, v, s});
  }
  [[nodiscard]] bool here(std::uint32_t q) const { return q >= begin_ && q < end_; }
  void list_edges(std::uint32_t q);
  void list_pair(std::uint32_t q, std::uint32_t p, HalfedgeId outer, std::uint32_t q_slot, BodyPair of_q);
  void weigh();

  const LabelledFaces& faces_;
  const Declaration& declaration_;
  std::span<const std::uint32_t> first_;
  std::uint32_t begin_ = 0, end_ = 0;
  Pile<Triangle> triangles_;
  Pile<Neighbours> edges_;  ///< p is kNone if only q decides
  Pile<BodyPair> sides_;    ///< for each edge, the triangles of its two or four values
  std::vector<Body> bodies_;
  std::vector<double> value_;
};

template <class Body>
template <class Block>
void EdgeBatch<Body>::pass_quadrilaterals(std::uint32_t begin, std::uint32_t end, Block& block) {
  begin_ = begin, end_ = end;
  const std::size_t count = end - begin;
  triangles_.clear(12 * count);
  edges_.clear(5 * count);
  sides_.clear(18 * count);
  for (std::uint32_t q = begin; q < end; ++q) {
    const HalfedgeId uv = faces_.quadrilaterals[q].diagonal;
    add(uv);
    add(faces_.tin.twin(uv));
    add_flipped(q, true);
    add_flipped(q, false);
  }
  for (std::uint32_t q = begin; q < end; ++q) list_edges(q);
  weigh();
  const double* f = value_.data();
  for (const Neighbours& at : edges_.all()) {
    if (at.p == kNone) {
      block.single(at.q, std::array{f[0]}, std::array{f[1]});
      f += 2;
    } else {
      block.pair(at, PairValues{f[0], f[1], f[2], f[3]});
      f += 4;
    }
  }
}

template <class Body>
template <class Block>
void EdgeBatch<Body>::pass_triangles(std::size_t begin, std::size_t end, Block& block) {
  triangles_.clear(4 * (end - begin));
  sides_.clear(3 * (end - begin));
  for (std::size_t t = begin; t < end; ++t) {
    if (faces_.owner[t] != kNone) continue;
    const std::uint32_t own = add(Tin::halfedge(TriangleId{t}, 0));
    for (std::size_t i = 0; i < 3; ++i) {
      const HalfedgeId h = Tin::halfedge(TriangleId{t}, i), outer = faces_.tin.twin(h);
      if (!outer.valid() || outer < h || faces_.owner[Tin::triangle_of(outer).index()] != kNone) continue;
      sides_.add({own, add(outer)});
    }
  }
  weigh();
  for (const double value : value_) block.constant(value);
}

template <class Body>
void EdgeBatch<Body>::list_edges(std::uint32_t q) {
  const std::uint32_t own = 4 * (q - begin_), at_s = own, at_t = own + 1, at_u = own + 2, at_v = own + 3;
  edges_.add({q, kNone, 0, 0});
  sides_.add({at_s, at_t});
  sides_.add({at_u, at_v});
  const std::array<Side, 4> sides = sides_of(faces_.tin, faces_.quadrilaterals[q]);
  std::uint32_t slot = first_[q];
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const HalfedgeId outer = faces_.tin.twin(sides[i].inner);
    if (!outer.valid()) continue;
    const std::uint32_t p = faces_.owner[Tin::triangle_of(outer).index()];
    const BodyPair of_q{i == 0 || i == 3 ? at_s : at_t, sides[i].at_s_u ? at_u : at_v};
    if (p != kNone) {
      if (p > q) list_pair(q, p, outer, slot, of_q);
      ++slot;
      continue;
    }
    const std::uint32_t outside = add(outer);
    edges_.add({q, kNone, 0, 0});
    for (const std::uint32_t body : of_q) sides_.add({body, outside});
  }
}

// The edge between q and a later p, where q has a body for each of its labels.
template <class Body>
void EdgeBatch<Body>::list_pair(std::uint32_t q, std::uint32_t p, HalfedgeId outer, std::uint32_t q_slot,
                                BodyPair of_q) {
  const std::array<Side, 4> sides = sides_of(faces_.tin, faces_.quadrilaterals[p]);
  std::uint32_t p_slot = first_[p];
  std::size_t j = 0;
  for (; sides[j].inner != outer; ++j) p_slot += faces_.owner_across(sides[j].inner) != kNone ? 1 : 0;
  const std::uint32_t its = 4 * (p - begin_);
  const BodyPair of_p = here(p) ? BodyPair{its + (j == 0 || j == 3 ? 0 : 1), its + (sides[j].at_s_u ? 2 : 3)}
                                : BodyPair{add(outer), add_flipped(p, sides[j].at_s_u)};
  edges_.add({q, p, q_slot, p_slot});
  for (const std::uint32_t other : of_p) {
    for (const std::uint32_t body : of_q) sides_.add({body, other});
  }
}

template <class Body>
void EdgeBatch<Body>::weigh() {
  bodies_.resize(triangles_.size());
  value_.resize(sides_.size());
  if constexpr (std::is_same_v<Body, Face>) {
    std::transform(triangles_.all().begin(), triangles_.all().end(), bodies_.begin(),
                   [&](const Triangle& t) { return faces_.face(t[0], t[1], t[2]); });
    std::transform(sides_.all().begin(), sides_.all().end(), value_.begin(), [&](const BodyPair& side) {
      return declaration_.edge(bodies_[side[0]], bodies_[side[1]], faces_.scale);
    });
  } else {
    find_normals(faces_.tin, triangles_.all(), faces_.scale, bodies_);
    angles_between(bodies_, sides_.all(), value_);
    std::transform(value_.begin(), value_.end(), value_.begin(), declaration_.of_angle);
  }
}

}  // namespace thalweg
