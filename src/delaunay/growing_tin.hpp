#pragma once

/// A constrained Delaunay triangulation that grows by the point that it misses most.

#include "cells.hpp"

#include <thalweg/mesh/tin.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace thalweg::detail {

inline constexpr std::uint32_t kNoSide = 0xffffffffU;

/// Vertices, in it or waiting, have the ids of `xy` and `z`. Cells are those inside of the outline; beyond it
/// is kNoSide.
class GrowingTin {
 public:
  /// Errors up to `limit` are no reason to insert; exactly so near the limit, and after `find_missed`.
  GrowingTin(std::span<const Point2> xy, std::span<const double> z, double limit);

  /// Takes a constrained Delaunay triangulation; vertex v of it is the vertex `ids[v]`.
  void start(const Tin& tin, std::span<const std::uint32_t> ids);
  /// Adds a vertex that waits, in the start's triangle that holds it. Follow with `rank_all`.
  void wait(std::uint32_t v, std::uint32_t cell);
  /// Measures the waiting vertices of all cells.
  void rank_all();

  /// The waiting vertex with the largest error beyond the limit.
  std::optional<std::uint32_t> worst();
  /// Inserts a vertex that waits.
  void insert(std::uint32_t v);
  /// Looks exactly for waiting vertices beyond the limit that rounding hid; `worst` knows them then.
  /// Returns whether there are any.
  bool find_missed(const Progress& progress);

  [[nodiscard]] std::span<const Cell> cells() const { return cells_; }
  /// The cell of a waiting vertex; kNoSide of one that does not wait.
  [[nodiscard]] std::uint32_t cell_of_waiting(std::uint32_t v) const { return cell_[v]; }
  /// The largest error of a waiting vertex.
  [[nodiscard]] double largest_error() const;

 private:
  /// A height above each position; the same whatever corner the cell starts at.
  struct Plane {
    Point2 origin;
    double z = 0, by_x = 0, by_y = 0;
    [[nodiscard]] double height(Point2 p) const {
      return z + (by_x * (p.x - origin.x) + by_y * (p.y - origin.y));
    }
  };
  /// A side of the cavity's rim, counter-clockwise.
  struct RimSide {
    std::uint32_t from = 0, to = 0;
    std::uint32_t outer = kNoSide;
    bool constrained = false;
  };
  struct Peak {
    double error = 0;
    Point2 xy;
    std::uint32_t vertex = 0, cell = 0;
    /// Lower in the heap.
    bool operator<(const Peak& other) const {
      return error != other.error ? error < other.error : xy > other.xy;
    }
  };

  [[nodiscard]] Plane plane_of(const Cell& cell) const;
  [[nodiscard]] double error_of(std::uint32_t v, const Plane& plane, const Cell& cell) const;
  [[nodiscard]] bool within_limit(std::uint32_t v, const Cell& cell) const;
  [[nodiscard]] bool conflicts(std::uint32_t cell, Point2 p) const;
  [[nodiscard]] bool higher(double error, std::uint32_t v, double other_error, std::uint32_t other) const {
    return error != other_error ? error > other_error : xy_[v] < xy_[other];
  }
  void add_waiting(std::uint32_t v, std::uint32_t cell, double error);
  void forget_waiting(std::uint32_t cell);
  void push_peak(std::uint32_t cell);
  void dig(std::uint32_t v);
  bool open_at_outline(std::uint32_t v);
  void fill(std::uint32_t v, bool open);
  void deal(std::uint32_t v, bool open);

  std::span<const Point2> xy_;
  std::span<const double> z_;
  double limit_;
  double slack_;  ///< errors nearer to the limit are compared exactly
  std::vector<Cell> cells_;
  std::vector<std::uint32_t> first_;         ///< of each cell: a waiting vertex
  std::vector<double> worst_error_;          ///< of each cell
  std::vector<std::uint32_t> worst_vertex_;  ///< of each cell
  std::vector<std::uint32_t> next_;          ///< of each vertex: the next that waits in its cell
  std::vector<std::uint32_t> cell_;          ///< of each vertex
  std::vector<Peak> peaks_;                  ///< a heap; entries of cells that changed since are skipped
  // Of one insertion:
  std::vector<std::uint32_t> pending_;  ///< sides of cavity cells to be looked at, the next one last
  std::vector<std::uint32_t> cavity_;
  std::vector<RimSide> rim_;
  std::vector<Plane> planes_;  ///< of the new cells
  std::vector<std::uint32_t> dealt_;
};

}  // namespace thalweg::detail
