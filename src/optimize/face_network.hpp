#pragma once

/// The labelling problem of all faces: each face a variable, its triangulations the labels.

#include "optimize/face_labels.hpp"
#include "optimize/label_network.hpp"
#include "optimize/sums.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace thalweg {

/// Plateaus that choices left without outlet together.
using PlateauSet = std::vector<std::uint32_t>;  ///< nodes, ascending

template <std::size_t Criteria>
struct FaceNetwork {
  LabelNetwork<Criteria> network;  ///< first the faces, then what counts pits
  /// By level what is taken out of the costs, so that their sums stay small: every choice costs as much more.
  /// The number of pits is at least this and the sum of their costs; equal but for sets of plateaus that a
  /// choice joins to each other only.
  std::array<WideSteps, Criteria> base{};
};

/// Puts the network together. `pits`: their nodes, if they are counted; `closed`: sets of plateaus each of
/// which has to have an outlet, or to count as a pit.
/// Throws: Error{SizeLimit} if sums of a level could overflow; {Cancelled}. Complexity: linear in labels and
/// pairs of candidates at fixed edges.
template <std::size_t Criteria>
FaceNetwork<Criteria> build_network(const FaceTerms<Criteria>& terms, const SideWeights<Criteria>& sides,
                                    const std::vector<FaceLabels<Criteria>>& faces, PlateauNodes* pits,
                                    std::span<const PlateauSet> closed);

struct SearchedFace {
  std::unique_ptr<const FrontGraph> own;  ///< null: that of FixedFaces
  bool whole = true;                      ///< whether it has all triangulations of the face
};

/// The fronts of a face; where they have more edges than `work_limit`, those of the largest order that has
/// not, or of the Delaunay triangulation alone. Throws: Error{SizeLimit} if that is none of the face.
SearchedFace search_fronts(const Tin& delaunay, const FixedFaces& faces, std::size_t face,
                           std::size_t work_limit);

/// The one path of the triangulation that has those of the face's candidates which are marked with 1; none if
/// these do not cover the face. Pre: they do not overlap.
std::optional<FrontGraph> path_of(const FixedFaces& faces, std::size_t face,
                                  std::span<const std::uint8_t> chosen);

/// The graph of a face that was searched.
inline const FrontGraph& graph_of(const FixedFaces& faces, std::span<const SearchedFace> searched,
                                  std::size_t face) {
  return searched[face].own ? *searched[face].own : faces.fronts[face];
}

/// Joins nodes that every triangulation of some face joins; links follow. Complexity: arcs of all graphs and
/// links of their faces.
void join_always(const FixedFaces& faces, std::span<const SearchedFace> searched, PlateauNodes& pits,
                 const Progress& progress);

}  // namespace thalweg
