// Points are sorted by triangles once; a quadrilateral looks at those of its two triangles.
#include "base/parallel.hpp"

#include <thalweg/geometry/vertical_distance.hpp>
#include <thalweg/terrain/source_error.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>

namespace thalweg {

namespace {

/// The points of each triangle.
class PointsByTriangle {
 public:
  PointsByTriangle(const Tin& tin, const LeftOutPoints& points)
      : first_(tin.triangle_count() + 1, 0), points_(points.xy.size()) {
    for (const TriangleId t : points.triangle) ++first_[t.index() + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t p = 0; p < points_.size(); ++p) {
      points_[next[points.triangle[p].index()]++] = static_cast<std::uint32_t>(p);
    }
  }
  [[nodiscard]] std::span<const std::uint32_t> of(TriangleId t) const {
    return std::span(points_).subspan(first_[t.index()], first_[t.index() + 1] - first_[t.index()]);
  }

 private:
  std::vector<std::uint32_t> first_;
  std::vector<std::uint32_t> points_;
};

// Pre: the corners are counter-clockwise.
bool within(const Tin& tin, const Triangle& corner, Point2 p, double z, double limit) {
  return within_of_plane(tin.point(corner[0]), tin.point(corner[1]), tin.point(corner[2]), p,
                         {tin.height(corner[0]), tin.height(corner[1]), tin.height(corner[2]), z}, limit);
}

bool may_flip(const Tin& tin, const LeftOutPoints& points, const PointsByTriangle& by_triangle, double limit,
              const Quadrilateral& q) {
  for (const HalfedgeId h : {q.diagonal, tin.twin(q.diagonal)}) {
    for (const std::uint32_t i : by_triangle.of(Tin::triangle_of(h))) {
      const Point2 p = points.xy[i];
      const bool at_u = orientation(tin.point(q.s), tin.point(q.t), p) < 0;
      const Triangle corner = at_u ? Triangle{q.s, q.u, q.t} : Triangle{q.t, q.v, q.s};
      if (!within(tin, corner, p, points.z[i], limit)) return false;
    }
  }
  return true;
}

}  // namespace

void bar_diagonals(const Tin& tin, const LeftOutPoints& points, double limit,
                   std::vector<Quadrilateral>& quadrilaterals, const Progress& progress) {
  constexpr std::size_t kBlock = 1024;
  if (points.xy.empty()) return;
  const PointsByTriangle by_triangle(tin, points);
  std::vector<std::uint8_t> stays(quadrilaterals.size());
  for_each_block(quadrilaterals.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t q = begin; q < end; ++q) {
      stays[q] = may_flip(tin, points, by_triangle, limit, quadrilaterals[q]) ? 1 : 0;
    }
  });
  std::size_t kept = 0;
  for (std::size_t q = 0; q < stays.size(); ++q) {
    if (stays[q] != 0) quadrilaterals[kept++] = quadrilaterals[q];
  }
  quadrilaterals.resize(kept);
}

LeftOutPoints relocated(const LeftOutPoints& points, const Tin& before, const Tin& after) {
  // For each triangle the one that it became, or those on either side of the new diagonal from s to t.
  struct Place {
    TriangleId left;  ///< of the diagonal; or the only one
    TriangleId right;
    VertexId s, t;
  };
  std::vector<Place> places(before.triangle_count());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const TriangleId t{i};
    for (std::size_t side = 0; side < 3; ++side) {
      const HalfedgeId h = Tin::halfedge(t, side);
      const HalfedgeId there = after.find_halfedge(before.origin(h), before.target(h));
      if (!there.valid()) {  // the diagonal that was flipped
        const VertexId s = before.apex(h), opposite = before.apex(before.twin(h));
        const HalfedgeId diagonal = after.find_halfedge(s, opposite);
        places[i] = {Tin::triangle_of(diagonal), Tin::triangle_of(after.twin(diagonal)), s, opposite};
        break;
      }
      places[i].left = Tin::triangle_of(there);
    }
  }
  LeftOutPoints moved = points;
  for (std::size_t p = 0; p < moved.xy.size(); ++p) {
    const Place& place = places[points.triangle[p].index()];
    const bool right =
        place.right.valid() && orientation(before.point(place.s), before.point(place.t), points.xy[p]) < 0;
    moved.triangle[p] = right ? place.right : place.left;
  }
  return moved;
}

SourceError measure_error(const Tin& tin, const LeftOutPoints& points) {
  SourceError error;
  double squares = 0;
  for (std::size_t p = 0; p < points.xy.size(); ++p) {
    const Triangle& corner = tin.triangle(points.triangle[p]);
    const Point2 a = tin.point(corner[0]), b = tin.point(corner[1]), c = tin.point(corner[2]);
    const double z = tin.height(corner[0]);
    const double bx = b.x - a.x, by = b.y - a.y, bz = tin.height(corner[1]) - z;
    const double cx = c.x - a.x, cy = c.y - a.y, cz = tin.height(corner[2]) - z;
    const double px = points.xy[p].x - a.x, py = points.xy[p].y - a.y;
    const double area = bx * cy - by * cx;
    const double height = z + ((bz * cy - by * cz) * px + (bx * cz - bz * cx) * py) / area;
    const double off = std::abs(points.z[p] - height);
    error.largest = std::max(error.largest, off);
    squares += off * off;
  }
  error.rms = std::sqrt(squares /
                        static_cast<double>(std::max<std::size_t>(1, points.xy.size() + tin.vertex_count())));
  return error;
}

}  // namespace thalweg
