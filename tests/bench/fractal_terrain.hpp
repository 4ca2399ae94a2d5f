#pragma once

/// Fractal heights, and points to take them at, for benches of growing input.

#include <thalweg/geometry/point.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace thalweg::bench {

/// A value of 0 to 1 for a node of a lattice.
inline double node_value(std::int64_t i, std::int64_t j, std::uint64_t octave) {
  std::uint64_t h = static_cast<std::uint64_t>(i) * 0x9e3779b97f4a7c15U ^
                    static_cast<std::uint64_t>(j) * 0xc2b2ae3d27d4eb4fU ^ octave * 0x165667b19e3779f9U;
  h = (h ^ (h >> 31U)) * 0xbf58476d1ce4e5b9U;
  h = (h ^ (h >> 29U)) * 0x94d049bb133111ebU;
  return static_cast<double>((h ^ (h >> 32U)) >> 11U) * 0x1p-53;
}

/// Bilinear noise of nine octaves, each of half the wavelength and 0.6 times the amplitude: from kilometres
/// down to a few cells of 30 m.
inline double fractal_height(Point2 p) {
  double height = 0, amplitude = 400, wavelength = 12800;
  for (std::uint64_t octave = 0; octave < 9; ++octave) {
    const double x = p.x / wavelength, y = p.y / wavelength;
    const double i = std::floor(x), j = std::floor(y), fx = x - i, fy = y - j;
    const auto at = [&](int di, int dj) {
      return node_value(static_cast<std::int64_t>(i) + di, static_cast<std::int64_t>(j) + dj, octave);
    };
    height += amplitude *
              ((1 - fy) * ((1 - fx) * at(0, 0) + fx * at(1, 0)) + fy * ((1 - fx) * at(0, 1) + fx * at(1, 1)));
    amplitude *= 0.6;
    wavelength /= 2;
  }
  return height;
}

inline constexpr double kSpacing = 30;

enum class Pattern { Random, Jittered, Lattice };

struct TerrainPoints {
  std::vector<Point2> xy;
  std::vector<double> z;
};

/// About `count` points, one a cell of kSpacing metres.
inline TerrainPoints fractal_terrain(Pattern pattern, std::size_t count) {
  std::mt19937_64 engine(1);
  const auto real = [&engine] { return static_cast<double>(engine() >> 11U) * 0x1p-53; };
  const auto side = static_cast<std::size_t>(std::llround(std::sqrt(static_cast<double>(count))));
  TerrainPoints points;
  for (std::size_t i = 0; i < side * side; ++i) {
    Point2 p{static_cast<double>(i % side), static_cast<double>(i / side)};
    if (pattern == Pattern::Jittered) p = {p.x + 0.8 * real() - 0.4, p.y + 0.8 * real() - 0.4};
    if (pattern == Pattern::Random) {
      p = {static_cast<double>(side) * real(), static_cast<double>(side) * real()};
    }
    p = {kSpacing * p.x, kSpacing * p.y};
    points.xy.push_back(p);
    points.z.push_back(fractal_height(p));
  }
  return points;
}

}  // namespace thalweg::bench
