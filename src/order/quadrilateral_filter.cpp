// Filters in batches.
//
// Loops over arrays, without branches, so that the compiler makes them ones of vector instructions; they are
// compiled for several processors and chosen at run time. What the filters leave unclear is decided by the
// exact predicates, so results do not depend on the processor.
#include "order/quadrilateral_filter.hpp"

#include <thalweg/geometry/predicates.hpp>

#include <algorithm>

namespace thalweg {

namespace {

/// +1, -1, or 0 if rounding may hide the sign; without branches.
inline double sign_of(RoundedDeterminant determinant) {
  const double positive = determinant.value > determinant.doubt ? 1.0 : 0.0;
  const double negative = -determinant.value > determinant.doubt ? 1.0 : 0.0;
  return positive - negative;
}

/// What is beyond is computed for nothing, but is no loop of its own.
constexpr std::size_t whole_vectors(std::size_t count) {
  constexpr std::size_t kMostLanes = 8;
  return (count + kMostLanes - 1) / kMostLanes * kMostLanes;
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
void QuadrilateralFilter::judge_corners(Columns& at, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
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
void QuadrilateralFilter::judge_circles(Columns& at, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const Point2 s{at.x[0][i], at.y[0][i]}, u{at.x[1][i], at.y[1][i]};
    const Point2 t{at.x[2][i], at.y[2][i]}, v{at.x[3][i], at.y[3][i]};
    at.verdict[0][i] = sign_of(in_circle_rounded(s, u, t, {at.x[4][i], at.y[4][i]}));
    at.verdict[1][i] = sign_of(in_circle_rounded(s, u, t, {at.x[5][i], at.y[5][i]}));
    at.verdict[2][i] = sign_of(in_circle_rounded(t, v, s, {at.x[6][i], at.y[6][i]}));
    at.verdict[3][i] = sign_of(in_circle_rounded(t, v, s, {at.x[7][i], at.y[7][i]}));
  }
}

// Lists are filled without branches: what is not wanted is written over by the next.

std::size_t QuadrilateralFilter::list_edges(std::size_t begin, std::size_t end) {
  std::size_t count = 0;
  for (std::size_t i = begin; i < end; ++i) {
    const HalfedgeId h{i}, twin = tin_.twin(h);
    edge_[count] = h;
    count += static_cast<std::size_t>(twin.valid()) & static_cast<std::size_t>(h < twin) &
             static_cast<std::size_t>(!tin_.constrained(h));
  }
  return count;
}

// But for those that are surely not strictly convex.
std::size_t QuadrilateralFilter::list_convex(std::size_t edges) {
  for (std::size_t i = 0; i < edges; ++i) {
    const Spot left(edge_[i]), right(tin_.twin(edge_[i]));
    const Triangle& at_left = tin_.triangles()[left.triangle];
    const Triangle& at_right = tin_.triangles()[right.triangle];
    std::array<VertexId, 8>& vertex = vertex_[i];
    vertex[0] = at_left[left.previous_side()];
    vertex[1] = at_left[left.side];
    vertex[2] = at_right[right.previous_side()];
    vertex[3] = at_right[right.side];
    for (std::size_t corner = 0; corner < 4; ++corner) place(corner, i, vertex[corner]);
  }
  judge_corners(at_, whole_vectors(edges));
  std::size_t count = 0;
  for (std::size_t i = 0; i < edges; ++i) {
    const double at_u = at_.verdict[0][i], at_v = at_.verdict[1][i];
    for (std::size_t corner = 0; corner < 4; ++corner) {
      at_.x[corner][count] = at_.x[corner][i];
      at_.y[corner][count] = at_.y[corner][i];
      vertex_[count][corner] = vertex_[i][corner];
    }
    edge_[count] = edge_[i];
    convex_[count] = static_cast<unsigned>(at_u > 0) & static_cast<unsigned>(at_v > 0);
    count += static_cast<std::size_t>(at_u >= 0) & static_cast<std::size_t>(at_v >= 0);
  }
  return count;
}

void QuadrilateralFilter::look_beyond(std::size_t i) {
  const Spot left(edge_[i]), right(tin_.twin(edge_[i]));
  const std::array<HalfedgeId, 4> sides = {left.next(), right.previous(), right.next(), left.previous()};
  for (std::size_t side = 0; side < 4; ++side) {
    VertexId& beyond = vertex_[i][4 + side];
    beyond = vertex_[i][0];
    if (const HalfedgeId outer = tin_.twin(sides[side]); outer.valid()) {
      const Spot across(outer);
      beyond = tin_.triangles()[across.triangle][across.previous_side()];
    }
    place(4 + side, i, beyond);
  }
}

bool QuadrilateralFilter::refused(std::size_t i) const {
  const bool at_v = std::max(at_.verdict[0][i], at_.verdict[1][i]) > 0;
  const bool at_u = std::max(at_.verdict[2][i], at_.verdict[3][i]) > 0;
  if (refusing_ == Refusing::All) return at_v | at_u;
  if (refusing_ == Refusing::None) return false;
  return (at_v & !ground_.blocks(vertex_[i][3])) | (at_u & !ground_.blocks(vertex_[i][1]));
}

std::span<const EdgeSurroundings> QuadrilateralFilter::look(std::size_t begin, std::size_t end) {
  const std::size_t count = list_convex(list_edges(begin, end));
  for (std::size_t i = 0; i < count; ++i) look_beyond(i);
  judge_circles(at_, whole_vectors(count));
  std::array<std::uint32_t, kMost> left;
  std::size_t found = 0;
  for (std::size_t i = 0; i < count; ++i) {
    left[found] = static_cast<std::uint32_t>(i);
    found += static_cast<std::size_t>(!refused(i));
  }
  for (std::size_t j = 0; j < found; ++j) {
    const std::size_t i = left[j];
    const auto& [s, u, t, v, at_vs, at_tv, at_ut, at_su] = vertex_[i];
    found_[j].quadrilateral = {s, u, t, v, edge_[i]};
    found_[j].beyond = {at_vs, at_tv, at_ut, at_su};
    for (std::size_t side = 0; side < 4; ++side) {
      found_[j].inside[side] = static_cast<std::int8_t>(at_.verdict[side][i]);
    }
    found_[j].convex = convex_[i];
  }
  return std::span(found_).first(found);
}

}  // namespace thalweg
