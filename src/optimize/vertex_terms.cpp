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

#include <thalweg/geometry/predicates.hpp>

#include <algorithm>
#include <array>
#include <tuple>

namespace thalweg {

namespace {

constexpr std::size_t kBlock = 1024;
/// From that many quadrilaterals on it is worth to look first whether labels change the term at all.
constexpr std::size_t kManyAtVertex = 10;

using Bend = SpokedStar::Bend;
using Spoke = SpokedStar::Spoke;

void note_edge(Star& star, Bend bend) {
  star.edges += bend != Bend::Absent ? 1 : 0;
  star.convex = star.convex || bend == Bend::Convex;
  star.reflex = star.reflex || bend == Bend::Reflex;
  star.flat = star.flat || bend == Bend::Flat;
}

class StarFinder {
 public:
  StarFinder(const TermScan& scan, VertexTerm term)
      : tin_(scan.tin()), quadrilaterals_(scan.quadrilaterals()), owner_(scan.owner()), term_(term) {}

  /// Adds the term of v. Pre: v is in a triangle.
  void find(VertexId v, std::size_t most, VertexTerms& terms) {
    gather(v);
    if (star_.scope.size() > std::min(most, kManyAtVertex)) {
      const std::vector<Star> stars = star_.reachable();
      const std::int64_t value = term_(stars.front());
      if (std::all_of(stars.begin(), stars.end(), [&](const Star& star) { return term_(star) == value; })) {
        terms.constants.push_back(value);
        return;
      }
    }
    if (star_.scope.size() > most) {
      terms.wide.push_back(star_);
      return;
    }
    Table<1> table{star_.scope, {}};
    table.entry.resize(std::size_t{1} << star_.scope.size());
    for (std::size_t e = 0; e < table.entry.size(); ++e) table.entry[e][0] = term_(star_under(e));
    table = without_idle(std::move(table));
    if (table.scope.empty()) {
      terms.constants.push_back(table.entry.front()[0]);
    } else {
      terms.tables.append(table);
    }
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
    star_ = {};
    std::vector<std::uint32_t>& scope = star_.scope;
    for (const HalfedgeId h : tin_.outgoing(v)) {
      const std::uint32_t q = owner_of(h);
      if (q != kNone && std::find(scope.begin(), scope.end(), q) == scope.end()) scope.push_back(q);
      if (tin_.on_rim(Tin::previous(h))) add_rim_edge();
      if (tin_.on_rim(h)) {
        add_rim_edge();
      } else {
        add_edge(h);
      }
      if (q != kNone && is_diagonal(q, Tin::next(h))) add_other_diagonal(q);
    }
    std::sort(star_.scope.begin(), star_.scope.end());
  }

  [[nodiscard]] bool is_diagonal(std::uint32_t q, HalfedgeId h) const {
    return quadrilaterals_[q].diagonal == h || quadrilaterals_[q].diagonal == tin_.twin(h);
  }

  void add_rim_edge() {
    star_.on_rim = true;
    star_.spokes.push_back({kNone, kNone, {Bend::Flat}});
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
    star_.spokes.push_back(spoke);
  }

  /// The third corner of the triangle at side ab under label 1.
  [[nodiscard]] VertexId flipped_apex(std::uint32_t q, VertexId a, VertexId b) const {
    if (q == kNone) return a;
    const auto& [s, u, t, v, diagonal] = quadrilaterals_[q];
    return s == a || s == b ? t : s;
  }

  void add_other_diagonal(std::uint32_t q) {
    const auto& [s, u, t, v, diagonal] = quadrilaterals_[q];
    star_.spokes.push_back({q, kNone, {Bend::Absent, bend(s, t, v, u)}});
  }

  [[nodiscard]] Star star_under(std::size_t labels) const {
    const auto one = [&](std::uint32_t q) -> std::size_t {
      if (q == kNone) return 0;
      const auto at = std::lower_bound(star_.scope.begin(), star_.scope.end(), q);
      return labels >> (at - star_.scope.begin()) & 1U;
    };
    Star star{.on_rim = star_.on_rim};
    for (const Spoke& spoke : star_.spokes) note_edge(star, spoke.bend[one(spoke.q) + 2 * one(spoke.p)]);
    return star;
  }

  const Tin& tin_;
  std::span<const Quadrilateral> quadrilaterals_;
  std::span<const std::uint32_t> owner_;
  VertexTerm term_;
  SpokedStar star_;
};

/// The stars of all labels, spoke by spoke: a state is what was met so far, and the labels of quadrilaterals
/// of which a spoke is still to come.
class StarSearch {
 public:
  StarSearch(const SpokedStar& star, std::optional<std::pair<std::uint32_t, Label>> fixed)
      : star_(star), fixed_(fixed) {}

  std::vector<Star> run() {
    std::vector<State> states = {{}};
    for (std::size_t i = 0; i < star_.spokes.size(); ++i) {
      const Spoke& spoke = star_.spokes[i];
      open(spoke.q, states);
      open(spoke.p, states);
      for (State& state : states) {
        note_edge(state.star, spoke.bend[label_in(state, spoke.q) + 2 * label_in(state, spoke.p)]);
      }
      close(spoke.q, i, states);
      close(spoke.p, i, states);
    }
    std::vector<Star> stars;
    for (State& state : states) {
      state.star.on_rim = star_.on_rim;
      stars.push_back(state.star);
    }
    return stars;
  }

 private:
  struct State {
    std::vector<Label> label;  ///< of the open quadrilaterals
    Star star;
  };
  static auto key(const State& state) {
    return std::tie(state.label, state.star.edges, state.star.convex, state.star.reflex, state.star.flat);
  }

  [[nodiscard]] std::size_t place_of(std::uint32_t q) const {
    return static_cast<std::size_t>(std::find(open_.begin(), open_.end(), q) - open_.begin());
  }
  [[nodiscard]] std::size_t label_in(const State& state, std::uint32_t q) const {
    return q != kNone && state.label[place_of(q)] == Label::One ? 1 : 0;
  }

  void open(std::uint32_t q, std::vector<State>& states) {
    if (q == kNone || place_of(q) < open_.size()) return;
    open_.push_back(q);
    const bool is_fixed = fixed_ && fixed_->first == q;
    const std::size_t count = states.size();
    for (std::size_t i = 0; i < count; ++i) {
      if (!is_fixed) states.push_back(states[i]);
      states[i].label.push_back(is_fixed ? fixed_->second : Label::Zero);
      if (!is_fixed) states.back().label.push_back(Label::One);
    }
  }

  void close(std::uint32_t q, std::size_t spoke, std::vector<State>& states) {
    const auto has = [&](const Spoke& s) { return s.q == q || s.p == q; };
    const auto later = star_.spokes.begin() + static_cast<std::ptrdiff_t>(spoke) + 1;
    if (q == kNone || std::any_of(later, star_.spokes.end(), has)) return;
    const auto place = static_cast<std::ptrdiff_t>(place_of(q));
    open_.erase(open_.begin() + place);
    for (State& state : states) state.label.erase(state.label.begin() + place);
    std::sort(states.begin(), states.end(), [](const State& a, const State& b) { return key(a) < key(b); });
    states.erase(std::unique(states.begin(), states.end(),
                             [](const State& a, const State& b) { return key(a) == key(b); }),
                 states.end());
  }

  const SpokedStar& star_;
  std::optional<std::pair<std::uint32_t, Label>> fixed_;
  std::vector<std::uint32_t> open_;
};

}  // namespace

Star SpokedStar::under(std::span<const Label> label) const {
  const auto one = [&](std::uint32_t q) -> std::size_t {
    return q != kNone && label[q] == Label::One ? 1 : 0;
  };
  Star star{.on_rim = on_rim};
  for (const Spoke& spoke : spokes) note_edge(star, spoke.bend[one(spoke.q) + 2 * one(spoke.p)]);
  return star;
}

std::vector<Star> SpokedStar::reachable(std::optional<std::pair<std::uint32_t, Label>> fixed) const {
  return StarSearch(*this, fixed).run();
}

std::uint32_t most_at_vertex(std::uint32_t width_limit) {
  constexpr std::uint32_t kMost = 20;
  return std::min(kMost, width_limit + 2);
}

VertexTerms find_vertex_terms(const TermScan& scan, VertexTerm term, const Progress& progress) {
  const std::size_t count = scan.tin().vertex_count();
  std::vector<VertexTerms> blocks((count + kBlock - 1) / kBlock);
  for_each_block(count, kBlock, progress, [&](std::size_t begin, std::size_t end) {
    VertexTerms& block = blocks[begin / kBlock];
    StarFinder finder(scan, term);
    for (std::size_t v = begin; v < end; ++v) {
      if (scan.tin().outgoing(VertexId{v}).empty()) continue;
      finder.find(VertexId{v}, scan.most_at_vertex(), block);
    }
  });
  VertexTerms terms;
  for (VertexTerms& block : blocks) {
    terms.constants.insert(terms.constants.end(), block.constants.begin(), block.constants.end());
    terms.tables.append(block.tables);
    terms.wide.insert(terms.wide.end(), block.wide.begin(), block.wide.end());
    block = {};
  }
  return terms;
}

}  // namespace thalweg
