#pragma once

/// Goes through all terms of a criterion, as functions of the labels of at most two quadrilaterals.

#include "base/parallel.hpp"
#include "optimize/edge_batch.hpp"

#include <array>
#include <span>
#include <vector>

namespace thalweg {

/// Triangles, edges and what of them depends on labels. Label 1 flips.
class TermScan {
 public:
  TermScan(const Tin& tin, std::span<const Quadrilateral> quadrilaterals,
           std::span<const std::uint32_t> owner, Scale scale, const Reference* reference)
      : faces_{tin, quadrilaterals, owner, scale}, reference_(reference) {}
  [[nodiscard]] const Tin& tin() const { return faces_.tin; }
  [[nodiscard]] std::span<const Quadrilateral> quadrilaterals() const { return faces_.quadrilaterals; }
  [[nodiscard]] std::span<const std::uint32_t> owner() const { return faces_.owner; }

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
  static constexpr std::size_t kBlock = 1024;

  [[nodiscard]] double left_on_rim(const Progress& progress) const;
  [[nodiscard]] double of_triangle(const Declaration& declaration, const Face& face) const {
    return declaration.triangle != nullptr ? declaration.triangle(face, faces_.scale)
                                           : declaration.against_reference(face, faces_.scale, *reference_);
  }
  template <class Block>
  void scan_triangle(TriangleId t, const Declaration& declaration, Block& block) const;
  template <class Body, class Block>
  void scan_edges(std::uint32_t begin, std::uint32_t end, const Declaration& declaration,
                  std::span<const std::uint32_t> first, Block& block) const;

  LabelledFaces faces_;
  const Reference* reference_;
};

template <class Sink>
void TermScan::run(const Declaration& declaration, std::span<const std::uint32_t> first, Sink& sink,
                   const Progress& progress) const {
  for_each_block(faces_.quadrilaterals.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    typename Sink::Block block(sink);
    const auto from = static_cast<std::uint32_t>(begin), to = static_cast<std::uint32_t>(end);
    if (declaration.of_angle != nullptr) {
      scan_edges<Vector3>(from, to, declaration, first, block);
    } else if (declaration.edge != nullptr) {
      scan_edges<Face>(from, to, declaration, first, block);
    } else {
      for (std::uint32_t q = from; q < to; ++q) {
        const HalfedgeId uv = faces_.quadrilaterals[q].diagonal;
        const auto value = [&](const Face& a, const Face& b) {
          return std::array{of_triangle(declaration, a), of_triangle(declaration, b)};
        };
        block.single(q, value(faces_.face(uv), faces_.face(faces_.tin.twin(uv))),
                     value(faces_.flipped_face(q, true), faces_.flipped_face(q, false)));
      }
    }
  });
  for_each_block(faces_.tin.triangle_count(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    typename Sink::Block block(sink);
    for (std::size_t t = begin; t < end; ++t) scan_triangle(TriangleId{t}, declaration, block);
  });
  if (declaration.against_reference != nullptr) typename Sink::Block(sink).constant(left_on_rim(progress));
}

template <class Block>
void TermScan::scan_triangle(TriangleId t, const Declaration& declaration, Block& block) const {
  if (faces_.owner[t.index()] != kNone) return;
  if (declaration.traits.coupling == Coupling::OneTriangle) {
    block.constant(of_triangle(declaration, faces_.face(Tin::halfedge(t, 0))));
    return;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const HalfedgeId h = Tin::halfedge(t, i);
    if (faces_.tin.on_rim(h) || !faces_.tin.represents_edge(h) || faces_.owner_across(h) != kNone) continue;
    block.constant(declaration.of_edge(faces_.face(h), faces_.face(faces_.tin.twin(h)), faces_.scale));
  }
}

template <class Body, class Block>
void TermScan::scan_edges(std::uint32_t begin, std::uint32_t end, const Declaration& declaration,
                          std::span<const std::uint32_t> first, Block& block) const {
  EdgeBatch<Body>(faces_, begin, end, first).pass_to(block, declaration);
}

}  // namespace thalweg
