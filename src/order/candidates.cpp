// Candidate triangles, their edges, crossings and faces.
//
// 1. Edges of all triangles, sorted; a triangle with a side off the rim beyond which there is none goes,
//    until none goes. What remains of the edges is numbered.
// 2. An edge that is none of the ground is followed through the triangles of the ground that it crosses: the
//    ground's edges on the way cross it; edges that pass one triangle of the ground are tested against each
//    other. Two edges that cross have their common point in a triangle of the ground that both pass, or on an
//    edge that both cross.
// 3. Faces: triangles that share a free edge, and those with edges that cross, are of one face. Conversely
//    the triangles of one triangulation of a face hang together over free edges, and any other candidate of
//    the face overlaps one of them, so it has a free edge in common with it or one that crosses one of its
//    edges.
#include "order/candidates.hpp"

#include "base/parallel.hpp"
#include "base/release.hpp"
#include "base/union_find.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/geometry/predicates.hpp>

#include <algorithm>
#include <atomic>
#include <numeric>
#include <string>
#include <utility>

namespace thalweg::detail {

namespace {

constexpr std::size_t kBlock = 4096;
constexpr std::uint32_t kNone = 0xffffffffU;
// Of pairs of edges that cross; a pair takes 16 bytes, and as much again while it is sorted.
constexpr std::size_t kMostCrossings = 20'000'000;

[[noreturn]] void refuse_crossings(std::size_t edges) {
  throw Error(ErrorCode::SizeLimit, "more than " + std::to_string(kMostCrossings) + " pairs of the " +
                                        std::to_string(edges) +
                                        " edges of triangles of that order cross each other; take a smaller "
                                        "order, fewer vertices, or a stronger definition");
}

/// Items of each row, ascending, each once. `visit_all` calls what it is given with each row and item, the
/// same ones each time: no list of them is needed.
template <class VisitAll>
Rows rows_of(const VisitAll& visit_all, std::size_t count, const Progress& progress) {
  Rows rows;
  rows.first.assign(count + 1, 0);
  visit_all([&](std::uint32_t row, std::uint32_t /*item*/) { ++rows.first[row + 1]; });
  std::partial_sum(rows.first.begin(), rows.first.end(), rows.first.begin());
  rows.items.resize(rows.first.back());
  std::vector<std::uint32_t> next(rows.first.begin(), rows.first.end() - 1);
  visit_all([&](std::uint32_t row, std::uint32_t item) { rows.items[next[row]++] = item; });
  for_each_block(count, kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const auto from = rows.items.begin() + rows.first[row], to = rows.items.begin() + rows.first[row + 1];
      std::sort(from, to);
      next[row] = static_cast<std::uint32_t>(std::unique(from, to) - from);
    }
  });
  std::uint32_t kept = 0;
  for (std::size_t row = 0; row < count; ++row) {
    const auto from = rows.items.begin() + rows.first[row];
    std::copy(from, from + next[row], rows.items.begin() + kept);
    rows.first[row] = kept;
    kept += next[row];
  }
  rows.first[count] = kept;
  rows.items.resize(kept);
  return rows;
}

class Finder {
 public:
  Finder(const Tin& ground, std::vector<OrderTriangle> triangles, const Progress& progress)
      : ground_(ground), progress_(progress) {
    found_.points.assign(ground.points().begin(), ground.points().end());
    found_.triangles = std::move(triangles);
  }

  Candidates find() {
    number_edges();
    drop_dead_ends();
    find_crossings();
    cut_into_faces(found_, progress_);
    return std::move(found_);
  }

 private:
  void number_edges();
  void number_sides();
  void drop_dead_ends();
  void find_crossings();
  template <class Visit>
  void follow(const CandidateEdge& edge, const Visit& visit) const;
  [[nodiscard]] bool cross(std::uint32_t e, std::uint32_t f) const;
  [[nodiscard]] std::uint32_t number_of(VertexId a, VertexId b) const;
  [[nodiscard]] std::vector<std::uint32_t> numbers_in_ground() const;

  const Tin& ground_;
  const Progress& progress_;
  Candidates found_;
  std::vector<std::uint32_t> first_edge_;  ///< by lower end; then their number
};

void Finder::number_edges() {
  const auto visit_ends = [&](const auto& visit) {
    for (const OrderTriangle& t : found_.triangles) {
      for (std::size_t i = 0; i < 3; ++i) {
        const auto ends = std::minmax({t.corners[i].value(), t.corners[(i + 1) % 3].value()});
        visit(ends.first, ends.second);
      }
    }
  };
  Rows higher = rows_of(visit_ends, ground_.vertex_count(), progress_);
  found_.edges.assign(higher.items.size(), {});
  for_each_block(higher.size(), kBlock, progress_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      for (std::uint32_t e = higher.first[v]; e < higher.first[v + 1]; ++e) {
        const VertexId a{v}, b{higher.items[e]};
        const HalfedgeId there = ground_.find_halfedge(a, b);
        found_.edges[e] = {a, b, there.valid() ? there : ground_.find_halfedge(b, a), false};
      }
    }
  });
  first_edge_ = std::move(higher.first);
  number_sides();
}

void Finder::number_sides() {
  found_.sides.resize(found_.triangles.size());
  for_each_block(found_.triangles.size(), kBlock, progress_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const Triangle& corners = found_.triangles[t].corners;
      for (std::size_t i = 0; i < 3; ++i) {
        const VertexId from = corners[i], to = corners[(i + 1) % 3];
        found_.sides[t][i] = 2 * number_of(std::min(from, to), std::max(from, to)) + (to < from ? 1 : 0);
      }
    }
  });
}

// Pre: it is an edge.
std::uint32_t Finder::number_of(VertexId a, VertexId b) const {
  const auto first = found_.edges.begin() + first_edge_[a.index()];
  const auto last = found_.edges.begin() + first_edge_[a.index() + 1];
  const auto at =
      std::lower_bound(first, last, b, [](const CandidateEdge& edge, VertexId end) { return edge.b < end; });
  return static_cast<std::uint32_t>(at - found_.edges.begin());
}

// By halfedge of the ground.
std::vector<std::uint32_t> Finder::numbers_in_ground() const {
  std::vector<std::uint32_t> number(ground_.halfedge_count(), kNone);
  for (std::uint32_t e = 0; e < found_.edges.size(); ++e) {
    const HalfedgeId h = found_.edges[e].ground;
    if (!h.valid()) continue;
    number[h.index()] = e;
    if (!ground_.on_rim(h)) number[ground_.twin(h).index()] = e;
  }
  return number;
}

// Triangles at a side are linked: each has for each of its sides the one before it there, as 3 times the
// triangle plus its corner.
void Finder::drop_dead_ends() {
  const std::size_t sides = 2 * found_.edges.size();
  std::vector<std::uint32_t> last(sides, kNone), alive(sides, 0);
  std::vector<std::array<std::uint32_t, 3>> before(found_.triangles.size());
  for (std::uint32_t t = 0; t < before.size(); ++t) {
    for (std::uint32_t i = 0; i < 3; ++i) {
      const std::uint32_t side = found_.sides[t][i];
      before[t][i] = std::exchange(last[side], 3 * t + i);
      ++alive[side];
    }
  }
  std::vector<std::uint8_t> dead(found_.triangles.size(), 0);
  std::vector<std::uint32_t> lonely;  // sides whose triangles all have nothing beyond
  const auto needs_both = [&](std::uint32_t side) {
    const HalfedgeId h = found_.edges[side / 2].ground;
    return !h.valid() || !ground_.on_rim(h);
  };
  for (std::uint32_t side = 0; side < sides; ++side) {
    if (alive[side] > 0 && alive[side ^ 1U] == 0 && needs_both(side)) lonely.push_back(side);
  }
  const bool any = !lonely.empty();
  while (!lonely.empty()) {
    const std::uint32_t side = lonely.back();
    lonely.pop_back();
    for (std::uint32_t at = last[side]; at != kNone; at = before[at / 3][at % 3]) {
      const std::uint32_t t = at / 3;
      if (dead[t] != 0) continue;
      dead[t] = 1;
      for (const std::uint32_t s : found_.sides[t]) {
        if (--alive[s] == 0 && alive[s ^ 1U] > 0 && needs_both(s)) lonely.push_back(s ^ 1U);
      }
    }
  }
  release(last);
  release(alive);
  release(before);
  if (any) drop_triangles(found_, dead);
}

// Visits the halfedges of the ground that the edge crosses, in order, each in the triangle that it leaves.
template <class Visit>
void Finder::follow(const CandidateEdge& edge, const Visit& visit) const {
  const Point2 from = ground_.point(edge.a), to = ground_.point(edge.b);
  HalfedgeId crossed;
  for (const HalfedgeId h : ground_.outgoing(edge.a)) {
    if (orientation(from, ground_.point(ground_.target(h)), to) > 0 &&
        orientation(from, to, ground_.point(ground_.apex(h))) > 0) {
      crossed = Tin::next(h);
      break;
    }
  }
  while (crossed.valid()) {
    visit(crossed);
    const HalfedgeId entry = ground_.twin(crossed);
    if (!entry.valid()) return;
    const VertexId apex = ground_.apex(entry);
    if (apex == edge.b) {
      visit(entry);  // the last triangle: the edge ends at its apex
      return;
    }
    const int side = orientation(from, to, ground_.point(apex));
    crossed = side > 0 ? Tin::next(entry) : Tin::previous(entry);
  }
}

bool Finder::cross(std::uint32_t e, std::uint32_t f) const {
  const CandidateEdge& one = found_.edges[e];
  const CandidateEdge& other = found_.edges[f];
  if (one.a == other.a || one.a == other.b || one.b == other.a || one.b == other.b) return false;
  return cross_properly(ground_.point(one.a), ground_.point(one.b), ground_.point(other.a),
                        ground_.point(other.b));
}

void Finder::find_crossings() {
  using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;
  const std::size_t edges = found_.edges.size();
  const std::size_t blocks = edges / kBlock + 1;
  const std::vector<std::uint32_t> number_of_halfedge = numbers_in_ground();
  std::vector<Pairs> passes(blocks), crossed(blocks);  // (triangle of the ground, edge); (edge, edge)
  for_each_block(edges, kBlock, progress_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      if (found_.edges[e].ground.valid()) continue;
      const auto number = static_cast<std::uint32_t>(e);
      follow(found_.edges[e], [&](HalfedgeId h) {
        passes[begin / kBlock].emplace_back(Tin::triangle_of(h).value(), number);
        const std::uint32_t other = number_of_halfedge[h.index()];
        if (other == kNone) return;
        crossed[begin / kBlock].emplace_back(number, other);
        crossed[begin / kBlock].emplace_back(other, number);
      });
    }
  });
  const auto in = [](const std::vector<Pairs>& parts) {
    return [&parts](const auto& visit) {
      for (const Pairs& part : parts) {
        for (const auto& [row, item] : part) visit(row, item);
      }
    };
  };
  const Rows passing = rows_of(in(passes), ground_.triangle_count(), progress_);
  release(passes);
  crossed.resize(std::max(blocks, passing.size() / kBlock + 1));
  std::atomic<std::size_t> pairs{0};
  for_each_block(passing.size(), kBlock, progress_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const auto here = passing.row(t);
      const std::size_t before = crossed[begin / kBlock].size();
      for (std::size_t i = 0; i < here.size(); ++i) {
        for (std::size_t j = i + 1; j < here.size(); ++j) {
          if (!cross(here[i], here[j])) continue;
          crossed[begin / kBlock].emplace_back(here[i], here[j]);
          crossed[begin / kBlock].emplace_back(here[j], here[i]);
        }
      }
      pairs += (crossed[begin / kBlock].size() - before) / 2;
      if (pairs > kMostCrossings) refuse_crossings(edges);
    }
  });
  found_.crossings = rows_of(in(crossed), edges, progress_);
}

}  // namespace

Candidates find_candidates(const Tin& ground, std::vector<OrderTriangle> triangles,
                           const Progress& progress) {
  return Finder(ground, std::move(triangles), progress).find();
}

void drop_triangles(Candidates& candidates, std::span<const std::uint8_t> dropped) {
  std::vector<std::uint32_t> number(candidates.edges.size(), kNone);
  std::size_t kept = 0;
  for (std::size_t t = 0; t < dropped.size(); ++t) {
    if (dropped[t] != 0) continue;
    candidates.triangles[kept] = candidates.triangles[t];
    candidates.sides[kept] = candidates.sides[t];
    for (const std::uint32_t side : candidates.sides[kept++]) number[side / 2] = 0;
  }
  candidates.triangles.resize(kept);
  candidates.sides.resize(kept);
  std::uint32_t edges = 0;
  for (std::size_t e = 0; e < number.size(); ++e) {
    if (number[e] == kNone) continue;
    candidates.edges[edges] = candidates.edges[e];
    number[e] = edges++;
  }
  candidates.edges.resize(edges);
  for (auto& sides : candidates.sides) {
    for (std::uint32_t& side : sides) side = 2 * number[side / 2] + side % 2;
  }
  Rows& crossings = candidates.crossings;
  if (crossings.size() == 0) return;
  std::uint32_t next = 0, begin = 0, row = 0;
  for (std::size_t e = 0; e < number.size(); ++e) {
    const std::uint32_t end = crossings.first[e + 1];
    for (std::uint32_t i = std::exchange(begin, end); i < end && number[e] != kNone; ++i) {
      const std::uint32_t crossed = number[crossings.items[i]];
      if (crossed != kNone) crossings.items[next++] = crossed;
    }
    if (number[e] != kNone) crossings.first[++row] = next;
  }
  crossings.first.resize(row + 1);
  crossings.items.resize(next);
}

void cut_into_faces(Candidates& found, const Progress& progress) {
  const auto edges = static_cast<std::uint32_t>(found.edges.size());
  for (std::uint32_t e = 0; e < edges; ++e) found.edges[e].free = !found.crossings.row(e).empty();
  UnionFind same(edges);
  for (std::uint32_t e = 0; e < edges; ++e) {
    for (const std::uint32_t f : found.crossings.row(e)) same.unite(e, f);
  }
  std::vector<std::uint32_t> some_free(found.triangles.size(), kNone);
  for (std::size_t t = 0; t < found.triangles.size(); ++t) {
    for (const std::uint32_t side : found.sides[t]) {
      const std::uint32_t e = side / 2;
      if (!found.edges[e].free) continue;
      if (some_free[t] != kNone) same.unite(e, some_free[t]);
      some_free[t] = e;
    }
  }
  std::vector<std::uint32_t> face_of(edges, kNone);
  std::uint32_t count = 0;
  for (std::uint32_t& at : some_free) {
    if (at == kNone) continue;
    std::uint32_t& face = face_of[same.find(at)];
    if (face == kNone) face = count++;
    at = face;
  }
  const auto visit_members = [&](const auto& visit) {
    for (std::uint32_t t = 0; t < some_free.size(); ++t) {
      if (some_free[t] != kNone) visit(some_free[t], t);
    }
  };
  found.faces = rows_of(visit_members, count, progress);
}

bool cover_ground(const Candidates& candidates, const Tin& ground) {
  std::vector<bool> there(ground.halfedge_count(), false);
  for (const CandidateEdge& edge : candidates.edges) {
    if (!edge.ground.valid()) continue;
    there[edge.ground.index()] = true;
    if (!ground.on_rim(edge.ground)) there[ground.twin(edge.ground).index()] = true;
  }
  for (std::size_t i = 0; i < there.size(); ++i) {
    const HalfedgeId h{i};
    if (!there[i] && (ground.on_rim(h) || ground.constrained(h))) return false;
  }
  return true;
}

}  // namespace thalweg::detail
