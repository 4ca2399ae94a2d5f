#include "io/antimeridian.hpp"

#include "io/file_content.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>

namespace thalweg {

namespace {

constexpr std::string_view kTurned = "Longitudes run on across the antimeridian; those of the TIN lie from ";

}  // namespace

std::optional<Turn> across_antimeridian(std::span<const Point2> xy, double period) {
  const auto sides = [xy](const auto& turn) {
    const auto [west, east] = std::ranges::minmax(xy, {}, [&](Point2 p) { return turn(p).x; });
    return std::pair(turn(west).x, turn(east).x);
  };
  if (xy.empty()) return {};
  const auto [west, east] = sides(std::identity());
  if (east - west <= period / 2) return {};
  for (const double start : {0.0, -period / 2}) {
    const auto [low, high] = sides(Turn{start, period});
    if (high - low >= east - west) continue;
    // To a hundredth of a degree, as that of MetricFrame, so that all layers are on one side.
    const double step = period / 36000, middle = std::round((low + high) / 2 / step) * step;
    return Turn{std::remainder(middle, period) - period / 2, period};
  }
  return {};
}

std::string describe_turned(double west) {
  return fmt::format("{}{}", kTurned, west);
}

std::optional<double> parse_turned(std::string_view description) {
  if (!description.starts_with(kTurned)) return std::nullopt;
  return parse_number(description.substr(kTurned.size()));
}

}  // namespace thalweg
