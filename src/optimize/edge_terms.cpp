// Edge terms as a quadratic function of labels.
//
// 1. Quadrilateral q offers two triangles for each label: suv and vut, or sut and tvs. A term f(l, r) of an
//    edge with triangles l and r is a constant, a function of one label (on a diagonal, and on a side whose
//    other triangle is free of choice), or of two. The latter is written f00 + (f10 - f00) x + (f01 - f00) y
//    + w x y with w = f11 - f10 - f01 + f00.
// 2. Rows of neighbours are laid out from topology alone; then each side between two quadrilaterals is
//    computed once, by the lower one, which writes the weight at both ends. Unary costs are sums of integers,
//    added atomically: their order does not matter.
#include "optimize/edge_terms.hpp"

#include "base/parallel.hpp"

#include <thalweg/base/assert.hpp>
#include <thalweg/base/error.hpp>

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <string>
#include <tuple>

namespace thalweg {

namespace {

constexpr std::size_t kBlock = 4096;

/// What a term needs to know of one of its triangles.
struct Face {
  Vector3 normal;
};

std::int64_t edge_steps(Criterion criterion, const Face& left, const Face& right) {
  switch (criterion) {
    case Criterion::NormalAngleSum:
      return to_steps(angle_between(left.normal, right.normal));
    case Criterion::LocalMinima:
      break;
  }
  THALWEG_ASSERT(false);
  return 0;
}

/// One side of a quadrilateral, seen from inside.
struct Side {
  HalfedgeId inner;     ///< of the triangle in the TIN, which has it under label 0
  bool at_s_u = false;  ///< under label 1 it belongs to triangle sut, else to tvs
};

/// Sides su, ut, tv, vs.
std::array<Side, 4> sides_of(const Tin& tin, const Quadrilateral& quadrilateral) {
  const HalfedgeId uv = quadrilateral.diagonal;
  const HalfedgeId vu = tin.twin(uv);
  return {
      {{Tin::previous(uv), true}, {Tin::next(vu), true}, {Tin::previous(vu), false}, {Tin::next(uv), false}}};
}

template <std::size_t Criteria>
class Builder {
 public:
  Builder(const Tin& tin, std::span<const Quadrilateral> quadrilaterals, std::span<const std::uint32_t> owner,
          std::span<const Criterion> criteria, Scale scale)
      : tin_(tin), quadrilaterals_(quadrilaterals), owner_(owner), criteria_(criteria), scale_(scale) {}

  EdgeTerms<Criteria> build(const Progress& progress) {
    lay_out_rows(progress);
    out_.labelling.unary.resize(quadrilaterals_.size());
    for_each_block(quadrilaterals_.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
      Steps sum{};
      for (std::size_t q = begin; q < end; ++q) add_quadrilateral(q, sum);
      add_to_total(sum);
    });
    for_each_block(tin_.triangle_count(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
      Steps sum{};
      for (std::size_t t = begin; t < end; ++t) add_free_edges(TriangleId{t}, sum);
      add_to_total(sum);
    });
    return std::move(out_);
  }

 private:
  using Steps = std::array<std::int64_t, Criteria>;

  [[nodiscard]] Face face(VertexId a, VertexId b, VertexId c) const {
    return {upward_normal(tin_, scale_, a, b, c)};
  }
  [[nodiscard]] Face face(HalfedgeId h) const { return face(tin_.origin(h), tin_.target(h), tin_.apex(h)); }
  [[nodiscard]] Face flipped_face(std::size_t q, bool at_s_u) const {
    const auto& [s, u, t, v, diagonal] = quadrilaterals_[q];
    return at_s_u ? face(s, u, t) : face(t, v, s);
  }
  [[nodiscard]] Steps value(const Face& left, const Face& right) const {
    Steps steps{};
    for (std::size_t i = 0; i < criteria_.size(); ++i) steps[i] = edge_steps(criteria_[i], left, right);
    return steps;
  }
  [[nodiscard]] std::uint32_t owner_across(HalfedgeId h) const {
    const HalfedgeId outer = tin_.twin(h);
    return outer.valid() ? owner_[Tin::triangle_of(outer).index()] : kNone;
  }

  /// Where the weight of side `side` of q stands: sides between two quadrilaterals in order.
  [[nodiscard]] std::size_t slot(std::size_t q, const std::array<Side, 4>& sides, HalfedgeId inner) const {
    std::size_t at = out_.labelling.first[q];
    for (const Side& side : sides) {
      if (side.inner == inner) break;
      at += owner_across(side.inner) != kNone ? 1 : 0;
    }
    return at;
  }

  void lay_out_rows(const Progress& progress) {
    Labelling<Criteria>& labelling = out_.labelling;
    const std::size_t count = quadrilaterals_.size();
    labelling.first.assign(count + 1, 0);
    for_each_block(count, kBlock, progress, [&](std::size_t begin, std::size_t end) {
      for (std::size_t q = begin; q < end; ++q) {
        for (const Side& side : sides_of(tin_, quadrilaterals_[q])) {
          labelling.first[q + 1] += owner_across(side.inner) != kNone ? 1 : 0;
        }
      }
    });
    for (std::size_t q = 0; q < count; ++q) labelling.first[q + 1] += labelling.first[q];
    labelling.neighbour.resize(labelling.first.back());
    labelling.weight.resize(labelling.first.back());
  }

  void add_quadrilateral(std::size_t q, Steps& delaunay) {
    const Quadrilateral& quadrilateral = quadrilaterals_[q];
    const std::array<Side, 4> sides = sides_of(tin_, quadrilateral);
    const Face at_s = face(quadrilateral.diagonal), at_t = face(tin_.twin(quadrilateral.diagonal));
    const Face at_u = flipped_face(q, true), at_v = flipped_face(q, false);
    const Steps kept = value(at_s, at_t), flipped = value(at_u, at_v);
    accumulate(delaunay, kept);
    Steps own = less(flipped, kept);
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const HalfedgeId outer = tin_.twin(sides[i].inner);
      if (!outer.valid()) continue;
      const Face& unflipped_face = i == 0 || i == 3 ? at_s : at_t;
      const Face& new_face = sides[i].at_s_u ? at_u : at_v;
      const std::uint32_t p = owner_[Tin::triangle_of(outer).index()];
      if (p != kNone && p < q) continue;
      const Face outside = face(outer);
      const Steps f00 = value(unflipped_face, outside), f10 = value(new_face, outside);
      accumulate(delaunay, f00);
      accumulate(own, less(f10, f00));
      if (p != kNone) add_pair(q, p, sides, i, {f00, f10, unflipped_face, new_face});
    }
    add_to_unary(q, own);
  }

  struct HalfTerm {
    Steps f00, f10;
    const Face& unflipped_face;
    const Face& new_face;
  };

  void add_pair(std::size_t q, std::size_t p, const std::array<Side, 4>& sides, std::size_t i,
                const HalfTerm& half) {
    const HalfedgeId outer = tin_.twin(sides[i].inner);
    const std::array<Side, 4> other_sides = sides_of(tin_, quadrilaterals_[p]);
    const auto side = std::find_if(other_sides.begin(), other_sides.end(),
                                   [&](const Side& candidate) { return candidate.inner == outer; });
    THALWEG_ASSERT(side != other_sides.end());
    const Face outside = flipped_face(p, side->at_s_u);
    const Steps f01 = value(half.unflipped_face, outside), f11 = value(half.new_face, outside);
    add_to_unary(p, less(f01, half.f00));
    const Steps weight = less(less(f11, half.f10), less(f01, half.f00));
    Labelling<Criteria>& labelling = out_.labelling;
    const std::size_t here = slot(q, sides, sides[i].inner), there = slot(p, other_sides, outer);
    labelling.neighbour[here] = static_cast<std::uint32_t>(p);
    labelling.neighbour[there] = static_cast<std::uint32_t>(q);
    labelling.weight[here] = labelling.weight[there] = weight;
  }

  /// Edges between two triangles that are in no quadrilateral.
  void add_free_edges(TriangleId t, Steps& delaunay) const {
    if (owner_[t.index()] != kNone) return;
    for (std::size_t i = 0; i < 3; ++i) {
      const HalfedgeId h = Tin::halfedge(t, i);
      if (tin_.on_rim(h) || !tin_.represents_edge(h) || owner_across(h) != kNone) continue;
      accumulate(delaunay, value(face(h), face(tin_.twin(h))));
    }
  }

  static void accumulate(Steps& sum, const Steps& steps) {
    for (std::size_t i = 0; i < Criteria; ++i) sum[i] += steps[i];
  }
  static Steps less(Steps a, const Steps& b) {
    for (std::size_t i = 0; i < Criteria; ++i) a[i] -= b[i];
    return a;
  }
  void add_to_unary(std::size_t q, const Steps& steps) {
    for (std::size_t i = 0; i < criteria_.size(); ++i) {
      std::atomic_ref(out_.labelling.unary[q].level[i]).fetch_add(steps[i], std::memory_order_relaxed);
    }
  }
  void add_to_total(const Steps& steps) {
    for (std::size_t i = 0; i < criteria_.size(); ++i) {
      std::atomic_ref(out_.delaunay[i]).fetch_add(steps[i], std::memory_order_relaxed);
    }
  }

  const Tin& tin_;
  std::span<const Quadrilateral> quadrilaterals_;
  std::span<const std::uint32_t> owner_;
  std::span<const Criterion> criteria_;
  Scale scale_;
  EdgeTerms<Criteria> out_;
};

std::uint64_t splitmix64(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31U);
}

}  // namespace

std::vector<std::uint32_t> quadrilaterals_of_triangles(const Tin& tin,
                                                       std::span<const Quadrilateral> quadrilaterals) {
  std::vector<std::uint32_t> owner(tin.triangle_count(), kNone);
  for (std::size_t q = 0; q < quadrilaterals.size(); ++q) {
    const HalfedgeId diagonal = quadrilaterals[q].diagonal;
    for (const HalfedgeId h : {diagonal, tin.twin(diagonal)}) {
      std::uint32_t& triangle = owner[Tin::triangle_of(h).index()];
      if (triangle != kNone) {
        throw Error(
            ErrorCode::Unsupported,
            "two quadrilaterals share triangle " + std::to_string(Tin::triangle_of(h).value()) +
                ", as can be under sees-3vtx and empty-quad; choose a stronger definition, such as sees-opp");
      }
      triangle = static_cast<std::uint32_t>(q);
    }
  }
  return owner;
}

template <std::size_t Criteria>
EdgeTerms<Criteria> build_edge_terms(const Tin& tin, std::span<const Quadrilateral> quadrilaterals,
                                     std::span<const std::uint32_t> owner,
                                     std::span<const Criterion> criteria, Scale scale,
                                     const Progress& progress) {
  return Builder<Criteria>(tin, quadrilaterals, owner, criteria, scale).build(progress);
}

template <std::size_t Criteria>
std::vector<std::uint32_t> add_flips_and_ties(const Tin& tin, std::span<const Quadrilateral> quadrilaterals,
                                              std::vector<Cost<Criteria>>& unary, const Progress& progress) {
  using Corners = std::array<Point2, 4>;
  const auto sorted_corners = [&](std::uint32_t q) {
    const auto& [s, u, t, v, diagonal] = quadrilaterals[q];
    Corners corners = {tin.point(s), tin.point(u), tin.point(t), tin.point(v)};
    std::sort(corners.begin(), corners.end());
    return corners;
  };
  struct Key {
    Point2 lowest;
    std::uint32_t quadrilateral;
  };
  const std::size_t count = quadrilaterals.size();
  std::vector<Key> keys(count);
  for_each_block(count, kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t q = begin; q < end; ++q) {
      const auto& [s, u, t, v, diagonal] = quadrilaterals[q];
      keys[q] = {std::min({tin.point(s), tin.point(u), tin.point(t), tin.point(v)}),
                 static_cast<std::uint32_t>(q)};
    }
  });
  tbb::parallel_sort(keys.begin(), keys.end(), [&](const Key& a, const Key& b) {
    if (a.lowest != b.lowest) return a.lowest < b.lowest;
    return a.quadrilateral != b.quadrilateral &&
           sorted_corners(a.quadrilateral) < sorted_corners(b.quadrilateral);
  });
  const int bits = 62 - static_cast<int>(std::bit_width(count));
  std::vector<std::uint32_t> rank(count);
  for_each_block(count, kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r) {
      const std::uint32_t q = keys[r].quadrilateral;
      rank[q] = static_cast<std::uint32_t>(r);
      unary[q].level[Criteria] = 1;
      unary[q].level[Criteria + 1] = static_cast<std::int64_t>(splitmix64(r) >> (64 - bits));
    }
  });
  return rank;
}

template EdgeTerms<1> build_edge_terms(const Tin&, std::span<const Quadrilateral>,
                                       std::span<const std::uint32_t>, std::span<const Criterion>, Scale,
                                       const Progress&);
template std::vector<std::uint32_t> add_flips_and_ties(const Tin&, std::span<const Quadrilateral>,
                                                       std::vector<Cost<1>>&, const Progress&);

}  // namespace thalweg
