#pragma once

/// Who sees somebody through a side of a triangle in a simple polygon: a sweep over directions.

#include "order/circumdisc.hpp"
#include "order/ground.hpp"
#include "order/side_view.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace thalweg::detail {

/// Sweeps for one side after the other; scratch memory is reused.
class ThroughSweep {
 public:
  /// A vertex beyond the side that sees it, strictly between the lines to its bounds.
  struct Eye {
    VertexId vertex;
    SideView::Bounds bounds;
  };
  /// Those of the eyes that see, through the open side from u to v, a vertex inside the disc, or the corner w
  /// opposite. Pre: ground.simple_polygons(); the triangle uvw is valid, counter-clockwise, and the disc is
  /// its circumdisc; uv does not block; the eyes are inside the disc, strictly right of uv. Complexity: n log
  /// n for n faces that meet the disc and eyes.
  std::span<const VertexId> look(const Ground& ground, const Circumdisc& disc, const Triangle& uvw,
                                 std::span<const Eye> eyes);

 private:
  /// Neighbours in a set, none: the size or kNone.
  struct Neighbours {
    std::uint32_t before, at;
  };
  /// A set of whole numbers, as a binary tree.
  class SortedSet {
   public:
    static constexpr std::uint32_t kNone = 0xffffffffU;
    void reset(std::size_t size);
    void change(std::size_t i, bool present);
    /// The first one that the condition holds for, and the last one before. Pre: it then holds for all that
    /// follow.
    template <class Condition>
    [[nodiscard]] Neighbours find(const Condition& holds) const;

   private:
    std::size_t leaves_ = 1;
    std::vector<std::uint32_t> last_;  ///< by node: the last one present below it
  };
  enum class Kind : std::uint8_t { EyeLeft, Start, End, EyeRight };
  enum class Place : std::uint8_t { First, Between, Last };
  /// What changes, or what is asked, where the direction is that from one vertex to another.
  struct Event {
    Point2 from, to;
    Place place = Place::Between;  ///< the first and the last direction are those along the side
    Kind kind = Kind::Start;
    std::uint32_t subject =
        0;  ///< an eye; or twice a beam, or 1 more: the vertex that parts it from the next
  };
  static bool before(const Event& one, const Event& other);
  void list_events(const Ground& ground, const Triangle& uvw, std::span<const Eye> eyes);
  [[nodiscard]] std::uint32_t beam_at(const Ground& ground, const Event& event) const;

  SideView side_view_;
  std::vector<SideView::Beam> beams_;   ///< of light from the side through the triangle, from left to right
  std::vector<VertexId> parting_;       ///< each beam from the next
  std::vector<std::uint32_t> counted_;  ///< by beam: how many of these left of it are wanted
  std::vector<Event> events_;
  SortedSet open_beams_, open_parting_;   ///< at the direction at hand
  std::vector<std::uint32_t> rightmost_;  ///< by eye: the beam that its ray farthest right is in
  std::vector<VertexId> seeing_;
};

}  // namespace thalweg::detail
