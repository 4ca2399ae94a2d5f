#pragma once

/// How many of the points around a vertex the discs through it hold, for all directions of the disc at once.

#include <cstddef>
#include <vector>

namespace thalweg::detail {

/// Points inverted about the vertex, as seen along a direction from which their `turn` is measured.
struct Inverted {
  double x = 0, y = 0;
  double turn = 0;  ///< radians counter-clockwise; in a fan that is not closed at most those of its breadth
};

/// Keeps, for each of the lanes into which the directions of a disc's centre fall, how near the nearest
/// points lie, and so tells what no disc reaches that holds few of them. In single precision, and with bounds
/// that hold for all of a lane: it errs towards `reaches`. Memory: (depth + 1) times 104 floats.
class DiscDepth {
 public:
  /// Forgets all points. A fan that is not closed has the breadth given, in radians: discs whose centre lies
  /// off it by at most a right angle are told apart even where they point the same way.
  void reset(std::size_t depth, bool closed, double breadth);
  void insert(const Inverted& point);
  /// Whether some disc, with its centre within a right angle of some turn in [from, to], has the position
  /// inside, and at most `depth` inserted points inside (or that position on its rim, as the order of the
  /// same holds). May say yes where that is not so. Pre: depth <= that of reset.
  [[nodiscard]] bool reaches(const Inverted& position, std::size_t depth, double from, double to) const;

  /// The largest depth for which this pays.
  static constexpr std::size_t kMostDepth = 15;

 private:
  template <class Visit>
  void for_lanes(int first, int last, const Visit& visit) const;

  std::size_t depth_ = 0;
  bool closed_ = true;
  int lanes_ = 0;               ///< in use
  std::vector<float> nearest_;  ///< rows of lanes: the nearest, the second, ... as its product with the lane
};

}  // namespace thalweg::detail
