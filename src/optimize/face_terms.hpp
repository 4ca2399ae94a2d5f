#pragma once

/// Terms of criteria over candidate triangles.

#include "optimize/cost.hpp"
#include "optimize/declaration.hpp"
#include "optimize/sums.hpp"
#include "optimize/ties.hpp"

#include <thalweg/mesh/tin.hpp>
#include <thalweg/optimize/criterion.hpp>
#include <thalweg/order/fixed_faces.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace thalweg {

/// One level of costs: the parts of an objective, each term weighted and rounded; with a limit, the number of
/// terms beyond it. No parts: terms cost nothing.
struct TermLevel {
  struct Part {
    const Declaration* declaration = nullptr;
    double factor = 1;  ///< weight, with its sign turned if the objective is maximised
  };
  std::vector<Part> parts;
  std::optional<std::int64_t> limit;
  const Reference* reference = nullptr;  ///< for terms that are measured against one
  double most_units = 0;                 ///< of a term, so that the sum of all parts has 63 bits too

  [[nodiscard]] std::int64_t of(const Face& triangle, Scale scale, const Tin& tin) const;
  [[nodiscard]] std::int64_t of(const Face& left, const Face& right, Scale scale, const Tin& tin) const;

 private:
  [[nodiscard]] std::int64_t measure(double value) const;
};

/// The level of an objective; without a limit also where it is an extreme: then for single terms only.
TermLevel level_of(const Objective& objective, std::optional<std::int64_t> limit, const Reference* reference);

/// Sums beyond it are refused: what is added to one that is smaller does not overflow.
constexpr double kMostSteps = 0x1p62;
/// Throws: Error{SizeLimit}: values of that level, from 0 on, are too large to be added exactly.
[[noreturn]] void refuse_sums(std::size_t level);

/// Where the sides of candidate triangles lead.
struct FaceSides {
  std::vector<std::uint32_t> face;  ///< by triangle: the face that it is of, or kNoFace
  Rows triangles;                   ///< by side: candidates left of it, ascending
  std::vector<std::uint32_t> rank;  ///< by edge, among those that the ground does not have, or kNoRank
  std::size_t rank_count = 0;

  static constexpr std::uint32_t kNoFace = 0xffffffffU;
  static constexpr std::uint32_t kNoTriangle = 0xffffffffU;
  static constexpr std::uint32_t kNoRank = 0xffffffffU;

  /// The face left of a side, or kNoFace.
  [[nodiscard]] std::uint32_t owner(std::uint32_t side) const {
    const auto here = triangles.row(side);
    return here.empty() ? kNoFace : face[here.front()];
  }
  /// The triangle left of a side that is in no face, or kNoTriangle. Others would overlap it.
  [[nodiscard]] std::uint32_t fixed(std::uint32_t side) const {
    const auto here = triangles.row(side);
    return here.empty() || face[here.front()] != kNoFace ? kNoTriangle : here.front();
  }
  /// What an edge costs at the last level.
  [[nodiscard]] std::int64_t tie(std::uint32_t edge) const {
    return rank[edge] == kNoRank ? 0 : tie_of(rank[edge], rank_count);
  }
};

/// Ties are by coordinates, as in ties.hpp. Complexity: sorting.
FaceSides find_sides(const Tin& tin, const FixedFaces& faces, const Progress& progress);

/// A candidate triangle in space.
inline Face face_of(const Tin& tin, const FixedFaces& faces, std::uint32_t triangle, Scale scale) {
  const auto& [a, b, c] = faces.triangles[triangle].corners;
  return make_face(corner_of(tin, a), corner_of(tin, b), corner_of(tin, c), scale);
}

/// What does not change from face to face.
template <std::size_t Criteria>
struct FaceTerms {
  const Tin& tin;
  const FixedFaces& faces;
  const FaceSides& sides;
  Scale scale;
  std::array<TermLevel, Criteria> levels;
  std::optional<std::size_t> order_level;  ///< where triangles cost their order
  std::optional<std::size_t> pit_level;    ///< where pits are counted

  [[nodiscard]] Weight<Criteria> of(const Face& triangle) const {
    Weight<Criteria> weight{};
    for (std::size_t i = 0; i < Criteria; ++i) weight[i] = levels[i].of(triangle, scale, tin);
    return weight;
  }
  [[nodiscard]] Weight<Criteria> of(const Face& left, const Face& right) const {
    Weight<Criteria> weight{};
    for (std::size_t i = 0; i < Criteria; ++i) weight[i] = levels[i].of(left, right, scale, tin);
    return weight;
  }
};

/// What terms of candidates may be under a level without limit, ascending, from the worst that no choice
/// changes on. Complexity: pairs of candidates at edges.
std::vector<std::int64_t> term_values(const Tin& tin, const FixedFaces& faces, const FaceSides& sides,
                                      const TermLevel& level, Scale scale, const Progress& progress);

/// Sum of the orders of a TIN's triangles. Throws: Error{Unsupported} for one that is no candidate.
WideSteps order_sum_on(const Tin& tin, const FixedFaces& faces);

}  // namespace thalweg
