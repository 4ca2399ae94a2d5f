#pragma once

/// Terms of vertices, as functions of the labels of the quadrilaterals that have the vertex as a corner.

#include "optimize/declaration.hpp"
#include "optimize/tables.hpp"
#include "optimize/term_scan.hpp"

#include <thalweg/base/progress.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace thalweg {

/// A star edge by edge: what each is under the labels of at most two quadrilaterals.
struct SpokedStar {
  enum class Bend : std::uint8_t { Absent, Convex, Flat, Reflex };
  struct Spoke {
    std::uint32_t q = kNone, p = kNone;
    std::array<Bend, 4> bend{};  ///< the index as in PairValues
  };
  std::vector<std::uint32_t> scope;  ///< quadrilaterals, ascending
  std::vector<Spoke> spokes;         ///< round the vertex
  bool on_rim = false;

  [[nodiscard]] Star under(std::span<const Label> label) const;
  /// Every star that some labels give; with `fixed`, some labels that give a quadrilateral this one.
  /// Complexity: edges squared.
  [[nodiscard]] std::vector<Star> reachable(
      std::optional<std::pair<std::uint32_t, Label>> fixed = std::nullopt) const;
};

struct VertexTerms {
  Tables<1> tables;  ///< variables are quadrilaterals; those that change nothing are left out
  std::vector<std::int64_t> constants;  ///< terms that no label changes
  std::vector<SpokedStar> wide;         ///< stars of more quadrilaterals than a table takes
};

/// The largest table that is written out for a vertex, where the dynamic program's have that width.
std::uint32_t most_at_vertex(std::uint32_t width_limit);

/// The term of every vertex that is in a triangle, each once; the result does not depend on the number of
/// threads. Complexity: k 2^k for a vertex with k quadrilaterals, if that is no more than
/// scan.most_at_vertex(); runs on all threads.
VertexTerms find_vertex_terms(const TermScan& scan, VertexTerm term, const Progress& progress);

}  // namespace thalweg
