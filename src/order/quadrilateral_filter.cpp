// Filters in batches.
//
// Loops over arrays, without branches, so that the compiler makes them ones of vector instructions; they are
// compiled for several processors and chosen at run time. What the filters leave unclear is decided by the
// exact predicates, so results do not depend on the processor.
#include "order/quadrilateral_filter.hpp"

#include <thalweg/geometry/predicates.hpp>

#include <cmath>

namespace thalweg {

namespace {

/// +1, -1, or 0 if rounding may hide the sign; without branches.
inline double sign_of(RoundedDeterminant determinant) {
  const double positive = determinant.value > determinant.doubt ? 1.0 : 0.0;
  const double negative = -determinant.value > determinant.doubt ? 1.0 : 0.0;
  return positive - negative;
}

/// A halfedge's triangle and place in it, and the ids that follow from these: divided by three once.
struct Spot {
  std::size_t triangle, side;
  explicit Spot(HalfedgeId h) : triangle(h.index() / 3), side(h.index() - 3 * triangle) {}
  [[nodiscard]] std::size_t next_side() const { return side == 2 ? 0 : side + 1; }
  [[nodiscard]] std::size_t previous_side() const { return side == 0 ? 2 : side - 1; }
  [[nodiscard]] HalfedgeId next() const { return HalfedgeId{3 * triangle + next_side()}; }
  [[nodiscard]] HalfedgeId previous() const { return HalfedgeId{3 * triangle + previous_side()}; }
};

}  // namespace

// The choice is made before sanitizers are ready.
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__) && \
    !defined(__SANITIZE_ADDRESS__)
[[gnu::target_clones("default", "avx2", "avx512f")]]
#endif
void QuadrilateralFilter::judge_corners(Columns& at) {
  for (std::size_t i = 0; i < kMost; ++i) {
    const Point2 s{at.x[0][i], at.y[0][i]}, u{at.x[1][i], at.y[1][i]};
    const Point2 t{at.x[2][i], at.y[2][i]}, v{at.x[3][i], at.y[3][i]};
    at.verdict[0][i] = sign_of(orientation_rounded(s, u, t));
    at.verdict[1][i] = sign_of(orientation_rounded(t, v, s));
  }
}

#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__) && \
    !defined(__SANITIZE_ADDRESS__)
[[gnu::target_clones("default", "avx2", "avx512f")]]
#endif
void QuadrilateralFilter::judge_circles(Columns& at) {
  for (std::size_t i = 0; i < kMost; ++i) {
    const Point2 s{at.x[0][i], at.y[0][i]}, u{at.x[1][i], at.y[1][i]};
    const Point2 t{at.x[2][i], at.y[2][i]}, v{at.x[3][i], at.y[3][i]};
    at.verdict[0][i] = sign_of(in_circle_rounded(s, u, t, {at.x[4][i], at.y[4][i]}));
    at.verdict[1][i] = sign_of(in_circle_rounded(s, u, t, {at.x[5][i], at.y[5][i]}));
    at.verdict[2][i] = sign_of(in_circle_rounded(t, v, s, {at.x[6][i], at.y[6][i]}));
    at.verdict[3][i] = sign_of(in_circle_rounded(t, v, s, {at.x[7][i], at.y[7][i]}));
  }
}

bool QuadrilateralFilter::is_convex(const Quadrilateral& q, std::size_t i) const {
  const double at_u = at_.verdict[0][i], at_v = at_.verdict[1][i];
  if (at_u < 0 || at_v < 0) return false;
  return (at_u > 0 || orientation(tin_.point(q.s), tin_.point(q.u), tin_.point(q.t)) > 0) &&
         (at_v > 0 || orientation(tin_.point(q.t), tin_.point(q.v), tin_.point(q.s)) > 0);
}

// But for what is beyond. In place: a copy would have to wait until all parts are written.
void QuadrilateralFilter::surround(HalfedgeId h, EdgeSurroundings& found) const {
  const Spot left(h), right(tin_.twin(h));
  const Triangle& at_left = tin_.triangles()[left.triangle];
  const Triangle& at_right = tin_.triangles()[right.triangle];
  Quadrilateral& quadrilateral = found.quadrilateral;
  quadrilateral.s = at_left[left.previous_side()];
  quadrilateral.u = at_left[left.side];
  quadrilateral.t = at_right[right.previous_side()];
  quadrilateral.v = at_right[right.side];
  quadrilateral.diagonal = h;
  found.sides[0] = left.next();
  found.sides[1] = right.previous();
  found.sides[2] = right.next();
  found.sides[3] = left.previous();
}

std::span<const EdgeSurroundings> QuadrilateralFilter::look(std::span<const HalfedgeId> edges) {
  for (std::size_t i = 0; i < edges.size(); ++i) {
    surround(edges[i], found_[i]);
    const Quadrilateral& q = found_[i].quadrilateral;
    place(0, i, q.s), place(1, i, q.u), place(2, i, q.t), place(3, i, q.v);
  }
  judge_corners(at_);
  std::size_t count = 0;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (!is_convex(found_[i].quadrilateral, i)) continue;
    EdgeSurroundings& found = found_[count];
    found = found_[i];
    for (std::size_t side = 0; side < 4; ++side) {
      at_.x[side][count] = at_.x[side][i], at_.y[side][count] = at_.y[side][i];
      found.beyond[side] = found.quadrilateral.s;
      if (const HalfedgeId outer = tin_.twin(found.sides[side]); outer.valid()) {
        const Spot across(outer);
        found.beyond[side] = tin_.triangles()[across.triangle][across.previous_side()];
      }
      place(4 + side, count, found.beyond[side]);
    }
    ++count;
  }
  judge_circles(at_);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t side = 0; side < 4; ++side) {
      found_[i].inside[side] = static_cast<std::int8_t>(at_.verdict[side][i]);
    }
  }
  return std::span(found_).first(count);
}

}  // namespace thalweg
