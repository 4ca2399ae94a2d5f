#pragma once

/// Whether a path inside a triangle's circle, off all constraint edges, joins a site to the triangle.

#include <support/oracle/scene.hpp>

namespace thalweg::oracle {

/// True if a path joins site p to the interior of t, all of which but its end p lies in the open disc of t
/// and off all closed constraint edges (it may leave the convex hull). Pre: t counter-clockwise and valid; p
/// a member of its circle.
bool path_joins(const Scene& scene, Corners t, int p);

}  // namespace thalweg::oracle
