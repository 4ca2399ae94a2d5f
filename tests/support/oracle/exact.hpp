#pragma once

/// Exact plane geometry on small integers for the oracle; shares nothing with the library.
///
/// Laws: every answer is exact while coordinates are at most kCoordinateLimit in magnitude: the largest
/// number formed is the square of twice an in-circle determinant, below 2^120.

#include <compare>
#include <cstdint>

namespace thalweg::oracle {

__extension__ typedef __int128 Wide;

inline constexpr std::int64_t kCoordinateLimit = 4096;

/// A vertex.
struct Site {
  std::int64_t x = 0;
  std::int64_t y = 0;
  constexpr auto operator<=>(const Site&) const = default;
};

/// The point (x / w, y / w), w > 0.
struct Spot {
  Wide x = 0;
  Wide y = 0;
  Wide w = 1;
};

constexpr Spot spot_of(Site s) {
  return {s.x, s.y, 1};
}
constexpr int sign_of(Wide value) {
  return value > 0 ? 1 : (value < 0 ? -1 : 0);
}

/// Twice the signed area of abc: positive if counter-clockwise.
constexpr std::int64_t turn(Site a, Site b, Site c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}
/// The sign of the same for points with denominators.
int turn_sign(const Spot& a, const Spot& b, const Spot& c);

/// True if the closed segment ab holds x.
bool on_segment(Site a, Site b, Site x);
/// True if x lies on the segment ab and is none of its ends.
bool inside_segment(Site a, Site b, Site x);
/// True if the closed segments ab and cd have a point in common. Pre: a != b, c != d, as points.
bool segments_meet(const Spot& a, const Spot& b, const Spot& c, const Spot& d);

/// The power of d with respect to the circle through a, b, c, times turn(a, b, c): negative inside, 0 on the
/// circle, positive outside. Pre: a, b, c counter-clockwise.
Wide power(Site a, Site b, Site c, Site d);
/// True if d is a member of the circle abc: strictly inside, or on it and inside once every site's lift
/// x^2 + y^2 is raised by an infinitesimal, that of a lexicographically larger site being infinitely larger.
/// Pre: a, b, c counter-clockwise; d none of them.
bool member_of_circle(Site a, Site b, Site c, Site d);
/// True if the segment pq has a point in the open disc of the circle abc (never perturbed).
/// Pre: a, b, c counter-clockwise; p != q.
bool enters_open_disc(Site a, Site b, Site c, Site p, Site q);

}  // namespace thalweg::oracle
