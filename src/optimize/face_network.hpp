#pragma once

/// The labelling problem of all faces: each face a variable, its triangulations the labels.

#include "optimize/face_pits.hpp"
#include "optimize/face_terms.hpp"
#include "optimize/label_network.hpp"

#include <thalweg/base/progress.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace thalweg {

/// Plateaus that choices left without outlet together.
using PlateauSet = std::vector<std::uint32_t>;  ///< nodes, ascending

template <std::size_t Criteria>
struct FaceNetwork {
  LabelNetwork<Criteria> network;  ///< first the faces, then what counts pits
  std::vector<FaceLabels<Criteria>> faces;
  /// The number of pits is at least this and the sum of their costs; equal but for sets of plateaus that a
  /// choice joins to each other only.
  std::int64_t sure_pits = 0;
};

/// Faces as the network takes them.
struct ListedFaces {
  std::vector<FaceTriangulations> lists;
  /// 1 where the list holds only some of the triangulations; in a network that bounds such a face has one
  /// label that stands for all.
  std::vector<std::uint8_t> partial;
};

enum class Purpose : std::uint8_t { Choose, Bound };

/// Puts the network together. `pits`: their nodes, and the level that counts them; `closed`: sets of plateaus
/// each of which has to have an outlet, or to count as a pit.
/// Throws: Error{SizeLimit} if sums of a level could overflow; {Cancelled}. Complexity: linear in labels and
/// pairs of candidates at fixed edges; runs on all threads.
template <std::size_t Criteria>
FaceNetwork<Criteria> build_network(const FaceTerms<Criteria>& terms, const ListedFaces& listed,
                                    Purpose purpose, PlateauNodes* pits, std::size_t pit_level,
                                    std::span<const PlateauSet> closed, const Progress& progress);

/// Joins nodes that every triangulation of some face joins. Complexity: edges of all triangulations.
void join_always(const FixedFaces& faces, const ListedFaces& listed, PlateauNodes& pits);

}  // namespace thalweg
