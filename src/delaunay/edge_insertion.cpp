// Inserting constraint edges.
//
// Based on: Anglada, An improved incremental algorithm for constructing restricted Delaunay triangulations,
// 1997, for the cavity; Toussaint, Avis, On a convex hull algorithm for polygons and its application to
// triangulation problems, 1982, for its halves.
//
// 1. Look at the cells about a and those about b in turn, as one of both may have very many, for the one
//    through whose far side ab leaves; say a's. Walk along ab to b: the cells crossed are the cavity. Of each
//    but the first and the last, one side is not crossed: it lies left or right of ab; the first has one at
//    a, the last one at b, on either hand.
// 2. The sides on one hand form a chain from a to b; together with ab it bounds half of the cavity. Each
//    vertex of the chain was joined across ab, so it sees a point of ab. Such a polygon is triangulated by
//    one scan: whenever the last two pieces of the chain turn towards ab, they and the chord between their
//    ends make a triangle, and the chord takes their place. A vertex may be on the chain twice, at the end of
//    an edge that hangs into the cavity; both sides of that edge are pieces of the chain, and the triangles
//    that come to lie at them are linked when the second one is made.
// 3. Flips make the new sides inside Delaunay. Sides of the chains were and stay sides of the constrained
//    Delaunay triangulation: a cell behind them sees nothing new.
// 4. Threads share the vertices out in ranges of their numbers. One inserts an edge if both its ends and all
//    corners of the cells that it crosses are its own; the others wait until all are done. What it rewrites
//    are cells with three corners of its own; of other cells it writes the sides between two of its own, and
//    reads corners and sides only at its own. A cell has but three corners, so no other thread writes any of
//    these. The outcome is unique, whoever inserts what and when.
#include "edge_insertion.hpp"

#include "base/id_range.hpp"
#include "base/parallel.hpp"

#include <thalweg/base/assert.hpp>
#include <thalweg/base/raw_vector.hpp>

#include <algorithm>
#include <atomic>

namespace thalweg::detail {

namespace {

constexpr std::size_t kStepsBetweenChecks = 1024;
constexpr std::size_t kBlock = 1 << 14;  // cells
// Fewer edges are not worth a thread of their own.
constexpr std::size_t kLeastEdges = 1 << 9;
constexpr std::uint32_t kNone = 0xffffffffU;

class EdgeInsertion {
 public:
  enum class Outcome : std::uint8_t { Inserted, NotOurs, Fault };

  /// `incident`: for each vertex a cell that it is a corner of.
  EdgeInsertion(const Positions& at, std::span<Cell> cells, std::span<std::uint32_t> incident, IdRange ours,
                const Progress& progress)
      : at_(at), cells_(cells), progress_(progress), incident_(incident), ours_(ours) {}

  /// Changes nothing unless it is inserted.
  Outcome insert(const DrawnEdge& edge);

 private:
  /// A piece of a chain: from the vertex before it to `to`, with what lies beyond.
  struct Piece {
    std::uint32_t to = 0;
    std::uint32_t outer = kNone;    ///< the side beyond, of a cell that stays or is already new
    std::uint32_t partner = kNone;  ///< of an edge that hangs into the cavity: its other side's piece
    EdgeKind kind = EdgeKind::None;
  };

  /// What one cell at the end of an edge tells of it; nothing of most of them.
  struct Look {
    std::uint32_t along = kNone;    ///< the edge is this side
    std::uint32_t inside = kNone;   ///< it runs through this vertex
    std::uint32_t leaving = kNone;  ///< it leaves the cell through this side
    [[nodiscard]] bool tells() const { return along != kNone || inside != kNone || leaving != kNone; }
  };

  void note_incident(std::uint32_t cell);
  [[nodiscard]] std::uint32_t corner_at(std::uint32_t cell, std::uint32_t vertex) const;
  [[nodiscard]] Look look(std::uint32_t cell, std::uint32_t from, std::uint32_t to) const;
  [[nodiscard]] bool is_ours(const Cell& cell) const {
    return std::ranges::all_of(cell.vertex, [this](std::uint32_t v) { return ours_.contains(v); });
  }
  Outcome find_cavity(std::uint32_t leaving, std::uint32_t a, std::uint32_t b);
  void take_pieces(std::uint32_t a, std::uint32_t b);
  void add_piece(std::uint32_t side, std::vector<std::uint32_t>& chain);
  std::uint32_t fill(std::span<const std::uint32_t> chain, std::uint32_t from);
  std::uint32_t make_triangle(std::uint32_t from, const Piece& first, const Piece& second);
  void attach(std::uint32_t side, const Piece& piece);
  void mark(std::uint32_t side, EdgeKind kind);
  void legalise();
  void flip(std::uint32_t side);

  Positions at_;
  std::span<Cell> cells_;
  const Progress& progress_;
  std::span<std::uint32_t> incident_;
  IdRange ours_;
  std::vector<std::uint32_t> cavity_;    ///< cells crossed, in order
  std::vector<Piece> pieces_;            ///< of both chains
  std::vector<std::uint32_t> piece_of_;  ///< for each cell of the cavity: the piece at the side not crossed
  std::vector<std::uint32_t> left_, right_;  ///< chains as indices of pieces, from b to a and from a to b
  std::vector<std::uint32_t> unused_;        ///< cells of the cavity to be used again
  std::vector<std::uint32_t> scan_;          ///< pieces of the chain as it shrinks
  std::vector<std::uint32_t> doubtful_;      ///< new sides that may not be Delaunay
};

void EdgeInsertion::note_incident(std::uint32_t cell) {
  for (const std::uint32_t v : cells_[cell].vertex) {
    if (v != at_.infinity()) incident_[v] = cell;
  }
}

void EdgeInsertion::mark(std::uint32_t side, EdgeKind kind) {
  cells_[cell_of(side)].kind[corner_of(side)] = kind;
  const std::uint32_t other = cells_[cell_of(side)].neighbour[corner_of(side)];
  cells_[cell_of(other)].kind[corner_of(other)] = kind;
}

std::uint32_t EdgeInsertion::corner_at(std::uint32_t cell, std::uint32_t vertex) const {
  std::uint32_t corner = 0;
  while (cells_[cell].vertex[corner] != vertex) ++corner;
  return corner;
}

EdgeInsertion::Look EdgeInsertion::look(std::uint32_t cell, std::uint32_t from, std::uint32_t to) const {
  const Cell& here = cells_[cell];
  const std::uint32_t corner = corner_at(cell, from);
  const std::uint32_t right = here.vertex[after(corner)];
  const std::uint32_t left = here.vertex[before(corner)];
  if (right == to || left == to)
    return {.along = side_of(cell, right == to ? before(corner) : after(corner))};
  if (right == at_.infinity() || left == at_.infinity()) return {};
  const int of_right = orientation(at_[from], at_[to], at_[right]);
  const int of_left = orientation(at_[from], at_[to], at_[left]);
  for (const auto& [v, side] : {std::pair(right, of_right), std::pair(left, of_left)}) {
    if (side == 0 && on_segment(at_[from], at_[to], at_[v])) return {.inside = v};
  }
  if (of_right < 0 && of_left > 0 && orientation(at_[from], at_[right], at_[left]) > 0) {
    return {.leaving = side_of(cell, corner)};
  }
  return {};
}

EdgeInsertion::Outcome EdgeInsertion::find_cavity(std::uint32_t leaving, std::uint32_t a, std::uint32_t b) {
  cavity_.clear();
  while (true) {
    cavity_.push_back(cell_of(leaving));
    if (!is_ours(cells_[cell_of(leaving)])) return Outcome::NotOurs;
    if (is_constraint(cells_[cell_of(leaving)].kind[corner_of(leaving)])) return Outcome::Fault;
    const std::uint32_t entered = cells_[cell_of(leaving)].neighbour[corner_of(leaving)];
    const std::uint32_t corner = corner_of(entered);
    const std::uint32_t apex = cells_[cell_of(entered)].vertex[corner];
    if (apex == b) {
      cavity_.push_back(cell_of(entered));
      return Outcome::Inserted;
    }
    const int side = orientation(at_[a], at_[b], at_[apex]);
    if (side == 0) return Outcome::Fault;
    // The left end of the side just crossed comes after the apex; an apex on the left takes its place.
    leaving = side_of(cell_of(entered), side > 0 ? after(corner) : before(corner));
  }
}

void EdgeInsertion::add_piece(std::uint32_t side, std::vector<std::uint32_t>& chain) {
  const Cell& cell = cells_[cell_of(side)];
  const std::uint32_t corner = corner_of(side);
  chain.push_back(static_cast<std::uint32_t>(pieces_.size()));
  pieces_.push_back({cell.vertex[before(corner)], cell.neighbour[corner], kNone, cell.kind[corner]});
}

// Counter-clockwise around each half, so a piece runs as the side of the cell of the cavity does.
void EdgeInsertion::take_pieces(std::uint32_t a, std::uint32_t b) {
  pieces_.clear();
  left_.clear();
  right_.clear();
  piece_of_.assign(cavity_.size(), kNone);
  for (std::size_t i = 0; i < cavity_.size(); ++i)
    cells_[cavity_[i]].mark = static_cast<std::uint32_t>(i + 1);
  for (std::size_t i = 0; i < cavity_.size(); ++i) {
    const Cell& cell = cells_[cavity_[i]];
    if (i == 0 || i + 1 == cavity_.size()) {
      const std::uint32_t tip = i == 0 ? a : b;
      const std::uint32_t corner = corner_at(cavity_[i], tip);
      // Opposite to the right neighbour of a, or the left one of b, lies the side on the left of ab.
      add_piece(side_of(cavity_[i], after(corner)), i == 0 ? left_ : right_);
      add_piece(side_of(cavity_[i], before(corner)), i == 0 ? right_ : left_);
      continue;
    }
    std::uint32_t corner = 0;
    const auto in_cavity = [&](std::uint32_t side, std::size_t index) {
      return cells_[cell_of(side)].mark == index + 1;
    };
    while (in_cavity(cell.neighbour[corner], i - 1) || in_cavity(cell.neighbour[corner], i + 1)) ++corner;
    piece_of_[i] = static_cast<std::uint32_t>(pieces_.size());
    const bool on_left = orientation(at_[a], at_[b], at_[cell.vertex[after(corner)]]) > 0;
    add_piece(side_of(cavity_[i], corner), on_left ? left_ : right_);
  }
  for (std::size_t i = 0; i < cavity_.size(); ++i) {
    if (piece_of_[i] == kNone) continue;
    Piece& piece = pieces_[piece_of_[i]];
    const std::uint32_t beyond = cells_[cell_of(piece.outer)].mark;
    if (beyond != 0) piece.partner = piece_of_[beyond - 1];
  }
  for (Piece& piece : pieces_) {
    if (piece.partner != kNone) piece.outer = kNone;
  }
  for (const std::uint32_t c : cavity_) cells_[c].mark = 0;
  std::reverse(left_.begin(), left_.end());
}

void EdgeInsertion::attach(std::uint32_t side, const Piece& piece) {
  cells_[cell_of(side)].kind[corner_of(side)] = piece.kind;
  if (piece.partner == kNone) {
    link(cells_, side, piece.outer);
  } else {
    // The other side of the hanging edge comes later, and finds this one as what lies beyond.
    Piece& partner = pieces_[piece.partner];
    partner.outer = side;
    partner.partner = kNone;
  }
}

// The triangle from -> first.to -> second.to; its third side is opposite to corner 1.
std::uint32_t EdgeInsertion::make_triangle(std::uint32_t from, const Piece& first, const Piece& second) {
  const std::uint32_t made = unused_.back();
  unused_.pop_back();
  cells_[made] = {{from, first.to, second.to}, {kNone, kNone, kNone}, {}, 0};
  attach(side_of(made, 2), first);
  attach(side_of(made, 0), second);
  note_incident(made);
  return side_of(made, 1);
}

// Triangulates one half, whose chain starts at `from`; the side along ab.
std::uint32_t EdgeInsertion::fill(std::span<const std::uint32_t> chain, std::uint32_t from) {
  scan_.clear();
  const auto start_of = [&](std::size_t i) { return i == 0 ? from : pieces_[scan_[i - 1]].to; };
  for (const std::uint32_t piece : chain) {
    scan_.push_back(piece);
    while (scan_.size() >= 2) {
      const std::size_t last = scan_.size() - 1;
      const std::uint32_t begin = start_of(last - 1);
      const Piece first = pieces_[scan_[last - 1]];
      const Piece second = pieces_[scan_[last]];
      if (orientation(at_[begin], at_[first.to], at_[second.to]) <= 0) break;
      const std::uint32_t chord = make_triangle(begin, first, second);
      doubtful_.push_back(chord);
      scan_.pop_back();
      scan_.back() = static_cast<std::uint32_t>(pieces_.size());
      pieces_.push_back({second.to, chord, kNone, EdgeKind::None});
    }
  }
  THALWEG_ASSERT(scan_.size() == 1);
  doubtful_.pop_back();  // ab itself
  return pieces_[scan_.front()].outer;
}

void EdgeInsertion::flip(std::uint32_t side) {
  // Cells c = (p, u, v) and d = (q, v, u), the side opposite to p and q, become (p, u, q) and (q, v, p).
  const std::uint32_t other = cells_[cell_of(side)].neighbour[corner_of(side)];
  const std::uint32_t c = cell_of(side), d = cell_of(other);
  const std::uint32_t i = corner_of(side), j = corner_of(other);
  const Cell old_c = cells_[c], old_d = cells_[d];
  const std::uint32_t p = old_c.vertex[i], u = old_c.vertex[after(i)], v = old_c.vertex[before(i)];
  const std::uint32_t q = old_d.vertex[j];
  const std::uint32_t beyond_pu = old_c.neighbour[before(i)], beyond_vp = old_c.neighbour[after(i)];
  const std::uint32_t beyond_qv = old_d.neighbour[before(j)], beyond_uq = old_d.neighbour[after(j)];
  cells_[c] = {{p, u, q}, {}, {old_d.kind[after(j)], EdgeKind::None, old_c.kind[before(i)]}, 0};
  cells_[d] = {{q, v, p}, {}, {old_c.kind[after(i)], EdgeKind::None, old_d.kind[before(j)]}, 0};
  link(cells_, side_of(c, 0), beyond_uq);
  link(cells_, side_of(c, 2), beyond_pu);
  link(cells_, side_of(d, 0), beyond_vp);
  link(cells_, side_of(d, 2), beyond_qv);
  link(cells_, side_of(c, 1), side_of(d, 1));
  note_incident(c);
  note_incident(d);
  for (const std::uint32_t s : {side_of(c, 0), side_of(c, 2), side_of(d, 0), side_of(d, 2)}) {
    doubtful_.push_back(s);
  }
}

void EdgeInsertion::legalise() {
  std::size_t steps = 0;
  while (!doubtful_.empty()) {
    if (++steps % kStepsBetweenChecks == 0) progress_.check();
    const std::uint32_t side = doubtful_.back();
    doubtful_.pop_back();
    const Cell& cell = cells_[cell_of(side)];
    const std::uint32_t corner = corner_of(side);
    if (is_constraint(cell.kind[corner])) continue;
    const std::uint32_t other = cell.neighbour[corner];
    const std::uint32_t apex = cells_[cell_of(other)].vertex[corner_of(other)];
    if (apex == at_.infinity() || cell.vertex[corner] == at_.infinity()) continue;
    if (in_circle_perturbed(at_[cell.vertex[0]], at_[cell.vertex[1]], at_[cell.vertex[2]], at_[apex])) {
      flip(side);
    }
  }
}

EdgeInsertion::Outcome EdgeInsertion::insert(const DrawnEdge& edge) {
  auto [a, b] = edge.ends;
  if (!ours_.contains(a) || !ours_.contains(b)) return Outcome::NotOurs;
  std::uint32_t cell_at_a = incident_[a], cell_at_b = incident_[b];
  Look found = look(cell_at_a, a, b);
  while (!found.tells()) {
    cell_at_a = cell_of(cells_[cell_at_a].neighbour[after(corner_at(cell_at_a, a))]);  // counter-clockwise
    std::swap(a, b);
    std::swap(cell_at_a, cell_at_b);
    found = look(cell_at_a, a, b);
  }
  if (found.inside != kNone) return Outcome::Fault;
  if (found.along != kNone) {
    mark(found.along, edge.kind);
    return Outcome::Inserted;
  }
  if (const Outcome outcome = find_cavity(found.leaving, a, b); outcome != Outcome::Inserted) return outcome;
  take_pieces(a, b);
  unused_ = cavity_;
  doubtful_.clear();
  const std::uint32_t on_left = fill(left_, b);
  const std::uint32_t on_right = fill(right_, a);
  link(cells_, on_left, on_right);
  mark(on_left, edge.kind);
  legalise();
  return Outcome::Inserted;
}

/// For each vertex some cell that it is a corner of.
RawVector<std::uint32_t> incident_cells(const Positions& at, std::span<const Cell> cells,
                                        const Progress& progress) {
  RawVector<std::uint32_t> incident(at.infinity());
  for_each_block(cells.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      for (const std::uint32_t v : cells[c].vertex) {
        if (v == at.infinity()) continue;
        std::atomic_ref(incident[v]).store(static_cast<std::uint32_t>(c), std::memory_order_relaxed);
      }
    }
  });
  return incident;
}

/// What one thread left undone.
struct Rest {
  std::vector<DrawnEdge> edges;
  std::optional<VertexPair> fault;
};

Rest insert_own(EdgeInsertion insertion, std::span<const DrawnEdge> edges, const Progress& progress) {
  Rest rest;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (i % kStepsBetweenChecks == 0) progress.check();
    const auto outcome = insertion.insert(edges[i]);
    if (outcome == EdgeInsertion::Outcome::NotOurs) rest.edges.push_back(edges[i]);
    if (outcome != EdgeInsertion::Outcome::Fault) continue;
    rest.fault = edges[i].ends;
    break;
  }
  return rest;
}

}  // namespace

std::optional<VertexPair> insert_edges(const Positions& at, std::span<Cell> cells,
                                       std::span<const DrawnEdge> edges, std::size_t threads,
                                       const Progress& progress) {
  RawVector<std::uint32_t> incident = incident_cells(at, cells, progress);
  const auto insert_of = [&](IdRange ours, std::span<const DrawnEdge> some) {
    return insert_own({at, cells, incident, ours, progress}, some, progress);
  };
  const IdRange all{0, at.infinity()};
  const std::size_t parts = std::min(threads, edges.size() / kLeastEdges);
  if (parts < 2) return insert_of(all, edges).fault;
  std::vector<Rest> rests(parts);
  for_each_block(parts, 1, progress, [&](std::size_t i, std::size_t) {
    const auto limit = [&](std::size_t part) {
      return part == 0 ? 0 : part == parts ? all.end : edges[part * edges.size() / parts].ends.first;
    };
    const IdRange ours{limit(i), limit(i + 1)};
    const auto first_from = [&](std::uint32_t v) {
      return std::ranges::lower_bound(edges, v, {}, [](const DrawnEdge& edge) { return edge.ends.first; });
    };
    rests[i] = insert_of(ours, {first_from(ours.begin), first_from(ours.end)});
  });
  std::vector<DrawnEdge> left;
  for (const Rest& rest : rests) {
    if (rest.fault) return rest.fault;
    left.insert(left.end(), rest.edges.begin(), rest.edges.end());
  }
  return insert_of(all, left).fault;
}

}  // namespace thalweg::detail
