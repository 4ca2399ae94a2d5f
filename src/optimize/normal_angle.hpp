#pragma once

/// The angle between the normals of two triangles, the same bits on every machine.
///
/// Laws: (1) it depends on coordinates only, not on ids or on the order of corners; (2) not on the frame's
/// origin, as long as a translation is exact; (3) only + - * / and square root are used, which IEEE 754
/// rounds correctly, so no mathematical library enters; (4) its error is below 1e-15 but for that of the
/// normals themselves.

#include <thalweg/mesh/tin.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

namespace thalweg {

/// Metres per unit of the plane and of heights.
struct Scale {
  double horizontal = 1;
  double vertical = 1;
};

struct Vector3 {
  double x = 0;
  double y = 0;
  double z = 0;
};

/// The angle of the vector (x, y) with the x-axis, for y >= 0 and not both zero.
/// Turned by a multiple of 45 degrees into |angle| <= 22.5 degrees; there a polynomial that interpolates
/// atan(t) / t as a function of t^2 at Chebyshev's nodes of [0, tan^2(pi / 8)], error below 3e-17.
inline double angle_of(double x, double y) {
  constexpr std::array<double, 11> kAtan = {
      0x1.0000000000000p+0, -0x1.55555555551e4p-2, 0x1.9999999934e50p-3, -0x1.2492490095732p-3,
      0x1.c71c648aca6a2p-4, -0x1.745baa2843f92p-4, 0x1.3afb01bbe7601p-4, -0x1.0ffbe63b09941p-4,
      0x1.d1fd545f28ae3p-5, -0x1.64314395b2626p-5, 0x1.5a482e20112ecp-6};
  constexpr double kTanEighth = 0x1.a827999fcef32p-2;
  constexpr double kQuarterTurn = 0x1.921fb54442d18p+0;
  const double a = std::abs(x);
  const bool steep = y > a;
  const double low = steep ? a : y, high = steep ? y : a;
  const bool diagonal = low > kTanEighth * high;
  const double t = (diagonal ? low - high : low) / (diagonal ? low + high : high);
  const double s = t * t;
  double sum = kAtan.back();
  for (std::size_t i = kAtan.size() - 1; i-- > 0;) sum = sum * s + kAtan[i];
  const double octant = (diagonal ? kQuarterTurn / 2 : 0.0) + t * sum;
  const double quadrant = steep ? kQuarterTurn - octant : octant;
  return x < 0 ? 2 * kQuarterTurn - quadrant : quadrant;
}

/// A vector of the same direction whose largest component is between 1/2 and 1.
inline Vector3 scaled_to_unit(Vector3 v) {
  const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (!(largest > 0) || !std::isfinite(largest)) return {0, 0, 1};
  int exponent = 0;
  std::frexp(largest, &exponent);
  return {std::ldexp(v.x, -exponent), std::ldexp(v.y, -exponent), std::ldexp(v.z, -exponent)};
}

/// Whether squares neither lose bits nor overflow.
inline bool has_plain_squares(double dot, double cross_squared) {
  const double magnitude = cross_squared + dot * dot;
  return magnitude > 1e-240 && magnitude < 1e300;
}

/// Angle between two directions, 0 to pi; symmetric to the bit.
inline double angle_between(Vector3 m, Vector3 n) {
  const Vector3 cross{m.y * n.z - m.z * n.y, m.z * n.x - m.x * n.z, m.x * n.y - m.y * n.x};
  const double dot = m.x * n.x + m.y * n.y + m.z * n.z;
  const double cross_squared = cross.x * cross.x + cross.y * cross.y + cross.z * cross.z;
  if (!has_plain_squares(dot, cross_squared)) return angle_between(scaled_to_unit(m), scaled_to_unit(n));
  return angle_of(dot, std::sqrt(cross_squared));
}

/// Two of some normals.
using BodyPair = std::array<std::uint32_t, 2>;

/// `angle_between` of pairs of normals, the same bits, several at a time.
/// Pre: as many angles as pairs.
void angles_between(std::span<const Vector3> normals, std::span<const BodyPair> pairs,
                    std::span<double> angles);

/// The normals that `make_face` gives triangles, the same bits, several at a time.
/// Pre: as many normals as triangles.
void find_normals(const Tin& tin, std::span<const Triangle> triangles, Scale scale,
                  std::span<Vector3> normals);

/// Throws: Error{SizeLimit}.
[[noreturn]] void refuse_term();

constexpr double kStepsPerUnit = 0x1p32;
constexpr double kMostUnits = 0x1p30;

/// Terms are integers: multiples of 2^-32 of their unit, rounded once. Throws: Error{SizeLimit} beyond so
/// many units, 2^30 at most.

inline std::int64_t to_steps(double value, double most_units = kMostUnits) {
  if (!(std::abs(value) <= most_units)) refuse_term();
  const double steps = value * kStepsPerUnit + 0.5;
  const auto towards_zero = static_cast<std::int64_t>(steps);
  return towards_zero - (static_cast<double>(towards_zero) > steps ? 1 : 0);
}

}  // namespace thalweg
