#pragma once

/// Longitudes that run on across the antimeridian, so that no triangle or line jumps around the earth.

#include <thalweg/geometry/point.hpp>

#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace thalweg {

/// One turn of longitude, from `west` on; what lies in it, ends included, stays.
struct Turn {
  double west, period;
  [[nodiscard]] Point2 operator()(Point2 p) const {
    if (p.x < west || p.x > west + period) p.x -= period * std::floor((p.x - west) / period);
    return p;
  }
};

/// The turn of longitude in which positions are together that lie on both sides of the antimeridian (or of
/// Greenwich, if longitudes run from 0); their middle is within half a turn of Greenwich. None: they can stay
/// as they are. `period` is a turn in their unit.
std::optional<Turn> across_antimeridian(std::span<const Point2> xy, double period);

/// What a layer of turned positions says of itself: from where on the turn goes in which the TIN has them.
std::string describe_turned(double west);
/// The inverse; nothing if the layer says nothing of that.
std::optional<double> parse_turned(std::string_view description);

}  // namespace thalweg
