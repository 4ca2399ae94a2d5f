#pragma once

/// The edges of a block of triangles, and the triangles that labels may put beside them.

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
    if (storage_.size() <= most) storage_.resize(most + 1);
    size_ = 0;
  }
  std::uint32_t add(const T& value) { return add_if(true, value); }
  /// Without a branch.
  std::uint32_t add_if(bool wanted, const T& value) {
    storage_[size_] = value;
    const std::size_t place = size_;
    size_ += wanted ? 1 : 0;
    return static_cast<std::uint32_t>(place);
  }
  [[nodiscard]] std::span<const T> all() const { return std::span(storage_).first(size_); }

 private:
  std::vector<T> storage_;
  std::size_t size_ = 0;
};

/// Lists one block after the other. Bodies are numbered: the triangles of the block, then `others`.
class EdgeList {
 public:
  /// `first` is that of the rows. What is referred to outlives it.
  EdgeList(const LabelledFaces& faces, std::span<const std::uint32_t> first) : faces_(faces), first_(first) {}

  /// The edges of the quadrilaterals whose diagonals the triangles represent, those to an earlier one aside,
  /// and the edges that the triangles represent and no label decides.
  void load(std::size_t begin, std::size_t end);

  [[nodiscard]] std::span<const Triangle> block() const {
    return faces_.tin.triangles().subspan(begin_, end_ - begin_);
  }
  [[nodiscard]] std::span<const Triangle> others() const { return others_.all(); }
  /// For each edge that one label decides, its quadrilateral.
  [[nodiscard]] std::span<const std::uint32_t> singles() const { return singles_.all(); }
  [[nodiscard]] std::span<const Neighbours> pairs() const { return pairs_.all(); }
  /// The bodies of the two values of each single, of the four of each pair, of the one of each other edge.
  [[nodiscard]] std::span<const BodyPair> sides() const { return sides_.all(); }

 private:
  /// A side of a quadrilateral that is not on the rim.
  struct Beside {
    std::uint32_t q, side;
    HalfedgeId outer;
    std::uint32_t p, slot;  ///< what is across, and where its slot would be
  };
  [[nodiscard]] bool here(std::uint32_t q) const { return q >= first_q_ && q < end_q_; }
  std::uint32_t add_other(const Triangle& triangle) {
    return static_cast<std::uint32_t>(end_ - begin_) + others_.add(triangle);
  }
  std::uint32_t body(HalfedgeId h) {
    const std::size_t t = Tin::triangle_of(h).index();
    return t >= begin_ && t < end_ ? static_cast<std::uint32_t>(t - begin_)
                                   : add_other(faces_.tin.triangles()[t]);
  }
  [[nodiscard]] std::uint32_t flipped_body(std::uint32_t q, bool at_s_u) const {
    return static_cast<std::uint32_t>(end_ - begin_) + 2 * (q - first_q_) + (at_s_u ? 0 : 1);
  }
  std::uint32_t add_flipped(std::uint32_t q, bool at_s_u);
  [[nodiscard]] std::uint32_t owned_before(std::uint32_t p, std::size_t side) const;
  /// The bodies at a side under labels 0 and 1. Pre: the quadrilateral is here.
  [[nodiscard]] BodyPair bodies_at(std::uint32_t q, std::size_t side) const;
  void clear();
  void list_quadrilaterals();
  void list_single(const Beside& at);
  void list_pair(const Beside& at);
  void list_constants();

  const LabelledFaces& faces_;
  std::span<const std::uint32_t> first_;
  std::size_t begin_ = 0, end_ = 0;
  std::uint32_t first_q_ = 0, end_q_ = 0;
  Pile<Triangle> others_;
  Pile<BodyPair> kept_;        ///< by quadrilateral: its triangles under label 0
  Pile<std::uint32_t> owned_;  ///< by quadrilateral: a bit for each side across which there is one
  Pile<Beside> to_free_, to_owned_;
  Pile<std::uint32_t> singles_;
  Pile<Neighbours> pairs_;
  Pile<HalfedgeId> constants_;
  Pile<BodyPair> sides_;
};

}  // namespace thalweg
