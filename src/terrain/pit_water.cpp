// Water in pits.
//
// 1. A vertex is under the water of a pit if it is lower than the level and its own basin is one of those
//    that the pit has met below that level, or its own: along the path of its water it is connected to the
//    bottom below its own height. Two corners of a triangle that are lower than the level are connected
//    by an edge, so the lowest corner tells of which pits a triangle holds water. It holds none unless a
//    corner is lower than where the last of the pits of its basin fills: so most triangles are left out.
// 2. A triangle counts as far as it is submerged, cut along its shore: in batches, in loops over columns
//    without branches.
// 3. What blocks of triangles hold is added up in their order, so sums do not depend on threads.
#include "terrain/pit_water.hpp"

#include "base/ordered_blocks.hpp"
#include "base/parallel.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace thalweg {

namespace {

constexpr std::size_t kBlock = 8192;
constexpr std::size_t kBatch = 128;
using Column = std::array<double, kBatch>;

struct Batch {
  std::array<Column, 3> over;  ///< height of the water over each corner
  Column whole;                ///< area of the triangle
  Column top, middle, bottom;  ///< the same, sorted
  Column area, volume;         ///< of the water
};

// The choice is made before sanitizers are ready.
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__) && \
    !defined(__SANITIZE_ADDRESS__)
[[gnu::target_clones("default", "avx2", "avx512f")]]
#endif
void fill(Batch& batch) {
  for (std::size_t i = 0; i < kBatch; ++i) {
    const double p = batch.over[0][i], q = batch.over[1][i], r = batch.over[2][i];
    const double most = std::max(p, q), least = std::min(p, q);
    batch.top[i] = std::max(most, r);
    batch.middle[i] = std::max(least, std::min(most, r));
    batch.bottom[i] = std::min(least, r);
  }
  for (std::size_t i = 0; i < kBatch; ++i) {
    const double a = batch.top[i], b = batch.middle[i], c = batch.bottom[i], whole = batch.whole[i];
    const double share = a / (a - b) * (a / (a - c)), dry = c / (c - a) * (c / (c - b));
    const double mean = (a + b + c) / 3;
    const double area_of_one = whole * share, area_of_two = whole * (1 - dry);
    const double volume_of_one = whole * share * a / 3, volume_of_two = whole * (mean - dry * c / 3);
    const bool one = b <= 0, all = c >= 0;  // submerged corners
    const double area = one ? area_of_one : area_of_two, volume = one ? volume_of_one : volume_of_two;
    batch.area[i] = all ? whole : area;
    batch.volume[i] = all ? whole * mean : volume;
  }
}

/// A triangle that holds water of a pit.
struct Submerged {
  TriangleId triangle;
  std::uint32_t basin = 0;
};

/// What a block of triangles holds.
struct Held {
  RawVector<TriangleId> wet;  ///< those that may hold any
  RawVector<Submerged> parts;
  std::size_t count = 0;
  RawVector<Water> water;  ///< of each part
};

class Gauge {
 public:
  Gauge(const FlowGraph& graph, const Basins& basins, const Progress& progress)
      : graph_(graph), mesh_(graph.mesh), basins_(basins), wet_(mesh_.vertex_count()) {
    for_each_block(wet_.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        wet_[v] = mesh_.height(VertexId{v}) < basins_.fill_level[basins_.of_vertex[v]] ? 1 : 0;
      }
    });
  }

  void look_at(std::size_t begin, std::size_t end, Held& held) const {
    list_parts(begin, end, held);
    held.water.resize(held.count);
    Batch batch{};
    for (std::size_t i = 0; i < held.count; i += kBatch) {
      const std::size_t count = std::min(kBatch, held.count - i);
      for (std::size_t k = 0; k < count; ++k) load(held.parts[i + k], batch, k);
      fill(batch);
      for (std::size_t k = 0; k < count; ++k) held.water[i + k] = {batch.area[k], batch.volume[k]};
    }
  }

 private:
  // Without a jump: which triangles have a corner under water cannot be foreseen.
  void list_parts(std::size_t begin, std::size_t end, Held& held) const {
    held.wet.resize(end - begin);
    std::size_t wet = 0;
    for (std::size_t t = begin; t < end; ++t) {
      const Triangle& c = mesh_.triangle(TriangleId{t});
      held.wet[wet] = TriangleId{t};
      wet += wet_[c[0].index()] | wet_[c[1].index()] | wet_[c[2].index()];
    }
    held.count = 0;
    for (std::size_t i = 0; i < wet; ++i) {
      const Triangle& c = mesh_.triangle(held.wet[i]);
      const double p = mesh_.height(c[0]), q = mesh_.height(c[1]), r = mesh_.height(c[2]);
      const double lower = std::min(p, q), lowest = std::min(lower, r);
      const std::size_t which = r < lower ? 2 : q < p ? 1 : 0;
      double before = -std::numeric_limits<double>::infinity();
      for (std::uint32_t basin = basins_.of_vertex[c[which].index()]; basin != 0;) {
        if (held.count == held.parts.size()) held.parts.resize(2 * held.count + kBlock);
        held.parts[held.count] = {held.wet[i], basin};
        const double level = basins_.level[basin];
        held.count += ((lowest < level) & (before < level)) ? 1 : 0;
        before = level;
        basin = basins_.met_by[basin];
      }
    }
  }

  void load(const Submerged& part, Batch& batch, std::size_t k) const {
    const Triangle& c = mesh_.triangle(part.triangle);
    const double level = basins_.level[part.basin];
    for (std::size_t i = 0; i < 3; ++i) batch.over[i][k] = level - mesh_.height(c[i]);
    batch.whole[k] = graph_.strips[part.triangle.index()].area;
  }

  const FlowGraph& graph_;
  const FlowMesh& mesh_;
  const Basins& basins_;
  RawVector<std::uint8_t> wet_;  // by vertex: 1 if it is under the water of a pit that its own runs into
};

}  // namespace

std::vector<Water> measure_water(const FlowGraph& graph, const Basins& basins, Progress& progress) {
  const Gauge gauge(graph, basins, progress);
  std::vector<Water> sums(basins.level.size());
  for_each_block_in_order<Held>(
      graph.mesh.triangle_count(), kBlock, progress,
      [&](std::size_t begin, std::size_t end, Held& held) { gauge.look_at(begin, end, held); },
      [&](std::size_t /*begin*/, std::size_t /*end*/, const Held& held) {
        for (std::size_t i = 0; i < held.count; ++i) {
          Water& sum = sums[held.parts[i].basin];
          sum.area += held.water[i].area;
          sum.volume += held.water[i].volume;
        }
      });
  return sums;
}

}  // namespace thalweg
