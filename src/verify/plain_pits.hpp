#pragma once

/// Fewest pits over all labellings, as connectivity of plateaus.

#include "verify/plain_delaunay.hpp"
#include "verify/plain_links.hpp"

#include <span>
#include <vector>

namespace thalweg::verify {

/// The plateaus of the edges that every labelling has, and what each diagonal connects. A plateau that has a
/// lower neighbour or touches the rim is drained; all drained ones are one node.
class PlainPlateaus {
 public:
  PlainPlateaus(const PlainMesh& delaunay, std::span<const PlainQuadrilateral> quadrilaterals);
  /// Other nodes and links, of which `drained` has an outlet.
  PlainPlateaus(PlainLinks links, Index drained);

  /// Between nodes: plateaus that are not drained, and one node for all that is; or what was given.
  [[nodiscard]] const PlainLinks& links() const { return links_; }
  /// No labelling has fewer pits: the sets of plateaus that all diagonals together leave undrained. Pre: the
  /// nodes are plateaus.
  [[nodiscard]] std::size_t fewest() const;
  /// For each plateau that some diagonal connects: one of them must be chosen where pits are fewest.
  [[nodiscard]] std::vector<Factor> plateau_clauses() const;
  /// The same for each set of plateaus that the labels leave unconnected though some diagonal would; empty if
  /// the labels have the fewest pits.
  [[nodiscard]] std::vector<Factor> broken_clauses(const std::vector<bool>& labels) const;

 private:
  [[nodiscard]] std::vector<Factor> clauses(const std::vector<Index>& set_of_node) const;

  PlainLinks links_;
  Index drained_ = 0;             ///< the node of all that is drained
  std::vector<bool> is_plateau_;  ///< nodes that stand for an undrained plateau
};

}  // namespace thalweg::verify
