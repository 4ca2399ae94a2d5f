// The eight orders of one triangle.
//
// 1. Std: all vertices in the disc, by a flood through every edge; over a polygon, whose ground may fall
//    apart inside the disc, by rows of its vertices.
// 2. Pathcon: a flood that edges stop which block (flood.cpp). All other definitions count some of its
//    vertices: each sight line that they ask for lies in the disc, and joins the vertex to the interior of
//    the triangle. In particular none of them counts beyond a side that blocks, and no such vertex is
//    reached.
// 3. SeesOpp: what the corners see through the sides across from them (corner_views.cpp); where that takes
//    long, a flood, and a walk to the opposite vertex. It runs through the triangle, for the part of the disc
//    beyond a side is a cap that can be left only through that side. Sees3vtx and EmptyQuad count some of
//    what SeesOpp counts.
// 4. SeesTriang: where the flood takes long, the light from the sides (side_count.cpp), if it ends earlier:
//    both are tried in turns, each time much farther. Else seeing the opposite vertex is enough, or the gaps
//    of the view decide (sights.cpp). SeesVtx: also a walk to one of the corners.
// 5. ConfEdge: p counts if it sees the opposite vertex, or a vertex r in the cap of another side: from cap to
//    cap a segment always crosses the interior, and within a cap or to the ends of its side never. r itself
//    is reached.
// 6. Where the flood finds many vertices, all of them at once by angular sweeps (sweep_count.cpp).
// 7. Sees3vtx: three walks. EmptyQuad: exactly the p for which uvp is a valid triangle: then up and pv are
//    free or constraint edges, the triangle is empty, and p sees w across two triangles that nothing enters.
// 8. Of order 0 or 1, SeesVtx counts what SeesTriang does, and SeesOpp what ConfEdge does (Lemmas 5 and 6).
//    So up to a limit of 1 the corners' views decide these, too; a vertex that an end of a side sees, and not
//    the corner opposite, is asked for the side. Above it they tell that there are too many, or what the
//    sides see decides (side_count.cpp).
#include "order/corner_views.hpp"
#include "order/flood.hpp"
#include "order/occupancy.hpp"
#include "order/side_count.hpp"
#include "order/sights.hpp"
#include "order/sweep_count.hpp"
#include "order/vertex_rows.hpp"

#include <thalweg/base/assert.hpp>
#include <thalweg/order/constrained_order.hpp>

#include <algorithm>
#include <limits>

namespace thalweg {

using detail::Ground;

struct OrderWorkspace::Parts {
  detail::Flood flood;
  detail::Occupancy occupancy;
  detail::SideSight side_sight;
  detail::SweepCount sweeps;
  detail::CornerViews views;
  detail::SideCount side_count;
  std::vector<VertexId> undecided;
  std::vector<VertexId> counted;
};

OrderWorkspace::OrderWorkspace() : parts_(std::make_unique<Parts>()) {}
OrderWorkspace::~OrderWorkspace() = default;
OrderWorkspace::OrderWorkspace(OrderWorkspace&&) noexcept = default;
OrderWorkspace& OrderWorkspace::operator=(OrderWorkspace&&) noexcept = default;

struct ConstrainedOrder::Parts {
  Ground ground;
  std::optional<detail::VertexRows> rows;  ///< of a polygon
};

namespace {

/// Vertices inside up to which pairs are tested; the experiment: tests/bench/order/sweeps.md.
constexpr std::size_t kMostPairs = 256;

constexpr std::size_t kUnlimited = std::numeric_limits<std::size_t>::max();

/// Of a flood: what most discs of low order hold. Where they hold more, the corners' views may be far fewer.
constexpr std::size_t kFewFaces = 20;

/// Of light from a side. Where a flood takes more than a few it mostly ends before: most of the disc is dark.
constexpr std::size_t kLitFaces = 4096;

/// How much farther light and a flood go, in turns, until one of them ends.
constexpr std::size_t kFarther = 16;

/// Up to this limit the list of what is counted is searched.
constexpr std::size_t kMostSearched = 64;

/// Of vertices in view that are looked at one by one, after which a flood and sweeps cost less.
constexpr std::size_t kMostLooks = 64;

/// A vertex beyond one side of a triangle: u and v are the side's ends, the triangle to its left; w is
/// opposite.
struct Beyond {
  VertexId u, v, w;
};

Beyond side_of(const Ground& ground, const Triangle& corners, VertexId p) {
  for (std::size_t i = 0; i < 2; ++i) {
    const VertexId u = corners[i];
    const VertexId v = corners[i + 1];
    if (orientation(ground.point(u), ground.point(v), ground.point(p)) < 0)
      return {u, v, corners[(i + 2) % 3]};
  }
  return {corners[2], corners[0], corners[1]};
}

Triangle counter_clockwise(const Ground& ground, Triangle t) {
  if (orientation(ground.point(t[0]), ground.point(t[1]), ground.point(t[2])) < 0) std::swap(t[1], t[2]);
  return t;
}

/// Whether a vertex that Pathcon counts is counted by a definition that looks at it alone.
bool counts_alone(const Ground& ground, const Triangle& corners, VertexId p, OrderDefinition definition,
                  detail::SideSight& side_sight, detail::Occupancy& occupancy) {
  const auto [u, v, w] = side_of(ground, corners, p);
  switch (definition) {
    case OrderDefinition::Std:
    case OrderDefinition::Pathcon:
      return true;
    case OrderDefinition::SeesTriang:
      return ground.sees(p, w) || side_sight.sees_side(ground, p, u, v);
    case OrderDefinition::SeesVtx:
      return ground.sees(p, w) ||
             ((ground.sees(p, u) || ground.sees(p, v)) && side_sight.sees_side(ground, p, u, v));
    case OrderDefinition::ConfEdge:
    case OrderDefinition::SeesOpp:
      return ground.sees(p, w);
    case OrderDefinition::Sees3vtx:
      return ground.sees(p, w) && ground.sees(p, u) && ground.sees(p, v);
    case OrderDefinition::EmptyQuad:
      return occupancy.inspect(ground, {u, v, p}, detail::Inspection::FirstFault).fault ==
             TriangleFault::None;
  }
  return false;
}

/// The weakest definition that counts the same vertices where it counts at most one (preamble, 8).
OrderDefinition same_up_to_one(OrderDefinition definition) {
  switch (definition) {
    case OrderDefinition::SeesTriang:
      return OrderDefinition::SeesVtx;
    case OrderDefinition::ConfEdge:
      return OrderDefinition::SeesOpp;
    default:
      return definition;
  }
}

}  // namespace

ConstrainedOrder::ConstrainedOrder(const Tin& ground, GroundMode mode)
    : parts_(std::make_unique<Parts>(Parts{Ground(ground, mode), std::nullopt})) {
  if (mode == GroundMode::Polygon) parts_->rows.emplace(ground);
}
ConstrainedOrder::~ConstrainedOrder() = default;
ConstrainedOrder::ConstrainedOrder(ConstrainedOrder&&) noexcept = default;
ConstrainedOrder& ConstrainedOrder::operator=(ConstrainedOrder&&) noexcept = default;

const Tin& ConstrainedOrder::ground() const {
  return parts_->ground.tin();
}
GroundMode ConstrainedOrder::mode() const {
  return parts_->ground.mode();
}

bool ConstrainedOrder::unconstrained() const {
  return !parts_->ground.any_blocks();
}

TriangleValidity ConstrainedOrder::validity(const Triangle& triangle, OrderWorkspace& workspace) const {
  return workspace.parts_->occupancy.inspect(parts_->ground, triangle, detail::Inspection::Lowest);
}

bool ConstrainedOrder::is_valid(const Triangle& triangle, OrderWorkspace& workspace) const {
  return workspace.parts_->occupancy.inspect(parts_->ground, triangle, detail::Inspection::FirstFault)
             .fault == TriangleFault::None;
}

bool ConstrainedOrder::sees(VertexId p, VertexId q) const {
  return parts_->ground.sees(p, q);
}

void ConstrainedOrder::count_in_box(const Triangle& corners, std::size_t limit,
                                    std::vector<VertexId>& counted) const {
  const detail::Circumdisc disc(ground().point(corners[0]), ground().point(corners[1]),
                                ground().point(corners[2]));
  parts_->rows->visit_box(disc.box(), [&](VertexId v) {
    if (std::find(corners.begin(), corners.end(), v) != corners.end()) return true;
    if (disc.holds(ground().point(v))) counted.push_back(v);
    return counted.size() <= limit;
  });
}

bool ConstrainedOrder::views_help(OrderDefinition definition, std::size_t limit) const {
  switch (definition) {
    case OrderDefinition::SeesOpp:
    case OrderDefinition::Sees3vtx:
    case OrderDefinition::EmptyQuad:
      return parts_->ground.any_blocks();
    case OrderDefinition::SeesVtx:
      return parts_->ground.any_blocks() && limit <= kMostSearched;
    default:
      return false;
  }
}

// As count, by what the corners see. False if that takes too long.
bool ConstrainedOrder::count_by_views(const Triangle& corners, OrderDefinition definition, std::size_t limit,
                                      OrderWorkspace& workspace) const {
  const Ground& ground = parts_->ground;
  auto& [flood, occupancy, side_sight, sweeps, views, side_count, undecided, counted] = *workspace.parts_;
  const bool vtx = definition == OrderDefinition::SeesVtx;
  const bool fewer = definition == OrderDefinition::Sees3vtx || definition == OrderDefinition::EmptyQuad;
  counted.clear();
  views.start(ground, corners,
              vtx ? detail::CornerViews::Eyes::AllCorners : detail::CornerViews::Eyes::Opposite);
  std::size_t looks = 0;
  while (const auto view = views.next()) {
    const auto& [p, u, v, from_opposite] = *view;
    if (fewer && ++looks > kMostLooks) return false;
    if (fewer && !counts_alone(ground, corners, p, definition, side_sight, occupancy)) continue;
    if (!from_opposite) {
      if (std::find(counted.begin(), counted.end(), p) != counted.end()) continue;
      if (!side_sight.sees_side(ground, p, u, v)) continue;
    }
    counted.push_back(p);
    if (counted.size() > limit) return true;
  }
  return !views.gave_up();
}

// As count, under SeesTriang, SeesVtx or ConfEdge; under the last `counted` holds what SeesOpp counts. False
// if that takes long.
bool ConstrainedOrder::count_by_sides(const Triangle& corners, OrderDefinition definition,
                                      const Limits& limits, OrderWorkspace& workspace) const {
  std::vector<VertexId>& counted = workspace.parts_->counted;
  detail::SideCount& sides = workspace.parts_->side_count;
  const auto all = definition == OrderDefinition::ConfEdge
                       ? sides.conflicting(parts_->ground, corners, counted, limits.counted)
                       : sides.lit(parts_->ground, corners, limits.counted, limits.faces);
  if (!all) return false;
  counted.assign(all->begin(), all->end());
  if (definition == OrderDefinition::SeesVtx) {
    std::erase_if(counted, [&](VertexId p) {
      return std::none_of(corners.begin(), corners.end(),
                          [&](VertexId corner) { return parts_->ground.sees(p, corner); });
    });
  }
  return true;
}

// As count, by a flood from a face that the triangle overlaps. False if that takes more faces.
bool ConstrainedOrder::count_by_flood(const Triangle& corners, TriangleId start, OrderDefinition definition,
                                      const Limits& limits, OrderWorkspace& workspace) const {
  const Ground& ground = parts_->ground;
  auto& [flood, occupancy, side_sight, sweeps, views, side_count, undecided, counted] = *workspace.parts_;
  undecided.clear();
  counted.clear();
  const bool all = definition == OrderDefinition::Std || !ground.any_blocks();
  flood.start(ground, corners, start, all ? detail::Barrier::None : detail::Barrier::BlockingEdges);
  const bool may_sweep = !all && definition != OrderDefinition::Pathcon;
  if (limits.counted == kUnlimited && !flood.spread(limits.faces)) return false;
  while (const auto p = flood.next(limits.faces)) {
    if (may_sweep && flood.inside().size() > kMostPairs) {
      flood.spread();
      const auto found = sweeps.count(ground, corners, start, definition, flood);
      counted.assign(found.begin(), found.end());
      return true;
    }
    if (counts_alone(ground, corners, *p, definition, side_sight, occupancy)) {
      counted.push_back(*p);
      if (counted.size() > limits.counted) return true;
    } else {
      undecided.push_back(*p);
    }
  }
  if (!flood.ended()) return false;
  if (definition != OrderDefinition::ConfEdge) return true;
  for (const VertexId p : undecided) {
    const VertexId opposite = side_of(ground, corners, p).w;
    const bool conflicts = std::any_of(flood.inside().begin(), flood.inside().end(), [&](VertexId r) {
      return side_of(ground, corners, r).w != opposite && ground.sees(p, r);
    });
    if (conflicts) counted.push_back(p);
    if (counted.size() > limits.counted) return true;
  }
  return true;
}

// Leaves the vertices counted in the workspace; stops when there are more than `limit`.
void ConstrainedOrder::count(const Triangle& triangle, OrderDefinition definition, std::size_t limit,
                             OrderWorkspace& workspace) const {
  const Ground& ground = parts_->ground;
  const Triangle corners = counter_clockwise(ground, triangle);
  std::vector<VertexId>& counted = workspace.parts_->counted;
  counted.clear();
  if (definition == OrderDefinition::Std && parts_->rows) return count_in_box(corners, limit, counted);
  const auto start = ground.face_in_angle(corners[0], corners[1], corners[2]);
  THALWEG_ASSERT(start.has_value());
  if (!start) return;
  const TriangleId face = Tin::triangle_of(*start);
  const OrderDefinition weaker = same_up_to_one(definition);
  const bool same = weaker == definition || limit <= 1;
  if (same) definition = weaker;
  if (views_help(weaker, limit) && (same || limit != kUnlimited)) {
    if (count_by_flood(corners, face, definition, {limit, kFewFaces}, workspace)) return;
    if (count_by_views(corners, weaker, limit, workspace)) {
      if (same || counted.size() > limit) return;
      if (count_by_sides(corners, definition, {limit, kLitFaces}, workspace)) return;
    }
  }
  if (limit == kUnlimited && weaker == OrderDefinition::SeesVtx && ground.any_blocks()) {
    if (count_by_flood(corners, face, definition, {limit, kFewFaces}, workspace)) return;
    for (std::size_t faces = kLitFaces;; faces *= kFarther) {
      if (count_by_sides(corners, definition, {limit, faces}, workspace)) return;
      if (count_by_flood(corners, face, definition, {limit, faces}, workspace)) return;
    }
  }
  count_by_flood(corners, face, definition, {limit, kUnlimited}, workspace);
}

std::size_t ConstrainedOrder::order(const Triangle& triangle, OrderDefinition definition,
                                    OrderWorkspace& workspace) const {
  count(triangle, definition, kUnlimited, workspace);
  return workspace.parts_->counted.size();
}

bool ConstrainedOrder::at_most(const Triangle& triangle, OrderDefinition definition, std::size_t k,
                               OrderWorkspace& workspace) const {
  count(triangle, definition, k, workspace);
  return workspace.parts_->counted.size() <= k;
}

std::optional<std::size_t> ConstrainedOrder::order_up_to(const Triangle& triangle, OrderDefinition definition,
                                                         std::size_t k, OrderWorkspace& workspace) const {
  if (!at_most(triangle, definition, k, workspace)) return std::nullopt;
  return workspace.parts_->counted.size();
}

std::vector<VertexId> ConstrainedOrder::counted(const Triangle& triangle, OrderDefinition definition,
                                                OrderWorkspace& workspace) const {
  count(triangle, definition, kUnlimited, workspace);
  std::vector<VertexId> vertices = workspace.parts_->counted;
  std::sort(vertices.begin(), vertices.end());
  return vertices;
}

}  // namespace thalweg
