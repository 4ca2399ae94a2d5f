// Which vertices can share a triangle of order at most k with u?
//
// 1. A side uv of a valid triangle runs free, or is a constraint edge: u sees v, past no vertex. All such v
//    are met by following the gaps of the view from u through the faces, cut at each vertex (as in
//    sights.cpp), nearest first or, where 5 holds, as they come. Edges at u that block part the ground around
//    it into fans, each searched alone: no valid triangle at u has such an edge inside.
// 2. Let t be a valid triangle at u with order <= k and disc D. Of the vertices x in D that u sees, many
//    must count:
//    a. Visible. Say x lies in the fan of t, less than half a turn from it. Then x counts under Pathcon, for
//       the segments xu and those of t leave u through one piece of the disc, and under SeesTriang and
//       SeesVtx: beside u, x sees points of the side of t beyond which it lies, and it sees u.
//    b. NearEnds. Say t = uvw in either turn, and x lies beyond uv. Segment xw crosses uv, at q, and from
//       there on runs through t. If an edge crosses xq, one of its ends lies in triangle uxq, for nothing
//       crosses the segments ux and uq; of these ends the one whose direction from u is nearest to v (the
//       nearest of them, on a tie) is seen by u. So x counts under SeesOpp if u sees no end of a constraint
//       edge, other than x itself, between the directions of v and x as near as q or x. If the angle at u is
//       the largest of t, then by the law of sines |uq| <= |ux| / sin 60. Beyond vw, x counts anyway, because
//       it sees u. With the largest angle at u, w lies 60 degrees or more from v to one side, and both within
//       a right angle of the direction of D's centre: so either w is to the left, all x up to 60 degrees left
//       of v count, farther left only ends beyond that are of weight, and the centre lies from 30 degrees
//       right to 90 degrees left of v; or the same the other way round. There must be no t of either kind.
// 3. A gap is given up when every disc through u and any place in the gap as far as its edge, or farther,
//    holds more than k vertices that count by 2: no v there has a triangle of order <= k with u. For 2b the
//    ends within reach of x must be known: gaps go by distance, so all nearer ends are, save those in gaps
//    given up, in whose directions certainty ends.
// 4. Inversion about u turns discs through u into half-planes: x lies in the disc through u and f with centre
//    in direction c exactly if x* c > f* c, where x* = x / |x|^2. The far part of a gap becomes a set that a
//    triangle with corners u, f1, f2 holds. So each x covers the directions c with (x* - f1) c > 0 and (x* -
//    f2) c > 0, and the gap is hopeless if all c that have f1 c > 0 or f2 c > 0 are covered more than k
//    times. What x covers is a convex cone: with two directions it covers all between them. So the sector of
//    all c is halved until more than k vertices cover both ends of each part, or some direction is found that
//    no more than k cover; that one is tried first on the gaps that come from this one. Most are settled by
//    the few nearest vertices, which come first.
// 5. Visible, where k is small: most gaps are given up, or gone on with, by disc_depth.cpp, which looks at
//    all directions c at once, and at the ends a, b of the gap's edge: if free segment uv crosses it, every
//    disc through u and v has a or b inside. (Edge ab has a circle that holds no vertex which sees a point of
//    its inside. The crossing of ab and uv sees u and v. If a, b were outside the one circle, and u, v
//    outside the other, the product of the lengths from the crossing to a and b would be at least, and at
//    most, that to u and v; equality is for the tie rule, which is a perturbation.) If a is one that counts,
//    a disc through u with a inside and at most k holds at most k - 1 beside it. NearEnds: the same tells
//    where a test would be in vain, for no more count than are seen.
// 6. This part alone, 3 to 5, is done in rounded arithmetic, with covers made smaller and discs larger by far
//    more than its errors: it decides what is searched, not what is found. What u sees is decided exactly.
//
// Where directions are compared they are measured by the diamond angle, which grows with the angle from 0 to
// 4 and by 1 a quarter turn.
#include "order/fan_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace thalweg::detail {

namespace {

constexpr double kWider = 1 + 1e-9;
// A gap is tested again once it is that much farther: few more are searched, and many tests saved.
constexpr double kFarther = 1.1;
// The same for gaps that disc_depth.cpp has not given up, from that many times the mean distance of the
// neighbours on: it is too coarse only for far and narrow gaps.
constexpr double kMuchFarther = 1.5;
constexpr double kFar = 2;
constexpr double kUnbounded = std::numeric_limits<double>::infinity();
constexpr double kPi = 3.14159265358979323846;

// For a heap with the nearest gap first.
constexpr auto kByDistance = [](const auto& a, const auto& b) { return a.distance > b.distance; };

}  // namespace

void FanSearch::start(const Ground& ground, VertexId u, std::size_t k, FanPruning pruning) {
  ground_ = &ground;
  u_ = u;
  at_ = ground.point(u);
  k_ = k;
  pruning_ = pruning;
  counting_ = pruning != FanPruning::None && k <= DiscDepth::kMostDepth;
  tabled_ = counting_ && pruning == FanPruning::Visible;
  fans_.clear();
  const auto around = ground.tin().outgoing(u);
  for (const HalfedgeId h : around) {
    if (starts_fan(h)) fans_.push_back(h);
  }
  closed_ = fans_.empty();
  if (closed_ && !around.empty()) fans_.push_back(around.front());
}

bool FanSearch::next_fan() {
  if (fans_.empty()) return false;
  const HalfedgeId first = fans_.back();
  fans_.pop_back();
  enter_fan(first);
  open_gaps(first);
  if (tabled_) {
    std::size_t next = 0;  // expanding adds more
    while (next < gaps_.size()) expand(Gap(gaps_[next++]));
  }
  while (!tabled_ && !gaps_.empty()) {
    std::pop_heap(gaps_.begin(), gaps_.end(), kByDistance);
    const Gap gap = gaps_.back();
    gaps_.pop_back();
    expand(gap);
  }
  collect();
  return true;
}

// Lists the neighbours of u in the fan.
void FanSearch::enter_fan(HalfedgeId first) {
  gaps_.clear();
  seen_.clear();
  behind_.clear();
  const Tin& tin = ground_->tin();
  const auto square = [&](VertexId v) {
    const Point2 p = ground_->point(v);
    return (p.x - at_.x) * (p.x - at_.x) + (p.y - at_.y) * (p.y - at_.y);
  };
  scale_ = square(tin.target(first));
  for (HalfedgeId h = first;;) {
    scale_ = std::min(scale_, square(tin.apex(h)));
    h = tin.twin(Tin::previous(h));
    if (!h.valid() || h == first || starts_fan(h)) break;
  }
  scale_ = std::sqrt(scale_);
  see(tin.target(first), 0);
  first_ = scaled({seen_[0].x, seen_[0].y}, 1 / seen_[0].distance);
  for (HalfedgeId h = first;;) {
    const HalfedgeId last = Tin::previous(h);
    h = tin.twin(last);
    if (h == first && closed_) break;
    const auto before = static_cast<std::uint32_t>(seen_.size() - 1);
    const VertexId v = tin.origin(last);
    const std::uint32_t fresh = see(v, std::max(seen_[before].turn, turn_of(before, ground_->point(v))));
    seen_[before].next = fresh;
    seen_[fresh].previous = before;
    if (!h.valid() || starts_fan(h)) break;
  }
  seen_.front().previous = static_cast<std::uint32_t>(seen_.size() - 1);
}

void FanSearch::open_gaps(HalfedgeId first) {
  const Tin& tin = ground_->tin();
  breadth_ = closed_ ? 2 * kPi : seen_.back().turn;
  narrow_ = closed_ || breadth_ < kPi;
  // One edge that blocks alone may be both sides of the fan.
  if (pruning_ == FanPruning::NearEnds && !closed_ && seen_.front().vertex == seen_.back().vertex) {
    seen_.back().slack = kUnbounded;
  }
  if (counting_) {
    counted_.clear();
    depth_.reset(k_, closed_, breadth_);
    for (std::uint32_t i = 0; i < seen_.size(); ++i) count(i);
  }
  far_ = 0;
  for (const Seen& seen : seen_) far_ += kFar * seen.distance / static_cast<double>(seen_.size());
  HalfedgeId h = first;
  for (std::uint32_t i = 0; i < seen_.size(); ++i) {
    if (!closed_ && i + 1 == seen_.size()) break;
    push(Tin::next(h), {.right = i, .left = seen_[i].next, .tested = tabled_ ? far_ : 0});
    h = tin.twin(Tin::previous(h));
  }
}

std::uint32_t FanSearch::see(VertexId v, double turn) {
  const Point2 p = ground_->point(v);
  Seen seen{.vertex = v, .x = p.x - at_.x, .y = p.y - at_.y};
  const double square = seen.x * seen.x + seen.y * seen.y;
  seen.distance = std::sqrt(square);
  seen.turn = turn;
  seen.inverse = {seen.x / square * scale_, seen.y / square * scale_};
  seen.slack = kCoverSlack / seen.distance * scale_;
  if (ground_->blocks(v)) seen.stop = seen.distance;
  seen_.push_back(seen);
  return static_cast<std::uint32_t>(seen_.size() - 1);
}

void FanSearch::count(std::uint32_t seen) {
  counted_.insert(seen_[seen].vertex.value());
  const Direction at = seen_[seen].inverse;
  depth_.insert({dot(first_, at), first_.x * at.y - first_.y * at.x, seen_[seen].turn});
}

// Of a position less than half a turn from one that was seen.
double FanSearch::turn_of(std::uint32_t from, Point2 p) const {
  const Seen& seen = seen_[from];
  const double x = p.x - at_.x, y = p.y - at_.y;
  return seen.turn + std::atan2(seen.x * y - seen.y * x, seen.x * x + seen.y * y);
}

Inverted FanSearch::inverted(Point2 p, double turn) const {
  const double x = p.x - at_.x, y = p.y - at_.y;
  const double factor = scale_ / (x * x + y * y);
  return {(first_.x * x + first_.y * y) * factor, (first_.x * y - first_.y * x) * factor, turn};
}

// Lists those of the vertices seen that can be partners, in order.
void FanSearch::collect() {
  partners_.clear();
  std::uint32_t i = 0;
  do {
    const Seen& seen = seen_[i];
    i = seen.next;
    if (pruning_ != FanPruning::None && hopeless_at(seen)) continue;
    partners_.push_back({seen.vertex, {seen.inverse.x, seen.inverse.y, seen.turn}});
  } while (i != 0);
}

bool FanSearch::hopeless_at(const Seen& seen) {
  if (counting_) {
    const Inverted at = inverted(ground_->point(seen.vertex), seen.turn);
    const bool reached = depth_.reaches(at, k_, seen.turn, seen.turn);
    if (tabled_ && !reached) return true;
    if (reached && seen.distance < kMuchFarther * far_) return false;
  }
  const Direction to{seen.x / seen.distance, seen.y / seen.distance};
  const Direction at{seen.x / seen.distance * (scale_ / seen.distance) * kWider,
                     seen.y / seen.distance * (scale_ / seen.distance) * kWider};
  std::array<Direction, 2> open;
  const std::uint32_t i = seen_[seen.next].previous;
  return hopeless({.right = i,
                   .left = i,
                   .right_turn = seen.turn,
                   .left_turn = seen.turn,
                   .to_right = to,
                   .to_left = to,
                   .right_at = at,
                   .left_at = at,
                   .horizon = kUnbounded},
                  open);
}

void FanSearch::push(HalfedgeId edge, Gap gap) {
  if (ground_->blocks(edge) || ground_->tin().on_rim(edge)) return;
  gap.edge = edge;
  if (!tabled_) gap.distance = std::max(gap.distance, distance_to(gap));
  gaps_.push_back(gap);
  if (!tabled_) std::push_heap(gaps_.begin(), gaps_.end(), kByDistance);
}

// Whether no disc of order <= k through u and a vertex of the gap has an end of its edge inside.
bool FanSearch::out_of_reach(const Gap& gap) const {
  const double from = seen_[gap.right].turn;
  double to = seen_[gap.left].turn;
  if (to < from) to += 2 * kPi;
  const auto known = [&](std::uint32_t i, double turn) {
    const Direction at = seen_[i].inverse;
    const Inverted there{dot(first_, at), first_.x * at.y - first_.y * at.x, turn};
    return k_ > 0 && depth_.reaches(there, k_ - 1, from, to);
  };
  const Tin& tin = ground_->tin();
  for (const VertexId v : {tin.origin(gap.edge), tin.target(gap.edge)}) {
    if (v == seen_[gap.right].vertex) {
      if (known(gap.right, from)) return false;
    } else if (v == seen_[gap.left].vertex) {
      if (known(gap.left, to)) return false;
    } else {
      const bool counts = narrow_ && counted_.contains(v.value());
      if (counts && k_ == 0) continue;
      const Point2 p = ground_->point(v);
      if (depth_.reaches(inverted(p, turn_of(gap.right, p)), counts ? k_ - 1 : k_, from, to)) return false;
    }
  }
  return true;
}

// Whether both ends of its edge are nearer than that: then so is its part in the angle.
bool FanSearch::nearer(const Gap& gap, double distance) const {
  const auto near = [&](VertexId v) {
    const Point2 p = ground_->point(v);
    return (p.x - at_.x) * (p.x - at_.x) + (p.y - at_.y) * (p.y - at_.y) < distance * distance;
  };
  return near(ground_->tin().origin(gap.edge)) && near(ground_->tin().target(gap.edge));
}

bool FanSearch::gives_up(Gap& gap) {
  if (pruning_ == FanPruning::None) return false;
  if (tabled_) {
    if (out_of_reach(gap)) return true;
    if (nearer(gap, kMuchFarther * gap.tested)) return false;
    gap.distance = std::max(gap.distance, distance_to(gap));
  }
  // Where few are seen in some disc, few of them count.
  if (counting_ && !tabled_ && nearer(gap, kMuchFarther * far_) && !out_of_reach(gap)) return false;
  if (gap.distance <= (tabled_ ? kMuchFarther : kFarther) * gap.tested) return false;
  const Seen& right = seen_[gap.right];
  const Seen& left = seen_[gap.left];
  const double cosine = (right.x * left.x + right.y * left.y) / (right.distance * left.distance);
  if (cosine <= -0.5) return false;
  gap.tested = gap.distance;
  const double size = kWider * scale_ / (gap.distance * std::sqrt((1 + std::min(cosine, 1.0)) / 2));
  const Direction to_right = scaled({right.x, right.y}, 1 / right.distance);
  const Direction to_left = scaled({left.x, left.y}, 1 / left.distance);
  return hopeless({.right = gap.right,
                   .left = gap.left,
                   .right_turn = right.turn,
                   .left_turn = left.turn,
                   .to_right = to_right,
                   .to_left = to_left,
                   .right_at = scaled(to_right, size),
                   .left_at = scaled(to_left, size),
                   .horizon = gap.distance},
                  gap.open);
}

void FanSearch::expand(const Gap& from) {
  Gap gap = from;
  if (gives_up(gap)) {
    seen_[gap.right].stop_after = gap.distance;
    return;
  }
  const HalfedgeId entry = ground_->tin().twin(gap.edge);
  const VertexId apex = ground_->tin().apex(entry);
  const Point2 p = ground_->point(apex);
  const int of_right = orientation(at_, at(gap.right), p);
  const int of_left = orientation(at_, p, at(gap.left));
  if (of_right > 0 && of_left > 0) {
    const double low = seen_[gap.right].turn, high = seen_[gap.left].turn;
    const double turn = std::max(low, turn_of(gap.right, p));
    const std::uint32_t middle = see(apex, low < high ? std::min(high, turn) : turn);
    if (counting_) count(middle);
    seen_[middle].next = gap.left;
    seen_[middle].previous = gap.right;
    seen_[gap.right].next = seen_[gap.left].previous = middle;
    Gap right = gap, left = gap;
    right.left = left.right = middle;
    push(Tin::next(entry), right);
    push(Tin::previous(entry), left);
    return;
  }
  if (of_right == 0 || of_left == 0) note_behind(of_right == 0 ? gap.right : gap.left, apex);
  push(of_right <= 0 ? Tin::previous(entry) : Tin::next(entry), gap);
}

// Comes up to twice, from both sides.
void FanSearch::note_behind(std::uint32_t seen, VertexId v) {
  const Point2 p = ground_->point(v);
  if (ground_->blocks(v)) {
    double& stop = seen_[seen].stop_behind;
    stop = std::min(stop, length({p.x - at_.x, p.y - at_.y}));
  }
  const bool known =
      std::any_of(behind_.begin(), behind_.end(), [&](const Partner& one) { return one.vertex == v; });
  if (known) return;
  const double x = p.x - at_.x, y = p.y - at_.y, factor = scale_ / (x * x + y * y);
  behind_.push_back({v, {x * factor, y * factor, seen_[seen].turn}});
}

// The distance of the edge's part within the angle. Where the edge is seen too flat for its cuts to be
// computed well, that of the whole edge.
double FanSearch::distance_to(const Gap& gap) const {
  constexpr double kFlat = 1e-7;
  constexpr double kError = 1e-8;
  const Point2 start = ground_->point(ground_->tin().origin(gap.edge));
  const Point2 end = ground_->point(ground_->tin().target(gap.edge));
  const double start_x = start.x - at_.x, start_y = start.y - at_.y;
  const double along_x = end.x - start.x, along_y = end.y - start.y;
  const double length_square = along_x * along_x + along_y * along_y;
  const double edge_length = std::sqrt(length_square);
  double low = 0;
  double high = 1;
  const auto cut = [&](Point2 through) {
    const double x = through.x - at_.x, y = through.y - at_.y;
    const double across = x * along_y - y * along_x;
    if (std::abs(across) < kFlat * edge_length * length({x, y})) return kUnbounded;
    return (y * start_x - x * start_y) / across;
  };
  const double from = cut(at(gap.right));
  const double to = cut(at(gap.left));
  if (from < kUnbounded) low = std::clamp(from, 0.0, 1.0);
  if (to < kUnbounded) high = std::clamp(to, low, 1.0);
  const double foot = std::clamp(-(start_x * along_x + start_y * along_y) / length_square, low, high);
  const double near = length({start_x + foot * along_x, start_y + foot * along_y});
  return near - kError * (length({start_x, start_y}) + edge_length);
}

}  // namespace thalweg::detail
