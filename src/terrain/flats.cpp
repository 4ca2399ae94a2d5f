// Plateaus.
//
// 1. In parallel: which vertices have a lower neighbour, a level one, lie on the rim. (Water that leaves a
//    vertex across a triangle runs towards a corner that is lower, so edges tell.)
// 2. From each vertex with neither walk its plateau through level edges. If none of it has a lower neighbour
//    or is an outlet, it is a pit.
// 3. If one has, a breadth-first search from all that have gives the others their rank; the next vertex on
//    the way is the first by (x, y) of those with the rank below, so ids do not matter.
#include "terrain/flats.hpp"

#include "base/parallel.hpp"

#include <algorithm>
#include <utility>

namespace thalweg {

namespace {

constexpr std::size_t kBlock = 8192;

/// Calls `visit(neighbour, halfedge of the edge)` for each neighbour; those on interior edges once.
template <class Visit>
void for_each_neighbour(const Tin& tin, VertexId v, const Visit& visit) {
  for (const HalfedgeId out : tin.outgoing(v)) {
    visit(tin.target(out), out);
    const HalfedgeId in = Tin::previous(out);
    if (tin.on_rim(in)) visit(tin.origin(in), in);
  }
}

class Resolver {
 public:
  Resolver(const Tin& tin, std::span<const VertexId> outlets) : tin_(tin) {
    const std::size_t n = tin.vertex_count();
    flats_.rank.assign(n, 0);
    flats_.toward.resize(n);
    flats_.pit.assign(n, kNoPit);
    flats_.on_rim.assign(n, 0);
    drained_.assign(n, 0);
    level_.assign(n, 0);
    for (const VertexId v : outlets) drained_[v.index()] = 1;
  }

  Flats run(const Progress& progress) {
    for_each_block(tin_.vertex_count(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) look_around(VertexId{v});
    });
    std::vector<std::uint8_t> visited(tin_.vertex_count(), 0);
    for (std::size_t i = 0; i < tin_.vertex_count(); ++i) {
      const VertexId v{i};
      if (drained_[i] != 0 || visited[i] != 0 || tin_.outgoing(v).empty()) continue;
      if (i % kBlock == 0) progress.check();
      plateau_.assign(1, v);
      visited[i] = 1;
      if (level_[i] != 0) walk(visited);
      settle();
    }
    return std::move(flats_);
  }

 private:
  void look_around(VertexId v) {
    const double height = tin_.height(v);
    for_each_neighbour(tin_, v, [&](VertexId w, HalfedgeId edge) {
      if (tin_.height(w) < height) drained_[v.index()] = 1;
      if (tin_.height(w) == height) level_[v.index()] = 1;
      if (tin_.on_rim(edge)) flats_.on_rim[v.index()] = 1;
    });
  }

  void walk(std::vector<std::uint8_t>& visited) {
    const double height = tin_.height(plateau_.front());
    for (std::size_t next = 0; next < plateau_.size(); ++next) {
      for_each_neighbour(tin_, plateau_[next], [&](VertexId w, HalfedgeId) {
        if (tin_.height(w) != height || visited[w.index()] != 0) return;
        visited[w.index()] = 1;
        plateau_.push_back(w);
      });
    }
  }

  void settle() {
    front_.clear();
    for (const VertexId v : plateau_) {
      if (drained_[v.index()] != 0) front_.push_back(v);
    }
    front_.empty() ? add_pit() : rank_plateau();
  }

  void add_pit() {
    PitSite site{.vertex = plateau_.front(), .vertices = static_cast<std::uint32_t>(plateau_.size())};
    bool on_rim = false, lake = false;
    for (const VertexId v : plateau_) {
      if (tin_.point(v) < tin_.point(site.vertex)) site.vertex = v;
      on_rim |= flats_.on_rim[v.index()] != 0;
      flats_.pit[v.index()] = static_cast<std::uint32_t>(flats_.pits.size());
      if (plateau_.size() == 1) continue;
      for_each_neighbour(tin_, v, [&](VertexId w, HalfedgeId edge) {
        lake |= tin_.height(w) == tin_.height(v) && has(tin_.kind(edge), EdgeKind::Lake);
      });
    }
    site.kind = on_rim ? PitKind::Boundary : lake ? PitKind::Lake : PitKind::Interior;
    flats_.pits.push_back(site);
  }

  // `front_` holds all vertices of one rank; those of rank 0 are marked by being drained.
  void rank_plateau() {
    const double height = tin_.height(plateau_.front());
    for (std::uint32_t rank = 1; !front_.empty(); ++rank) {
      reached_.clear();
      for (const VertexId v : front_) {
        for_each_neighbour(tin_, v, [&](VertexId w, HalfedgeId) {
          if (tin_.height(w) != height || drained_[w.index()] != 0) return;
          std::uint32_t& known = flats_.rank[w.index()];
          VertexId& toward = flats_.toward[w.index()];
          if (known == 0) {
            known = rank;
            toward = v;
            reached_.push_back(w);
          } else if (known == rank && tin_.point(v) < tin_.point(toward)) {
            toward = v;
          }
        });
      }
      std::swap(front_, reached_);
    }
  }

  const Tin& tin_;
  Flats flats_;
  std::vector<std::uint8_t> drained_, level_;
  std::vector<VertexId> plateau_, front_, reached_;
};

}  // namespace

Flats resolve_flats(const Tin& tin, std::span<const VertexId> outlets, const Progress& progress) {
  return Resolver(tin, outlets).run(progress);
}

}  // namespace thalweg
