// Plateaus.
//
// 1. A vertex without a step has no lower neighbour. (Water that leaves a vertex across a triangle runs
//    towards a corner that is lower, so edges tell.) If all are higher it is a pit by itself.
// 2. From each other one walk its plateau through level edges. If none of it has a lower neighbour or is an
//    outlet, it is a pit.
// 3. If one has, a breadth-first search from all that have gives the others their rank; the next vertex on
//    the way is the first by (x, y) of those with the rank below, so ids do not matter.
#include "terrain/flats.hpp"

#include "base/parallel.hpp"

#include <algorithm>
#include <utility>

namespace thalweg {

namespace {

constexpr std::size_t kBlock = 8192;
constexpr std::uint32_t kWaiting = 0xffffffffU;  // rank of what is on the plateau at hand

class Resolver {
 public:
  Resolver(const FlowMesh& mesh, std::span<const VertexId> outlets, std::span<const HalfedgeId> rim,
           std::span<VertexStep> steps, const Progress& progress)
      : mesh_(mesh), steps_(steps), drained_(mesh.vertex_count()) {
    flats_.rank.assign(mesh.vertex_count(), 0);
    flats_.pit.assign(mesh.vertex_count(), kNoPit);
    flats_.on_rim.assign(mesh.vertex_count(), 0);
    for_each_block(steps.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) drained_[v] = steps[v].squared_slope >= 0 ? 1 : 0;
    });
    for (const VertexId v : outlets) drained_[v.index()] = 1;
    for (const HalfedgeId h : rim) {
      flats_.on_rim[mesh.origin(h).index()] = flats_.on_rim[mesh.target(h).index()] = 1;
    }
  }

  Flats run(const Progress& progress) {
    std::vector<VertexId> without_step;
    for (std::size_t v = 0; v < mesh_.vertex_count(); ++v) {
      if (drained_[v] == 0) without_step.push_back(VertexId{v});
    }
    if (!mesh_.same()) {
      std::sort(without_step.begin(), without_step.end(),
                [&](VertexId v, VertexId w) { return mesh_.given(v) < mesh_.given(w); });
    }
    for (std::size_t i = 0; i < without_step.size(); ++i) {
      const VertexId v = without_step[i];
      if (i % kBlock == 0) progress.check();
      if (is_settled(v) || !steps_[v.index()].edge.valid()) continue;
      walk(v);
      front_.empty() ? add_pit() : rank_plateau();
    }
    return std::move(flats_);
  }

 private:
  [[nodiscard]] bool is_settled(VertexId v) const {
    return drained_[v.index()] != 0 || flats_.rank[v.index()] != 0 || flats_.pit[v.index()] != kNoPit;
  }

  template <class Visit>
  void for_each_neighbour(VertexId v, const Visit& visit) const {
    mesh_.for_each_neighbour(v, steps_[v.index()].edge, visit);
  }

  // Up to the vertices that drain, which go to `front_`: other parts of the plateau may meet them too.
  void walk(VertexId start) {
    const double height = mesh_.height(start);
    plateau_.assign(1, start);
    front_.clear();
    if (steps_[start.index()].squared_slope == kRises) return;
    flats_.rank[start.index()] = kWaiting;
    for (std::size_t next = 0; next < plateau_.size(); ++next) {
      for_each_neighbour(plateau_[next], [&](VertexId w, HalfedgeId) {
        if (mesh_.height(w) != height) return;
        if (drained_[w.index()] != 0) {
          front_.push_back(w);
        } else if (flats_.rank[w.index()] == 0) {
          flats_.rank[w.index()] = kWaiting;
          plateau_.push_back(w);
        }
      });
    }
  }

  void add_pit() {
    PitSite site{.vertex = plateau_.front(), .vertices = static_cast<std::uint32_t>(plateau_.size())};
    bool on_rim = false, lake = false;
    for (const VertexId v : plateau_) {
      if (mesh_.point(v) < mesh_.point(site.vertex)) site.vertex = v;
      on_rim |= flats_.on_rim[v.index()] != 0;
      flats_.rank[v.index()] = 0;
      flats_.pit[v.index()] = static_cast<std::uint32_t>(flats_.pits.size());
      if (plateau_.size() == 1) continue;
      for_each_neighbour(v, [&](VertexId w, HalfedgeId edge) {
        lake |= mesh_.height(w) == mesh_.height(v) && has(mesh_.kind(edge), EdgeKind::Lake);
      });
    }
    site.kind = on_rim ? PitKind::Boundary : lake ? PitKind::Lake : PitKind::Interior;
    flats_.pits.push_back(site);
  }

  [[nodiscard]] VertexId toward(VertexId v) const {
    const HalfedgeId edge = steps_[v.index()].edge;
    return mesh_.origin(edge) == v ? mesh_.target(edge) : mesh_.origin(edge);
  }

  // `front_` holds all vertices of one rank.
  void rank_plateau() {
    const double height = mesh_.height(plateau_.front());
    for (std::uint32_t rank = 1; !front_.empty(); ++rank) {
      reached_.clear();
      for (const VertexId v : front_) {
        for_each_neighbour(v, [&](VertexId w, HalfedgeId edge) {
          if (mesh_.height(w) != height) return;
          std::uint32_t& known = flats_.rank[w.index()];
          const VertexStep step{.edge = edge, .kind = VertexStep::Kind::Edge};
          if (known == kWaiting) {
            known = rank;
            steps_[w.index()] = step;
            reached_.push_back(w);
          } else if (known == rank && mesh_.point(v) < mesh_.point(toward(w))) {
            steps_[w.index()] = step;
          }
        });
      }
      std::swap(front_, reached_);
    }
  }

  const FlowMesh& mesh_;
  std::span<VertexStep> steps_;
  Flats flats_;
  RawVector<std::uint8_t> drained_;
  std::vector<VertexId> plateau_, front_, reached_;
};

}  // namespace

Flats resolve_flats(const FlowMesh& mesh, std::span<const VertexId> outlets, std::span<const HalfedgeId> rim,
                    std::span<VertexStep> steps, const Progress& progress) {
  return Resolver(mesh, outlets, rim, steps, progress).run(progress);
}

}  // namespace thalweg
