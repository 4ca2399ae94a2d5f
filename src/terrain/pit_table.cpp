// Pits one by one.
//
// 1. The sinks part the vertices into basins; all that leaves is one basin, the outside, and so is every rim
//    vertex. Along the path of its water a vertex is joined to its sink below its own height, so two basins
//    are joined at height h exactly if an edge between them reaches no higher than h.
// 2. Of the edges between the same two basins only the lowest counts: by its higher end, then its lower one
//    (ties by (x, y)). These, from the lowest up, unite their basins (Kruskal's minimum spanning tree). When
//    two sets meet, the one with the higher bottom has found its spill vertex; the outside is the lowest of
//    all.
// 3. A pit that spills into a set ends at the level of that set's pit, known later: so from the last to the
//    first each takes the fill height of the pit of the set it met.
// 4. What each pit holds when it is full: pit_water.cpp.
// Based on: Barnes, Callaghan, Wickert, Computing water flow through complex landscapes - Part 2: Finding
// hierarchies in depressions, 2020, section 3, for the idea of step 2.
#include "base/buckets.hpp"
#include "base/ordered_blocks.hpp"
#include "base/parallel.hpp"
#include "base/union_find.hpp"
#include "terrain/depth_limit.hpp"
#include "terrain/flow_graph.hpp"
#include "terrain/pit_water.hpp"

#include <thalweg/terrain/pit_table.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace thalweg {

namespace {

constexpr std::uint32_t kOutside = 0;

/// An edge between two basins.
struct Pass {
  std::uint32_t basin = kOutside;  ///< the lower number
  std::uint32_t other = kOutside;
  VertexId high, low;  ///< its ends
};

using Edge = std::array<VertexId, 2>;

/// The passes in a block of triangles.
struct PassList {
  RawVector<TriangleId> triangles;  ///< those with corners in several basins come first
  RawVector<Edge> edges;            ///< the first `count` of them
  std::size_t count = 0;
  std::vector<Pass> passes;
};

class Tabulator {
 public:
  Tabulator(const SurfaceFlow& flow, const MetricScale& scale)
      : graph_(flow.graph()), mesh_(graph_.mesh), scale_(scale) {}

  PitTable run(Progress& progress) {
    progress.start_phase("measure pits");
    list_pits();
    find_basins(progress);
    find_spills(lowest_passes(progress));
    progress.advance(0.5);
    measure_all(progress);
    put_in_order_of_sinks();
    for (const Pit& pit : table_.pits) count(pit);
    progress.advance(1);
    return std::move(table_);
  }

 private:
  static constexpr std::size_t kBlock = 8192;

  /// From here on pits have numbers along the mesh, so what is near is near in memory.
  void list_pits() {
    const double square = scale_.horizontal_metres_per_unit * scale_.horizontal_metres_per_unit;
    std::vector<std::pair<VertexId, std::size_t>> places;  // of the bottom; the sink
    for (std::size_t s = 0; s < graph_.sinks.size(); ++s) {
      const Sink& sink = graph_.sinks[s];
      if (sink.kind == Sink::Kind::Pit || sink.kind == Sink::Kind::Lake) {
        places.emplace_back(mesh_.own(sink.vertex), s);
      }
    }
    std::sort(places.begin(), places.end());
    basin_of_sink_.assign(graph_.sinks.size(), kOutside);
    for (const auto& [bottom, s] : places) {
      const Sink& sink = graph_.sinks[s];
      bottom_.push_back(bottom);
      table_.pits.push_back({.sink = SinkId{s},
                             .vertex = sink.vertex,
                             .vertices = sink.vertices,
                             .lake = sink.kind == Sink::Kind::Lake,
                             .height = mesh_.height(bottom),
                             .catchment_area_m2 = sink.area * square});
      basin_of_sink_[s] = static_cast<std::uint32_t>(table_.pits.size());
    }
  }

  void put_in_order_of_sinks() {
    std::vector<std::size_t> place(table_.pits.size());  // of each pit in that order
    std::size_t next = 0;
    for (const std::uint32_t basin : basin_of_sink_) {
      if (basin != kOutside) place[basin - 1] = next++;
    }
    std::vector<Pit> sorted(table_.pits.size());
    for (std::size_t i = 0; i < place.size(); ++i) {
      Pit& pit = table_.pits[i];
      if (pit.spills_into) pit.spills_into = place[*pit.spills_into];
      sorted[place[i]] = pit;
    }
    table_.pits = std::move(sorted);
  }

  void find_basins(const Progress& progress) {
    basin_.resize(mesh_.vertex_count());
    for_each_block(mesh_.vertex_count(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        const std::uint32_t sink = graph_.sink[v];
        const bool outside = sink == SinkId::kInvalid || graph_.flats.on_rim[v] != 0;
        basin_[v] = outside ? kOutside : basin_of_sink_[sink];
      }
    });
  }

  [[nodiscard]] bool is_before(VertexId v, VertexId w) const {
    const double p = mesh_.height(v), q = mesh_.height(w);
    return p != q ? p < q : mesh_.point(v) < mesh_.point(w);
  }
  [[nodiscard]] bool is_before(const Pass& a, const Pass& b) const {
    return a.high != b.high ? is_before(a.high, b.high) : is_before(a.low, b.low);
  }

  // Basin x has the lower bottom.
  [[nodiscard]] bool goes_on(std::uint32_t x, std::uint32_t y) const {
    if (x == kOutside || y == kOutside) return x == kOutside;
    return is_before(bottom_[x - 1], bottom_[y - 1]);
  }

  /// Lists the edges between two basins, of the two triangles beside each for one; without a jump: which they
  /// are cannot be foreseen.
  void list_edges(std::size_t begin, std::size_t end, PassList& list) const {
    list.triangles.resize(end - begin);
    std::size_t between = 0;
    for (std::size_t t = begin; t < end; ++t) {
      const Triangle& c = mesh_.triangle(TriangleId{t});
      const std::uint32_t first = basin_[c[0].index()];
      list.triangles[between] = TriangleId{t};
      between += ((first != basin_[c[1].index()]) | (first != basin_[c[2].index()])) ? 1 : 0;
    }
    list.edges.resize(3 * between + 1);
    list.count = 0;
    for (std::size_t i = 0; i < between; ++i) {
      const Triangle& c = mesh_.triangle(list.triangles[i]);
      for (std::size_t side = 0; side < 3; ++side) {
        const VertexId v = c[side], w = c[kNextSide[side]];
        list.edges[list.count] = {v, w};
        list.count += ((basin_[v.index()] != basin_[w.index()]) & (v < w)) ? 1 : 0;
      }
    }
  }

  [[nodiscard]] Pass pass_over(const Edge& edge) const {
    const auto [least, most] = std::minmax(basin_[edge[0].index()], basin_[edge[1].index()]);
    const std::size_t low = is_before(edge[0], edge[1]) ? 0 : 1;
    return {least, most, edge[1 - low], edge[low]};
  }

  // Edges on the rim are outside. Of those between two basins in one block of triangles most are left out.
  [[nodiscard]] LargeVector<Pass> list_passes(const Progress& progress) const {
    LargeVector<Pass> passes;
    passes.reserve(mesh_.vertex_count() / 4);
    const auto make = [&](std::size_t begin, std::size_t end, PassList& list) {
      list_edges(begin, end, list);
      list.passes.clear();
      std::array<std::uint32_t, 256> latest{};  // pass of two basins, by a mix of their numbers
      for (std::size_t i = 0; i < list.count; ++i) {
        const Pass pass = pass_over(list.edges[i]);
        std::uint32_t& known = latest[(pass.basin + 31 * pass.other) % latest.size()];
        if (known < list.passes.size() && list.passes[known].basin == pass.basin &&
            list.passes[known].other == pass.other) {
          if (is_before(pass, list.passes[known])) list.passes[known] = pass;
        } else {
          known = static_cast<std::uint32_t>(list.passes.size());
          list.passes.push_back(pass);
        }
      }
    };
    for_each_block_in_order<PassList>(mesh_.triangle_count(), kBlock, progress, make,
                                      [&](std::size_t /*begin*/, std::size_t /*end*/, const PassList& list) {
                                        passes.insert(passes.end(), list.passes.begin(), list.passes.end());
                                      });
    return passes;
  }

  /// Of each two basins that meet; from the lowest up.
  [[nodiscard]] std::vector<Pass> lowest_passes(const Progress& progress) const {
    const LargeVector<Pass> passes = list_passes(progress);
    std::vector<std::uint32_t> basins(passes.size());
    std::transform(passes.begin(), passes.end(), basins.begin(), [](const Pass& p) { return p.basin; });
    Buckets by_basin = sort_into_buckets(basins, table_.pits.size() + 1);
    progress.check();
    std::vector<Pass> lowest;
    std::vector<std::size_t> place(table_.pits.size() + 1,
                                   0);  // in `lowest`, if that is of the basin at hand
    for (std::uint32_t basin = 0; basin < by_basin.size(); ++basin) {
      const std::size_t first = lowest.size();
      for (const std::uint32_t i : by_basin.items(basin)) {
        const Pass& pass = passes[i];
        std::size_t& known = place[pass.other];
        if (known >= first && known < lowest.size() && lowest[known].other == pass.other) {
          if (is_before(pass, lowest[known])) lowest[known] = pass;
        } else {
          known = lowest.size();
          lowest.push_back(pass);
        }
      }
    }
    progress.check();
    std::sort(lowest.begin(), lowest.end(), [&](const Pass& a, const Pass& b) { return is_before(a, b); });
    return lowest;
  }

  void find_spills(const std::vector<Pass>& passes) {
    UnionFind sets(table_.pits.size() + 1);
    std::vector<std::uint32_t> deepest(table_.pits.size() + 1);  // of each set the basin that goes on
    std::iota(deepest.begin(), deepest.end(), 0U);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> met;  // pit that spilled, basin that goes on
    for (const Pass& pass : passes) {
      const std::uint32_t here = basin_[pass.high.index()], there = basin_[pass.low.index()];
      const std::uint32_t x = deepest[sets.find(here)], y = deepest[sets.find(there)];
      if (!sets.unite(here, there)) continue;
      const bool first = goes_on(x, y);
      deepest[sets.find(here)] = first ? x : y;
      Pit& pit = table_.pits[(first ? y : x) - 1];
      const std::uint32_t across = first ? here : there;  // on the other side than the pit that spills
      pit.spill_height = mesh_.height(pass.high);
      pit.spill_vertex = mesh_.given(pass.high);
      pit.overflow = mesh_.given(first ? pass.high : pass.low);
      if (across != kOutside) pit.spills_into = across - 1;
      met.emplace_back(first ? y : x, first ? x : y);
    }
    std::reverse(met.begin(), met.end());
    met_by_.assign(table_.pits.size() + 1, kOutside);
    for (const auto& [spilled, other] : met) {
      Pit& pit = table_.pits[spilled - 1];
      pit.fill_height = other == kOutside ? pit.spill_height : table_.pits[other - 1].fill_height;
      met_by_[spilled] = other;
    }
  }

  void measure_all(Progress& progress) {
    std::vector<double> level = {-std::numeric_limits<double>::infinity()}, fill_level = level;
    for (const Pit& pit : table_.pits) {
      level.push_back(pit.spill_height);
      fill_level.push_back(pit.fill_height);
    }
    const std::vector<Water> water = measure_water(
        graph_, {.of_vertex = basin_, .level = level, .fill_level = fill_level, .met_by = met_by_}, progress);
    for (std::size_t i = 0; i < table_.pits.size(); ++i) fill_in(table_.pits[i], water[i + 1]);
  }

  void fill_in(Pit& pit, const Water& water) const {
    const double square = scale_.horizontal_metres_per_unit * scale_.horizontal_metres_per_unit;
    pit.depth_m = (pit.spill_height - pit.height) * scale_.vertical_metres_per_unit;
    pit.area_m2 = water.area * square;
    pit.volume_m3 = water.volume * square * scale_.vertical_metres_per_unit;
  }

  void count(const Pit& pit) {
    if (pit.spill_height == pit.fill_height) {
      table_.fill_volume_m3 += pit.volume_m3;  // else part of a larger lake
    }
    if (pit.lake) return;
    const auto* const depth_class =
        std::find_if(kDepthClassesMetres.begin(), kDepthClassesMetres.end(), [&](double limit) {
          return apart_at_most(pit.spill_height, pit.height, limit, scale_.vertical_metres_per_unit);
        });
    ++table_.interior_by_depth[static_cast<std::size_t>(depth_class - kDepthClassesMetres.begin())];
  }

  const FlowGraph& graph_;
  const FlowMesh& mesh_;
  const MetricScale& scale_;
  PitTable table_;
  std::vector<VertexId> bottom_;  // by pit: its vertex
  std::vector<std::uint32_t> basin_of_sink_;
  std::vector<std::uint32_t> met_by_;  // by basin: the one that goes on when its pit spills
  RawVector<std::uint32_t> basin_;     // by vertex: number of its pit, counted from 1, or outside
};

}  // namespace

PitTable tabulate_pits(const SurfaceFlow& flow, const MetricScale& scale, Progress& progress) {
  return Tabulator(flow, scale).run(progress);
}

Spilling let_spill(const SurfaceFlow& flow, const PitTable& table, double max_depth_m) {
  const FlowGraph& graph = flow.graph();
  Spilling spilling;
  spilling.overflow.resize(graph.sinks.size());
  std::vector<SinkId> next(graph.sinks.size());
  for (const Pit& pit : table.pits) {
    const double unit = pit.depth_m / (pit.spill_height - pit.height);
    if (pit.lake || !apart_at_most(pit.spill_height, pit.height, max_depth_m, unit)) continue;
    const VertexId overflow = graph.mesh.own(pit.overflow);
    const bool leaves = graph.flats.on_rim[overflow.index()] != 0;
    spilling.overflow[pit.sink.index()] = pit.overflow;
    next[pit.sink.index()] = SinkId{(leaves ? graph.rim_sink : graph.sink)[overflow.index()]};
  }
  spilling.end.resize(graph.sinks.size());
  std::vector<SinkId> chain;
  for (std::size_t s = 0; s < graph.sinks.size(); ++s) {
    SinkId at{s};
    chain.clear();
    while (!spilling.end[at.index()].valid() && next[at.index()].valid()) {
      chain.push_back(at);
      at = next[at.index()];
    }
    const SinkId known = spilling.end[at.index()];
    const SinkId end = known.valid() ? known : at;
    spilling.end[at.index()] = end;
    for (const SinkId passed : chain) spilling.end[passed.index()] = end;
  }
  return spilling;
}

}  // namespace thalweg
