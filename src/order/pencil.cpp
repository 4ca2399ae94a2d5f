// What lies beside an edge.
//
// 1. The circles through u and v are ordered by where their centres are, and so are the vertices left of uv:
//    x is inside the circle through u, v and y exactly if it sees uv at a larger angle than y does. Of one on
//    the right the two angles together must exceed half a turn. By the tie rule this is a total order.
// 2. The nearest vertices are found one after the other, each among the neighbours of those before it and the
//    vertices of the faces that uv passes. Proof. Let D be the inside of a circle through u and v. Of the
//    lifted vertices those in D are below a plane through u and v, and from each of them but the lowest an
//    edge of the ground, whose lifted surface is convex, leads to a lower one: so a path in D leads to the
//    lowest. Where it crosses the line uv that is between u and v, for the surface is convex along that
//    line; so the last vertex before is one of a face that uv passes. Two paths that stay left of uv meet
//    in the lowest vertex; and the nearest vertex of all is one of a face that is passed, for with uv as a
//    constraint edge nothing but these faces would be triangulated anew, and it would be the corner there.
// 3. Let uv cross edge ab of the ground, a on the left. If uv is of use at order k, then so is the triangle
//    of u, v and its nearest vertex on the left (Gudmundsson, Hammar, van Kreveld, Higher order Delaunay
//    triangulations, 2002, Lemma 3), and b is inside its circle. For a is not inside; if b were not either,
//    and u, v are not inside the empty circle of ab, the product of the lengths from the crossing to a and b
//    would be at least, and at most, that to u and v. So at most k vertices a side have such edges; and the
//    nearest vertex is one of them, for uv with the greedy triangulation beside it, made of these vertices,
//    is the constrained Delaunay triangulation with uv as a constraint edge.
// 4. Cotangents of angles are compared with a bound of their rounding, else by the exact predicate.
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
constexpr double kUnbounded = std::numeric_limits<double>::infinity();

}  // namespace

Pencil::Position Pencil::position(Point2 from, Point2 to, VertexId x) const {
  const Point2 p = ground_->point(x);
  const double dx = p.x - from.x, dy = p.y - from.y, ex = p.x - to.x, ey = p.y - to.y;
  const double vx = to.x - from.x, vy = to.y - from.y;
  const double one = dx * ex, other = dy * ey, left = vx * dy, right = vy * dx;
  const double size = std::abs(one) + std::abs(other) + std::abs(left) + std::abs(right);
  return {one + other, left - right, kRounding * size + kNoUnderflow};
}

bool Pencil::nearer(const Side& side, const Beside& one, const Beside& other) const {
  if (one.cotangent + one.error < other.cotangent - other.error) return true;
  if (one.cotangent - one.error > other.cotangent + other.error) return false;
  return in_circle_perturbed(side.from, side.to, ground_->point(other.vertex), ground_->point(one.vertex));
}

// None if it is not strictly on the left.
std::optional<Pencil::Beside> Pencil::beside(const Side& side, VertexId x) const {
  const Position at = position(side.from, side.to, x);
  if (at.across > 2 * at.error) {
    const double cotangent = at.along / at.across;
    return Beside{x, cotangent, 2 * at.error * (1 + std::abs(cotangent)) / at.across};
  }
  if (at.across < -2 * at.error || x == u_ || x == v_) return std::nullopt;
  if (orientation(side.from, side.to, ground_->point(x)) <= 0) return std::nullopt;
  return Beside{x, 0, kUnbounded};
}

// Keeps the nearest. Pre: it is not there.
bool Pencil::insert(const Beside& fresh, Side& side) const {
  std::vector<Beside>& nearest = side.nearest;
  if (nearest.size() > most_) {
    if (!nearer(side, fresh, nearest.back())) return false;
    nearest.pop_back();
  }
  auto place = nearest.end();
  while (place != nearest.begin() && nearer(side, fresh, *std::prev(place))) --place;
  nearest.insert(place, fresh);
  return true;
}

// Whether it is one of the nearest so far, and new among them.
bool Pencil::meet(VertexId x, Side& side) const {
  for (const Beside& known : side.nearest) {
    if (known.vertex == x) return false;
  }
  const auto found = beside(side, x);
  return found && insert(*found, side);
}

// Meets the neighbours of the next vertex; false, and some are not met, once it is time to stop.
template <class Stop>
bool Pencil::settle(Side& side, const Stop& stop) {
  const VertexId x = side.nearest[side.settled++].vertex;
  for (const HalfedgeId h : ground_->outgoing(x)) {
    if (meet(ground_->target(h), side) && stop()) return false;
    if (ground_->on_rim(Tin::previous(h)) && meet(ground_->apex(h), side) && stop()) return false;
  }
  return true;
}

// Whether at most `most_` vertices of the side are inside the circle through u, v and one on the other side.
bool Pencil::few_inside(Side& side, const Beside& corner) {
  const auto too_many = [&] {
    return side.nearest.size() > most_ && inside(side.to, side.from, corner, side.nearest.back());
  };
  if (too_many()) return false;
  while (side.settled < side.nearest.size() &&
         inside(side.to, side.from, corner, side.nearest[side.settled])) {
    if (!settle(side, too_many)) return false;
  }
  return true;
}

// Goes on to the `most_` + 1 nearest.
void Pencil::complete(Side& side) {
  while (side.settled < std::min(side.nearest.size(), most_)) settle(side, [] { return false; });
}

// Whether x, beyond the edge between from and to, is inside the circle through its ends and a corner on the
// left of them.
bool Pencil::inside(Point2 from, Point2 to, const Beside& corner, const Beside& x) const {
  const double sum = corner.cotangent + x.cotangent, error = corner.error + x.error;
  if (sum < -error) return true;
  if (sum > error) return false;
  return in_circle_perturbed(from, to, ground_->point(corner.vertex), ground_->point(x.vertex));
}

// Meets the vertices of the faces that uv passes; false if there is a vertex on it, or too many are on one
// side.
bool Pencil::pass(VertexId u, VertexId v) {
  const Point2 from = ground_->point(u), to = ground_->point(v);
  HalfedgeId crossed;
  for (const HalfedgeId h : ground_->outgoing(u)) {
    const VertexId one = ground_->target(h), other = ground_->apex(h);
    if (one == v || other == v) return false;
    if (orientation(from, ground_->point(one), to) <= 0 ||
        orientation(from, to, ground_->point(other)) <= 0) {
      continue;
    }
    crossed = Tin::next(h);
    meet(one, right_);
    meet(other, left_);
    break;
  }
  std::size_t of_left = 1, of_right = 1;
  while (crossed.valid()) {
    const HalfedgeId entry = ground_->twin(crossed);
    if (!entry.valid()) return false;
    const VertexId apex = ground_->apex(entry);
    if (apex == v) return true;
    const int side = orientation(from, to, ground_->point(apex));
    if (side == 0 || ++(side > 0 ? of_left : of_right) > most_) return false;
    meet(apex, side > 0 ? left_ : right_);
    crossed = side > 0 ? Tin::next(entry) : Tin::previous(entry);
  }
  return false;
}

bool Pencil::look_at(VertexId u, VertexId v) {
  u_ = u;
  v_ = v;
  left_.start(ground_->point(u), ground_->point(v));
  right_.start(ground_->point(v), ground_->point(u));
  if (!pass(u, v)) return false;
  const Beside on_left = left_.nearest.front(), on_right = right_.nearest.front();
  // The nearer one has the larger circle on the other side.
  const bool right_first = on_left.cotangent <= on_right.cotangent;
  if (right_first && !few_inside(right_, on_left)) return false;
  if (!few_inside(left_, on_right)) return false;
  if (!right_first && !few_inside(right_, on_left)) return false;
  complete(left_);
  complete(right_);
  return true;
}

std::optional<std::size_t> Pencil::order(std::span<const Beside> side, std::size_t place) const {
  const bool on_left = is_left(side);
  const Point2 u = on_left ? left_.from : left_.to, v = on_left ? left_.to : left_.from;
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
  const Point2 u = left ? left_.from : left_.to, v = left ? left_.to : left_.from,
               w = ground_->point(side[place].vertex);
  return std::none_of(side.begin(), side.begin() + static_cast<std::ptrdiff_t>(place), [&](const Beside& x) {
    const Point2 p = ground_->point(x.vertex);
    return orientation(v, w, p) >= 0 && orientation(w, u, p) >= 0;
  });
}

// The nearest of the known on a side is no nearer than the nearest of all; the circle through that one holds
// what is inside on the other side, and more. On which side one is cannot be foretold, so nothing branches.
bool Pencil::may_be_of_use(VertexId a, VertexId b, std::span<const VertexId> known) {
  const Point2 from = ground_->point(a), to = ground_->point(b);
  known_left_.resize(known.size());
  known_right_.resize(known.size());
  std::size_t of_left = 0, of_right = 0;
  for (const VertexId x : known) {
    const Position at = position(from, to, x);  // a and b are not certain to be on a side
    const double across = std::abs(at.across), cotangent = at.along / across;
    const double most = cotangent + 2 * at.error * (1 + std::abs(cotangent)) / across;
    const auto certain = static_cast<unsigned>(across > 2 * at.error);
    known_left_[of_left] = known_right_[of_right] = most;
    of_left += certain & static_cast<unsigned>(at.across > 0);
    of_right += certain & static_cast<unsigned>(at.across < 0);
  }
  const auto few = [&](std::span<const double> one, std::span<const double> other) {
    if (one.empty() || other.size() <= most_) return true;
    const double least = *std::min_element(one.begin(), one.end());
    const auto inside =
        std::count_if(other.begin(), other.end(), [&](double cotangent) { return cotangent < -least; });
    return static_cast<std::size_t>(inside) <= most_;
  };
  const std::span<const double> left(known_left_.data(), of_left), right(known_right_.data(), of_right);
  return few(left, right) && few(right, left);
}

}  // namespace thalweg::detail
