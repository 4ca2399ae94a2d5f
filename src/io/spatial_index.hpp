#pragma once

/// The spatial index of a GeoPackage's layer, filled at once.

#include <thalweg/base/progress.hpp>
#include <thalweg/geometry/point.hpp>

#include <gdal_priv.h>

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace thalweg {

class GdalSession;

/// Takes the place of the trigger by which the index grows with each feature: that costs six times what all
/// else does.
class SpatialIndex {
 public:
  /// `target`: the file that the user asked for, for errors. Pre: the layer has its fields, an index
  /// (SPATIAL_INDEX=YES), and no feature. Throws (all): Error{WriteFailed, OutOfMemory}.
  SpatialIndex(GDALDataset& dataset, const std::string& layer, std::string target);
  /// The box of the next feature; their ids count from 1.
  void add(const Box2& box);
  /// Fills the index, and puts the trigger back. Throws: also Error{Cancelled}. Complexity: sorting.
  void finish(const Progress& progress);

 private:
  /// Single precision, as SQLite has it: min x, max x, min y, max y, rounded outwards.
  using Bounds = std::array<float, 4>;
  struct Entry {
    std::int64_t id;  ///< of a feature or node
    Bounds bounds;
  };
  std::vector<Entry> write_level(std::vector<Entry>& entries, std::int64_t first_id, unsigned depth,
                                 const Progress& progress);
  void write_nodes_of(std::vector<std::pair<std::int64_t, std::int64_t>> node_of, const char* table);
  [[noreturn]] void fail(const GdalSession& session) const;
  void execute(const std::string& statement);
  [[nodiscard]] std::string ask(const std::string& query);

  GDALDataset& dataset_;
  std::string target_;
  std::string name_;     // of the index
  std::string trigger_;  // the statement that makes it
  std::size_t node_size_ = 0;
  std::vector<Entry> entries_;  // of features, until `finish`
};

}  // namespace thalweg
