// What lies beside an edge.
//
// 1. The circles through u and v are ordered by where their centres are, and so are the vertices left of uv:
//    x is inside the circle through u, v and y exactly if it sees uv at a larger angle than y does. Of one on
//    the right the two angles together must exceed half a turn. By the tie rule this is a total order.
// 2. The nearest vertices are found through the faces of the ground, from those that uv passes on, over every
//    edge that meets the part left of uv of the disc through u, v and the farthest vertex of the list. That
//    part is convex, so all faces that meet it hang together over such edges; the list only gets nearer.
//    First no farther than the circle through the nearest vertex of the other side: most edges end there.
// 3. Let uv cross edge ab of the ground, a on the left. If uv is of use at order k, then so is the triangle
//    of u, v and its nearest vertex on the left (Gudmundsson, Hammar, van Kreveld, Higher order Delaunay
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

Pencil::Position Pencil::position(Point2 from, Point2 to, VertexId x) const {
  const Point2 p = ground_->point(x);
  const double dx = p.x - from.x, dy = p.y - from.y, ex = p.x - to.x, ey = p.y - to.y;
  const double vx = to.x - from.x, vy = to.y - from.y;
  const double one = dx * ex, other = dy * ey, left = vx * dy, right = vy * dx;
  return {one + other, left - right, std::abs(one) + std::abs(other) + std::abs(left) + std::abs(right)};
}

bool Pencil::nearer(const Side& side, const Beside& one, const Beside& other) const {
  if (one.cotangent + one.error < other.cotangent - other.error) return true;
  if (one.cotangent - one.error > other.cotangent + other.error) return false;
  return in_circle_perturbed(side.from, side.to, ground_->point(other.vertex), ground_->point(one.vertex));
}

// None if it is not strictly on the left.
std::optional<Pencil::Beside> Pencil::beside(const Side& side, VertexId x, const Position& at) const {
  const double error = kRounding * at.size + kNoUnderflow;
  if (at.across > 2 * error) {
    const double cotangent = at.along / at.across;
    return Beside{x, cotangent, 2 * error * (1 + std::abs(cotangent)) / at.across};
  }
  if (at.across < -2 * error || x == u_ || x == v_) return std::nullopt;
  if (orientation(side.from, side.to, ground_->point(x)) <= 0) return std::nullopt;
  return Beside{x, 0, kUnbounded};
}

// Whether the border may meet what is left of uv of the disc through u, v and a place that sees uv at an
// angle of that cotangent.
bool Pencil::reaches(const Border& border, double cotangent) const {
  const Position &p = border.from, &q = border.to;
  const double slack = kWider * (p.size + q.size);
  if (p.across < -slack && q.across < -slack) return false;
  if (!(cotangent < kUnbounded)) return true;
  // The power of the point p + t (q - p) with respect to the circle is a parabola in t.
  const double of_p = p.along - cotangent * p.across, of_q = q.along - cotangent * q.across;
  const double error = slack * (1 + std::abs(cotangent));
  if (std::min(of_p, of_q) <= error) return true;
  const double square = square_of(border.edge), wider = error + kWider * square;
  if (std::min(of_p, of_q) <= wider) return true;
  const double slope = of_q - of_p - square;
  if (slope >= 0 || -slope >= 2 * square) return false;
  return of_p - slope * slope / (4 * square) <= wider;
}

double Pencil::square_of(HalfedgeId edge) const {
  const Point2 p = ground_->point(ground_->origin(edge)), q = ground_->point(ground_->target(edge));
  return (q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y);
}

// Keeps the nearest.
void Pencil::insert(const Beside& fresh, Side& side) const {
  std::vector<Beside>& nearest = side.nearest;
  const bool full = nearest.size() > most_;
  if (full && !nearer(side, fresh, nearest.back())) return;
  for (const Beside& known : nearest) {
    if (known.vertex == fresh.vertex) return;
  }
  if (full) nearest.pop_back();
  auto place = nearest.end();
  while (place != nearest.begin() && nearer(side, fresh, *std::prev(place))) --place;
  nearest.insert(place, fresh);
}

// The vertices of the faces that uv passes.
void Pencil::begin(Side& side) const {
  side.nearest.clear();
  for (const VertexId x : side.vertices) {
    side.positions.push_back(position(side.from, side.to, x));
    if (const auto found = beside(side, x, side.positions.back())) insert(*found, side);
  }
}

// The ends of the edge are at its borders' ends, too: their position is nothing.
void Pencil::put_borders(const Side& side) {
  const bool reversed = &side == &left_;
  pending_.clear();
  for (std::size_t i = 0; i < side.borders.size(); ++i) {
    const Position near_u = i == 0 ? Position{} : side.positions[i - 1];
    const Position near_v = i == side.positions.size() ? Position{} : side.positions[i];
    pending_.push_back({side.borders[i], reversed ? near_v : near_u, reversed ? near_u : near_v});
  }
}

// Goes on over the pending borders that are within the limit, and meets the vertices beyond; the other
// borders are left for later.
template <class Limit, class Meet>
bool Pencil::spread(Side& side, const Limit& limit, const Meet& meet) {
  for (std::size_t next = 0; next < pending_.size(); ++next) {
    const Border over = pending_[next];
    if (!reaches(over, limit())) {
      side.later.push_back(over);
      continue;
    }
    const HalfedgeId entry = ground_->twin(over.edge);
    if (!entry.valid() || !side.met.insert(Tin::triangle_of(entry).value())) continue;
    const VertexId apex = ground_->apex(entry);
    const Position at = position(side.from, side.to, apex);
    const auto found = beside(side, apex, at);
    if (found && !meet(*found)) return false;
    pending_.push_back({Tin::next(entry), over.from, at});
    pending_.push_back({Tin::previous(entry), at, over.to});
  }
  return true;
}

// Whether at most `most_` vertices of the side are inside the circle through u, v and one on the other side.
bool Pencil::few_inside(Side& side, const Beside& corner) {
  side.later.clear();
  side.met.clear();
  side.beyond.clear();
  for (const TriangleId t : passed_) side.met.insert(t.value());
  put_borders(side);
  std::size_t count = 0;
  const auto note = [&](const Beside& found) {
    return !inside(side.to, side.from, corner, found) || ++count <= most_;
  };
  for (const Beside& passed : side.nearest) {
    if (!note(passed)) return false;
  }
  return spread(
      side, [&] { return corner.error - corner.cotangent; },
      [&](const Beside& found) {
        const auto known = [&](const std::vector<Beside>& list) {
          return std::any_of(list.begin(), list.end(),
                             [&](const Beside& other) { return other.vertex == found.vertex; });
        };
        if (known(side.nearest) || known(side.beyond)) return true;
        side.beyond.push_back(found);
        return note(found);
      });
}

// Goes on to the `most_` + 1 nearest. The limit was smaller before, and only gets smaller here.
void Pencil::complete(Side& side) {
  for (const Beside& found : side.beyond) insert(found, side);
  pending_.swap(side.later);
  side.later.clear();
  spread(
      side,
      [&] {
        const Beside& last = side.nearest.back();
        return side.nearest.size() > most_ ? last.cotangent + last.error : kUnbounded;
      },
      [&](const Beside& found) {
        insert(found, side);
        return true;
      });
}

// Whether x, beyond the edge between from and to, is inside the circle through its ends and a corner on the
// left of them.
bool Pencil::inside(Point2 from, Point2 to, const Beside& corner, const Beside& x) const {
  const double sum = corner.cotangent + x.cotangent, error = corner.error + x.error;
  if (sum < -error) return true;
  if (sum > error) return false;
  return in_circle_perturbed(from, to, ground_->point(corner.vertex), ground_->point(x.vertex));
}

// The faces that uv passes; false if there is a vertex on it, or it has too many vertices of such faces on
// one side.
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
    right_.vertices.push_back(one);
    right_.borders.push_back(h);
    left_.vertices.push_back(other);
    left_.borders.push_back(Tin::previous(h));
    break;
  }
  while (crossed.valid()) {
    passed_.push_back(Tin::triangle_of(crossed));
    const HalfedgeId entry = ground_->twin(crossed);
    if (!entry.valid()) return false;
    const VertexId apex = ground_->apex(entry);
    const int side = apex == v ? 0 : orientation(from, to, ground_->point(apex));
    if (side == 0 && apex != v) return false;
    if (side <= 0) right_.borders.push_back(Tin::next(entry));
    if (side >= 0) left_.borders.push_back(Tin::previous(entry));
    if (apex == v) {
      passed_.push_back(Tin::triangle_of(entry));
      return true;
    }
    Side& here = side > 0 ? left_ : right_;
    here.vertices.push_back(apex);
    if (here.vertices.size() > most_) return false;
    crossed = side > 0 ? Tin::next(entry) : Tin::previous(entry);
  }
  return false;
}

bool Pencil::look_at(VertexId u, VertexId v) {
  u_ = u;
  v_ = v;
  passed_.clear();
  left_.start(ground_->point(u), ground_->point(v));
  right_.start(ground_->point(v), ground_->point(u));
  if (!pass(u, v)) return false;
  begin(left_);
  begin(right_);
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
// what is inside on the other side, and more.
bool Pencil::may_be_of_use(VertexId a, VertexId b, std::span<const VertexId> known) {
  const Point2 from = ground_->point(a), to = ground_->point(b);
  known_left_.clear();
  known_right_.clear();
  for (const VertexId x : known) {
    if (x == a || x == b) continue;
    const Position at = position(from, to, x);
    const double across = std::abs(at.across), error = kRounding * at.size + kNoUnderflow;
    if (across <= 2 * error) continue;
    const double cotangent = at.along / across;
    (at.across > 0 ? known_left_ : known_right_)
        .push_back(cotangent + 2 * error * (1 + std::abs(cotangent)) / across);
  }
  const auto few = [&](const std::vector<double>& one, const std::vector<double>& other) {
    if (one.empty() || other.size() <= most_) return true;
    const double least = *std::min_element(one.begin(), one.end());
    const auto inside =
        std::count_if(other.begin(), other.end(), [&](double cotangent) { return cotangent < -least; });
    return static_cast<std::size_t>(inside) <= most_;
  };
  return few(known_left_, known_right_) && few(known_right_, known_left_);
}

}  // namespace thalweg::detail
