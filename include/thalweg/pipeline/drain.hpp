#pragma once

/// Hydrology of a TIN file: pits, flow paths, network, catchments, and whether drawn lines hold.

#include <thalweg/base/progress.hpp>
#include <thalweg/io/source.hpp>
#include <thalweg/pipeline/condition.hpp>
#include <thalweg/terrain/consistency.hpp>
#include <thalweg/terrain/pit_table.hpp>

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace thalweg {

struct DrainReport;

struct DrainConfig {
  std::string input;
  std::string output;  ///< .gpkg
  bool overwrite = false;
  std::string report_path;               ///< JSON; empty: none ("-" is the caller's business)
  std::vector<SourceSpec> outlets;       ///< points; water leaves at the nearest corner of the triangle there
  std::vector<SourceSpec> seeds;         ///< points from which paths are followed; without CRS, in the TIN's
  std::optional<double> seed_spacing_m;  ///< and a lattice of such points
  std::optional<double> min_area_m2;     ///< of the network; none: a thousandth of the TIN
  double pass_pits_m = 0;                ///< pits that are not deeper are full and spill
  ConditionConfig condition;
  std::string mesh_path;         ///< mesh with attributes of flow, .nc or .gpkg; empty: none
  std::string swmm_path;         ///< the network and its grounds for EPA SWMM 5, .inp; empty: none
  std::string conditioned_path;  ///< the TIN with its new heights, in a format by extension; empty: none
  /// Told the report when all files are whole, before they get their names: what it throws leaves none.
  std::function<void(const DrainReport&)> announce;
};

/// What a file for SWMM holds.
struct SwmmReport {
  std::size_t junctions = 0;
  std::size_t outfalls = 0;
  std::size_t storages = 0;  ///< pits at which reaches end
  std::size_t conduits = 0;
  std::size_t subcatchments = 0;
  double area_m2 = 0;  ///< of the subcatchments: ground that drains to the network
};

struct DrainReport {
  std::string input;
  std::size_t vertices = 0;
  std::size_t triangles = 0;
  double area_m2 = 0;
  std::size_t interior_pits = 0;
  std::size_t lakes = 0;
  std::array<std::size_t, 6> interior_by_depth{};
  double fill_volume_m3 = 0;
  struct OutletPlace {
    double distance_m = 0;  ///< from the point that was given to the vertex that was taken
    double catchment_area_m2 = 0;
  };
  std::vector<OutletPlace> outlets;
  std::size_t rim_outlets = 0;  ///< places at the rim where water leaves
  double drained_area_m2 = 0;   ///< of all that leaves there or at given outlets
  std::size_t flow_paths = 0;
  std::size_t seeds_outside = 0;
  std::size_t reaches = 0;
  double min_area_m2 = 0;
  unsigned strahler = 0;
  std::size_t catchments = 0;
  double pass_pits_m = 0;
  std::size_t pits_passed = 0;
  std::size_t broken_cycles = 0;
  Consistency consistency;
  std::optional<ConditionReport> conditioned;
  std::optional<SwmmReport> swmm;
  std::vector<std::string> notes;
};

/// Writes the layers pits, flow_paths, network, catchments and inconsistencies to a GeoPackage. With
/// `condition` heights are changed first, all else is found on the new ones, and the layer conditioned lists
/// the changes.
/// Throws: as read_tin and write_features; Error{InvalidTin}; Error{OutsideHull} for an outlet outside of the
/// TIN. Nothing is left behind then.
DrainReport drain_tin(const DrainConfig& config, Progress& progress);
std::string to_json(const DrainReport& report);
std::string to_text(const DrainReport& report);

}  // namespace thalweg
