#pragma once

/// A triangle in space, as the terms of criteria see it.

#include "optimize/normal_angle.hpp"

#include <thalweg/mesh/tin.hpp>

#include <array>
#include <utility>

namespace thalweg {

/// In the units of the TIN.
struct Corner {
  Point2 at;
  double height = 0;
  bool operator==(const Corner&) const = default;
};

/// Counter-clockwise; the corner that comes first lexicographically stands first, so equal triangles have
/// equal bits. The normal is in square metres and points up; half its z is the area in the plane.
struct Face {
  std::array<Corner, 3> corner;
  Vector3 normal;
};

inline Face make_face(Corner a, Corner b, Corner c, Scale scale) {
  while (b.at < a.at || c.at < a.at) a = std::exchange(b, std::exchange(c, a));
  const double bx = (b.at.x - a.at.x) * scale.horizontal, cx = (c.at.x - a.at.x) * scale.horizontal;
  const double by = (b.at.y - a.at.y) * scale.horizontal, cy = (c.at.y - a.at.y) * scale.horizontal;
  const double bz = (b.height - a.height) * scale.vertical, cz = (c.height - a.height) * scale.vertical;
  return {{a, b, c}, {by * cz - bz * cy, bz * cx - bx * cz, bx * cy - by * cx}};
}

inline Corner corner_of(const Tin& tin, VertexId v) {
  return {tin.point(v), tin.height(v)};
}

}  // namespace thalweg
