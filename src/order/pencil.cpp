// What lies beside an edge.
//
// 1. The circles through u and v are ordered by where their centres are, and so are the vertices left of uv:
//    x is inside the circle through u, v and y exactly if it sees uv at a larger angle than y does. Of one on
//    the right the two angles together must exceed half a turn. By the tie rule this is a total order.
// 2. The nearest vertices are found through the faces of the ground, from those that uv passes on, over every
//    edge that meets the part left of uv of the disc through u, v and the farthest vertex of the list. That
//    part is convex, so all faces that meet it hang together over such edges; the list only gets nearer.
// 3. Let uv cross edge ab of the ground, a on the left. If uv is of use at order k, then so is the triangle
// of
//    u, v and its nearest vertex on the left (Gudmundsson, Hammar, van Kreveld, Higher order Delaunay
//    triangulations, 2002, Lemma 3), and b is inside its circle. For a is not inside; if b were not either,
//    and u, v are not inside the empty circle of ab, the product of the lengths from the crossing to a and b
//    would be at least, and at most, that to u and v. So at most k vertices a side have such edges; and the
//    nearest vertex is one of them, for uv with the greedy triangulation beside it, made of these vertices,
//    is the constrained Delaunay triangulation with uv as a constraint edge.
// 4. Cotangents of angles are compared with a bound of their rounding, else by the exact predicate. Where a
//    disc ends is rounded outwards: it decides how far is searched, not what is found.
#include "order/pencil.hpp"

#include <thalweg/geometry/predicates.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace thalweg::detail {

namespace {

// Two differences, their product and a sum of two such: less than 5 * 2^-53 of the sum of magnitudes.
constexpr double kRounding = 0x1p-50;
constexpr double kNoUnderflow = 1e-280;
constexpr double kWider = 1e-9;
constexpr double kUnbounded = std::numeric_limits<double>::infinity();

}  // namespace

Pencil::Position Pencil::position(VertexId x) const {
  const Point2 p = ground_->point(x);
  const double dx = p.x - from_.x, dy = p.y - from_.y, ex = p.x - to_.x, ey = p.y - to_.y;
  const double vx = to_.x - from_.x, vy = to_.y - from_.y;
  const double one = dx * ex, other = dy * ey, left = vx * dy, right = vy * dx;
  return {one + other, left - right, std::abs(one) + std::abs(other) + std::abs(left) + std::abs(right)};
}

bool Pencil::nearer(const Beside& one, const Beside& other) const {
  if (one.cotangent + one.error < other.cotangent - other.error) return true;
  if (one.cotangent - one.error > other.cotangent + other.error) return false;
  return in_circle_perturbed(from_, to_, ground_->point(other.vertex), ground_->point(one.vertex));
}

// None if it is not strictly on the left.
std::optional<Pencil::Beside> Pencil::beside(VertexId x, const Position& at) const {
  const double error = kRounding * at.size + kNoUnderflow;
  if (at.across > 2 * error) {
    const double cotangent = at.along / at.across;
    return Beside{x, cotangent, 2 * error * (1 + std::abs(cotangent)) / at.across};
  }
  if (at.across < -2 * error || x == u_ || x == v_) return std::nullopt;
  if (orientation(from_, to_, ground_->point(x)) <= 0) return std::nullopt;
  return Beside{x, 0, kUnbounded};
}

// Whether an edge of the ground, of that length squared, may meet what is left of uv of the disc through u, v
// and a place that sees uv at an angle of that cotangent.
bool Pencil::reaches(const Border& border, double square, double cotangent) {
  const Position &p = border.from, &q = border.to;
  const double slack = kWider * (p.size + q.size);
  if (p.across < -slack && q.across < -slack) return false;
  if (!(cotangent < kUnbounded)) return true;
  // The power of the point p + t (q - p) with respect to the circle is a parabola in t.
  const double of_p = p.along - cotangent * p.across, of_q = q.along - cotangent * q.across;
  const double error = slack * (1 + std::abs(cotangent)) + kWider * square;
  if (std::min(of_p, of_q) <= error) return true;
  const double slope = of_q - of_p - square;
  if (slope >= 0 || -slope >= 2 * square) return false;
  return of_p - slope * slope / (4 * square) <= error;
}

// Meets vertices on the left until `meet` says no; `limit` is the cotangent at which the disc ends.
template <class Meet, class Limit>
void Pencil::search(const Start& start, const Meet& meet, const Limit& limit) {
  met_.clear();
  pending_.clear();
  for (const TriangleId t : passed_) met_.insert(t.value());
  for (const VertexId x : start.vertices) {
    const auto found = beside(x, position(x));
    if (found && !meet(*found)) return;
  }
  for (const HalfedgeId h : start.borders) {
    pending_.push_back({h, position(ground_->origin(h)), position(ground_->target(h))});
  }
  for (std::size_t next = 0; next < pending_.size(); ++next) {
    const Border border = pending_[next];
    const HalfedgeId entry = ground_->twin(border.edge);
    if (!entry.valid()) continue;
    const Point2 p = ground_->point(ground_->origin(entry)), q = ground_->point(ground_->target(entry));
    const double square = (q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y);
    if (!reaches(border, square, limit()) || !met_.insert(Tin::triangle_of(entry).value())) continue;
    const VertexId apex = ground_->apex(entry);
    const Position at = position(apex);
    const auto found = beside(apex, at);
    if (found && !meet(*found)) return;
    pending_.push_back({Tin::next(entry), border.from, at});
    pending_.push_back({Tin::previous(entry), at, border.to});
  }
}

void Pencil::insert(const Beside& fresh, std::vector<Beside>& nearest) const {
  const bool full = nearest.size() > most_;
  if (full && !nearer(fresh, nearest.back())) return;
  for (const Beside& known : nearest) {
    if (known.vertex == fresh.vertex) return;
  }
  if (full) nearest.pop_back();
  auto place = nearest.end();
  while (place != nearest.begin() && nearer(fresh, *std::prev(place))) --place;
  nearest.insert(place, fresh);
}

// Whether at most `most_` of them are inside the circle through u, v and one on the right; if not, the list
// is not finished.
bool Pencil::list(const Start& start, const Beside& corner, std::vector<Beside>& nearest) {
  nearest.clear();
  bool few = true;
  search(
      start,
      [&](const Beside& found) {
        insert(found, nearest);
        few = nearest.size() <= most_ || !inside(to_, from_, corner, nearest.back());
        return few;
      },
      [&] { return nearest.size() > most_ ? nearest.back().cotangent + nearest.back().error : kUnbounded; });
  return few;
}

Pencil::Beside Pencil::nearest(const Start& start) const {
  std::optional<Beside> best;
  for (const VertexId x : start.vertices) {
    const auto found = beside(x, position(x));
    if (found && (!best || nearer(*found, *best))) best = found;
  }
  return *best;
}

// Whether x, beyond the edge between from and to, is inside the circle through its ends and a corner on the
// left of them.
bool Pencil::inside(Point2 from, Point2 to, const Beside& corner, const Beside& x) const {
  const double sum = corner.cotangent + x.cotangent, error = corner.error + x.error;
  if (sum < -error) return true;
  if (sum > error) return false;
  return in_circle_perturbed(from, to, ground_->point(corner.vertex), ground_->point(x.vertex));
}

// Whether at most `most_` vertices on the left are inside the circle through u, v and one on the right.
bool Pencil::few_inside(const Start& start, const Beside& corner) {
  counted_.clear();
  search(
      start,
      [&](const Beside& found) {
        const bool counts = inside(to_, from_, corner, found) &&
                            std::find(counted_.begin(), counted_.end(), found.vertex) == counted_.end();
        if (counts) counted_.push_back(found.vertex);
        return counted_.size() <= most_;
      },
      [&] { return corner.error - corner.cotangent; });
  return counted_.size() <= most_;
}

// The faces that uv passes; false if there is a vertex on it, or it has too many vertices of such faces on
// one side.
bool Pencil::pass(VertexId u, VertexId v) {
  const Point2 from = ground_->point(u), to = ground_->point(v);
  HalfedgeId crossed;
  for (const HalfedgeId h : ground_->outgoing(u)) {
    if (orientation(from, ground_->point(ground_->target(h)), to) <= 0 ||
        orientation(from, to, ground_->point(ground_->apex(h))) <= 0) {
      continue;
    }
    crossed = Tin::next(h);
    right_start_.vertices.push_back(ground_->origin(crossed));
    right_start_.borders.push_back(h);
    left_start_.vertices.push_back(ground_->target(crossed));
    left_start_.borders.push_back(Tin::previous(h));
    break;
  }
  while (crossed.valid()) {
    passed_.push_back(Tin::triangle_of(crossed));
    const HalfedgeId entry = ground_->twin(crossed);
    if (!entry.valid()) return false;
    const VertexId apex = ground_->apex(entry);
    const int side = apex == v ? 0 : orientation(from, to, ground_->point(apex));
    if (side == 0 && apex != v) return false;
    if (side <= 0) right_start_.borders.push_back(Tin::next(entry));
    if (side >= 0) left_start_.borders.push_back(Tin::previous(entry));
    if (apex == v) {
      passed_.push_back(Tin::triangle_of(entry));
      return true;
    }
    Start& start = side > 0 ? left_start_ : right_start_;
    start.vertices.push_back(apex);
    if (start.vertices.size() > most_) return false;
    crossed = side > 0 ? Tin::next(entry) : Tin::previous(entry);
  }
  return false;
}

void Pencil::look_from(VertexId u, VertexId v) {
  from_ = ground_->point(u);
  to_ = ground_->point(v);
}

bool Pencil::look_at(VertexId u, VertexId v) {
  u_ = u;
  v_ = v;
  passed_.clear();
  left_start_.clear();
  right_start_.clear();
  const bool in_ground = ground_->find_halfedge(u, v).valid() || ground_->find_halfedge(v, u).valid();
  if (in_ground || !pass(u, v)) return false;
  look_from(u, v);
  const Beside on_left = nearest(left_start_);
  look_from(v, u);
  const Beside on_right = nearest(right_start_);
  if (!few_inside(right_start_, on_left)) return false;
  look_from(u, v);
  if (!list(left_start_, on_right, left_)) return false;
  look_from(v, u);
  list(right_start_, on_left, right_);
  look_from(u, v);
  return true;
}

std::optional<std::size_t> Pencil::order(std::span<const Beside> side, std::size_t place) const {
  const bool on_left = is_left(side);
  const Point2 u = on_left ? from_ : to_, v = on_left ? to_ : from_;
  std::size_t count = place;
  for (const Beside& x : on_left ? right() : left()) {
    if (count > most_ || !inside(u, v, side[place], x)) break;
    ++count;
  }
  return count <= most_ ? std::optional(count) : std::nullopt;
}

// A vertex in the triangle is inside its circle, and on this side.
bool Pencil::is_empty(std::span<const Beside> side, std::size_t place) const {
  const bool left = is_left(side);
  const Point2 u = left ? from_ : to_, v = left ? to_ : from_, w = ground_->point(side[place].vertex);
  return std::none_of(side.begin(), side.begin() + static_cast<std::ptrdiff_t>(place), [&](const Beside& x) {
    const Point2 p = ground_->point(x.vertex);
    return orientation(v, w, p) >= 0 && orientation(w, u, p) >= 0;
  });
}

}  // namespace thalweg::detail
