#pragma once

/// Profiles: heights of a TIN along a line.

#include <thalweg/base/progress.hpp>
#include <thalweg/mesh/tin.hpp>

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace thalweg {

struct ProfilePoint {
  std::size_t part = 0;  ///< pieces of the line that are on the surface, counted from 0
  double distance = 0;   ///< along the line from its start, in the TIN's plane
  Point2 xy;
  double z = 0;
};

/// Answers what the surface is along lines. Keeps a reference to the TIN, which must stay where it is.
class ProfileTracer {
 public:
  explicit ProfileTracer(const Tin& tin);
  ~ProfileTracer();
  ProfileTracer(const ProfileTracer&) = delete;
  ProfileTracer& operator=(const ProfileTracer&) = delete;

  /// The line's vertices and each place where it meets an edge or a vertex of the TIN, in order: between two
  /// that follow each other in a part the surface is straight. What is off the surface is left out. Throws:
  /// Error{Cancelled}. Complexity: the triangles that the line's pieces meet.
  [[nodiscard]] std::vector<ProfilePoint> trace(std::span<const Point2> line, const Progress& progress) const;

 private:
  struct Index;
  std::unique_ptr<const Index> index_;
};

}  // namespace thalweg
