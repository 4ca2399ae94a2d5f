#pragma once

/// A constrained Delaunay triangulation that grows by the point that it misses most.

#include "cells.hpp"
#include "peaks.hpp"
#include "waiting_lattice.hpp"

#include <thalweg/mesh/tin.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace thalweg::detail {

inline constexpr std::uint32_t kNoSide = 0xffffffffU;
inline constexpr std::uint32_t kUnlisted = 0xfffffffeU;

/// Vertices, in it or waiting, have the ids of `xy` and `z`. Cells are those inside of the outline; beyond it
/// is kNoSide. Laws: which vertex is the worst depends on positions and heights only, whether they lie on a
/// lattice or not.
class GrowingTin {
 public:
  /// Errors up to `limit` are no reason to insert; exactly so near the limit, and after `find_missed`.
  GrowingTin(std::span<const Point2> xy, std::span<const double> z, double limit);

  /// Takes a constrained Delaunay triangulation; vertex v of it is the vertex `ids[v]`. All others wait.
  void start(const Tin& tin, std::span<const std::uint32_t> ids, Progress& progress);

  /// The waiting vertex with the largest error beyond the limit.
  std::optional<std::uint32_t> worst();
  /// Inserts a vertex that waits: the worst, or after `place_all` any.
  void insert(std::uint32_t v);
  /// Looks exactly for waiting vertices beyond the limit that rounding hid; `worst` knows them then.
  /// Returns whether there are any.
  bool find_missed(const Progress& progress);

  [[nodiscard]] std::span<const Cell> cells() const { return cells_; }
  /// Finds the cell of each waiting vertex.
  void place_all();
  /// After `place_all`: the cell of a waiting vertex; kNoSide of one that does not wait.
  [[nodiscard]] std::uint32_t cell_of_waiting(std::uint32_t v) const { return cell_[v]; }
  /// The largest error of a waiting vertex.
  [[nodiscard]] double largest_error() const;

 private:
  /// What waits in a cell.
  struct Waiting {
    double worst_error = 0;
    std::uint32_t worst_vertex = kNoSide;
    std::uint32_t first = kNoSide;  ///< of a list; kUnlisted: found in the lattice
  };
  /// A side of the cavity's rim, counter-clockwise.
  struct RimSide {
    std::uint32_t from = 0, to = 0;
    std::uint32_t outer = kNoSide;
    EdgeKind kind = EdgeKind::None;
    bool owned = false;  ///< what lies on it belongs to the cell within
  };

  [[nodiscard]] HeightPlane plane_of(const Cell& cell) const;
  [[nodiscard]] double error_of(std::uint32_t v, const HeightPlane& plane, const Cell& cell) const;
  [[nodiscard]] bool within_limit(std::uint32_t v, const Cell& cell) const;
  [[nodiscard]] bool conflicts(std::uint32_t cell, Point2 p) const;
  [[nodiscard]] bool higher(double error, std::uint32_t v, double other_error, std::uint32_t other) const {
    return error != other_error ? error > other_error : xy_[v] < xy_[other];
  }
  [[nodiscard]] OwningTriangle outline_of(const Cell& cell) const;
  void add_waiting(std::uint32_t v, std::uint32_t cell);
  void locate_waiting(const Tin& tin, Progress& progress);
  void compare(std::uint32_t v, double error, std::uint32_t cell);
  void measure(std::uint32_t cell, const HeightPlane& plane);
  void list(std::uint32_t cell);
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
  std::vector<Waiting> waiting_;     ///< of each cell
  std::vector<std::uint32_t> next_;  ///< of each vertex: the next that waits in its cell
  std::vector<std::uint32_t> cell_;  ///< of each vertex; out of date where its cell is not listed
  std::optional<WaitingLattice> lattice_;
  Peaks peaks_;  ///< entries of cells that changed since are skipped
  // Of one insertion:
  std::vector<std::uint32_t> pending_;  ///< sides of cavity cells to be looked at, the next one last
  std::vector<std::uint32_t> cavity_;
  std::vector<RimSide> rim_;
  std::vector<HeightPlane> planes_;  ///< of the new cells
  std::vector<std::uint32_t> dealt_, listed_;
};

}  // namespace thalweg::detail
