// Which vertices can share a triangle of order at most k with u?
//
// 1. A side uv of a valid triangle runs free, or is a constraint edge: u sees v, past no vertex. All such v
// are met by
//    following the gaps of the view from u through the faces, cut at each vertex (as in sights.cpp), nearest
//    first.
// 2. Let t be a valid triangle at u with order <= k and disc D. Of the vertices x in D that u sees, many must
// count:
//    a. Visible. Say no constraint edge at u lies between the directions of x and of t. Then x counts under
//    Pathcon,
//       for the segments xu and those of t leave u through one piece of the disc, and under SeesTriang and
//       SeesVtx: beside u, x sees points of the side of t beyond which it lies, and it sees u.
//    b. NearEnds. Say t = uvw in either turn, and x lies beyond uv. Segment xw crosses uv, at q, and from
//    there on runs
//       through t. If an edge crosses xq, one of its ends lies in triangle uxq, for nothing crosses the
//       segments ux and uq; of these ends the one whose direction from u is nearest to v (the nearest of
//       them, on a tie) is seen by u. So x counts under SeesOpp if u sees no end of a constraint edge, other
//       than x itself, between the directions of v and x as near as q or x. If the angle at u is the largest
//       of t, at least 60 degrees, then by the law of sines |uq| <= |ux| / sin 60. Beyond vw, x counts
//       anyway, because it sees u.
// 3. A gap is given up when every disc through u and any place in the gap as far as its edge, or farther,
// holds more
//    than k vertices that count by 2: no v there has a triangle of order <= k with u. For 2b the ends within
//    reach of x must be known: gaps go by distance, so all nearer ends are, save those in gaps given up,
//    whose directions end the certainty.
// 4. Inversion about u turns discs through u into half-planes: x lies in the disc through u and f with centre
// in
//    direction c exactly if x* c > f* c, where x* = x / |x|^2. The far part of a gap becomes a set that a
//    triangle with corners u, f1, f2 holds. So each x covers the directions c with (x* - f1) c > 0 and (x* -
//    f2) c > 0, an arc, and the gap is hopeless if the arcs cover all c that have f1 c > 0 or f2 c > 0 more
//    than k times.
// 5. This part alone is done in rounded arithmetic, with arcs made smaller and discs larger by far more than
// its
//    errors: it decides what is searched, not what is found. What u sees is decided exactly.
//
// Directions are measured by the diamond angle, which grows with the angle from 0 to 4 and by 1 a quarter
// turn.
#include "order/fan_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace thalweg::detail {

namespace {

constexpr double kReach = 1.1548;  // above 1 / sin 60
constexpr double kWider = 1 + 1e-9;
constexpr double kAngleSlack = 1e-11;
constexpr double kUnbounded = std::numeric_limits<double>::infinity();

double diamond_angle(double x, double y) {
  const double share = x / (std::abs(x) + std::abs(y));
  return y >= 0 ? 1 - share : 3 + share;
}

// From one direction counter-clockwise to another, in [0, 4).
double turn_between(double from, double to) {
  const double turn = to - from;
  return turn < 0 ? turn + 4 : turn;
}

double normal(double angle) {
  if (angle < 0) return angle + 4;
  return angle >= 4 ? angle - 4 : angle;
}

bool farther(double a, double b) {
  return a > b;
}

}  // namespace

std::span<const FanSearch::Partner> FanSearch::partners(const Ground& ground, VertexId u, std::size_t k,
                                                        FanPruning pruning) {
  ground_ = &ground;
  u_ = u;
  at_ = ground.point(u);
  k_ = k;
  pruning_ = pruning;
  const auto by_distance = [](const Gap& a, const Gap& b) { return farther(a.distance, b.distance); };
  start();
  while (!gaps_.empty()) {
    std::pop_heap(gaps_.begin(), gaps_.end(), by_distance);
    const Gap gap = gaps_.back();
    gaps_.pop_back();
    expand(gap);
  }
  partners_.clear();
  for (const Seen& seen : seen_) {
    const double x = seen.inverse_x * kWider;
    const double y = seen.inverse_y * kWider;
    if (hopeless({seen.angle, seen.angle, x, y, x, y}, kUnbounded)) continue;
    partners_.push_back({seen.vertex, seen.angle});
  }
  return partners_;
}

void FanSearch::start() {
  gaps_.clear();
  seen_.clear();
  stops_.clear();
  const Tin& tin = ground_->tin();
  for (const HalfedgeId h : tin.outgoing(u_)) {
    const HalfedgeId last = Tin::previous(h);
    see(tin.target(h));
    if (ground_->blocks(h)) stop_at(tin.target(h), 0);
    if (tin.on_rim(last)) {
      see(tin.apex(h));
      if (ground_->blocks(last)) stop_at(tin.apex(h), 0);
    }
    push(Tin::next(h), {ground_->point(tin.target(h)), ground_->point(tin.apex(h))}, 0);
  }
}

void FanSearch::see(VertexId v) {
  const Point2 p = ground_->point(v);
  Seen seen{.vertex = v, .x = p.x - at_.x, .y = p.y - at_.y};
  const double square = seen.x * seen.x + seen.y * seen.y;
  seen.distance = std::sqrt(square);
  seen.angle = diamond_angle(seen.x, seen.y);
  seen.inverse_x = seen.x / square;
  seen.inverse_y = seen.y / square;
  seen_.push_back(seen);
  if (pruning_ == FanPruning::NearEnds && ground_->blocks(v)) stop_at(v, seen.distance);
}

void FanSearch::stop_at(VertexId v, double distance) {
  const Point2 p = ground_->point(v);
  stops_.push_back({v, diamond_angle(p.x - at_.x, p.y - at_.y), distance});
}

void FanSearch::give_up(const Gap& gap) {
  if (pruning_ != FanPruning::NearEnds) return;
  for (const Point2 p : {gap.angle.right, gap.angle.left}) {
    stops_.push_back({{}, diamond_angle(p.x - at_.x, p.y - at_.y), gap.distance});
  }
}

void FanSearch::push(HalfedgeId edge, const Angle& angle, double distance) {
  if (ground_->blocks(edge) || ground_->tin().on_rim(edge)) return;
  Gap gap{edge, angle, distance};
  gap.distance = std::max(distance, distance_to(gap));
  gaps_.push_back(gap);
  std::push_heap(gaps_.begin(), gaps_.end(),
                 [](const Gap& a, const Gap& b) { return farther(a.distance, b.distance); });
}

void FanSearch::expand(const Gap& gap) {
  const double right_x = gap.angle.right.x - at_.x, right_y = gap.angle.right.y - at_.y;
  const double left_x = gap.angle.left.x - at_.x, left_y = gap.angle.left.y - at_.y;
  const double right_length = std::hypot(right_x, right_y);
  const double left_length = std::hypot(left_x, left_y);
  const double cosine = (right_x * left_x + right_y * left_y) / (right_length * left_length);
  if (cosine > -0.5 && gap.distance > 0) {
    const double size = kWider / (gap.distance * std::sqrt((1 + std::min(cosine, 1.0)) / 2));
    const Range range{diamond_angle(right_x, right_y), diamond_angle(left_x, left_y),
                      right_x / right_length * size,   right_y / right_length * size,
                      left_x / left_length * size,     left_y / left_length * size};
    if (hopeless(range, gap.distance)) return give_up(gap);
  }
  const HalfedgeId entry = ground_->tin().twin(gap.edge);
  const VertexId apex = ground_->tin().apex(entry);
  const Point2 p = ground_->point(apex);
  const int of_right = orientation(at_, gap.angle.right, p);
  const int of_left = orientation(at_, p, gap.angle.left);
  if (of_right > 0 && of_left > 0) {
    see(apex);
    push(Tin::next(entry), {gap.angle.right, p}, gap.distance);
    push(Tin::previous(entry), {p, gap.angle.left}, gap.distance);
    return;
  }
  if ((of_right == 0 || of_left == 0) && pruning_ == FanPruning::NearEnds && ground_->blocks(apex)) {
    stop_at(apex, std::hypot(p.x - at_.x, p.y - at_.y));
  }
  push(of_right <= 0 ? Tin::previous(entry) : Tin::next(entry), gap.angle, gap.distance);
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
  const double length = std::sqrt(length_square);
  double low = 0;
  double high = 1;
  const auto cut = [&](Point2 through) {
    const double x = through.x - at_.x, y = through.y - at_.y;
    const double across = x * along_y - y * along_x;
    if (std::abs(across) < kFlat * length * std::hypot(x, y)) return kUnbounded;
    return (y * start_x - x * start_y) / across;
  };
  const double from = cut(gap.angle.right);
  const double to = cut(gap.angle.left);
  if (from < kUnbounded) low = std::clamp(from, 0.0, 1.0);
  if (to < kUnbounded) high = std::clamp(to, low, 1.0);
  const double foot = std::clamp(-(start_x * along_x + start_y * along_y) / length_square, low, high);
  const double near = std::hypot(start_x + foot * along_x, start_y + foot * along_y);
  return near - kError * (std::hypot(start_x, start_y) + length);
}

bool FanSearch::certain(const Range& range, const Seen& seen, double horizon) const {
  const double reach = kReach * seen.distance;
  if (pruning_ == FanPruning::NearEnds && reach > horizon) return false;
  const double breadth = turn_between(range.right, range.left);
  const double from_right = turn_between(range.right, seen.angle);
  double start = range.right;
  double turn = breadth;
  if (from_right > breadth) {
    const double to_left = turn_between(seen.angle, range.left);
    if (from_right < 2) {
      turn = from_right;
    } else if (to_left < 2) {
      start = seen.angle;
      turn = to_left;
    } else {
      return false;
    }
  }
  const double slack_start = normal(start - kAngleSlack);
  return std::none_of(stops_.begin(), stops_.end(), [&](const Stop& stop) {
    if (stop.vertex.valid() && stop.vertex == seen.vertex) return false;
    return stop.distance <= reach && turn_between(slack_start, stop.angle) <= turn + 2 * kAngleSlack;
  });
}

// The arc of directions that a vertex covers (step 4), as changes of depth along the directions to be
// covered.
void FanSearch::add_turns(const Range& range, const Seen& seen) {
  const double right = diamond_angle(seen.inverse_x - range.right_x, seen.inverse_y - range.right_y);
  const double left = diamond_angle(seen.inverse_x - range.left_x, seen.inverse_y - range.left_y);
  const double apart = turn_between(right, left);
  const double length = std::abs(2 - apart) - 2 * kAngleSlack;
  if (!(length > 0)) return;
  const double start = normal((apart < 2 ? left : right) - 1 + kAngleSlack);
  const double offset = turn_between(normal(range.right - 1), start);
  turns_.push_back({offset, 1});
  turns_.push_back({offset + length, -1});
  if (offset + length > 4) {
    turns_.push_back({0, 1});
    turns_.push_back({offset + length - 4, -1});
  }
}

bool FanSearch::hopeless(const Range& range, double horizon) {
  if (pruning_ == FanPruning::None || seen_.size() <= k_) return false;
  // Near the hull only vertices far along a narrow gap tell that it is hopeless, so all count; the limit
  // keeps a vertex that sees thousands from a cost that is quadratic in them.
  constexpr std::size_t kMost = 1024;
  turns_.clear();
  for (std::size_t i = 0; i < std::min(kMost, seen_.size()); ++i) {
    if (certain(range, seen_[i], horizon)) add_turns(range, seen_[i]);
  }
  if (turns_.size() <= 2 * k_) return false;
  std::sort(turns_.begin(), turns_.end(), [](const Turn& a, const Turn& b) {
    return a.angle != b.angle ? a.angle < b.angle : a.change < b.change;
  });
  const double end = turn_between(range.right, range.left) + 2;
  std::size_t depth = 0;
  std::size_t i = 0;
  for (; i < turns_.size() && turns_[i].angle <= 0; ++i) depth += 1;
  for (; depth > k_ && i < turns_.size() && turns_[i].angle < end; ++i) {
    if (turns_[i].change > 0) {
      ++depth;
    } else {
      --depth;
    }
  }
  return depth > k_;
}

}  // namespace thalweg::detail
