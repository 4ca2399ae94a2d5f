#pragma once

/// Vertices that wait, where they lie on a lattice along the axes: found row by row, without lists.

#include <thalweg/geometry/point.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace thalweg::detail {

inline constexpr std::uint32_t kNoVertex = 0xffffffffU;

/// A height above each position; the same whatever corner its triangle starts at.
struct HeightPlane {
  Point2 origin;
  double z = 0, by_x = 0, by_y = 0;
  [[nodiscard]] double height(Point2 p) const {
    return z + (by_x * (p.x - origin.x) + by_y * (p.y - origin.y));
  }
};

/// A triangle with some of its sides: corners counter-clockwise, side i opposite to corner i.
struct OwningTriangle {
  std::array<Point2, 3> corner;
  std::uint32_t owned = 0;  ///< bit i: what lies on side i belongs to the triangle

  /// Exactly, whether p belongs to it.
  [[nodiscard]] bool holds(Point2 p) const;
};

/// The largest distance from a plane, as rounding leaves it, and where it is.
struct LatticePeak {
  double error = -1;  ///< below zero if nothing waits
  std::uint32_t vertex = kNoVertex;
};

/// Columns and rows are evenly spaced but for a hundredth of the spacing, as rounded coordinates are. Corners
/// of triangles may lie anywhere.
class WaitingLattice {
 public:
  /// The lattice of the vertices that wait; none if they do not lie on one, or fill less than a quarter of
  /// it. Complexity: linear.
  static std::optional<WaitingLattice> find(std::span<const Point2> xy, std::span<const double> z,
                                            const std::vector<bool>& waits);

  /// A vertex of the lattice waits no more.
  void take(Point2 p);
  /// How many places a triangle of that area has, about.
  [[nodiscard]] double places(double area) const { return area * columns_.by * rows_.by; }
  /// The largest distance from the plane of a vertex that waits in the triangle; of equal ones the first by
  /// (x, y). Complexity: rows, and half a nanosecond for each place.
  [[nodiscard]] LatticePeak peak(const OwningTriangle& triangle, const HeightPlane& plane) const;
  /// Appends those that wait in the triangle.
  void append(const OwningTriangle& triangle, std::vector<std::uint32_t>& to) const;

 private:
  /// Coordinates of columns or rows, ascending.
  struct Axis {
    std::vector<double> at;
    double by = 0;  ///< places a unit of length
    [[nodiscard]] double place(double coordinate) const { return (coordinate - at.front()) * by; }
    [[nodiscard]] std::size_t nearest(double coordinate) const {
      const double half_up = place(coordinate) + 0.5;
      return static_cast<std::size_t>(half_up);
    }
  };
  struct Row;
  class Rows;

  static std::optional<Axis> find_axis(std::span<const Point2> xy, const std::vector<bool>& waits,
                                       double Point2::*coordinate);
  /// The first place of the row that is as far from the plane as the row's farthest.
  [[nodiscard]] std::size_t farthest(const Row& row, const OwningTriangle& triangle, const HeightPlane& plane,
                                     double error) const;
  [[nodiscard]] std::size_t index(std::size_t row, std::size_t column) const {
    return row * columns_.at.size() + column;
  }

  [[nodiscard]] Point2 position(std::size_t row, std::size_t column) const {
    return {columns_.at[column], rows_.at[row]};
  }

  Axis columns_, rows_;
  std::vector<double> z_;              ///< row by row; NaN where nothing waits
  std::vector<std::uint32_t> vertex_;  ///< likewise
};

}  // namespace thalweg::detail
