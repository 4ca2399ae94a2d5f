#pragma once

/// The choice of a triangulation in each face (LabellingConfig::by_faces), between the ground and the files.

#include "pipeline/surface.hpp"

#include <thalweg/optimize/optimize_faces.hpp>
#include <thalweg/order/fixed_faces.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace thalweg {

/// Throws: Error{Unsupported} for what cannot be had with a choice by faces, if that is what is asked for.
void check_choice_by_faces(const LabellingConfig& labelling, const OutputConfig& output, bool simplified);

struct SurfaceFaces {
  FixedFaces faces;
  /// Not all triangles of the order could be listed, so the faces are for the triangulations that have no
  /// other edges than those of the ground and other diagonals of its first-order quadrilaterals.
  bool only_flips = false;
  /// At order 1, chosen exactly, if some faces have too many triangulations to list: faces for the
  /// triangulations that in these have no other edges than those of the ground and diagonals that SeesOpp
  /// frees, of which no two overlap. What is chosen is chosen from these; bounds are for all.
  std::optional<FixedFaces> narrowed;
};

/// The faces of the surface, from the orders of triangles on the whole ground. `surface`: the kept triangles.
/// Throws: Error{Unsupported} if no triangulation has an order that low, as can be under Std; {SizeLimit};
/// {Cancelled}.
SurfaceFaces find_surface_faces(const Terrain& terrain, const Tin& surface, const LabellingConfig& labelling,
                                Progress& progress);

struct HigherOrderChoice {
  Tin tin;
  std::vector<std::uint16_t> orders;               ///< by triangle of `tin`
  std::vector<std::array<VertexId, 2>> new_edges;  ///< that the Delaunay triangulation does not have
  std::vector<CriterionResult> criteria;
  ReportHigherOrder figures;
};

/// Throws: as optimize_faces.
HigherOrderChoice choose_triangulations(const Tin& delaunay, const SurfaceFaces& faces,
                                        const OptimizeOptions& options, const LabellingConfig& labelling,
                                        Progress& progress);

}  // namespace thalweg
