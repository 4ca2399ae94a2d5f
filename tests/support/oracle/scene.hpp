#pragma once

/// A small scene for the oracle: vertices, constraint edges, and the boundary of the ground where one is
/// given.

#include <support/oracle/exact.hpp>

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace thalweg::oracle {

/// Indices of three vertices.
using Corners = std::array<int, 3>;
/// Indices of two vertices.
using Edge = std::pair<int, int>;

inline constexpr int kMaxSites = 32;

/// Pre (checked by `defect`): at most kMaxSites distinct sites within kCoordinateLimit; constraint edges meet
/// only at their ends and hold no site inside; every boundary edge is a constraint edge, the boundary edges
/// are closed rings, and no site lies off the ground.
struct Scene {
  std::vector<Site> sites;
  std::vector<Edge> constraints;  ///< each once, lower index first
  std::vector<Edge>
      boundary;  ///< polygon mode: what they enclose (even-odd) is the ground; empty: plane mode

  [[nodiscard]] int size() const { return static_cast<int>(sites.size()); }
  [[nodiscard]] bool polygon_mode() const { return !boundary.empty(); }
  [[nodiscard]] const Site& at(int v) const { return sites[static_cast<std::size_t>(v)]; }
  [[nodiscard]] bool constrained(int a, int b) const;
  /// The same three corners in counter-clockwise order.
  [[nodiscard]] Corners counter_clockwise(Corners t) const;
};

/// An edge as scenes hold it: lower index first.
constexpr Edge edge_of(int a, int b) {
  return a < b ? Edge{a, b} : Edge{b, a};
}

/// True if the point lies in the ground; always true in plane mode. Pre: the point lies on no boundary edge.
bool in_ground(const Scene& scene, const Spot& point);
/// Sight from p to q (theory: a constraint edge sees itself; else the open segment meets no closed constraint
/// edge, one that ends in p or q may touch it there). In polygon mode the segment must lie in the ground.
bool sees(const Scene& scene, int p, int q);
/// What breaks the preconditions of a scene, or an empty string.
std::string defect(const Scene& scene);
/// The scene in words that can be pasted into a test.
std::string to_text(const Scene& scene);

}  // namespace thalweg::oracle
