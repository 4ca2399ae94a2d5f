#pragma once

/// The terms of the edges of neighbouring quadrilaterals, computed together.

#include "optimize/declaration.hpp"
#include "optimize/labelled_faces.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <type_traits>
#include <vector>

namespace thalweg {

/// The edges of a block of quadrilaterals. Each quadrilateral's four triangles are made once, and values are
/// computed in one go. A body is what a term sees of a triangle: all of it, or its normal.
template <class Body>
class EdgeBatch {
 public:
  EdgeBatch(const LabelledFaces& faces, std::uint32_t begin, std::uint32_t end,
            std::span<const std::uint32_t> first)
      : faces_(faces), begin_(begin), end_(end), first_(first) {
    bodies_.reserve(std::size_t{6} * (end - begin));
    for (std::uint32_t q = begin; q < end; ++q) {
      const HalfedgeId uv = faces.quadrilaterals[q].diagonal;
      add(faces.face(uv));
      add(faces.face(faces.tin.twin(uv)));
      add(faces.flipped_face(q, true));
      add(faces.flipped_face(q, false));
    }
    edges_.reserve(std::size_t{5} * (end - begin));
    sides_.reserve(std::size_t{12} * (end - begin));
    for (std::uint32_t q = begin; q < end; ++q) list_edges(q);
  }

  template <class Block>
  void pass_to(Block& block, const Declaration& declaration) {
    weigh(declaration);
    const double* f = value_.data();
    for (const Neighbours& at : edges_) {
      if (at.p == kNone) {
        block.single(at.q, std::array{f[0]}, std::array{f[1]});
        f += 2;
      } else {
        block.pair(at, PairValues{f[0], f[1], f[2], f[3]});
        f += 4;
      }
    }
  }

 private:
  std::uint32_t add(const Face& face) {
    if constexpr (std::is_same_v<Body, Face>) {
      bodies_.push_back(face);
    } else {
      bodies_.push_back(face.normal);
    }
    return static_cast<std::uint32_t>(bodies_.size() - 1);
  }
  [[nodiscard]] bool here(std::uint32_t q) const { return q >= begin_ && q < end_; }
  void list_edges(std::uint32_t q);
  void weigh(const Declaration& declaration);

  const LabelledFaces& faces_;
  std::uint32_t begin_, end_;
  std::span<const std::uint32_t> first_;
  std::vector<Body> bodies_;
  std::vector<Neighbours> edges_;  ///< p is kNone if only q decides
  std::vector<BodyPair> sides_;    ///< for each edge, the bodies of its two or four values
  std::vector<double> value_;
};

template <class Body>
void EdgeBatch<Body>::list_edges(std::uint32_t q) {
  const std::uint32_t own = 4 * (q - begin_), at_s = own, at_t = own + 1, at_u = own + 2, at_v = own + 3;
  edges_.push_back({q, kNone, 0, 0});
  sides_.push_back({at_s, at_t});
  sides_.push_back({at_u, at_v});
  const std::array<Side, 4> sides = sides_of(faces_.tin, faces_.quadrilaterals[q]);
  std::uint32_t slot = first_[q];
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const HalfedgeId outer = faces_.tin.twin(sides[i].inner);
    if (!outer.valid()) continue;
    const std::uint32_t p = faces_.owner[Tin::triangle_of(outer).index()];
    const std::uint32_t q_slot = p != kNone ? slot++ : 0;
    if (p != kNone && p < q) continue;
    const std::uint32_t kept = i == 0 || i == 3 ? at_s : at_t;
    const std::uint32_t flipped = sides[i].at_s_u ? at_u : at_v;
    if (p == kNone) {
      const std::uint32_t outside = add(faces_.face(outer));
      edges_.push_back({q, kNone, 0, 0});
      sides_.push_back({kept, outside});
      sides_.push_back({flipped, outside});
      continue;
    }
    const std::array<Side, 4> other = sides_of(faces_.tin, faces_.quadrilaterals[p]);
    std::uint32_t p_slot = first_[p];
    std::size_t j = 0;
    for (; other[j].inner != outer; ++j) p_slot += faces_.owner_across(other[j].inner) != kNone ? 1 : 0;
    const std::uint32_t its = 4 * (p - begin_);
    const std::uint32_t outside = here(p) ? its + (j == 0 || j == 3 ? 0 : 1) : add(faces_.face(outer));
    const std::uint32_t outside_flipped =
        here(p) ? its + (other[j].at_s_u ? 2 : 3) : add(faces_.flipped_face(p, other[j].at_s_u));
    edges_.push_back({q, p, q_slot, p_slot});
    sides_.push_back({kept, outside});
    sides_.push_back({flipped, outside});
    sides_.push_back({kept, outside_flipped});
    sides_.push_back({flipped, outside_flipped});
  }
}

template <class Body>
void EdgeBatch<Body>::weigh(const Declaration& declaration) {
  value_.resize(sides_.size());
  if constexpr (std::is_same_v<Body, Face>) {
    std::transform(sides_.begin(), sides_.end(), value_.begin(), [&](const BodyPair& side) {
      return declaration.edge(bodies_[side[0]], bodies_[side[1]], faces_.scale);
    });
  } else {
    angles_between(bodies_, sides_, value_);
    std::transform(value_.begin(), value_.end(), value_.begin(), declaration.of_angle);
  }
}

}  // namespace thalweg
