#pragma once

/// Goes through all terms of a criterion, as functions of the labels of at most two quadrilaterals.

#include "base/parallel.hpp"
#include "optimize/declaration.hpp"
#include "optimize/sides.hpp"

#include <thalweg/base/assert.hpp>

#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace thalweg {

/// Triangles, edges and what of them depends on labels. Label 1 flips.
class TermScan {
 public:
  TermScan(const Tin& tin, std::span<const Quadrilateral> quadrilaterals,
           std::span<const std::uint32_t> owner, Scale scale, const Reference* reference)
      : tin_(tin), quadrilaterals_(quadrilaterals), owner_(owner), scale_(scale), reference_(reference) {}
  [[nodiscard]] const Tin& tin() const { return tin_; }
  [[nodiscard]] std::span<const Quadrilateral> quadrilaterals() const { return quadrilaterals_; }
  [[nodiscard]] std::span<const std::uint32_t> owner() const { return owner_; }

  /// Rows of neighbours, sides in order, both ways. Complexity: linear, on all threads.
  struct Rows {
    std::vector<std::uint32_t> first = {0}, neighbour;
  };
  [[nodiscard]] Rows lay_out_rows(const Progress& progress) const;
  /// Calls, on all threads, a `Block` of the sink, made anew for each block of quadrilaterals or triangles:
  ///   constant(value)                 a term that no label changes,
  ///   single(q, f0, f1)               one that the label of q decides,
  ///   pair(neighbours, PairValues)    one that two labels decide.
  /// Every term once. `first` is that of the rows. Blocks of a sink see ascending q.
  template <class Sink>
  void run(const Declaration& declaration, std::span<const std::uint32_t> first, Sink& sink,
           const Progress& progress) const;

 private:
  static constexpr std::size_t kBlock = 4096;

  [[nodiscard]] Face face(VertexId a, VertexId b, VertexId c) const {
    return make_face(corner_of(tin_, a), corner_of(tin_, b), corner_of(tin_, c), scale_);
  }
  [[nodiscard]] Face face(HalfedgeId h) const { return face(tin_.origin(h), tin_.target(h), tin_.apex(h)); }
  [[nodiscard]] Face flipped_face(std::size_t q, bool at_s_u) const {
    const auto& [s, u, t, v, diagonal] = quadrilaterals_[q];
    return at_s_u ? face(s, u, t) : face(t, v, s);
  }
  [[nodiscard]] std::uint32_t owner_across(HalfedgeId h) const {
    const HalfedgeId outer = tin_.twin(h);
    return outer.valid() ? owner_[Tin::triangle_of(outer).index()] : kNone;
  }
  /// The slot of a side in the row of q, which begins there.
  [[nodiscard]] std::uint32_t slot(std::uint32_t begin, std::span<const Side> sides, HalfedgeId inner) const;

  [[nodiscard]] double left_on_rim(const Progress& progress) const;
  [[nodiscard]] double of_triangle(const Declaration& declaration, const Face& face) const {
    return declaration.triangle != nullptr ? declaration.triangle(face, scale_)
                                           : declaration.against_reference(face, scale_, *reference_);
  }
  template <class Block>
  void scan_triangle(TriangleId t, const Declaration& declaration, Block& block) const;
  template <class Block>
  void scan_quadrilateral_edges(std::uint32_t q, EdgeTerm term, std::span<const std::uint32_t> first,
                                Block& block) const;

  const Tin& tin_;
  std::span<const Quadrilateral> quadrilaterals_;
  std::span<const std::uint32_t> owner_;
  Scale scale_;
  const Reference* reference_;
};

template <class Sink>
void TermScan::run(const Declaration& declaration, std::span<const std::uint32_t> first, Sink& sink,
                   const Progress& progress) const {
  for_each_block(quadrilaterals_.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    typename Sink::Block block(sink);
    for (auto q = static_cast<std::uint32_t>(begin); q < end; ++q) {
      if (declaration.edge != nullptr) {
        scan_quadrilateral_edges(q, declaration.edge, first, block);
      } else {
        const HalfedgeId uv = quadrilaterals_[q].diagonal;
        const auto value = [&](const Face& a, const Face& b) {
          return std::array{of_triangle(declaration, a), of_triangle(declaration, b)};
        };
        block.single(q, value(face(uv), face(tin_.twin(uv))),
                     value(flipped_face(q, true), flipped_face(q, false)));
      }
    }
  });
  for_each_block(tin_.triangle_count(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    typename Sink::Block block(sink);
    for (std::size_t t = begin; t < end; ++t) scan_triangle(TriangleId{t}, declaration, block);
  });
  if (declaration.against_reference != nullptr) typename Sink::Block(sink).constant(left_on_rim(progress));
}

template <class Block>
void TermScan::scan_triangle(TriangleId t, const Declaration& declaration, Block& block) const {
  if (owner_[t.index()] != kNone) return;
  if (declaration.edge == nullptr) {
    block.constant(of_triangle(declaration, face(Tin::halfedge(t, 0))));
    return;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const HalfedgeId h = Tin::halfedge(t, i);
    if (tin_.on_rim(h) || !tin_.represents_edge(h) || owner_across(h) != kNone) continue;
    block.constant(declaration.edge(face(h), face(tin_.twin(h)), scale_));
  }
}

template <class Block>
void TermScan::scan_quadrilateral_edges(std::uint32_t q, EdgeTerm term, std::span<const std::uint32_t> first,
                                        Block& block) const {
  const Quadrilateral& quadrilateral = quadrilaterals_[q];
  const std::array<Side, 4> sides = sides_of(tin_, quadrilateral);
  const Face at_s = face(quadrilateral.diagonal), at_t = face(tin_.twin(quadrilateral.diagonal));
  const Face at_u = flipped_face(q, true), at_v = flipped_face(q, false);
  block.single(q, std::array{term(at_s, at_t, scale_)}, std::array{term(at_u, at_v, scale_)});
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const HalfedgeId outer = tin_.twin(sides[i].inner);
    if (!outer.valid()) continue;
    const std::uint32_t p = owner_[Tin::triangle_of(outer).index()];
    if (p != kNone && p < q) continue;
    const Face& kept = i == 0 || i == 3 ? at_s : at_t;
    const Face& flipped = sides[i].at_s_u ? at_u : at_v;
    const Face outside = face(outer);
    const double f0 = term(kept, outside, scale_), f1 = term(flipped, outside, scale_);
    if (p == kNone) {
      block.single(q, std::array{f0}, std::array{f1});
      continue;
    }
    const std::array<Side, 4> other_sides = sides_of(tin_, quadrilaterals_[p]);
    const auto side = std::find_if(other_sides.begin(), other_sides.end(),
                                   [&](const Side& candidate) { return candidate.inner == outer; });
    THALWEG_ASSERT(side != other_sides.end());
    const Face outside_flipped = flipped_face(p, side->at_s_u);
    block.pair(
        Neighbours{q, p, slot(first[q], sides, sides[i].inner), slot(first[p], other_sides, outer)},
        PairValues{f0, f1, term(kept, outside_flipped, scale_), term(flipped, outside_flipped, scale_)});
  }
}

}  // namespace thalweg
