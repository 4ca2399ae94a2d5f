#pragma once

/// Candidate triangles of one face, and what their terms cost: each is computed once.

#include "optimize/face_pits.hpp"
#include "optimize/face_terms.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace thalweg {

/// Terms of pairs of candidates at the edges between two faces.
template <std::size_t Criteria>
struct SideWeights {
  std::vector<std::uint32_t> edges;  ///< between two faces, ascending
  std::vector<std::uint32_t> index;  ///< by candidate edge: where it is among these, or kNone
  std::vector<std::size_t> first;    ///< of these: its first weight
  /// Those at an edge: for each candidate left of its even side, for each left of the other.
  std::vector<Weight<Criteria>> weights;
  /// By item of FaceSides::triangles: 0 if a label of its face need not have that candidate there.
  std::vector<std::uint8_t> possible;

  static constexpr std::uint32_t kNone = 0xffffffffU;
};

/// Complexity: the pairs; runs on all threads.
template <std::size_t Criteria>
SideWeights<Criteria> weigh_sides(const FaceTerms<Criteria>& terms, const Progress& progress);

/// The candidates of a face left of one side.
struct FaceGroup {
  static constexpr std::uint32_t kNone = 0xffffffffU;

  std::uint32_t side = 0;
  std::uint32_t size = 0;
  std::uint32_t opposite = kNone;  ///< the group on the other side of the edge, if it is of this face
  std::uint32_t link = kNone;      ///< what a free edge joins, among the face's links
  /// Of what may be across, in this face or another one; 0: that is one triangle, or nothing.
  std::uint32_t size_across = 0;
  std::size_t first_weight = 0, stride = 0, stride_across = 0;
};

template <std::size_t Criteria>
struct FaceModel {
  const FaceTerms<Criteria>* terms = nullptr;
  std::size_t face = 0;
  std::span<const std::uint32_t> triangles;  ///< candidates of the face
  std::vector<Face> corners;                 ///< by triangle
  std::vector<Weight<Criteria>> own;         ///< by triangle: its terms, and those with triangles in no face
  std::vector<FaceGroup> groups;             ///< by side, ascending
  std::vector<std::array<std::uint32_t, 3>> group;  ///< by triangle, of its sides
  std::vector<std::array<std::uint16_t, 3>> place;  ///< by triangle, in these groups
  std::vector<std::uint32_t> coupled;               ///< groups beyond which there is another face, ascending
  std::vector<Weight<Criteria>> weights;
  std::vector<PlateauLink> links;  ///< of free edges, ascending

  /// The term of a group's candidate and one that may be across.
  [[nodiscard]] const Weight<Criteria>& weight(const FaceGroup& g, std::size_t here,
                                               std::size_t there) const {
    return weights[g.first_weight + here * g.stride + there * g.stride_across];
  }
  [[nodiscard]] std::span<const std::uint32_t> members(const FaceGroup& g) const {
    return terms->sides.triangles.row(g.side);
  }
  [[nodiscard]] std::size_t index_of(std::uint32_t triangle) const {
    return static_cast<std::size_t>(std::lower_bound(triangles.begin(), triangles.end(), triangle) -
                                    triangles.begin());
  }
  /// Another face; memory stays.
  void start(const FaceTerms<Criteria>& of, std::size_t at) {
    terms = &of;
    face = at;
    triangles = of.faces.faces.row(at);
    corners.clear();
    own.clear();
    groups.clear();
    group.resize(triangles.size());
    place.resize(triangles.size());
    coupled.clear();
    weights.clear();
    links.clear();
  }
};

/// Models faces one by one: memory is reused from face to face. What it refers to outlives it.
template <std::size_t Criteria>
class FaceModeller {
 public:
  /// `links`: by candidate edge, as PlateauNodes::link; empty if pits are not counted.
  FaceModeller(const FaceTerms<Criteria>& terms, const SideWeights<Criteria>& sides,
               std::span<const PlateauLink> links)
      : terms_(terms), sides_(sides), links_(links) {}

  /// The model, until the next call. Throws: Error{SizeLimit} if sums over a triangulation of the face could
  /// overflow. Complexity: pairs of candidates at the face's edges.
  const FaceModel<Criteria>& model(std::size_t face);

 private:
  void group_sides();
  void weigh(std::uint32_t index);
  void weigh_coupled(FaceGroup& group, std::size_t first);
  void weigh_pairs(FaceGroup& here, FaceGroup& there);
  void note_links();
  void refuse_overflow();
  [[nodiscard]] bool joins(const FaceGroup& group) const;

  const FaceTerms<Criteria>& terms_;
  const SideWeights<Criteria>& sides_;
  std::span<const PlateauLink> links_;
  FaceModel<Criteria> model_;
  std::vector<VertexId> vertices_;      ///< scratch
  std::vector<std::uint64_t> entries_;  ///< in the upper half a side, then 3 times a triangle plus its corner
};

}  // namespace thalweg
