// Who sees somebody through a side.
//
// Based on: Guibas, Hershberger, Leven, Sharir, Tarjan, Linear-time algorithms for visibility and shortest
// path problems inside triangulated simple polygons, 1987, for ray shooting from a segment: where a line
// through it hits is a convex subdivision of the dual plane. Silveira and van Kreveld, section 5,
// Observation 3, for what two rays tell. Here all rays are known before, so one sweep over the dual plane
// places them, in the order of their directions.
//
// 1. The light from the side uv that goes out through the triangle falls apart at each vertex x that it falls
//    on, into beams (side_view.cpp). A line through uv is a point of the dual plane. Its lines through x, as
//    far as they run on the ground from uv to x, are a segment there; these segments do not cross, and cut
//    the plane into cells, one a beam. A cell is cut off from a larger convex one by a line: it is convex.
// 2. The rays by which an eye p sees uv are a segment of the dual plane, too. It crosses that of x exactly if
//    p sees x. So p sees none exactly if both its ends are in one cell: its two outermost rays in one beam.
// 3. Only vertices in the disc are wanted, and w. Let D be the part of ground and disc that hangs together
//    with the triangle, and h, h' where the two rays leave it. If p sees no wanted vertex then the point in
//    which a ray that turns from one to the other leaves D moves along the border of D without a jump, for it
//    jumps only past a vertex inside the disc. So none is on the border between h and h'. Vertices on which
//    light falls are on the borders of D and of the polygon in the same order: p sees a wanted vertex exactly
//    if there is one among those between the two beams.
// 4. The sweep goes over all directions in which uv can be crossed, counter-clockwise. The rays of one
//    direction are in beams that follow each other from left to right; each two neighbours are parted by a
//    vertex of those on which light of that direction falls. A beam, and such a vertex, comes and goes at
//    directions that its outermost rays have. An eye's ray is found by the sides of it on which the vertices
//    are that part.
// 5. An eye does not see what is straight behind its bounds. So its rays are taken just within: the one
//    farthest right after all that changes at its direction, the other one before.
#include "order/through_sweep.hpp"

#include <thalweg/base/assert.hpp>
#include <thalweg/geometry/direction.hpp>

#include <algorithm>
#include <bit>

namespace thalweg::detail {

void ThroughSweep::SortedSet::reset(std::size_t size) {
  leaves_ = std::bit_ceil(std::max<std::size_t>(size, 1));
  last_.assign(2 * leaves_, kNone);
}

void ThroughSweep::SortedSet::change(std::size_t i, bool present) {
  std::size_t node = leaves_ + i;
  last_[node] = present ? static_cast<std::uint32_t>(i) : kNone;
  while (node > 1) {
    node /= 2;
    last_[node] = last_[2 * node + 1] != kNone ? last_[2 * node + 1] : last_[2 * node];
  }
}

template <class Condition>
ThroughSweep::Neighbours ThroughSweep::SortedSet::find(const Condition& holds) const {
  if (last_[1] == kNone || !holds(last_[1])) return {last_[1], kNone};
  Neighbours found{kNone, kNone};
  std::size_t node = 1;
  while (node < leaves_) {
    node *= 2;
    if (last_[node] == kNone) {
      ++node;
    } else if (!holds(last_[node])) {
      found.before = last_[node++];
    }
  }
  found.at = last_[node];
  return found;
}

bool ThroughSweep::before(const Event& one, const Event& other) {
  if (one.place != other.place) return one.place < other.place;
  if (one.place == Place::Between) {
    const bool same = one.from == other.from && one.to == other.to;
    const int sign = same ? 0 : turn({one.from, one.to}, {other.from, other.to});
    if (sign != 0) return sign > 0;
  }
  if (one.kind != other.kind) return one.kind < other.kind;
  return one.subject < other.subject;
}

void ThroughSweep::list_events(const Ground& ground, const Triangle& uvw, std::span<const Eye> eyes) {
  events_.clear();
  const Direction2 side{ground.point(uvw[0]), ground.point(uvw[1])};
  const auto add = [&](VertexId from, VertexId to, Kind kind, std::uint32_t subject) {
    Event event{ground.point(from), ground.point(to), Place::Between, kind, subject};
    const bool of_beam = subject % 2 == 0 && (kind == Kind::Start || kind == Kind::End);
    if (of_beam && turn(side, {event.from, event.to}) == 0) {
      event.place = kind == Kind::Start ? Place::First : Place::Last;
    }
    events_.push_back(event);
  };
  for (std::uint32_t i = 0; i < beams_.size(); ++i) {
    const SideView::Beam& beam = beams_[i];
    add(beam.right_from, beam.right_to, Kind::Start, 2 * i);
    add(beam.left_from, beam.left_to, Kind::End, 2 * i);
    if (i == parting_.size()) continue;
    const SideView::Bounds& bounds = side_view_.bounds()[beam.at_right];
    add(bounds.right, parting_[i], Kind::Start, 2 * i + 1);
    add(bounds.left, parting_[i], Kind::End, 2 * i + 1);
  }
  for (std::uint32_t i = 0; i < eyes.size(); ++i) {
    add(eyes[i].vertex, eyes[i].bounds.right, Kind::EyeRight, i);
    add(eyes[i].vertex, eyes[i].bounds.left, Kind::EyeLeft, i);
  }
  std::sort(events_.begin(), events_.end(), before);
}

std::uint32_t ThroughSweep::beam_at(const Ground& ground, const Event& event) const {
  const int straight =
      event.kind == Kind::EyeRight ? 0 : -1;  // what is straight ahead is right of it, or left
  const Neighbours parted = open_parting_.find([&](std::uint32_t i) {
    return orientation(event.from, event.to, ground.point(parting_[i])) <= straight;
  });
  const std::uint32_t first = parted.before == SortedSet::kNone ? 0 : parted.before + 1;
  const std::uint32_t beam = open_beams_.find([&](std::uint32_t i) { return i >= first; }).at;
  THALWEG_ASSERT(beam != SortedSet::kNone && (parted.at == SortedSet::kNone || beam <= parted.at));
  return beam;
}

std::span<const VertexId> ThroughSweep::look(const Ground& ground, const Circumdisc& disc,
                                             const Triangle& uvw, std::span<const Eye> eyes) {
  seeing_.clear();
  if (eyes.empty()) return seeing_;
  const auto found = side_view_.look(ground, disc, uvw[1], uvw[0]);
  beams_ = side_view_.beams();
  parting_.clear();
  counted_.assign(1, 0);
  for (std::size_t i = 0; i + 1 < beams_.size(); ++i) {
    const VertexId x = parting_.emplace_back(found[beams_[i].at_right]);
    counted_.push_back(counted_.back() + (x == uvw[2] || disc.holds(ground.point(x)) ? 1 : 0));
  }
  list_events(ground, uvw, eyes);
  open_beams_.reset(beams_.size());
  open_parting_.reset(parting_.size());
  rightmost_.assign(eyes.size(), 0);
  for (const Event& event : events_) {
    if (event.kind == Kind::EyeRight) {
      rightmost_[event.subject] = beam_at(ground, event);
    } else if (event.kind == Kind::EyeLeft) {
      const std::uint32_t leftmost = beam_at(ground, event);
      if (counted_[leftmost] < counted_[rightmost_[event.subject]]) {
        seeing_.push_back(eyes[event.subject].vertex);
      }
    } else {
      SortedSet& set = event.subject % 2 == 0 ? open_beams_ : open_parting_;
      set.change(event.subject / 2, event.kind == Kind::Start);
    }
  }
  return seeing_;
}

}  // namespace thalweg::detail
