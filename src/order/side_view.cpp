// Light from a side.
//
// Based on: Guibas, Hershberger, Leven, Sharir, Tarjan, Linear-time algorithms for visibility and shortest
// path problems inside triangulated simple polygons, 1987, for the walk along the dual tree with two chains
// of shortest paths. Of these chains only the part is kept that bounds light, which is cut in two where paths
// part.
//
// 1. The rays from points of the open side uv that go through an edge ab of the triangulation ("window") lie
//    between two: the one farthest right touches the left chain at its far end and then the right chain at
//    its near end, the one farthest left the other way round. Between these touches each chain bends inwards:
//    the left chain is a path from its far end that turns left at each corner, the right one turns right.
// 2. The third corner x of the face beyond the window is in light if it lies strictly between the two rays; a
//    vertex that a ray touches shades what lies behind it (closed shadows). Else all light passes it on one
//    side, through one of the face's other edges, between the same rays.
// 3. If x is in light it cuts it in two. The rays through x lie between its tangents to both chains. Through
//    ax falls what touches the left chain up to the tangent's point, then x, and the right chain from the
//    tangent's point on; through xb the rest. So both chains fall apart, with that point in both parts. It is
//    looked for from both ends at once: the work is that of the smaller part, n log n in all.
// 4. The faces that uv crosses: their corners right of uv are in light, along the edges that cross uv. Of two
//    that follow each other, each bounds the light through the edge between them; the chains are those that a
//    shortest path from u to one, and from v to the other, loses on its way to the next: a Graham scan.
// 5. Windows wait on a stack, the left one of two on top: those in which the walk ends come from left to
//    right, and the vertex that parts two neighbours is the last one found that parts none before.
// 6. None of this needs the dual to be a tree: a window is a way from face to face, and chains are those of
//    the paths along it. Where edges that block stand alone in the ground, light goes past both of their
//    ends, and meets again. A vertex that blocks nothing cuts light like others: what lies straight behind it
//    is strictly between the rays of a window at its other side.
#include "order/side_view.hpp"

#include <algorithm>

namespace thalweg::detail {

namespace {

constexpr std::uint32_t kNone = 0xffffffffU;

}  // namespace

std::uint32_t SideView::add(VertexId v) {
  links_.push_back({v, kNone, kNone});
  return static_cast<std::uint32_t>(links_.size() - 1);
}

SideView::Chain SideView::append(Chain chain, VertexId v) {
  const std::uint32_t last = add(v);
  links_[last].farther = chain.near;
  links_[chain.near].nearer = last;
  return {chain.far, last};
}

int SideView::turn(std::uint32_t farther, std::uint32_t nearer, VertexId x) const {
  return orientation(ground_->point(links_[farther].vertex), ground_->point(links_[nearer].vertex),
                     ground_->point(x));
}

// The last corner that a shortest path to x bends at, or the chain's far end.
std::uint32_t SideView::tangent(Chain chain, Turn bend, VertexId x) const {
  const int sign = static_cast<int>(bend);
  std::uint32_t low = chain.far, high = chain.near;
  for (;;) {
    if (high == chain.far || turn(links_[high].farther, high, x) == sign) return high;
    high = links_[high].farther;
    const std::uint32_t next = links_[low].nearer;
    if (next == kNone || turn(low, next, x) != sign) return low;
    low = next;
  }
}

// The link is the near end of one half, and a copy of it the far end of the other.
SideView::Halves SideView::split(Chain chain, std::uint32_t at) {
  const std::uint32_t copy = add(links_[at].vertex);
  links_[copy].nearer = links_[at].nearer;
  if (links_[at].nearer != kNone) links_[links_[at].nearer].farther = copy;
  links_[at].nearer = kNone;
  return {{chain.far, at}, {copy, at == chain.near ? copy : chain.near}};
}

// For each corner but the first the chain that the path to it leaves, from where it does to the corner
// before.
void SideView::wrap(std::span<const VertexId> corners, Turn bend, Wrapped& wrapped) {
  auto& [chains, tangents] = wrapped;
  chains.clear();
  tangents.clear();
  const std::uint32_t first = add(corners.front());
  Chain path{first, first};
  for (const VertexId corner : corners.subspan(1)) {
    std::uint32_t at = path.near;
    while (at != path.far && turn(links_[at].farther, at, corner) != static_cast<int>(bend)) {
      at = links_[at].farther;
    }
    tangents.push_back(links_[at].vertex);
    const Halves halves = split(path, at);
    chains.push_back(halves.near);
    path = append(halves.far, corner);
  }
}

void SideView::open_windows(VertexId u, VertexId v) {
  const Tin& tin = ground_->tin();
  const Point2 from = ground_->point(u), to = ground_->point(v);
  corners_.assign(1, u);
  edges_.clear();
  HalfedgeId crossed = tin.find_halfedge(u, v);
  if (crossed.valid()) {
    edges_.push_back(crossed);
  } else {
    for (const HalfedgeId h : tin.outgoing(u)) {
      if (orientation(from, ground_->point(tin.target(h)), to) <= 0 ||
          orientation(from, to, ground_->point(tin.apex(h))) <= 0) {
        continue;
      }
      edges_.push_back(h);
      corners_.push_back(tin.target(h));
      crossed = Tin::next(h);
      break;
    }
    while (crossed.valid()) {
      const HalfedgeId entry = tin.twin(crossed);
      if (!entry.valid()) break;
      const VertexId apex = tin.apex(entry);
      if (apex != v && orientation(from, to, ground_->point(apex)) > 0) {
        crossed = Tin::next(entry);
        continue;
      }
      edges_.push_back(Tin::next(entry));
      if (apex == v) break;
      corners_.push_back(apex);
      crossed = Tin::previous(entry);
    }
  }
  visible_.assign(corners_.begin() + 1, corners_.end());
  corners_.push_back(v);
  wrap(corners_, Turn::Right, right_);
  std::reverse(corners_.begin(), corners_.end());
  wrap(corners_, Turn::Left, left_);
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    open_.push_back({edges_[i], right_.chains[i], left_.chains[edges_.size() - 1 - i]});
  }
  bounds_.clear();
  for (std::size_t i = 0; i < visible_.size(); ++i) {
    bounds_.push_back({left_.tangents[visible_.size() - 1 - i], right_.tangents[i]});
  }
}

void SideView::enter(const Window& window) {
  const Tin& tin = ground_->tin();
  const HalfedgeId entry = tin.twin(window.edge);
  const HalfedgeId right_exit = Tin::next(entry), left_exit = Tin::previous(entry);
  const VertexId x = tin.apex(entry);
  const auto& [edge, right, left] = window;
  const auto side = [&](std::uint32_t first, std::uint32_t second) {
    return orientation(ground_->point(links_[first].vertex), ground_->point(links_[second].vertex),
                       ground_->point(x));
  };
  if (side(left.far, right.near) <= 0) return open_.push_back({left_exit, right, left});
  if (side(right.far, left.near) >= 0) return open_.push_back({right_exit, right, left});
  visible_.push_back(x);
  const std::uint32_t left_tangent = tangent(left, Turn::Left, x);
  const std::uint32_t right_tangent = tangent(right, Turn::Right, x);
  bounds_.push_back({links_[left_tangent].vertex, links_[right_tangent].vertex});
  const Halves left_halves = split(left, left_tangent);
  const Halves right_halves = split(right, right_tangent);
  open_.push_back({right_exit, right_halves.near, append(left_halves.far, x)});
  open_.push_back({left_exit, append(right_halves.far, x), left_halves.near});
}

std::span<const VertexId> SideView::look(const Ground& ground, const Circumdisc& disc, VertexId u, VertexId v,
                                         std::size_t most_faces) {
  const Tin& tin = ground.tin();
  ground_ = &ground;
  links_.clear();
  open_.clear();
  ends_.clear();
  open_windows(u, v);
  const auto leaves_at = [&](HalfedgeId edge) {
    if (ground.blocks(edge) || tin.on_rim(edge)) return true;
    const Point2 right = ground.point(tin.origin(edge)), left = ground.point(tin.target(edge));
    return disc.side(right) < 0 && disc.side(left) < 0 && !disc.passes(right, left);
  };
  for (std::size_t faces = 0; !open_.empty() && faces < most_faces;) {
    const Window window = open_.back();
    open_.pop_back();
    if (leaves_at(window.edge)) {
      ends_.push_back({window.right, window.left, static_cast<std::uint32_t>(visible_.size())});
      continue;
    }
    enter(window);
    ++faces;
  }
  return visible_;
}

std::vector<SideView::Beam> SideView::beams() const {
  std::vector<Beam> beams;
  beams.reserve(ends_.size());
  std::vector<std::uint32_t> parting;
  std::uint32_t found = 0;
  for (const auto& [right, left, after] : ends_) {
    while (found < after) parting.push_back(found++);
    Beam& beam = beams.emplace_back(Beam{links_[left.far].vertex, links_[right.near].vertex,
                                         links_[right.far].vertex, links_[left.near].vertex});
    if (parting.empty()) break;
    beam.at_right = parting.back();
    parting.pop_back();
  }
  return beams;
}

}  // namespace thalweg::detail
