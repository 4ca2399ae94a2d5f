// How triangles fall.
//
// 1. Triangles in batches: loops over columns, without branches, give for each side the sign of its fall
//    where rounding cannot change it, where the line of flow through the middle corner meets the side across,
//    and for each corner the steeper of its ways down in the triangle. As in the scalar functions, of which
//    these are copies, all operations are rounded correctly and none is fused, so the bits are the same.
//    Triangles whose angle at the lowest corner may let water round in a cycle (flow_channels.cpp) are
//    listed.
// 2. Triangles with a side that is not sure, or level, or ways that are equally steep, are looked at one by
//    one, by the exact predicate.
// 3. The steepest way down from each vertex is chosen: an edge, or the line of flow of a triangle over both
//    of whose sides at the vertex water enters. Ties: the end that is first by (x, y); so the order in which
//    ways are offered does not matter. Where there is none, it is noted if a neighbour is level. Triangles
//    come by their smallest vertex: each part of them chooses for the vertices that are smallest in it, and
//    keeps what it has for others until all parts are done.
#include "base/parallel.hpp"
#include "terrain/flow_graph.hpp"

#include <thalweg/geometry/slope.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace thalweg {

namespace {

constexpr std::size_t kPart = 1U << 15U;  // of triangles: few of them have vertices of another part
constexpr std::size_t kBatch = 128;       // columns of a page each would share the cache's sets
using Column = std::array<double, kBatch>;

/// Triangles with corners a, b, c; sides are ab, bc, ca. Of flags 1 is yes, 0 no.
struct Batch {
  std::array<Column, 3> x, y, z;
  std::array<Column, 3> fall;  ///< over each side: positive out, negative in, 0 not sure
  Column split_at, area;
  std::array<Column, 3> down;      ///< squared slope of each side that falls; else kLevel or kRises
  Column slope;                    ///< squared
  std::array<Column, 3> steepest;  ///< of both ways down from each corner
  std::array<Column, 3> crosses;   ///< that is the line of flow across the triangle, not the side
  Column doubt;   ///< there is no telling by these numbers how it falls, or which is steepest
  Column shape;   ///< the bits of a TriangleShape
  Column obtuse;  ///< one side is In, and the corner across is not the lowest of all
};

struct Corner {
  double x, y, z;
  [[nodiscard]] Point2 at() const { return {x, y}; }
};

/// As fall_across, with 0 where that would go on to its exact stage.
inline double sure_fall(const Corner& a, const Corner& b, const Corner& c) {
  const RoundedDeterminant fall = fall_across_rounded(a.at(), a.z, b.at(), b.z, c.at(), c.z);
  return std::abs(fall.value) > fall.doubt ? fall.value : 0;
}

inline double squared_slope(const Corner& a, const Corner& b) {
  const double x = b.x - a.x, y = b.y - a.y, z = b.z - a.z;
  return z * z / (x * x + y * y);
}

// Never at an end, whatever rounding says: then both sides have ground, and lines end where others begin.
inline double inner_share(double share) {
  constexpr double kLeast = 0x1p-50;
  const double bounded = std::min(std::max(share, kLeast), 1 - kLeast);
  return share == share ? bounded : 0.5;
}

// The choice is made before sanitizers are ready.
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__) && \
    !defined(__SANITIZE_ADDRESS__)
[[gnu::target_clones("default", "avx2", "avx512f")]]
#endif
void measure(Batch& batch) {
  // Loops of their own: all in one are too much for GCC 12 to make vector instructions of.
  const auto corners = [&batch](std::size_t i) {
    return std::array<Corner, 3>{Corner{batch.x[0][i], batch.y[0][i], batch.z[0][i]},
                                 Corner{batch.x[1][i], batch.y[1][i], batch.z[1][i]},
                                 Corner{batch.x[2][i], batch.y[2][i], batch.z[2][i]}};
  };
  for (std::size_t i = 0; i < kBatch; ++i) {
    const auto [a, b, c] = corners(i);
    batch.fall[0][i] = sure_fall(a, b, c);
    batch.fall[1][i] = sure_fall(b, c, a);
    batch.fall[2][i] = sure_fall(c, a, b);
  }
  for (std::size_t i = 0; i < kBatch; ++i) {
    const auto [a, b, c] = corners(i);
    const double ab = a.z == b.z ? kLevel : kRises, bc = b.z == c.z ? kLevel : kRises;
    const double ca = c.z == a.z ? kLevel : kRises;
    batch.down[0][i] = b.z < a.z ? squared_slope(a, b) : ab;
    batch.down[1][i] = c.z < b.z ? squared_slope(b, c) : bc;
    batch.down[2][i] = a.z < c.z ? squared_slope(c, a) : ca;
  }
  for (std::size_t i = 0; i < kBatch; ++i) {
    const auto [a, b, c] = corners(i);
    const double x1 = b.x - a.x, y1 = b.y - a.y, z1 = b.z - a.z;
    const double x2 = c.x - a.x, y2 = c.y - a.y, z2 = c.z - a.z;
    const double gx = z1 * y2 - z2 * y1, gy = x1 * z2 - x2 * z1, area = x1 * y2 - x2 * y1;
    batch.area[i] = area / 2;
    batch.slope[i] = (gx * gx + gy * gy) / (area * area);
    // Of three sides one is In and two are not, or the reverse: the odd one is split.
    const bool ab = batch.fall[0][i] < 0, bc = batch.fall[1][i] < 0, ca = batch.fall[2][i] < 0;
    const bool one = ab ^ bc ^ ca;
    const bool first = ab == one, second = bc == one;
    const auto turned = [&](double p, double q, double r) { return first ? p : (second ? q : r); };
    const double ox = turned(a.x, b.x, c.x), oy = turned(a.y, b.y, c.y);
    const double whole = gx * (turned(b.y, c.y, a.y) - oy) - gy * (turned(b.x, c.x, a.x) - ox);
    const double part = gx * (turned(c.y, a.y, b.y) - oy) - gy * (turned(c.x, a.x, b.x) - ox);
    batch.split_at[i] = part / whole;
  }
  for (std::size_t i = 0; i < kBatch; ++i) batch.split_at[i] = inner_share(batch.split_at[i]);
  for (std::size_t i = 0; i < kBatch; ++i) {
    const double a = batch.z[0][i], b = batch.z[1][i], c = batch.z[2][i];
    const double over_ab = c < std::min(a, b) ? 0.0 : 1.0, over_bc = a < std::min(b, c) ? 0.0 : 1.0;
    const double over_ca = b < std::min(c, a) ? 0.0 : 1.0;
    const double ab = batch.fall[0][i] < 0 ? 1.0 : 0.0, bc = batch.fall[1][i] < 0 ? 1.0 : 0.0;
    const double ca = batch.fall[2][i] < 0 ? 1.0 : 0.0, count = ab + bc + ca;
    const double low_corner = count == 1 ? 1.0 : 0.0, high_corner = count == 2 ? 1.0 : 0.0;
    batch.obtuse[i] = low_corner * (ab * over_ab + bc * over_bc + ca * over_ca);
    const double at_bc = bc == low_corner ? 64.0 : 128.0, split = ab == low_corner ? 0.0 : at_bc;
    batch.shape[i] = 42 - ab - 4 * bc - 16 * ca + split + 256 * low_corner;
    const double of_ab = batch.fall[0][i] == 0 ? 1.0 : 0.0, of_bc = batch.fall[1][i] == 0 ? 1.0 : 0.0;
    const double of_ca = batch.fall[2][i] == 0 ? 1.0 : 0.0;
    batch.doubt[i] = std::max(of_ab, std::max(of_bc, of_ca));
    // From the corner across the only side that is Out.
    batch.crosses[0][i] = high_corner * (1 - bc);
    batch.crosses[1][i] = high_corner * (1 - ca);
    batch.crosses[2][i] = high_corner * (1 - ab);
  }
}

/// Of the two ways down from each corner.
// The choice is made before sanitizers are ready.
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__) && \
    !defined(__SANITIZE_ADDRESS__)
[[gnu::target_clones("default", "avx2", "avx512f")]]
#endif
void find_steepest(Batch& batch) {
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < kBatch; ++i) {
      const double slope = batch.slope[i], across = batch.crosses[k][i] != 0 ? slope : kRises;
      batch.steepest[k][i] = across;
    }
    for (std::size_t i = 0; i < kBatch; ++i) {
      const double along = batch.down[k][i], across = batch.steepest[k][i], doubt = batch.doubt[i];
      const double over = across > along ? 1.0 : 0.0, under = across < along ? 1.0 : 0.0;
      const double none = along <= kLevel ? 1.0 : 0.0;
      batch.doubt[i] = over + under + none != 0 ? doubt : 1.0;
      batch.crosses[k][i] = over;
      batch.steepest[k][i] = across > along ? across : along;
    }
  }
}

/// A way down from a vertex.
struct Way {
  VertexId from;
  VertexStep step;
};

/// What a part of the triangles found.
struct Part {
  VertexId begin, end;    ///< the vertices for which it chooses
  std::vector<Way> ways;  ///< of others
  std::vector<TriangleId> obtuse;
  std::vector<HalfedgeId> rim;
};

class FallFinder {
 public:
  explicit FallFinder(FlowGraph& graph) : graph_(graph), mesh_(graph.mesh) {
    graph_.shape.resize(mesh_.triangle_count());
    graph_.strips.resize(mesh_.triangle_count());
    graph_.step.resize(mesh_.vertex_count());
  }

  void run(const Progress& progress) {
    const std::size_t count = mesh_.triangle_count();
    std::vector<Part> parts((count + kPart - 1) / kPart);
    for_each_block(count, kPart, progress, [&](std::size_t begin, std::size_t end) {
      Part& part = parts[begin / kPart];
      part.begin = begin == 0 ? VertexId{std::size_t{0}} : smallest_vertex(TriangleId{begin});
      part.end = end == count ? VertexId{mesh_.vertex_count()} : smallest_vertex(TriangleId{end});
      part.obtuse.resize(end - begin);
      std::size_t obtuse = 0;
      Batch batch{};
      for (std::size_t t = begin; t < end; t += kBatch) {
        const std::size_t stop = std::min(end, t + kBatch);
        load(t, stop, batch);
        measure(batch);
        find_steepest(batch);
        store(t, stop, batch, part);
        for (std::size_t i = t; i < stop; ++i) {
          part.obtuse[obtuse] = TriangleId{i};
          obtuse += integer(batch.obtuse[i - t]);
        }
      }
      part.obtuse.resize(obtuse);
      for (std::size_t h = 3 * begin; h < 3 * end; ++h) {
        if (mesh_.on_rim(HalfedgeId{h})) part.rim.push_back(HalfedgeId{h});
      }
    });
    for (const Part& part : parts) {
      for (const Way& way : part.ways) choose(way.from, way.step);
      graph_.rim.insert(graph_.rim.end(), part.rim.begin(), part.rim.end());
      graph_.obtuse.insert(graph_.obtuse.end(), part.obtuse.begin(), part.obtuse.end());
    }
    for (const HalfedgeId h : graph_.rim) offer_upwards(h);
    graph_.mesh.link_fans(graph_.rim);
  }

 private:
  [[nodiscard]] VertexId smallest_vertex(TriangleId t) const {
    const Triangle& c = mesh_.triangle(t);
    return std::min({c[0], c[1], c[2]});
  }

  void load(std::size_t begin, std::size_t end, Batch& batch) const {
    for (std::size_t t = begin; t < end; ++t) {
      const Triangle& corners = mesh_.triangle(TriangleId{t});
      for (std::size_t k = 0; k < 3; ++k) {
        const Point2 p = mesh_.point(corners[k]);
        batch.x[k][t - begin] = p.x;
        batch.y[k][t - begin] = p.y;
        batch.z[k][t - begin] = mesh_.height(corners[k]);
      }
    }
  }

  static unsigned integer(double value) { return static_cast<unsigned>(static_cast<int>(value)); }

  void store(std::size_t begin, std::size_t end, Batch& batch, Part& part) {
    for (std::size_t t = begin; t < end; ++t) {
      const std::size_t i = t - begin;
      graph_.strips[t] = {batch.split_at[i], batch.area[i]};
      graph_.shape[t] = shape_of(integer(batch.shape[i]));
      if (batch.doubt[i] != 0) {
        look_at(TriangleId{t}, batch, i, part);
        continue;
      }
      const Triangle& c = mesh_.triangle(TriangleId{t});
      for (unsigned side = 0; side < 3; ++side) {
        const double slope = batch.steepest[side][i];
        const unsigned crosses = integer(batch.crosses[side][i]);
        const std::array<unsigned, 2> edge = {side, kNextSide[side]};
        const std::array<VertexStep::Kind, 4> kind = {VertexStep::Kind::Stay, VertexStep::Kind::Stay,
                                                      VertexStep::Kind::Edge, VertexStep::Kind::Cross};
        offer(c[side],
              {slope, Tin::halfedge(TriangleId{t}, edge[crosses]), kind[(slope >= 0 ? 2 : 0) + crosses]},
              part);
      }
    }
  }

  static TriangleShape shape_of(unsigned bits) {
    return {.falls = static_cast<std::uint16_t>(bits & 63U),
            .split = static_cast<std::uint16_t>(bits >> 6U & 3U),
            .corner_is_low = static_cast<std::uint16_t>(bits >> 8U & 1U)};
  }

  /// The odd one of three sides is split.
  static TriangleShape shape_of(const std::array<Fall, 3>& fall) {
    constexpr std::array<std::uint8_t, 8> kSplit = {0, 0, 1, 2, 2, 1, 0, 0};
    unsigned falls = 0, which = 0;
    for (unsigned side = 0; side < 3; ++side) {
      falls |= static_cast<unsigned>(fall[side]) << (2 * side);
      which |= (fall[side] == Fall::In ? 1U : 0U) << side;
    }
    const bool one = which == 1 || which == 2 || which == 4;
    return {.falls = static_cast<std::uint16_t>(falls & 63U),
            .split = static_cast<std::uint16_t>(kSplit[which] & 3U),
            .corner_is_low = one};
  }

  void look_at(TriangleId t, Batch& batch, std::size_t i, Part& part) {
    if (batch.fall[0][i] == 0 || batch.fall[1][i] == 0 || batch.fall[2][i] == 0) {
      find_shape(t);
      batch.obtuse[i] = graph_.shape[t.index()].corner_is_low;  // not sure
    }
    const Triangle& c = mesh_.triangle(t);
    for (std::size_t side = 0; side < 3; ++side) {
      const double down = batch.down[side][i],
                   slope = down == down ? down : kLevel;  // wider than all numbers
      offer(c[side],
            {slope, Tin::halfedge(t, side), slope >= 0 ? VertexStep::Kind::Edge : VertexStep::Kind::Stay},
            part);
    }
    const TriangleShape shape = graph_.shape[t.index()];
    if (shape.level() || shape.corner_is_low != 0) return;
    const HalfedgeId across = Tin::halfedge(t, shape.split);
    offer(c[kPreviousSide[shape.split]], {batch.slope[i], across, VertexStep::Kind::Cross}, part);
  }

  void find_shape(TriangleId t) {
    const Triangle& c = mesh_.triangle(t);
    graph_.shape[t.index()] = {};
    if (mesh_.height(c[0]) == mesh_.height(c[1]) && mesh_.height(c[1]) == mesh_.height(c[2])) return;
    std::array<Fall, 3> fall{};
    for (std::size_t side = 0; side < 3; ++side) {
      const VertexId a = c[side], b = c[(side + 1) % 3], apex = c[(side + 2) % 3];
      const int sign = fall_across(mesh_.point(a), mesh_.height(a), mesh_.point(b), mesh_.height(b),
                                   mesh_.point(apex), mesh_.height(apex));
      fall[side] = sign > 0 ? Fall::Out : sign < 0 ? Fall::In : Fall::Along;
    }
    graph_.shape[t.index()] = shape_of(fall);
    Strip strip = graph_.strip_of(t);
    strip.at = inner_share(graph_.share_of(t, strip, mesh_.point(mesh_.apex(strip.split))));
    if (strip.corner_is_low && graph_.fall(Tin::next(strip.split)) == Fall::Along) {
      strip.at = 1;
    } else if (strip.corner_is_low && graph_.fall(Tin::previous(strip.split)) == Fall::Along) {
      strip.at = 0;
    }
    graph_.strips[t.index()].at = strip.at;
  }

  [[gnu::always_inline]] void offer(VertexId v, const VertexStep& step, Part& part) {
    if (v >= part.begin && v < part.end) {
      choose(v, step);
    } else {
      part.ways.push_back({v, step});
    }
  }

  // What falls against the direction of its only halfedge.
  void offer_upwards(HalfedgeId h) {
    const VertexId low = mesh_.origin(h), high = mesh_.target(h);
    if (mesh_.height(low) == mesh_.height(high)) choose(high, {kLevel, h, VertexStep::Kind::Stay});
    if (!(mesh_.height(low) < mesh_.height(high))) return;
    const Point2 p = mesh_.point(low), q = mesh_.point(high);
    const double slope = squared_slope({q.x, q.y, mesh_.height(high)}, {p.x, p.y, mesh_.height(low)});
    choose(high, {slope, h, VertexStep::Kind::Edge});
  }

  // Without a jump where they differ: which is steeper cannot be foreseen.
  [[gnu::always_inline]] void choose(VertexId v, const VertexStep& step) {
    VertexStep& best = graph_.step[v.index()];
    if ((step.squared_slope == best.squared_slope) & (step.squared_slope >= 0)) {
      if (!goes_before(v, best, step)) best = step;
      return;
    }
    const bool steeper = step.squared_slope > best.squared_slope;
    const std::uint32_t take = steeper ? 0xffffffffU : 0U;
    best.squared_slope = std::max(best.squared_slope, step.squared_slope);
    best.edge = HalfedgeId{(step.edge.value() & take) | (best.edge.value() & ~take)};
    const auto kind = [](const VertexStep& s) { return static_cast<std::uint32_t>(s.kind); };
    best.kind = static_cast<VertexStep::Kind>((kind(step) & take) | (kind(best) & ~take));
  }

  // Where both are equally steep.
  [[nodiscard]] bool goes_before(VertexId v, const VertexStep& a, const VertexStep& b) const {
    const Point2 p = end_of(v, a), q = end_of(v, b);
    if (p != q) return p < q;
    const HalfedgeId g = mesh_.given(mesh_.out_of(v, a.edge)), h = mesh_.given(mesh_.out_of(v, b.edge));
    return h < g || (g == h && a.kind == VertexStep::Kind::Cross);
  }

  [[nodiscard]] Point2 end_of(VertexId v, const VertexStep& step) const {
    if (step.kind == VertexStep::Kind::Edge) return mesh_.point(graph_.neighbour(v, step));
    return std::min(mesh_.point(mesh_.origin(step.edge)), mesh_.point(mesh_.target(step.edge)));
  }

  FlowGraph& graph_;
  const FlowMesh& mesh_;
};

}  // namespace

void find_falls(FlowGraph& graph, const Progress& progress) {
  FallFinder(graph).run(progress);
}

}  // namespace thalweg
