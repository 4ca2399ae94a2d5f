// Sweeps instead of pairs.
//
// Based on: R. I. Silveira, M. van Kreveld, Towards a Definition of Higher Order Constrained Delaunay
// Triangulations, 2009, section 3 and Table 1. A vertex inside lies beyond exactly one side uv, so there is a
// sweep for each side, from the corner w opposite to it; one sweep for all three would change its eye.
//
// 1. The view from w beyond uv: of a sight line that is blocked, the part from w to the first obstacle is in
//    ground that the flood reached, so that obstacle is an edge that the flood met, or an end of one that was
//    reached. These are all that the sweep needs. The same for lines from a vertex beyond uv through t.
// 2. The views from u and v run beside t, over ground that the flood need not reach: they take all that is in
//    the disc, by a flood through every edge. Where the ground is a polygon it may fall apart in the disc, so
//    that flood starts from all faces at the corners, in one of which a line of sight begins. Lines may also
//    run all the way outside of the polygon, past nothing: those that leave the corner into no fan of it are
//    dropped.
// 3. SeesTriang: p that sees w counts. So does p that sees u if no edge that blocks leaves u strictly between
//    the directions of v and p: nothing touches the segment from u to p between its ends, and edges that end
//    in p shade no more than a ray, so p sees the points of uv near u. The same at v. SeesVtx: the same of
//    those that see a corner. Who is left is looked at alone: gaps of its view first, as long as they are
//    few, then the shadows on uv, sorted (sights.cpp). ConfEdge: a sweep from the vertex through uv; any
//    vertex that it sees in another cap will do, if there is one.
// 4. EmptyQuad: p sees u and v, and triangle uvp is empty. By angle at u, then by distance from u: p is empty
//    if its angle at v is smaller than all before it.
// 5. Over simple polygons walks along the dual tree give each view (polygon_view.cpp) and all that sees a
//    side, and between which lines (side_view.cpp; section 5 and Table 2). A triangle uvp whose sides run on
//    the ground then holds no vertex (Lemma 2).
// 6. ConfEdge there: of the vertices that see a side, those that see somebody through it (through_sweep.cpp).
#include "order/sweep_count.hpp"

#include <algorithm>
#include <iterator>

namespace thalweg::detail {

namespace {

// Each edge once.
std::vector<HalfedgeId> distinct(const Tin& tin, std::span<const HalfedgeId> edges) {
  std::vector<HalfedgeId> list;
  list.reserve(edges.size());
  for (const HalfedgeId h : edges) {
    const HalfedgeId twin = tin.twin(h);
    list.push_back(twin.valid() ? std::min(h, twin) : h);
  }
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
  return list;
}

void assign_sorted(std::vector<VertexId>& list, std::span<const VertexId> from) {
  list.assign(from.begin(), from.end());
  std::sort(list.begin(), list.end());
}

std::vector<VertexId> common(const std::vector<VertexId>& a, const std::vector<VertexId>& b) {
  std::vector<VertexId> both;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return both;
}

/// A fan of faces at a vertex, from its first to its last edge.
struct Fan {
  Point2 first, last;
};

std::vector<Fan> fans_at(const Ground& ground, VertexId eye) {
  const Tin& tin = ground.tin();
  std::vector<Fan> fans;
  for (const HalfedgeId start : tin.outgoing(eye)) {
    if (!tin.on_rim(start)) continue;
    HalfedgeId h = start;
    while (!tin.on_rim(Tin::previous(h))) h = tin.twin(Tin::previous(h));
    fans.push_back({ground.point(tin.target(start)), ground.point(tin.apex(h))});
  }
  return fans;
}

bool in_fan(Point2 eye, const Fan& fan, Point2 p) {
  const bool left_of_first = orientation(eye, fan.first, p) >= 0;
  const bool right_of_last = orientation(eye, p, fan.last) >= 0;
  const int turn = orientation(eye, fan.first, fan.last);
  if (turn == 0) return left_of_first;
  return turn > 0 ? left_of_first && right_of_last : left_of_first || right_of_last;
}

void drop_outside(const Ground& ground, VertexId eye, std::vector<VertexId>& list) {
  if (ground.mode() != GroundMode::Polygon) return;
  const std::vector<Fan> fans = fans_at(ground, eye);
  if (fans.empty()) return;
  std::erase_if(list, [&](VertexId p) {
    return std::none_of(fans.begin(), fans.end(),
                        [&](const Fan& fan) { return in_fan(ground.point(eye), fan, ground.point(p)); });
  });
}

bool needs_all(OrderDefinition definition) {
  return definition != OrderDefinition::SeesOpp && definition != OrderDefinition::ConfEdge;
}

/// The first edge that blocks at u, turning from v by `turn` (+1: counter-clockwise) by less than half a
/// turn; v if there is none.
VertexId first_blocking(const Ground& ground, VertexId u, VertexId v, int turn) {
  const Tin& tin = ground.tin();
  VertexId first = v;
  const auto consider = [&](HalfedgeId h, VertexId end) {
    if (!ground.blocks(h) || orientation(ground.point(u), ground.point(v), ground.point(end)) != turn) return;
    if (first == v || orientation(ground.point(u), ground.point(end), ground.point(first)) == turn)
      first = end;
  };
  for (const HalfedgeId h : tin.outgoing(u)) {
    consider(h, tin.target(h));
    if (tin.on_rim(Tin::previous(h))) consider(Tin::previous(h), tin.apex(h));
  }
  return first;
}

/// Where all that is inside lies beyond one side, a vertex conflicts with the opposite corner only.
OrderDefinition same_if_alone(OrderDefinition definition) {
  return definition == OrderDefinition::ConfEdge ? OrderDefinition::SeesOpp : definition;
}

bool right_of(const Ground& ground, VertexId u, VertexId v, VertexId p) {
  return orientation(ground.point(u), ground.point(v), ground.point(p)) < 0;
}

}  // namespace

std::span<const VertexId> SweepCount::count(const Ground& ground, const Triangle& corners, TriangleId start,
                                            OrderDefinition definition, const Flood& reached) {
  corners_ = corners;
  counted_.clear();
  inside_ = reached.inside();
  edges_ = distinct(ground.tin(), reached.barriers());
  for (std::size_t side = 0; side < 3; ++side) {
    beyond_[side].clear();
    for (const VertexId p : inside_) {
      if (right_of(ground, corners[side], corners[(side + 1) % 3], p)) beyond_[side].push_back(p);
    }
    std::sort(beyond_[side].begin(), beyond_[side].end());
  }
  disc_ = Circumdisc(ground.point(corners[0]), ground.point(corners[1]), ground.point(corners[2]));
  if (needs_all(definition) && !ground.simple_polygons()) {
    all_.start(ground, corners, start, Barrier::None);
    if (ground.mode() == GroundMode::Polygon) {
      for (const VertexId corner : corners) {
        for (const HalfedgeId h : ground.tin().outgoing(corner)) all_.start_also(Tin::triangle_of(h));
      }
    }
    all_.spread();
    all_edges_ = distinct(ground.tin(), all_.barriers());
  }
  for (std::size_t side = 0; side < 3; ++side) {
    if (beyond_[side].empty()) continue;
    const bool alone = beyond_[side].size() == inside_.size();
    if (definition == OrderDefinition::ConfEdge && ground.simple_polygons() && !alone) {
      add_conflicts(ground, side);
    } else {
      at_side(ground, alone ? same_if_alone(definition) : definition, side);
    }
  }
  return counted_;
}

// What the eye sees of the points, over simple polygons of all in the disc; sorted.
void SweepCount::view(const Ground& ground, VertexId eye, ViewSweep::HalfPlane half,
                      std::span<const VertexId> points, std::span<const HalfedgeId> edges,
                      std::vector<VertexId>& seen) {
  if (ground.simple_polygons()) {
    assign_sorted(seen, polygon_view_.look(ground, disc_, eye));
  } else {
    assign_sorted(seen, sweep_.look(ground, eye, half, points, edges));
    drop_outside(ground, eye, seen);
  }
}

void SweepCount::at_side(const Ground& ground, OrderDefinition definition, std::size_t side) {
  const VertexId u = corners_[side], v = corners_[(side + 1) % 3], w = corners_[(side + 2) % 3];
  const bool by_light = definition == OrderDefinition::SeesTriang || definition == OrderDefinition::SeesVtx ||
                        definition == OrderDefinition::ConfEdge;
  if (by_light && ground.simple_polygons()) {
    assign_sorted(in_light_, side_view_.look(ground, disc_, u, v));
    in_light_ = common(in_light_, beyond_[side]);
    if (definition == OrderDefinition::SeesTriang) {
      counted_.insert(counted_.end(), in_light_.begin(), in_light_.end());
      return;
    }
  }
  if (definition != OrderDefinition::EmptyQuad) {
    view(ground, w, {v, -1}, beyond_[side], edges_, from_corner_);
    seen_ = common(from_corner_, beyond_[side]);
  }
  if (needs_all(definition)) {
    all_beyond_.clear();
    if (!ground.simple_polygons()) {
      std::copy_if(all_.inside().begin(), all_.inside().end(), std::back_inserter(all_beyond_),
                   [&](VertexId p) { return right_of(ground, u, v, p); });
    }
    view(ground, u, {v, -1}, all_beyond_, all_edges_, from_start_);
    view(ground, v, {u, 1}, all_beyond_, all_edges_, from_end_);
  }
  if (definition == OrderDefinition::Sees3vtx) seen_ = common(seen_, common(from_start_, from_end_));
  if (definition == OrderDefinition::EmptyQuad) {
    seen_ = common(beyond_[side], common(from_start_, from_end_));
    if (!ground.simple_polygons()) keep_empty(ground, u, v, seen_);
  }
  counted_.insert(counted_.end(), seen_.begin(), seen_.end());
  if (by_light) add_light(ground, definition, side);
}

// Of the vertices that do not see w those that count all the same.
void SweepCount::add_light(const Ground& ground, OrderDefinition definition, std::size_t side) {
  const VertexId u = corners_[side], v = corners_[(side + 1) % 3];
  const auto listed = [](const std::vector<VertexId>& list, VertexId p) {
    return std::binary_search(list.begin(), list.end(), p);
  };
  const bool by_corner = definition != OrderDefinition::ConfEdge;
  const VertexId edge_at_u = by_corner ? first_blocking(ground, u, v, -1) : v;
  const VertexId edge_at_v = by_corner ? first_blocking(ground, v, u, 1) : u;
  const auto sees_near = [&](VertexId p, VertexId corner, VertexId other, VertexId edge, int turn) {
    return edge == other || orientation(ground.point(corner), ground.point(edge), ground.point(p)) != turn;
  };
  for (const VertexId p : beyond_[side]) {
    if (listed(from_corner_, p)) continue;
    if (by_corner) {
      const bool sees_u = listed(from_start_, p), sees_v = listed(from_end_, p);
      if (definition == OrderDefinition::SeesVtx && !sees_u && !sees_v) continue;
      if ((sees_u && sees_near(p, u, v, edge_at_u, -1)) || (sees_v && sees_near(p, v, u, edge_at_v, 1))) {
        counted_.push_back(p);
        continue;
      }
    }
    const bool in_light =
        ground.simple_polygons() ? listed(in_light_, p) : side_sight_.sees_side(ground, p, u, v, edges_);
    if (!in_light) continue;
    if (definition == OrderDefinition::ConfEdge && !conflicts(ground, p, side)) continue;
    counted_.push_back(p);
  }
}

bool SweepCount::conflicts(const Ground& ground, VertexId p, std::size_t side) {
  const auto& across = beyond_[(side + 1) % 3];
  const auto& also_across = beyond_[(side + 2) % 3];
  const auto visible = sweep_.look(ground, p, {corners_[side], -1}, inside_, edges_);
  return std::any_of(visible.begin(), visible.end(), [&](VertexId r) {
    return std::binary_search(across.begin(), across.end(), r) ||
           std::binary_search(also_across.begin(), also_across.end(), r);
  });
}

// Over simple polygons.
void SweepCount::add_conflicts(const Ground& ground, std::size_t side) {
  const Triangle uvw{corners_[side], corners_[(side + 1) % 3], corners_[(side + 2) % 3]};
  lit_.clear();
  const auto seen = side_view_.look(ground, disc_, uvw[0], uvw[1]);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (!std::binary_search(beyond_[side].begin(), beyond_[side].end(), seen[i])) continue;
    lit_.push_back({seen[i], side_view_.bounds()[i]});
  }
  const auto seeing = through_sweep_.look(ground, disc_, uvw, lit_);
  counted_.insert(counted_.end(), seeing.begin(), seeing.end());
}

void SweepCount::keep_empty(const Ground& ground, VertexId u, VertexId v,
                            std::vector<VertexId>& candidates) const {
  const Point2 at_u = ground.point(u), at_v = ground.point(v);
  std::vector<VertexId> by_angle = all_beyond_;
  const auto at = [&](VertexId p) { return ground.point(p); };
  std::sort(by_angle.begin(), by_angle.end(), [&](VertexId a, VertexId b) {
    const int turn = orientation(at_u, at(a), at(b));
    return turn != 0 ? turn < 0 : orientation(at_v, at(a), at(b)) > 0;
  });
  std::vector<VertexId> empty;
  VertexId lowest;  // the smallest angle at v so far
  for (const VertexId p : by_angle) {
    if (lowest.valid() && orientation(at_v, ground.point(p), ground.point(lowest)) <= 0) continue;
    lowest = p;
    empty.push_back(p);
  }
  std::sort(empty.begin(), empty.end());
  candidates = common(candidates, empty);
}

}  // namespace thalweg::detail
