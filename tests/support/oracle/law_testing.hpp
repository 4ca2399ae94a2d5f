#pragma once

/// Streams of scenes for law tests. A binary built with THALWEG_SCENE_FACTOR = f runs f times as many.

#include <gtest/gtest.h>
#include <support/oracle/orders.hpp>
#include <support/oracle/random_scenes.hpp>

#include <algorithm>
#include <string>

#ifndef THALWEG_SCENE_FACTOR
#define THALWEG_SCENE_FACTOR 1
#endif

namespace thalweg::oracle {

/// What a stream holds.
enum class Stream { General, Lattice, Circle, Polygon, Ground };
inline constexpr std::array<Stream, 5> kStreams{Stream::General, Stream::Lattice, Stream::Circle,
                                                Stream::Polygon, Stream::Ground};
inline constexpr std::array<Stream, 3> kPlaneStreams{Stream::General, Stream::Lattice, Stream::Circle};

inline Scene draw_scene(Dice& dice, Stream stream, const SceneOptions& options) {
  switch (stream) {
    case Stream::General:
      return random_scene(dice, options);
    case Stream::Lattice:
      return random_lattice_scene(dice, options);
    case Stream::Circle:
      return random_circle_scene(dice, options);
    case Stream::Polygon:
      return random_polygon(dice, options);
    case Stream::Ground:
      return random_ground(dice, options);
  }
  return {};
}

/// Calls law(oracle) for `count` scenes of each stream; the seed is the running test's name. Stops at the
/// first scene at which the test fails and prints it.
template <class Streams, class Law>
void for_each_scene(const Streams& streams, int count, SceneOptions options, const Law& law) {
  const auto* const test = testing::UnitTest::GetInstance()->current_test_info();
  for (const Stream stream : streams) {
    const std::string name = std::string(test->name()) + " " + std::to_string(static_cast<int>(stream));
    Dice dice{std::string_view(name)};
    for (int i = 0; i < count * THALWEG_SCENE_FACTOR; ++i) {
      constexpr std::array<int, 3> kRanges{24, 100, 1000};
      options.range = kRanges[static_cast<std::size_t>(i) % kRanges.size()];
      const Oracle oracle(draw_scene(dice, stream, options));
      SCOPED_TRACE("seed \"" + name + "\", scene " + std::to_string(i) + ": " + to_text(oracle.scene()));
      law(oracle);
      if (testing::Test::HasFailure()) return;
    }
  }
}

inline std::string to_text(Corners t) {
  return std::to_string(t[0]) + "," + std::to_string(t[1]) + "," + std::to_string(t[2]);
}

}  // namespace thalweg::oracle
