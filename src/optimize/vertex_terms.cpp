// Stars of vertices.
//
// What meets at a vertex v under given labels: the edges that are no diagonals, always; the Delaunay diagonal
// of a quadrilateral in which v is one of its ends, under label 0; the other diagonal, if v is one of its
// ends, under label 1. How the surface bends at a diagonal depends on its quadrilateral's corners alone, at
// another edge on the labels of the quadrilaterals on both sides, which have v as a corner too. So every edge
// is listed with what it is under the labels of at most two quadrilaterals, and a star is a sum over its
// edges.
#include "optimize/vertex_terms.hpp"

#include "base/parallel.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/geometry/predicates.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace thalweg {

namespace {

constexpr std::size_t kBlock = 1024;

enum class Bend : std::uint8_t { Absent, Convex, Flat, Reflex };

/// An edge at the vertex: what it is under the labels of two quadrilaterals, the index as in PairValues.
struct Spoke {
  std::uint32_t q = kNone, p = kNone;
  std::array<Bend, 4> bend{};
};

class StarFinder {
 public:
  StarFinder(const TermScan& scan, VertexTerm term)
      : tin_(scan.tin()), quadrilaterals_(scan.quadrilaterals()), owner_(scan.owner()), term_(term) {}

  /// Pre: v is in a triangle.
  Table<1> find(VertexId v) {
    gather(v);
    Table<1> table{scope_, {}};
    table.entry.resize(std::size_t{1} << scope_.size());
    for (std::size_t e = 0; e < table.entry.size(); ++e) table.entry[e][0] = term_(star_under(e));
    return without_idle(std::move(table));
  }

 private:
  [[nodiscard]] std::uint32_t owner_of(HalfedgeId h) const {
    return h.valid() ? owner_[Tin::triangle_of(h).index()] : kNone;
  }

  [[nodiscard]] Bend bend(VertexId a, VertexId b, VertexId left, VertexId right) const {
    const int side = side_of_plane(tin_.point(a), tin_.point(b), tin_.point(left), tin_.point(right),
                                   {tin_.height(a), tin_.height(b), tin_.height(left), tin_.height(right)});
    return side < 0 ? Bend::Convex : side > 0 ? Bend::Reflex : Bend::Flat;
  }

  void gather(VertexId v) {
    scope_.clear();
    spokes_.clear();
    on_rim_ = false;
    for (const HalfedgeId h : tin_.outgoing(v)) {
      const std::uint32_t q = owner_of(h);
      if (q != kNone && std::find(scope_.begin(), scope_.end(), q) == scope_.end()) scope_.push_back(q);
      if (tin_.on_rim(Tin::previous(h))) add_rim_edge();
      if (tin_.on_rim(h)) {
        add_rim_edge();
      } else {
        add_edge(h);
      }
      if (q != kNone && is_diagonal(q, Tin::next(h))) add_other_diagonal(q);
    }
    std::sort(scope_.begin(), scope_.end());
    if (scope_.size() <= kMostAtVertex) return;
    throw Error(
        ErrorCode::Unsupported,
        fmt::format("{} quadrilaterals meet at vertex {} ({}, {}); criteria of vertices take at most {}: "
                    "choose another criterion, or a constraint edge there",
                    scope_.size(), v.value(), tin_.point(v).x, tin_.point(v).y, kMostAtVertex));
  }

  [[nodiscard]] bool is_diagonal(std::uint32_t q, HalfedgeId h) const {
    return quadrilaterals_[q].diagonal == h || quadrilaterals_[q].diagonal == tin_.twin(h);
  }

  void add_rim_edge() {
    on_rim_ = true;
    spokes_.push_back({kNone, kNone, {Bend::Flat}});
  }

  void add_edge(HalfedgeId h) {
    const HalfedgeId twin = tin_.twin(h);
    const VertexId a = tin_.origin(h), b = tin_.target(h);
    const std::uint32_t q = owner_of(h), p = owner_of(twin);
    Spoke spoke{q, p, {}};
    if (q != kNone && q == p) {
      spoke = {q, kNone, {bend(a, b, tin_.apex(h), tin_.apex(twin)), Bend::Absent}};
    } else {
      const std::array left = {tin_.apex(h), flipped_apex(q, a, b)};
      const std::array right = {tin_.apex(twin), flipped_apex(p, a, b)};
      for (std::size_t e = 0; e < 4; ++e) {
        const bool one_q = (e & 1U) != 0, one_p = (e & 2U) != 0;
        if ((one_q && q == kNone) || (one_p && p == kNone)) continue;
        spoke.bend[e] = bend(a, b, left[one_q ? 1 : 0], right[one_p ? 1 : 0]);
      }
    }
    spokes_.push_back(spoke);
  }

  /// The third corner of the triangle at side ab under label 1.
  [[nodiscard]] VertexId flipped_apex(std::uint32_t q, VertexId a, VertexId b) const {
    if (q == kNone) return a;
    const auto& [s, u, t, v, diagonal] = quadrilaterals_[q];
    return s == a || s == b ? t : s;
  }

  void add_other_diagonal(std::uint32_t q) {
    const auto& [s, u, t, v, diagonal] = quadrilaterals_[q];
    spokes_.push_back({q, kNone, {Bend::Absent, bend(s, t, v, u)}});
  }

  [[nodiscard]] Star star_under(std::size_t labels) const {
    const auto one = [&](std::uint32_t q) -> std::size_t {
      if (q == kNone) return 0;
      return labels >> (std::lower_bound(scope_.begin(), scope_.end(), q) - scope_.begin()) & 1U;
    };
    Star star{.on_rim = on_rim_};
    for (const Spoke& spoke : spokes_) {
      const Bend bend = spoke.bend[one(spoke.q) + 2 * one(spoke.p)];
      star.edges += bend != Bend::Absent ? 1 : 0;
      star.convex += bend == Bend::Convex ? 1 : 0;
      star.reflex += bend == Bend::Reflex ? 1 : 0;
    }
    return star;
  }

  const Tin& tin_;
  std::span<const Quadrilateral> quadrilaterals_;
  std::span<const std::uint32_t> owner_;
  VertexTerm term_;
  std::vector<std::uint32_t> scope_;
  std::vector<Spoke> spokes_;
  bool on_rim_ = false;
};

}  // namespace

VertexTerms find_vertex_terms(const TermScan& scan, VertexTerm term, const Progress& progress) {
  const std::size_t count = scan.tin().vertex_count();
  std::vector<VertexTerms> blocks((count + kBlock - 1) / kBlock);
  for_each_block(count, kBlock, progress, [&](std::size_t begin, std::size_t end) {
    VertexTerms& block = blocks[begin / kBlock];
    StarFinder finder(scan, term);
    for (std::size_t v = begin; v < end; ++v) {
      if (scan.tin().outgoing(VertexId{v}).empty()) continue;
      const Table<1> table = finder.find(VertexId{v});
      if (table.scope.empty()) {
        block.constants.push_back(table.entry.front()[0]);
      } else {
        block.tables.append(table);
      }
    }
  });
  VertexTerms terms;
  for (VertexTerms& block : blocks) {
    terms.constants.insert(terms.constants.end(), block.constants.begin(), block.constants.end());
    terms.tables.append(block.tables);
    block = {};
  }
  return terms;
}

}  // namespace thalweg
