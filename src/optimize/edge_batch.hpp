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

/// Passes on the values of the edges of a block of quadrilaterals, or of triangles, computed in one go. A
/// body is what a term sees of a triangle: all of it, or its normal. One batch serves block after block.
template <class Body>
class EdgeBatch {
 public:
  EdgeBatch(const LabelledFaces& faces, const Declaration& declaration, std::span<const std::uint32_t> first)
      : faces_(faces), declaration_(declaration), list_(faces, first) {}

  template <class Block>
  void pass_quadrilaterals(std::uint32_t begin, std::uint32_t end, Block& block) {
    list_.load_quadrilaterals(begin, end);
    weigh();
    const double* f = value_.data();
    for (const Neighbours& at : list_.edges()) {
      if (at.p == kNone) {
        block.single(at.q, std::array{f[0]}, std::array{f[1]});
        f += 2;
      } else {
        block.pair(at, PairValues{f[0], f[1], f[2], f[3]});
        f += 4;
      }
    }
  }

  template <class Block>
  void pass_triangles(std::size_t begin, std::size_t end, Block& block) {
    list_.load_triangles(begin, end);
    weigh();
    for (const double value : value_) block.constant(value);
  }

 private:
  void weigh() {
    const std::span<const Triangle> triangles = list_.triangles();
    const std::span<const BodyPair> sides = list_.sides();
    bodies_.resize(triangles.size());
    value_.resize(sides.size());
    if constexpr (std::is_same_v<Body, Face>) {
      std::transform(triangles.begin(), triangles.end(), bodies_.begin(),
                     [&](const Triangle& t) { return faces_.face(t[0], t[1], t[2]); });
      std::transform(sides.begin(), sides.end(), value_.begin(), [&](const BodyPair& side) {
        return declaration_.of_edge(bodies_[side[0]], bodies_[side[1]], faces_.scale, faces_.tin);
      });
    } else {
      find_normals(faces_.tin, triangles, faces_.scale, bodies_);
      angles_between(bodies_, sides, value_);
      std::transform(value_.begin(), value_.end(), value_.begin(), declaration_.of_angle);
    }
  }

  const LabelledFaces& faces_;
  const Declaration& declaration_;
  EdgeList list_;
  std::vector<Body> bodies_;
  std::vector<double> value_;
};

}  // namespace thalweg
