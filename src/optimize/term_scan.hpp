#pragma once

/// Goes through all terms of a criterion, as functions of the labels of at most two quadrilaterals.

#include "base/parallel.hpp"
#include "optimize/edge_batch.hpp"

#include <tbb/enumerable_thread_specific.h>

#include <array>
#include <span>
#include <vector>

namespace thalweg {

/// Triangles, edges and what of them depends on labels. Label 1 flips.
class TermScan {
 public:
  TermScan(const Tin& tin, std::span<const Quadrilateral> quadrilaterals,
           std::span<const std::uint32_t> owner, Scale scale, const Reference* reference,
           std::uint32_t most_at_vertex = 0)
      : faces_{tin, quadrilaterals, owner, scale}, reference_(reference), most_at_vertex_(most_at_vertex) {}
  [[nodiscard]] const Tin& tin() const { return faces_.tin; }
  [[nodiscard]] std::span<const Quadrilateral> quadrilaterals() const { return faces_.quadrilaterals; }
  [[nodiscard]] std::span<const std::uint32_t> owner() const { return faces_.owner; }
  /// Quadrilaterals at a vertex up to which its term is written out as a table.
  [[nodiscard]] std::uint32_t most_at_vertex() const { return most_at_vertex_; }

  /// Rows of neighbours, sides in order, both ways. Complexity: linear, on all threads.
  struct Rows {
    std::vector<std::uint32_t> first = {0}, neighbour;
  };
  [[nodiscard]] Rows lay_out_rows(const Progress& progress) const;
  /// Calls, on all threads, a `Block` of the sink, made anew for each block of quadrilaterals or triangles:
  ///   constant(value)                 a term that no label changes,
  ///   single(q, f0, f1)               one that the label of q decides,
  ///   pair(neighbours, PairValues)    one that two labels decide,
  ///   finish()                        after all of them.
  /// Every term once. `first` is that of the rows. Blocks of a sink see ascending q.
  template <class Sink>
  void run(const Declaration& declaration, std::span<const std::uint32_t> first, Sink& sink,
           const Progress& progress) const;

 private:
  static constexpr std::size_t kBlock = 1024;

  [[nodiscard]] double left_on_rim(const Progress& progress) const;
  [[nodiscard]] double of_triangle(const Declaration& declaration, const Face& face) const {
    return declaration.of_triangle(face, faces_.scale, faces_.tin, reference_);
  }
  template <class Body, class Sink>
  void scan_edges(const Declaration& declaration, std::span<const std::uint32_t> first, Sink& sink,
                  const Progress& progress) const;
  template <class Sink>
  void scan_triangles(const Declaration& declaration, Sink& sink, const Progress& progress) const;

  LabelledFaces faces_;
  const Reference* reference_;
  std::uint32_t most_at_vertex_;
};

template <class Sink>
void TermScan::run(const Declaration& declaration, std::span<const std::uint32_t> first, Sink& sink,
                   const Progress& progress) const {
  if (declaration.of_angle != nullptr) {
    scan_edges<Vector3>(declaration, first, sink, progress);
  } else if (declaration.traits.coupling == Coupling::Edge) {
    scan_edges<Face>(declaration, first, sink, progress);
  } else {
    scan_triangles(declaration, sink, progress);
  }
}

template <class Body, class Sink>
void TermScan::scan_edges(const Declaration& declaration, std::span<const std::uint32_t> first, Sink& sink,
                          const Progress& progress) const {
  tbb::enumerable_thread_specific<EdgeBatch<Body>> batches(faces_, declaration, first);
  for_each_block(faces_.tin.triangle_count(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    typename Sink::Block block(sink);
    batches.local().pass(begin, end, block);
    block.finish();
  });
}

template <class Sink>
void TermScan::scan_triangles(const Declaration& declaration, Sink& sink, const Progress& progress) const {
  const auto terms = [&](const Face& a, const Face& b) {
    return std::array{of_triangle(declaration, a), of_triangle(declaration, b)};
  };
  for_each_block(faces_.quadrilaterals.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    typename Sink::Block block(sink);
    for (std::size_t q = begin; q < end; ++q) {
      const HalfedgeId uv = faces_.quadrilaterals[q].diagonal;
      block.single(static_cast<std::uint32_t>(q), terms(faces_.face(uv), faces_.face(faces_.tin.twin(uv))),
                   terms(faces_.flipped_face(q, true), faces_.flipped_face(q, false)));
    }
    block.finish();
  });
  for_each_block(faces_.tin.triangle_count(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    typename Sink::Block block(sink);
    for (std::size_t t = begin; t < end; ++t) {
      if (faces_.owner[t] != kNone) continue;
      block.constant(of_triangle(declaration, faces_.face(Tin::halfedge(TriangleId{t}, 0))));
    }
    block.finish();
  });
  if (declaration.against_reference != nullptr) {
    typename Sink::Block block(sink);
    block.constant(left_on_rim(progress));
    block.finish();
  }
}

}  // namespace thalweg
