#pragma once

/// The water in pits that are full.

#include "terrain/flow_mesh.hpp"

#include <thalweg/base/raw_vector.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace thalweg {

/// In the units of the TIN.
struct Water {
  double area = 0;
  double volume = 0;
};

/// Measures the water in some pits at once.
class WaterGauge {
 public:
  /// `reached`: by vertex a mark of the pit that has reached it last.
  WaterGauge(const FlowMesh& mesh, std::span<std::uint32_t> reached)
      : mesh_(mesh), reached_({&elsewhere_, reached.data()}) {}
  WaterGauge(const WaterGauge&) = delete;
  WaterGauge& operator=(const WaterGauge&) = delete;
  ~WaterGauge() = default;

  /// Adds the pit with this bottom, full to `level`. Pre: nothing has been reached with that mark; what is
  /// under water is not on the rim.
  void flood(VertexId bottom, double level, std::uint32_t mark);
  /// The water in each pit, in the order in which they were added. None is left.
  std::vector<Water> measure();

 private:
  /// A triangle with corner `o` under water.
  struct Submerged {
    VertexId o, p, q;
    std::uint32_t pit = 0;  ///< number of the pit, in the order in which they were added
  };

  void reach(VertexId v, HalfedgeId out, bool wet);

  const FlowMesh& mesh_;
  std::uint32_t elsewhere_ = 0;
  std::array<std::uint32_t*, 2> reached_;  // so that a vertex is marked, or not, without a jump
  std::uint32_t mark_ = 0;
  RawVector<HalfedgeId> lake_;  // what is under water, each vertex by a halfedge from it
  std::size_t lake_count_ = 0;
  RawVector<Submerged> triangles_;
  std::size_t triangle_count_ = 0;
  std::vector<double> levels_;  // by pit
};

}  // namespace thalweg
