// Why the rim is enough. A counter-clockwise triangle winds once around each point inside it and not at all
// around a point outside, so the number of triangles that cover a point off all edges is the sum of their
// boundaries' winding numbers. Where two triangles share an edge it cancels; what remains is the winding
// number of the rim. So triangles overlap if and only if the rim winds twice around some point.
//
// If rim edges meet at common ends only, that number is constant between them, and it grows by one from the
// right of each edge to its left. So it stays within 0 and 1 if and only if each edge has 0 on its right:
// that is, if along every vertical line the edges' surfaced sides match, starting with 0 below the lowest.
//
// An inner vertex of the surface needs no look: its triangles cover a neighbourhood, and whatever else
// touches it there overlaps with them. So vertices can lie on foreign edges, or on each other, only at the
// rim.
//
// 1. Sweep from left to right (equal x: upwards), with the edges under the sweep line in a balanced tree
//    (Shamos and Hoey, Geometric intersection problems, 1976). Neighbours in the tree are tested for a
//    common point, exactly.
// 2. An edge that meets another one is reported and left out of the tree, so that the order in it stays
//    sound; the surfaced sides are compared as long as nothing was left out.
#include "mesh/rim_sweep.hpp"

#include <thalweg/geometry/predicates.hpp>

#include <algorithm>
#include <iterator>
#include <optional>
#include <set>
#include <tuple>

namespace thalweg {

namespace {

using Kind = RimFinding::Kind;

struct Segment {
  Point2 left;
  Point2 right;
  RimEdge edge;
  bool surface_above = false;
};

using SegmentIndex = std::uint32_t;

// Order of segments under the sweep line, bottom up. Pre: they do not cross.
struct Below {
  using is_transparent = void;
  const std::vector<Segment>* segments;

  bool operator()(SegmentIndex i, SegmentIndex j) const {
    if (i == j) return false;
    const Segment& s = (*segments)[i];
    const Segment& t = (*segments)[j];
    return s.left <= t.left ? side(s, t) > 0 : side(t, s) < 0;
  }
  bool operator()(SegmentIndex i, Point2 p) const { return side(i, p) > 0; }
  bool operator()(Point2 p, SegmentIndex i) const { return side(i, p) < 0; }

  [[nodiscard]] int side(SegmentIndex i, Point2 p) const {
    return orientation((*segments)[i].left, (*segments)[i].right, p);
  }
  static int side(const Segment& s, const Segment& later) {
    const int sign = orientation(s.left, s.right, later.left);
    return sign != 0 ? sign : orientation(s.left, s.right, later.right);
  }
};

bool has_end(const Segment& s, Point2 p) {
  return s.left == p || s.right == p;
}

// The one end of `s` that lies within t, if any.
std::optional<VertexId> end_within(const Segment& s, const Segment& t) {
  const bool forward = s.surface_above;
  if (!has_end(t, s.left) && on_segment(t.left, t.right, s.left)) return forward ? s.edge.from : s.edge.to;
  if (!has_end(t, s.right) && on_segment(t.left, t.right, s.right)) return forward ? s.edge.to : s.edge.from;
  return std::nullopt;
}

class Sweep {
 public:
  Sweep(std::span<const Point2> xy, std::span<const RimEdge> rim, std::span<const VertexId> isolated) {
    segments_.reserve(rim.size());
    events_.reserve(2 * rim.size() + isolated.size());
    for (const RimEdge& e : rim) {
      const Point2 from = xy[e.from.index()];
      const Point2 to = xy[e.to.index()];
      const bool forward = from < to;
      const auto index = static_cast<SegmentIndex>(segments_.size());
      segments_.push_back({forward ? from : to, forward ? to : from, e, forward});
      events_.push_back({from, forward ? Step::Start : Step::End, index, e.from});
      events_.push_back({to, forward ? Step::End : Step::Start, index, e.to});
    }
    for (const VertexId v : isolated) events_.push_back({xy[v.index()], Step::Isolated, 0, v});
    std::sort(events_.begin(), events_.end());
    places_.assign(segments_.size(), tree_.end());
  }

  std::vector<RimFinding> run() && {
    for (auto first = events_.begin(); first != events_.end();) {
      auto last = first;
      while (last != events_.end() && last->at == first->at) ++last;
      visit({first, last});
      first = last;
    }
    return std::move(findings_);
  }

 private:
  enum class Step : std::uint8_t { End, Start, Isolated };
  struct Event {
    Point2 at;
    Step step;
    SegmentIndex segment;
    VertexId vertex;
    bool operator<(const Event& other) const {
      return std::tie(at, step, vertex, segment) <
             std::tie(other.at, other.step, other.vertex, other.segment);
    }
  };
  using Tree = std::set<SegmentIndex, Below>;

  // All that happens at one position.
  void visit(std::span<const Event> events) {
    for (const Event& e : events) {
      if (e.vertex == events.front().vertex) continue;
      add({Kind::SamePosition, {events.front().vertex, {}}, {e.vertex, {}}});
      complete_ = false;
      break;
    }
    for (const Event& e : events) {
      if (e.step == Step::End) remove(e.segment);
      if (e.step == Step::Start) insert(e.segment);
    }
    for (const Event& e : events) {
      if (e.step == Step::Start && complete_) compare_sides(e.segment);
    }
    if (events.front().step == Step::Isolated) locate(events.front());
  }

  void remove(SegmentIndex s) {
    const Tree::iterator place = places_[s];
    if (place == tree_.end()) return;
    places_[s] = tree_.end();
    const Tree::iterator above = tree_.erase(place);
    if (above == tree_.begin() || above == tree_.end()) return;
    if (meet(*std::prev(above), *above)) leave_out(*above);
  }

  void insert(SegmentIndex s) {
    const auto [place, is_new] = tree_.insert(s);
    if (!is_new) {  // on one line with the other
      meet(*place, s);
      complete_ = false;
      return;
    }
    places_[s] = place;
    const bool meets_lower = place != tree_.begin() && meet(*std::prev(place), s);
    const bool meets_upper = std::next(place) != tree_.end() && meet(*std::next(place), s);
    if (meets_lower || meets_upper) leave_out(s);
  }

  void leave_out(SegmentIndex s) {
    tree_.erase(places_[s]);
    places_[s] = tree_.end();
    complete_ = false;
  }

  // The edges at a vertex find the same; once is enough.
  void add(const RimFinding& finding) {
    if (findings_.empty() || findings_.back() != finding) findings_.push_back(finding);
  }

  // Reports what two segments have in common apart from ends.
  bool meet(SegmentIndex i, SegmentIndex j) {
    const Segment& s = segments_[i];
    const Segment& t = segments_[j];
    if (const auto v = end_within(s, t)) {
      add({Kind::VertexOnEdge, t.edge, {*v, {}}});
    } else if (const auto w = end_within(t, s)) {
      add({Kind::VertexOnEdge, s.edge, {*w, {}}});
    } else if (cross_properly(s.left, s.right, t.left, t.right)) {
      add({Kind::EdgesCross, s.edge, t.edge});
    } else {
      return false;
    }
    return true;
  }

  void compare_sides(SegmentIndex s) {
    const Tree::iterator place = places_[s];
    const Tree::iterator above = std::next(place);
    const bool covered_below = place != tree_.begin() && segments_[*std::prev(place)].surface_above;
    const bool covered_above = above != tree_.end() && !segments_[*above].surface_above;
    const bool surface_above = segments_[s].surface_above;
    if (covered_below == !surface_above && covered_above == surface_above) return;
    const SegmentIndex other = covered_below != !surface_above && place != tree_.begin() ? *std::prev(place)
                               : above != tree_.end()                                    ? *above
                                                                                         : s;
    add({Kind::EdgeOnSurface, segments_[s].edge, segments_[other].edge});
    complete_ = false;
  }

  void locate(const Event& e) {
    const Tree::iterator above = tree_.lower_bound(e.at);
    if (above == tree_.end()) return;
    if (tree_.key_comp().side(*above, e.at) == 0) {
      add({Kind::VertexOnEdge, segments_[*above].edge, {e.vertex, {}}});
    } else if (!segments_[*above].surface_above && complete_) {
      add({Kind::VertexOnSurface, segments_[*above].edge, {e.vertex, {}}});
    }
  }

  std::vector<Segment> segments_;
  std::vector<Event> events_;
  Tree tree_{Below{&segments_}};
  std::vector<Tree::iterator> places_;
  std::vector<RimFinding> findings_;
  bool complete_ = true;
};

}  // namespace

std::vector<RimFinding> sweep_rim(std::span<const Point2> xy, std::span<const RimEdge> rim,
                                  std::span<const VertexId> isolated) {
  return Sweep(xy, rim, isolated).run();
}

}  // namespace thalweg
