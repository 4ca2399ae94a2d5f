#pragma once

/// What `drain` finds, as layers in the coordinates that came in.

#include "pipeline/loaded_tin.hpp"

#include <thalweg/io/write_features.hpp>
#include <thalweg/terrain/catchments.hpp>
#include <thalweg/terrain/consistency.hpp>
#include <thalweg/terrain/network.hpp>
#include <thalweg/terrain/pit_table.hpp>

#include <span>
#include <vector>

namespace thalweg {

/// A path and the point that it starts from, as written.
struct SeededPath {
  Point2 written;
  FlowPath path;
};

/// The points as written, equal neighbours once.
FeatureLine line_of(const LoadedTin& loaded, std::span<const FlowPoint> points);
FeatureLine ring_of(const LoadedTin& loaded, const CatchmentRing& points);

FeatureLayer pit_layer(const LoadedTin& loaded, const PitTable& table);
FeatureLayer path_layer(const LoadedTin& loaded, const SurfaceFlow& flow, std::span<const SeededPath> paths);
FeatureLayer network_layer(const LoadedTin& loaded, const SurfaceFlow& flow, std::span<const Reach> network);
FeatureLayer catchment_layer(const LoadedTin& loaded, const SurfaceFlow& flow,
                             std::span<const Catchment> catchments, std::span<const double> area_m2);
FeatureLayer inconsistency_layer(const LoadedTin& loaded, const Consistency& consistency);
}  // namespace thalweg
