#pragma once

/// What a side of a triangle sees inside a disc, by one walk from face to face.

#include "order/circumdisc.hpp"
#include "order/ground.hpp"

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace thalweg::detail {

/// Looks from one side after the other; scratch memory is reused.
class SideView {
 public:
  /// The vertices that see a point of the open side uv along a segment in the disc, and some more that see
  /// one; in no promised order, over simple polygons each once. Stops after `most_faces`. Pre: the side of a
  /// valid triangle to the left of uv, which does not block. Complexity: n log n at most for n faces entered;
  /// over simple polygons each that meets the disc once at most, else once for each way between the obstacles
  /// along which light comes to it.
  std::span<const VertexId> look(const Ground& ground, const Circumdisc& disc, VertexId u, VertexId v,
                                 std::size_t most_faces = std::numeric_limits<std::size_t>::max());
  /// Between what a vertex sees the side: all lines from it strictly between the two cross uv unhindered.
  struct Bounds {
    VertexId right, left;
  };
  /// One for each vertex that the last look gave.
  [[nodiscard]] std::span<const Bounds> bounds() const { return bounds_; }
  /// A bundle of the light, between two neighbouring ones of what it falls on, where the last look left it:
  /// at an edge that blocks, or one that does not meet the disc. Its rays turn from the one through the first
  /// two vertices counter-clockwise to the one through the other two, both of which only touch it.
  struct Beam {
    VertexId right_from, right_to, left_from, left_to;
    std::uint32_t at_right = 0;  ///< which of the vertices found parts it from the next; the last has none
  };
  /// Those of the last look, from left to right as it goes out. Pre: it was not stopped. Complexity: linear.
  [[nodiscard]] std::vector<Beam> beams() const;
  /// Whether the last walk was stopped: then what it found is not all.
  [[nodiscard]] bool gave_up() const { return !open_.empty(); }

 private:
  /// Of a chain: the corners at which the lit ground bends, from the far end, near uv, to the near one.
  struct Link {
    VertexId vertex;
    std::uint32_t farther, nearer;
  };
  struct Chain {
    std::uint32_t far, near;
  };
  enum class Turn : int { Right = -1, Left = 1 };
  /// An edge through which light from uv falls: `edge` from its right to its left end, entered from uv's
  /// side.
  struct Window {
    HalfedgeId edge;
    Chain right, left;
  };
  struct Halves {
    Chain far, near;
  };

  std::uint32_t add(VertexId v);
  Chain append(Chain chain, VertexId v);
  [[nodiscard]] int turn(std::uint32_t farther, std::uint32_t nearer, VertexId x) const;
  [[nodiscard]] std::uint32_t tangent(Chain chain, Turn bend, VertexId x) const;
  Halves split(Chain chain, std::uint32_t at);
  void open_windows(VertexId u, VertexId v);
  /// A part of the chain for each edge between corners, and for each corner but the first its tangent.
  struct Wrapped {
    std::vector<Chain> chains;
    std::vector<VertexId> tangents;
  };
  void wrap(std::span<const VertexId> corners, Turn bend, Wrapped& wrapped);
  void enter(const Window& window);
  /// Where a window was left, and how many vertices had been found.
  struct End {
    Chain right, left;
    std::uint32_t after;
  };

  const Ground* ground_ = nullptr;
  std::vector<Link> links_;
  std::vector<Window> open_;
  std::vector<VertexId> visible_, corners_;
  std::vector<Bounds> bounds_;
  std::vector<End> ends_;
  std::vector<HalfedgeId> edges_;
  Wrapped right_, left_;
};

}  // namespace thalweg::detail
