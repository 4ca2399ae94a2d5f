// A label that costs no more than any triangulation of its face.
#include "optimize/face_labels.hpp"

#include <thalweg/base/assert.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace thalweg {

namespace {

constexpr std::size_t kFrontLimit = 2'000'000;

/// Bounds of one face, level by level.
template <std::size_t Criteria>
class FaceBounds {
 public:
  explicit FaceBounds(const FaceModel<Criteria>& model) : model_(model), terms_(*model.terms) {}

  /// Own terms, and of each pair at an edge half its least, rounded down, at either side: a sum of these is
  /// no more than that of the terms. `size`: triangles of a triangulation.
  [[nodiscard]] std::int64_t least_cost(std::size_t level, std::uint32_t size) const {
    std::vector<std::int64_t> weights;
    for (const Weight<Criteria>& own : model_.own) weights.push_back(own[level]);
    for (const FaceGroup& here : model_.groups) {
      if (here.opposite == FaceGroup::kNone) continue;
      const auto triangles = model_.members(here);
      for (std::size_t i = 0; i < triangles.size(); ++i) {
        std::int64_t least = std::numeric_limits<std::int64_t>::max();
        for (std::size_t j = 0; j < here.size_across; ++j) {
          least = std::min(least, model_.weight(here, i, j)[level]);
        }
        weights[model_.index_of(triangles[i])] += least >> 1;
      }
    }
    const auto sum = find_least_sum(terms_.faces, model_.face, weights, kFrontLimit);
    THALWEG_ASSERT(!sum || least_by_area(weights, size) <= *sum);
    return sum ? *sum : least_by_area(weights, size);
  }

 private:
  /// Spreads the weight of each triangle over its area: a triangulation covers each ground triangle once, at
  /// no less than the least weight by area of those that overlap it. Two triangles on the same vertices
  /// overlap exactly if they are the same or some of their sides cross.
  [[nodiscard]] std::int64_t least_by_area(std::span<const std::int64_t> weights, std::uint32_t size) const {
    std::vector<std::size_t> ground;
    for (std::size_t i = 0; i < model_.triangles.size(); ++i) {
      if (is_ground(model_.triangles[i])) ground.push_back(i);
    }
    if (ground.size() != size) {
      return std::int64_t{size} * *std::min_element(weights.begin(), weights.end());
    }
    constexpr long double kRounding = 1e-12L;  // far above that of all operations here
    long double sum = 0, rounding = 0;
    for (const std::size_t i : ground) {
      long double least = by_area(weights, i);
      for (const std::uint32_t side : terms_.faces.sides[model_.triangles[i]]) {
        for (const std::uint32_t crossing : terms_.faces.crossings.row(side / 2)) {
          for (const std::uint32_t other : {2 * crossing, 2 * crossing + 1}) {
            for (const std::uint32_t t : terms_.sides.triangles.row(other)) {
              least = std::min(least, by_area(weights, model_.index_of(t)));
            }
          }
        }
      }
      sum += least * model_.corners[i].normal.z;
      rounding += std::abs(least * model_.corners[i].normal.z) * kRounding;
    }
    return static_cast<std::int64_t>(std::floor(sum - rounding));
  }

  [[nodiscard]] long double by_area(std::span<const std::int64_t> weights, std::size_t i) const {
    return static_cast<long double>(weights[i]) / model_.corners[i].normal.z;
  }

  [[nodiscard]] bool is_ground(std::uint32_t triangle) const {
    const auto& [a, b, c] = terms_.faces.triangles[triangle].corners;
    const HalfedgeId ab = terms_.tin.find_halfedge(a, b);
    return ab.valid() && terms_.tin.apex(ab) == c;
  }

  const FaceModel<Criteria>& model_;
  const FaceTerms<Criteria>& terms_;
};

}  // namespace

template <std::size_t Criteria>
FaceLabels<Criteria> relax_face(const FaceModel<Criteria>& model, std::uint32_t size) {
  FaceLabels<Criteria> labels;
  const FaceBounds<Criteria> bounds(model);
  Cost<Criteria> cost;
  for (std::size_t level = 0; level < Criteria; ++level) cost.level[level] = bounds.least_cost(level, size);
  labels.unary = {cost};
  for (const std::uint32_t g : model.coupled) {
    labels.side.push_back(model.groups[g].side);
    labels.at_side.push_back(static_cast<std::uint16_t>(model.groups[g].size));
  }
  labels.link = model.links;
  labels.joins.assign(model.links.size(), 1);
  labels.relaxed = true;
  return labels;
}

template FaceLabels<1> relax_face(const FaceModel<1>&, std::uint32_t);
template FaceLabels<2> relax_face(const FaceModel<2>&, std::uint32_t);
template FaceLabels<5> relax_face(const FaceModel<5>&, std::uint32_t);

}  // namespace thalweg
