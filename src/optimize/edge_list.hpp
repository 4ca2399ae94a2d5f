#pragma once

/// The edges whose terms a block of quadrilaterals or triangles has, and the triangles beside them.

#include "optimize/labelled_faces.hpp"
#include "optimize/normal_angle.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace thalweg {

/// A vector that keeps its elements when emptied, and has room before it is filled.
template <class T>
class Pile {
 public:
  /// Empties it. Pre of `add`: no more than `most` are added.
  void clear(std::size_t most) {
    if (storage_.size() < most) storage_.resize(most);
    size_ = 0;
  }
  std::uint32_t add(const T& value) {
    storage_[size_] = value;
    return static_cast<std::uint32_t>(size_++);
  }
  [[nodiscard]] std::span<const T> all() const { return std::span(storage_).first(size_); }

 private:
  std::vector<T> storage_;
  std::size_t size_ = 0;
};

/// Lists one block after the other; each quadrilateral's four triangles are listed once.
class EdgeList {
 public:
  /// `first` is that of the rows. What is referred to outlives it.
  EdgeList(const LabelledFaces& faces, std::span<const std::uint32_t> first) : faces_(faces), first_(first) {}

  /// The edges that a label of the quadrilaterals decides; those to an earlier one are left to its block.
  void load_quadrilaterals(std::uint32_t begin, std::uint32_t end);
  /// The edges that no label decides and that the triangles represent; only their sides.
  void load_triangles(std::size_t begin, std::size_t end);

  [[nodiscard]] std::span<const Triangle> triangles() const { return triangles_.all(); }
  /// p is kNone if only q decides.
  [[nodiscard]] std::span<const Neighbours> edges() const { return edges_.all(); }
  /// For each edge, the triangles of its two or four values; of one that no label decides, of its one.
  [[nodiscard]] std::span<const BodyPair> sides() const { return sides_.all(); }

 private:
  std::uint32_t add(HalfedgeId h) { return triangles_.add(faces_.tin.triangle(Tin::triangle_of(h))); }
  std::uint32_t add_flipped(std::uint32_t q, bool at_s_u) {
    const auto& [s, u, t, v, diagonal] = faces_.quadrilaterals[q];
    return triangles_.add(at_s_u ? Triangle{s, u, t} : Triangle{t, v, s});
  }
  [[nodiscard]] bool here(std::uint32_t q) const { return q >= begin_ && q < end_; }
  void list_edges(std::uint32_t q);
  void list_pair(std::uint32_t q, std::uint32_t p, HalfedgeId outer, std::uint32_t q_slot, BodyPair of_q);

  const LabelledFaces& faces_;
  std::span<const std::uint32_t> first_;
  std::uint32_t begin_ = 0, end_ = 0;
  Pile<Triangle> triangles_;
  Pile<Neighbours> edges_;
  Pile<BodyPair> sides_;
};

}  // namespace thalweg
