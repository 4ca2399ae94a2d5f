// Pits one by one.
//
// 1. The sinks part the vertices into basins; all that leaves is one basin, the outside, and so is every rim
//    vertex. Along the path of its water a vertex is joined to its sink below its own height, so two basins
//    are joined at height h exactly if an edge between them reaches no higher than h.
// 2. Vertices with a neighbour of another basin, from the lowest up (ties by (x, y)), unite the basins of
// their
//    lower neighbours with their own (Kruskal's minimum spanning tree). When two sets meet, the one with the
//    higher bottom has found its spill vertex; the outside is the lowest of all.
// 3. A pit that spills into a set ends at the level of that set's pit, known later: so from the last to the
//    first each takes the fill height of the pit of the set it met.
// 4. Under water is what is lower than the spill height and connected to the pit below it; a triangle counts
// as
//    far as it is submerged, cut along its shore. Two submerged corners of a triangle are connected by its
//    edge, so it is of one pit; it is counted at its submerged corner of least id.
// Based on: Barnes, Callaghan, Wickert, Computing water flow through complex landscapes - Part 2: Finding
// hierarchies in depressions, 2020, section 3, for the idea of step 2.
#include "base/union_find.hpp"
#include "terrain/flow_graph.hpp"

#include <thalweg/terrain/pit_table.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace thalweg {

namespace {

constexpr std::uint32_t kOutside = 0;

struct Water {
  double area = 0;
  double volume = 0;
};

// The part of a triangle below `level`, of `area` as a whole.
Water water_in(std::array<double, 3> depth, double area) {
  std::sort(depth.begin(), depth.end(), std::greater<>());
  const auto [a, b, c] = depth;
  if (a <= 0) return {};
  if (c >= 0) return {area, area * (a + b + c) / 3};
  if (b <= 0) {
    const double share = a / (a - b) * (a / (a - c));
    return {area * share, area * share * a / 3};
  }
  const double dry = c / (c - a) * (c / (c - b));
  return {area * (1 - dry), area * ((a + b + c) / 3 - dry * c / 3)};
}

class Tabulator {
 public:
  Tabulator(const SurfaceFlow& flow, const MetricScale& scale)
      : graph_(flow.graph()), tin_(graph_.tin), scale_(scale) {}

  PitTable run(Progress& progress) {
    progress.start_phase("measure pits");
    list_pits();
    find_spills(progress);
    progress.advance(0.5);
    reached_.assign(tin_.vertex_count(), kNoPit);
    for (std::size_t i = 0; i < table_.pits.size(); ++i) {
      if (i % 256 == 0) {
        progress.advance(0.5 + 0.5 * static_cast<double>(i) / static_cast<double>(table_.pits.size()));
      }
      measure(i);
    }
    progress.advance(1);
    return std::move(table_);
  }

 private:
  void list_pits() {
    const double square = scale_.horizontal_metres_per_unit * scale_.horizontal_metres_per_unit;
    basin_of_sink_.assign(graph_.sinks.size(), kOutside);
    for (std::size_t s = 0; s < graph_.sinks.size(); ++s) {
      const Sink& sink = graph_.sinks[s];
      if (sink.kind != Sink::Kind::Pit && sink.kind != Sink::Kind::Lake) continue;
      table_.pits.push_back({.sink = SinkId{s},
                             .vertex = sink.vertex,
                             .vertices = sink.vertices,
                             .lake = sink.kind == Sink::Kind::Lake,
                             .height = tin_.height(sink.vertex),
                             .catchment_area_m2 = sink.area * square});
      basin_of_sink_[s] = static_cast<std::uint32_t>(table_.pits.size());
    }
  }

  [[nodiscard]] std::uint32_t basin_of(VertexId v) const {
    const std::uint32_t sink = graph_.sink[v.index()];
    return sink == SinkId::kInvalid || graph_.flats.on_rim[v.index()] != 0 ? kOutside : basin_of_sink_[sink];
  }

  [[nodiscard]] auto key(VertexId v) const { return std::tuple(tin_.height(v), tin_.point(v)); }

  // Basin x has the lower bottom.
  [[nodiscard]] bool goes_on(std::uint32_t x, std::uint32_t y) const {
    if (x == kOutside || y == kOutside) return x == kOutside;
    return key(table_.pits[x - 1].vertex) < key(table_.pits[y - 1].vertex);
  }

  void find_spills(const Progress& progress) {
    std::vector<VertexId> passes;
    for (std::size_t i = 0; i < tin_.vertex_count(); ++i) {
      const VertexId v{i};
      const std::uint32_t own = basin_of(v);
      for (const HalfedgeId h : tin_.outgoing(v)) {
        if (basin_of(tin_.target(h)) == own && basin_of(tin_.apex(h)) == own) continue;
        passes.push_back(v);
        break;
      }
    }
    progress.check();
    std::sort(passes.begin(), passes.end(), [&](VertexId v, VertexId w) { return key(v) < key(w); });
    progress.check();
    UnionFind sets(table_.pits.size() + 1);
    std::vector<std::uint32_t> bottom(table_.pits.size() + 1);  // of each set the basin that goes on
    for (std::uint32_t b = 0; b < bottom.size(); ++b) bottom[b] = b;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> met;  // pit that spilled, basin that goes on
    std::vector<VertexId> lower;
    for (const VertexId v : passes) {
      lower.clear();
      for (const HalfedgeId h : tin_.outgoing(v)) {
        for (const VertexId w : {tin_.target(h), tin_.apex(h)}) {
          if (key(w) < key(v)) lower.push_back(w);
        }
      }
      std::sort(lower.begin(), lower.end(), [&](VertexId a, VertexId b) { return key(a) < key(b); });
      for (const VertexId w : lower) {
        const std::uint32_t here = basin_of(v), there = basin_of(w);
        const std::uint32_t x = bottom[sets.find(here)], y = bottom[sets.find(there)];
        if (!sets.unite(here, there)) continue;
        const bool first = goes_on(x, y);
        bottom[sets.find(here)] = first ? x : y;
        Pit& pit = table_.pits[(first ? y : x) - 1];
        const std::uint32_t across = first ? here : there;  // on the other side than the pit that spills
        pit.spill_height = tin_.height(v);
        pit.spill_vertex = v;
        pit.overflow = first ? v : w;
        if (across != kOutside) pit.spills_into = across - 1;
        met.emplace_back(first ? y : x, first ? x : y);
      }
    }
    std::reverse(met.begin(), met.end());
    for (const auto& [spilled, other] : met) {
      Pit& pit = table_.pits[spilled - 1];
      pit.fill_height = other == kOutside ? pit.spill_height : table_.pits[other - 1].fill_height;
    }
  }

  void measure(std::size_t index) {
    Pit& pit = table_.pits[index];
    const auto mark = static_cast<std::uint32_t>(index);
    const auto submerged = [&](VertexId v) { return tin_.height(v) < pit.spill_height; };
    lake_.assign(1, pit.vertex);
    reached_[pit.vertex.index()] = mark;
    Water water;
    for (std::size_t next = 0; next < lake_.size(); ++next) {
      const VertexId v = lake_[next];
      for (const HalfedgeId h : tin_.outgoing(v)) {
        const VertexId b = tin_.target(h), c = tin_.apex(h);
        for (const VertexId w : {b, c}) {
          if (!submerged(w) || reached_[w.index()] == mark) continue;
          reached_[w.index()] = mark;
          lake_.push_back(w);
        }
        if ((submerged(b) && b < v) || (submerged(c) && c < v)) continue;
        const Point2 o = tin_.point(v), p = tin_.point(b), q = tin_.point(c);
        const double area = ((p.x - o.x) * (q.y - o.y) - (p.y - o.y) * (q.x - o.x)) / 2;
        const Water part = water_in({pit.spill_height - tin_.height(v), pit.spill_height - tin_.height(b),
                                     pit.spill_height - tin_.height(c)},
                                    area);
        water.area += part.area;
        water.volume += part.volume;
      }
    }
    const double square = scale_.horizontal_metres_per_unit * scale_.horizontal_metres_per_unit;
    pit.depth_m = (pit.spill_height - pit.height) * scale_.vertical_metres_per_unit;
    pit.area_m2 = water.area * square;
    pit.volume_m3 = water.volume * square * scale_.vertical_metres_per_unit;
    if (pit.spill_height == pit.fill_height)
      table_.fill_volume_m3 += pit.volume_m3;  // else part of a larger lake
    if (pit.lake) return;
    const auto* const depth_class =
        std::lower_bound(kDepthClassesMetres.begin(), kDepthClassesMetres.end(), pit.depth_m);
    ++table_.interior_by_depth[static_cast<std::size_t>(depth_class - kDepthClassesMetres.begin())];
  }

  const FlowGraph& graph_;
  const Tin& tin_;
  const MetricScale& scale_;
  PitTable table_;
  std::vector<std::uint32_t> basin_of_sink_;
  std::vector<std::uint32_t> reached_;
  std::vector<VertexId> lake_;
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
    if (pit.lake || pit.depth_m > max_depth_m) continue;
    const bool leaves = graph.flats.on_rim[pit.overflow.index()] != 0;
    spilling.overflow[pit.sink.index()] = pit.overflow;
    next[pit.sink.index()] = SinkId{(leaves ? graph.rim_sink : graph.sink)[pit.overflow.index()]};
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
