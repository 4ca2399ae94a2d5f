#pragma once

/// Which ground of the elevation rasters is no ground of the TIN.

#include <thalweg/geometry/point.hpp>

#include <memory>
#include <vector>

namespace thalweg {

/// What happens to the regions without data of a raster. A region is a maximal set of cells without data that
/// are connected over sides and corners; it touches the frame if one of its cells lies at the rim of the
/// cells read.
enum class NodataMode {
  BridgeHoles,  ///< regions that touch the frame are outside of the TIN, others are bridged
  BridgeAll,    ///< all regions are bridged
  BridgeNone    ///< all regions are outside of the TIN
};

/// The ground without data of all rasters of a survey, as asked for by NodataMode. Immutable; copies are
/// cheap.
///
/// The ground of a raster is tiled by its dual cells: parallelograms with four cell centres as corners. In a
/// dual cell with four valid centres all is ground; with three, the closed triangle of these three; the rest
/// is ground without data, and outside if one of the dual cell's invalid centres belongs to a region that is
/// outside. Beyond the frame of cell centres (and where a --bbox cut centres off) a raster says nothing.
class NodataRegion {
 public:
  class Grid;

  NodataRegion() = default;
  explicit NodataRegion(std::vector<std::shared_ptr<const Grid>> grids) : grids_(std::move(grids)) {}

  /// True if no ground is outside.
  [[nodiscard]] bool empty() const { return grids_.empty(); }

  /// True if some raster says that p, in the plane of the survey, is outside, and no raster has ground there.
  /// Thread-safe. Complexity: constant for each raster (plus a coordinate transformation where one was
  /// applied).
  [[nodiscard]] bool outside(Point2 p) const;

 private:
  std::vector<std::shared_ptr<const Grid>> grids_;
};

}  // namespace thalweg
