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
//    vertices. A triangle that is none of the ground has such an edge. One with a side that is of no use is
//    in no triangulation, and so are all at an edge that has none on one side.
// 3. Most edges that come up are of no use, and come up more than once. Those that meet for the first time in
//    a block are tried on the vertices at hand: at order 3 2.4 edges a random point are looked at,
//    and 1.5 are of use.
#include "base/parallel.hpp"
#include "base/release.hpp"
#include "order/pencil.hpp"
#include "order/stamped_map.hpp"

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
        searches_([&ground, max_order] { return Search{.pencil = Pencil(ground, max_order)}; }) {}

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
  /// The third corner of a triangle at an edge, and its order.
  struct Corner {
    VertexId vertex;
    std::uint32_t order = 0;
  };

  /// Of one thread: memory is reused from block to block.
  struct Search {
    Pencil pencil;
    detail::StampedMapOf<EdgeKey> seen = {};               ///< edges of the block: 1 if they may be of use
    std::vector<EdgeKey> fresh = {};                       ///< of these what may be of use
    std::vector<OrderTriangle> found = {};                 ///< in the block
    std::vector<Corner> left = {}, right = {};             ///< at the edge
    std::vector<VertexId> known = {};                      ///< vertices near the edge
    std::vector<VertexId> around = {}, around_other = {};  ///< neighbours of its ends, or of a vertex
  };

  /// Edges that cut off one vertex, ascending.
  std::vector<EdgeKey> start() {
    std::vector<std::vector<EdgeKey>> edges((ground_.vertex_count() + kBlock - 1) / kBlock);
    for_each_block(ground_.vertex_count(), kBlock, progress_, {0, 0.1},
                   [&](std::size_t begin, std::size_t end) {
                     Search& search = searches_.local();
                     for (std::size_t s = begin; s < end; ++s) {
                       const bool closed = list_around(VertexId{s}, search.around);
                       list_known(VertexId{s}, search);
                       for (std::size_t i = 0; i < search.around.size(); ++i)
                         cut_off(VertexId{s}, i, closed, search);
                     }
                     edges[begin / kBlock] = take_fresh(search);
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

  /// A vertex, its neighbours, and the vertices beyond the edges between these.
  void list_known(VertexId s, Search& search) const {
    search.known = search.around;
    search.known.push_back(s);
    for (const HalfedgeId h : ground_.outgoing(s)) {
      const HalfedgeId across = ground_.twin(Tin::next(h));
      if (across.valid()) search.known.push_back(ground_.apex(across));
    }
    std::sort(search.known.begin(), search.known.end());
    search.known.erase(std::unique(search.known.begin(), search.known.end()), search.known.end());
  }

  /// The edges from one of the neighbours of s that cross edges at s alone. One that crosses a single edge
  /// is found from both its ends; the smaller id has it.
  void cut_off(VertexId s, std::size_t i, bool closed, Search& search) const {
    const std::vector<VertexId>& around = search.around;
    const std::size_t count = around.size();
    const std::size_t all = (closed ? count : count - i) - 1;
    const std::size_t reach = max_order_ < all ? max_order_ + 1 : all;
    const Point2 at = ground_.point(s), x = ground_.point(around[i]);
    for (std::size_t step = 2; step <= reach; ++step) {
      const VertexId other = around[(i + step) % count];
      const Point2 y = ground_.point(other);
      if (orientation(at, x, y) <= 0) return;
      bool alone = step > 2 || s < around[(i + 1) % count];
      for (std::size_t between = 1; between < step && alone; ++between) {
        alone = orientation(x, y, ground_.point(around[(i + between) % count])) < 0;
      }
      if (alone) note(around[i], other, search);
    }
  }

  /// Lists the triangles at the edges; returns their other sides, ascending.
  std::vector<EdgeKey> look_at(std::span<const EdgeKey> edges, Stretch stretch) {
    const std::size_t blocks = (edges.size() + kBlock - 1) / kBlock;
    std::vector<std::vector<EdgeKey>> fresh(blocks);
    std::vector<std::vector<OrderTriangle>> found(blocks);
    for_each_block(edges.size(), kBlock, progress_, stretch, [&](std::size_t begin, std::size_t end) {
      Search& search = searches_.local();
      for (std::size_t i = begin; i < end; ++i) search.seen.insert(edges[i], 1);
      for (std::size_t i = begin; i < end; ++i) {
        list(VertexId{edges[i] >> 32U}, VertexId{edges[i] & 0xffffffffU}, search);
      }
      found[begin / kBlock] = search.found;
      search.found.clear();
      fresh[begin / kBlock] = take_fresh(search);
    });
    std::move(found.begin(), found.end(), std::back_inserter(found_));
    return joined(fresh);
  }

  /// An edge to look at; false, and it is not, if it is known to be of no use. Pre: it is none of the ground.
  static bool note(VertexId a, VertexId b, Search& search) {
    const EdgeKey key = key_of(a, b);
    if (const std::uint8_t* const known = search.seen.find(key)) return *known != 0;
    const bool may_be_of_use = search.pencil.may_be_of_use(a, b, search.known);
    search.seen.insert(key, may_be_of_use ? 1 : 0);
    if (may_be_of_use) search.fresh.push_back(key);
    return may_be_of_use;
  }

  /// Ascending; what was seen is forgotten.
  static std::vector<EdgeKey> take_fresh(Search& search) {
    std::sort(search.fresh.begin(), search.fresh.end());
    std::vector<EdgeKey> fresh = search.fresh;
    search.fresh.clear();
    search.seen.clear();
    return fresh;
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

  void list(VertexId a, VertexId b, Search& search) const {
    Pencil& pencil = search.pencil;
    if (!pencil.look_at(a, b)) return;
    list_corners(pencil, pencil.left(), search.left);
    list_corners(pencil, pencil.right(), search.right);
    if (search.left.empty() || search.right.empty()) return;
    search.known.assign({a, b});
    for (const std::span<const Pencil::Beside> side : {pencil.left(), pencil.right()}) {
      for (const Pencil::Beside& x : side) search.known.push_back(x.vertex);
    }
    list_around(a, search.around);
    list_around(b, search.around_other);
    const auto is_new = [](VertexId c, const std::vector<VertexId>& around) {
      return std::find(around.begin(), around.end(), c) == around.end();
    };
    const auto add = [&](VertexId from, VertexId to, const Corner& corner) {
      Triangle corners{from, to, corner.vertex};
      std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
      if (is_new(corner.vertex, search.around) && !note(a, corner.vertex, search)) return;
      if (is_new(corner.vertex, search.around_other) && !note(b, corner.vertex, search)) return;
      search.found.push_back({corners, corner.order});
    };
    for (const Corner& corner : search.left) add(a, b, corner);
    for (const Corner& corner : search.right) add(b, a, corner);
  }

  /// Third corners, on one side, of empty triangles of small enough order.
  static void list_corners(const Pencil& pencil, std::span<const Pencil::Beside> side,
                           std::vector<Corner>& corners) {
    corners.clear();
    for (std::size_t i = 0; i < side.size(); ++i) {
      const auto order = pencil.order(side, i);
      if (order && pencil.is_empty(side, i))
        corners.push_back({side[i].vertex, static_cast<std::uint32_t>(*order)});
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
  tbb::enumerable_thread_specific<Search> searches_;
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
