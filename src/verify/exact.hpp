#pragma once

/// Exact signs, written apart from module geometry: a second opinion on every decision.
///
/// All answers are those of exact arithmetic on the given doubles. Pre (all): coordinates are finite.

#include <thalweg/geometry/point.hpp>

namespace thalweg::verify {

/// +1 if a, b, c turn counter-clockwise, -1 clockwise, 0 on one line.
int turn(Point2 a, Point2 b, Point2 c);

/// +1 if d lies inside the circle of the counter-clockwise a, b, c, -1 outside, 0 on it.
int circle_side(Point2 a, Point2 b, Point2 c, Point2 d);

/// Whether d counts as inside, also where the four are on one circle: the lexicographically largest of them
/// counts as outside the circle of the others. Pre: a, b, c counter-clockwise; four distinct points.
bool counts_as_inside(Point2 a, Point2 b, Point2 c, Point2 d);

/// Whether the open segments ab and cd cross in one point.
bool segments_cross(Point2 a, Point2 b, Point2 c, Point2 d);

/// Whether x lies on the open segment ab.
bool inside_segment(Point2 a, Point2 b, Point2 x);

}  // namespace thalweg::verify
