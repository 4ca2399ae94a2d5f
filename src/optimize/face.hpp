#pragma once

/// A triangle in space, as the terms of criteria see it.

#include "optimize/normal_angle.hpp"

#include <thalweg/mesh/tin.hpp>

#include <array>
#include <cstddef>

namespace thalweg {

/// In the units of the TIN.
struct Corner {
  Point2 at;
  double height = 0;
  VertexId vertex;
  bool operator==(const Corner&) const = default;
};

/// Counter-clockwise; the corner that comes first lexicographically stands first, so equal triangles have
/// equal bits. The normal is in square metres and points up; half its z is the area in the plane.
struct Face {
  std::array<Corner, 3> corner;
  Vector3 normal;
};

inline Face make_face(Corner a, Corner b, Corner c, Scale scale) {
  // Any of the three may come first: a branch would be mispredicted as often as not.
  const auto before = [](const Corner& p, const Corner& q) {
    return static_cast<unsigned>(p.at.x < q.at.x) |
           (static_cast<unsigned>(p.at.x == q.at.x) & static_cast<unsigned>(p.at.y < q.at.y));
  };
  const unsigned b_a = before(b, a), c_a = before(c, a), c_b = before(c, b);
  const std::size_t first = (b_a & (1 - c_b)) + 2 * (c_a & c_b);
  const std::array<Corner, 5> turn{a, b, c, a, b};
  a = turn[first], b = turn[first + 1], c = turn[first + 2];
  const double bx = (b.at.x - a.at.x) * scale.horizontal, cx = (c.at.x - a.at.x) * scale.horizontal;
  const double by = (b.at.y - a.at.y) * scale.horizontal, cy = (c.at.y - a.at.y) * scale.horizontal;
  const double bz = (b.height - a.height) * scale.vertical, cz = (c.height - a.height) * scale.vertical;
  return {{a, b, c}, {by * cz - bz * cy, bz * cx - bx * cz, bx * cy - by * cx}};
}

inline Corner corner_of(const Tin& tin, VertexId v) {
  return {tin.point(v), tin.height(v), v};
}

}  // namespace thalweg
