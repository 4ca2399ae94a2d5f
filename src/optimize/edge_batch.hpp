#pragma once

/// The terms of many edges, computed together.

#include "optimize/declaration.hpp"
#include "optimize/edge_list.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <type_traits>
#include <vector>

namespace thalweg {

/// Passes on the values of the edges of a block of triangles, computed in one go. A body is what a term sees
/// of a triangle: all of it, or its normal. One batch serves block after block.
template <class Body>
class EdgeBatch {
 public:
  EdgeBatch(const LabelledFaces& faces, const Declaration& declaration, std::span<const std::uint32_t> first)
      : faces_(faces), declaration_(declaration), list_(faces, first) {}

  template <class Block>
  void pass(std::size_t begin, std::size_t end, Block& block) {
    list_.load(begin, end);
    weigh();
    const double* f = value_.data();
    for (const std::uint32_t q : list_.singles()) {
      block.single(q, std::array{f[0]}, std::array{f[1]});
      f += 2;
    }
    for (const Neighbours& at : list_.pairs()) {
      block.pair(at, PairValues{f[0], f[1], f[2], f[3]});
      f += 4;
    }
    for (; f != value_.data() + value_.size(); ++f) block.constant(*f);
  }

 private:
  void weigh() {
    const std::span<const Triangle> own = list_.block(), others = list_.others();
    const std::span<const BodyPair> sides = list_.sides();
    bodies_.resize(own.size() + others.size());
    value_.resize(sides.size());
    const std::span<Body> of_own = std::span(bodies_).first(own.size());
    const std::span<Body> of_others = std::span(bodies_).subspan(own.size());
    if constexpr (std::is_same_v<Body, Face>) {
      const auto face_of = [&](const Triangle& t) { return faces_.face(t[0], t[1], t[2]); };
      std::ranges::transform(own, of_own.begin(), face_of);
      std::ranges::transform(others, of_others.begin(), face_of);
      std::ranges::transform(sides, value_.begin(), [&](const BodyPair& side) {
        return declaration_.of_edge(bodies_[side[0]], bodies_[side[1]], faces_.scale, faces_.tin);
      });
    } else {
      find_normals(faces_.tin, own, faces_.scale, of_own);
      find_normals(faces_.tin, others, faces_.scale, of_others);
      angles_between(bodies_, sides, value_);
      if (declaration_.of_angle != the_angle) {
        std::ranges::transform(value_, value_.begin(), declaration_.of_angle);
      }
    }
  }

  const LabelledFaces& faces_;
  const Declaration& declaration_;
  EdgeList list_;
  std::vector<Body> bodies_;
  std::vector<double> value_;
};

}  // namespace thalweg
