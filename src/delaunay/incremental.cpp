// Incremental Delaunay triangulation on flat arrays.
//
// Based on: Bowyer, Computing Dirichlet tessellations, and Watson, Computing the n-dimensional Delaunay
// tessellation, 1981; ghost triangles: Shewchuk, Lecture notes on Delaunay mesh generation, 1999, section
// 3.4; the layout and the walk along the cavity are ours.
//
// 1. A vertex is located by a walk from the last one's triangle through sides that have it on their far
//    side. In a Delaunay triangulation such a walk ends, in the triangle that holds it or in a ghost.
// 2. The cells whose circles hold the vertex (under the tie rule, which is one perturbation of the lifted
//    points) form its cavity: connected, around the located cell, without vertices inside, so its dual graph
//    is a tree. A depth-first search that takes sides counter-clockwise therefore needs no marks, and comes
//    upon the sides of the cavity's rim one after the other, counter-clockwise. Cells are judged before it is
//    their turn, both behind one at once, and without branches on the outcome: waits overlap.
// 3. As it does, each side of the rim and the vertex make a new cell, linked to the one before. Cells of the
//    cavity are used again once the search is over; two more than there were are needed, so n vertices fill
//    exactly 2 n - 2 cells.
// 4. No new triangle is flat: a vertex in line with a side of the rim lies beside it; were it beyond one end
//    of the side, it would be outside of the circle of the cell within, and on the open side inside both
//    neighbours' circles. A ghost is in conflict if the vertex lies beyond its hull edge, or on it.
#include "incremental.hpp"

#include <thalweg/base/assert.hpp>

#include <algorithm>
#include <optional>
#include <vector>

namespace thalweg::detail {

bool beyond_hull_edge(const Cell& ghost, const Positions& at, Point2 p) {
  const std::uint32_t infinity = at.infinity();
  std::uint32_t corner = 0;
  while (ghost.vertex[corner] != infinity) ++corner;
  const Point2 from = at[ghost.vertex[after(corner)]];
  const Point2 to = at[ghost.vertex[before(corner)]];
  const int side = orientation(from, to, p);
  if (side != 0) return side > 0;
  return from.x != to.x ? (from.x < p.x) == (p.x < to.x) : (from.y < p.y) == (p.y < to.y);
}

bool in_conflict_unsure(const Cell& cell, const Positions& at, Point2 p) {
  const auto [a, b, c] = cell.vertex;
  const std::uint32_t infinity = at.infinity();
  if (a == infinity || b == infinity || c == infinity) return beyond_hull_edge(cell, at, p);
  return in_circle_perturbed_exact(at[a], at[b], at[c], p);
}

namespace {

// A few milliseconds of work.
constexpr std::size_t kStepsBetweenChecks = 2048;

class Insertion {
 public:
  Insertion(const Positions& at, std::span<Cell> cells, std::uint32_t first_cell)
      : at_(at), cells_(cells), next_cell_(first_cell) {
    make_room(64);
  }

  void start(std::array<std::uint32_t, 3> corners);
  void insert(std::uint32_t v);

 private:
  [[nodiscard]] std::uint32_t locate(Point2 p) const;
  void make_room(std::size_t room) {
    pending_.resize(room);
    cavity_.resize(room);
    rim_.resize(room);
  }

  Positions at_;
  std::span<Cell> cells_;
  std::uint32_t next_cell_;
  std::uint32_t last_ = 0;  ///< a finite cell near the next vertex, as is hoped
  // Room for the search of a cavity: of each there are at most two more than cells in conflict.
  std::vector<std::uint64_t> pending_;  ///< twice a side of a cell to visit; one more: that is in conflict
  std::vector<std::uint32_t> cavity_;   ///< cells in conflict
  std::vector<std::uint32_t> rim_;      ///< sides, seen from outside of the cavity
};

// Pre: corners are counter-clockwise. The three ghosts lie beyond the sides.
void Insertion::start(std::array<std::uint32_t, 3> corners) {
  const std::uint32_t first = next_cell_;
  next_cell_ += 4;
  cells_[first] = {corners, {}, {}, 0};
  for (std::uint32_t i = 0; i < 3; ++i) {
    cells_[first + 1 + i] = {{at_.infinity(), corners[before(i)], corners[after(i)]}, {}, {}, 0};
  }
  for (std::uint32_t i = 0; i < 3; ++i) {
    link(cells_, side_of(first, i), side_of(first + 1 + i, 0));
    // Beyond side (corner after i, infinity) of this ghost lies the ghost whose hull edge ends there.
    link(cells_, side_of(first + 1 + i, 1), side_of(first + 1 + before(i), 2));
  }
  last_ = first;
}

// Whether p lies to the right of ab; the sign alone is asked for without a branch, as in `in_conflict`.
inline bool right_of(const Point2& a, const Point2& b, const Point2& p) {
  const RoundedDeterminant turn = orientation_rounded(a, b, p);
  return turn.sure() ? turn.value < 0 : orientation_exact(a, b, p) < 0;
}

std::uint32_t Insertion::locate(Point2 p) const {
  const std::uint32_t infinity = at_.infinity();
  const Cell& first = cells_[last_];
  std::uint32_t exit = 0;
  while (!right_of(at_[first.vertex[after(exit)]], at_[first.vertex[before(exit)]], p)) {
    if (++exit == 3) return last_;
  }
  std::uint32_t side = first.neighbour[exit];
  // Where both ways lead on, they are taken in turns: who keeps to one goes around the whole fan of a vertex
  // that has very many neighbours, as points near one line have.
  for (bool turn = false;; turn = !turn) {
    const Cell& here = cells_[cell_of(side)];
    const std::uint32_t corner = corner_of(side);
    if (here.vertex[corner] == infinity) return cell_of(side);
    const Point2& apex = at_[here.vertex[corner]];
    const bool past_one = right_of(at_[here.vertex[before(corner)]], apex, p);
    const bool past_other = right_of(apex, at_[here.vertex[after(corner)]], p);
    if (!past_one && !past_other) return cell_of(side);
    side = here.neighbour[past_one && (turn || !past_other) ? after(corner) : before(corner)];
  }
}

void Insertion::insert(std::uint32_t v) {
  const Point2 p = at_[v];
  const std::uint32_t start = locate(p);
  const auto judged = [&](std::uint32_t side) {
    return 2 * std::uint64_t{side} + (in_conflict(cells_[cell_of(side)], at_, p) ? 1 : 0);
  };
  std::size_t cavity = 0, rim = 0, pending = 0;
  cavity_[cavity++] = start;
  for (std::uint32_t i = 3; i-- > 0;) pending_[pending++] = judged(cells_[start].neighbour[i]);
  while (pending > 0) {
    const std::uint64_t next = pending_[--pending];
    const auto side = static_cast<std::uint32_t>(next / 2);
    if (next % 2 == 0) {
      rim_[rim++] = side;
      continue;
    }
    if (cavity + 3 == cavity_.size()) make_room(2 * cavity_.size());
    const Cell& cell = cells_[cell_of(side)];
    const std::uint32_t corner = corner_of(side);
    cavity_[cavity++] = cell_of(side);
    pending_[pending] = judged(cell.neighbour[before(corner)]);
    pending_[pending + 1] = judged(cell.neighbour[after(corner)]);
    pending += 2;
  }
  THALWEG_ASSERT(rim == cavity + 2);
  cavity_[cavity++] = next_cell_++;
  cavity_[cavity++] = next_cell_++;

  const std::uint32_t infinity = at_.infinity();
  std::uint32_t previous = cavity_[rim - 1];
  for (std::size_t i = 0; i < rim; ++i) {
    const std::uint32_t outer = rim_[i];
    const std::uint32_t made = cavity_[i];
    const std::uint32_t following = cavity_[i + 1 == rim ? 0 : i + 1];
    Cell& beyond = cells_[cell_of(outer)];
    const std::uint32_t corner = corner_of(outer);
    const std::uint32_t from = beyond.vertex[before(corner)];
    const std::uint32_t to = beyond.vertex[after(corner)];
    cells_[made] = {{v, from, to}, {outer, side_of(following, 2), side_of(previous, 1)}, {}, 0};
    beyond.neighbour[corner] = side_of(made, 0);
    if (from != infinity && to != infinity) last_ = made;
    previous = made;
  }
}

/// Index of three vertices that are not collinear: the first two, and the first that makes a triangle.
std::optional<std::size_t> first_apex(const Positions& at, std::span<const std::uint32_t> vertices) {
  for (std::size_t i = 2; i < vertices.size(); ++i) {
    if (orientation(at[vertices[0]], at[vertices[1]], at[vertices[i]]) != 0) return i;
  }
  return std::nullopt;
}

}  // namespace

bool insert_all(const Positions& at, std::span<const std::uint32_t> vertices, std::span<Cell> cells,
                std::uint32_t first_cell, const Progress& progress) {
  const auto apex = first_apex(at, vertices);
  if (!apex) return false;
  std::array<std::uint32_t, 3> corners{vertices[0], vertices[1], vertices[*apex]};
  if (orientation(at[corners[0]], at[corners[1]], at[corners[2]]) < 0) std::swap(corners[0], corners[1]);
  Insertion insertion(at, cells, first_cell);
  insertion.start(corners);
  for (std::size_t i = 2; i < vertices.size(); ++i) {
    if (i % kStepsBetweenChecks == 0) progress.check();
    if (i != *apex) insertion.insert(vertices[i]);
  }
  return true;
}

}  // namespace thalweg::detail
