#pragma once

/// Heights of a surface: exact point location in a TIN, and interpolation that keeps to its supports.
///
/// Laws: (1) the supports of a place are the one, two or three vertices of the vertex, edge or triangle whose
/// relative interior holds it, in exact arithmetic; (2) an interpolated height lies in the closed range of
/// its supports' heights, and is exactly their common height where all are equal; (3) it depends on the
/// supports' positions and heights, not on their order or ids.

#include <thalweg/mesh/tin.hpp>

#include <array>
#include <memory>
#include <optional>

namespace thalweg {

/// The height at p, linear between a and b, after p's projection onto the closed segment. Pre: a != b.
double interpolate_on_segment(Point2 a, double z_a, Point2 b, double z_b, Point2 p);

/// The height at p, linear over the triangle. Pre: the corners are not collinear, p lies in the triangle.
double interpolate_on_triangle(const std::array<Point2, 3>& corners, const std::array<double, 3>& z,
                               Point2 p);

/// A place on a surface. `supports[0 .. support_count)` count, in order of (x, y).
struct SurfacePlace {
  TriangleId triangle;  ///< one that holds the place
  std::array<VertexId, 3> supports;
  std::size_t support_count = 0;
};

/// Answers where points lie in a TIN. Keeps a reference to it: the TIN must stay where it is.
/// Thread-safe once built.
class SurfaceLocator {
 public:
  /// Complexity: linear on a convex TIN, else n log n.
  explicit SurfaceLocator(const Tin& tin);
  ~SurfaceLocator();
  SurfaceLocator(const SurfaceLocator&) = delete;
  SurfaceLocator& operator=(const SurfaceLocator&) = delete;

  /// The place of p on the closed surface; none outside of it. A hint is a triangle near p.
  /// Complexity: a walk of a few steps from the hint or from a start of our own.
  [[nodiscard]] std::optional<SurfacePlace> locate(Point2 p, TriangleId hint = {}) const;
  /// The height of the surface at p; none outside of it.
  [[nodiscard]] std::optional<double> height_at(Point2 p, TriangleId hint = {}) const;
  /// The height at a place that `locate` gave for p.
  [[nodiscard]] double height(const SurfacePlace& place, Point2 p) const;

 private:
  struct Index;
  const Tin& tin_;
  std::unique_ptr<const Index> index_;
};

}  // namespace thalweg
