// Triangles of triangulations of order at most k.
//
// Where nothing blocks. Let uv be of use at order k, and s the vertex nearest to it on one side (pencil.cpp).
// Triangle uvs has order at most k, and so have all triangles of the greedy triangulation of uv, which are
// got by going on from us and sv until all edges are the ground's. Based on: Gudmundsson, Hammar, van
// Kreveld, Higher order Delaunay triangulations, 2002, Lemmas 3 and 4.
// 1. So every edge that is of use and none of the ground is a side of some empty triangle of order at most k
//    either at another such edge, with fewer steps to the ground, or at two edges of the ground, sx and sy.
//    Then s is all that xy cuts off on its side: what it crosses are edges of s, and these lead to at most k
//    vertices on the other side (pencil.cpp). So the neighbours of each vertex that are at most k + 1 apart
//    are looked at first, and then, in rounds, the sides of all triangles that are found.
// 2. An edge goes if its triangle with the nearest vertex on some side has a larger order. At each that stays
//    the empty triangles of order at most k are listed: their third corner is among the k + 1 nearest
//    vertices. A triangle that is none of the ground has such an edge.
#include "base/parallel.hpp"
#include "base/release.hpp"
#include "order/pencil.hpp"

#include <thalweg/geometry/predicates.hpp>
#include <thalweg/order/useful_triangles.hpp>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <iterator>

namespace thalweg {

namespace {

using detail::Pencil;

constexpr std::size_t kBlock = 512;

/// Two vertices, the smaller id in the upper half.
using EdgeKey = std::uint64_t;

EdgeKey key_of(VertexId a, VertexId b) {
  const auto [low, high] = std::minmax({a.value(), b.value()});
  return EdgeKey{low} << 32U | high;
}

class EdgeSearch {
 public:
  EdgeSearch(const Tin& ground, std::size_t max_order, Progress& progress)
      : ground_(ground),
        max_order_(max_order),
        progress_(progress),
        pencils_([&ground, max_order] { return Pencil(ground, max_order); }) {}

  std::vector<OrderTriangle> run() {
    std::vector<EdgeKey> now = start();
    std::vector<EdgeKey> known;
    Stretch stretch{0.1, 0.7};
    while (!now.empty()) {
      const std::vector<EdgeKey> fresh = look_at(now, stretch);
      std::vector<EdgeKey> both;
      std::set_union(known.begin(), known.end(), now.begin(), now.end(), std::back_inserter(both));
      known = std::move(both);
      now.clear();
      std::set_difference(fresh.begin(), fresh.end(), known.begin(), known.end(), std::back_inserter(now));
      stretch = {stretch.to, stretch.to + (1 - stretch.to) / 2};
    }
    return sorted();
  }

 private:
  /// Edges that cut off one vertex, ascending.
  std::vector<EdgeKey> start() {
    std::vector<std::vector<EdgeKey>> edges((ground_.vertex_count() + kBlock - 1) / kBlock);
    for_each_block(ground_.vertex_count(), kBlock, progress_, {0, 0.1},
                   [&](std::size_t begin, std::size_t end) {
                     std::vector<VertexId> around;
                     for (std::size_t s = begin; s < end; ++s) {
                       const bool closed = list_around(VertexId{s}, around);
                       for (std::size_t i = 0; i < around.size(); ++i) {
                         cut_off(VertexId{s}, around, i, closed, edges[begin / kBlock]);
                       }
                     }
                     sort_once(edges[begin / kBlock]);
                   });
    return joined(edges);
  }

  /// The neighbours of a vertex, counter-clockwise; whether they go all around it.
  bool list_around(VertexId s, std::vector<VertexId>& around) const {
    around.clear();
    const auto outgoing = ground_.outgoing(s);
    if (outgoing.empty()) return false;
    const auto rim =
        std::find_if(outgoing.begin(), outgoing.end(), [&](HalfedgeId h) { return ground_.on_rim(h); });
    const HalfedgeId first = rim == outgoing.end() ? outgoing.front() : *rim;
    for (HalfedgeId h = first;;) {
      around.push_back(ground_.target(h));
      const HalfedgeId last = Tin::previous(h);
      h = ground_.twin(last);
      if (h == first) return true;
      if (h.valid()) continue;
      around.push_back(ground_.origin(last));
      return false;
    }
  }

  /// The edges from one of the neighbours of s that cross edges at s alone.
  void cut_off(VertexId s, std::span<const VertexId> around, std::size_t i, bool closed,
               std::vector<EdgeKey>& edges) const {
    const std::size_t count = around.size();
    const std::size_t reach = std::min(max_order_ + 1, (closed ? count : count - i) - 1);
    const Point2 at = ground_.point(s), x = ground_.point(around[i]);
    for (std::size_t step = 2; step <= reach; ++step) {
      const VertexId other = around[(i + step) % count];
      const Point2 y = ground_.point(other);
      if (orientation(at, x, y) <= 0) return;
      bool alone = true;
      for (std::size_t between = 1; between < step && alone; ++between) {
        alone = orientation(x, y, ground_.point(around[(i + between) % count])) < 0;
      }
      if (alone) edges.push_back(key_of(around[i], other));
    }
  }

  /// Lists the triangles at the edges; returns their other sides, ascending.
  std::vector<EdgeKey> look_at(std::span<const EdgeKey> edges, Stretch stretch) {
    const std::size_t blocks = (edges.size() + kBlock - 1) / kBlock;
    std::vector<std::vector<EdgeKey>> fresh(blocks);
    std::vector<std::vector<OrderTriangle>> found(blocks);
    for_each_block(edges.size(), kBlock, progress_, stretch, [&](std::size_t begin, std::size_t end) {
      Pencil& pencil = pencils_.local();
      for (std::size_t i = begin; i < end; ++i) {
        const VertexId a{edges[i] >> 32U}, b{edges[i] & 0xffffffffU};
        list(pencil, a, b, found[begin / kBlock], fresh[begin / kBlock]);
      }
      sort_once(fresh[begin / kBlock]);
    });
    std::move(found.begin(), found.end(), std::back_inserter(found_));
    return joined(fresh);
  }

  static std::vector<EdgeKey> joined(std::vector<std::vector<EdgeKey>>& parts) {
    std::vector<EdgeKey> all;
    std::size_t count = 0;
    for (const std::vector<EdgeKey>& part : parts) count += part.size();
    all.reserve(count);
    for (std::vector<EdgeKey>& part : parts) {
      all.insert(all.end(), part.begin(), part.end());
      release(part);
    }
    tbb::parallel_sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }

  static void sort_once(std::vector<EdgeKey>& edges) {
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  }

  void list(Pencil& pencil, VertexId a, VertexId b, std::vector<OrderTriangle>& found,
            std::vector<EdgeKey>& fresh) const {
    if (!pencil.look_at(a, b)) return;
    for (const std::span<const Pencil::Beside> side : {pencil.left(), pencil.right()}) {
      const bool left = side.data() == pencil.left().data();
      for (std::size_t i = 0; i < side.size(); ++i) {
        const VertexId c = side[i].vertex;
        const auto order = pencil.order(side, i);
        if (!order || !pencil.is_empty(side, i)) continue;
        Triangle corners{left ? a : b, left ? b : a, c};
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        found.push_back({corners, static_cast<std::uint32_t>(*order)});
        fresh.push_back(key_of(a, c));
        fresh.push_back(key_of(b, c));
      }
    }
  }

  /// What was found, each once: into rows by the first corner, then within each.
  std::vector<OrderTriangle> sorted() {
    std::vector<std::size_t> first(ground_.vertex_count() + 1, 0);
    const auto visit_all = [&](const auto& visit) {
      for (const Triangle& corners : ground_.triangles()) visit(OrderTriangle{corners, 0});
      for (const std::vector<OrderTriangle>& part : found_) std::for_each(part.begin(), part.end(), visit);
    };
    visit_all([&](const OrderTriangle& t) { ++first[t.corners[0].index() + 1]; });
    for (std::size_t v = 0; v + 1 < first.size(); ++v) first[v + 1] += first[v];
    std::vector<OrderTriangle> by_corner(first.back());
    std::vector<std::size_t> next(first.begin(), first.end() - 1);
    visit_all([&](const OrderTriangle& t) { by_corner[next[t.corners[0].index()]++] = t; });
    release(found_);
    for_each_block(next.size(), kBlock, progress_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        std::sort(by_corner.begin() + static_cast<std::ptrdiff_t>(first[v]),
                  by_corner.begin() + static_cast<std::ptrdiff_t>(first[v + 1]));
      }
    });
    by_corner.erase(std::unique(by_corner.begin(), by_corner.end()), by_corner.end());
    return by_corner;
  }

  const Tin& ground_;
  std::size_t max_order_;
  Progress& progress_;
  tbb::enumerable_thread_specific<Pencil> pencils_;
  std::vector<std::vector<OrderTriangle>> found_;  ///< none of the ground
};

}  // namespace

std::vector<OrderTriangle> find_useful_triangles(const ConstrainedOrder& ground,
                                                 const OrderTriangleOptions& options, Progress& progress) {
  if (!ground.unconstrained() || options.definition == OrderDefinition::EmptyQuad) {
    return find_order_triangles(ground, options, progress);
  }
  return EdgeSearch(ground.ground(), options.max_order, progress).run();
}

}  // namespace thalweg
