#pragma once

/// Links between plateaus: which choices of them keep together what they can keep together.

#include "verify/factor_sum.hpp"

#include <span>
#include <vector>

namespace thalweg::verify {

/// An edge between two nodes, there while the label of a quadrilateral is `label`.
struct PlainLink {
  Index quadrilateral;
  bool label;
  Index a, b;  ///< different
};

/// A label of a quadrilateral.
struct PlainLiteral {
  Index quadrilateral;
  bool label;
};

class PlainLinks {
 public:
  PlainLinks() = default;
  PlainLinks(std::vector<PlainLink> links, std::size_t node_count);

  [[nodiscard]] std::span<const PlainLink> all() const { return links_; }
  [[nodiscard]] std::size_t node_count() const { return at_.size(); }

  /// Whether every labelling that connects all that the links connect makes one of the literals true: without
  /// their links, the ends of the first one's link are apart. Complexity: the smaller side.
  [[nodiscard]] bool is_cut(std::span<const PlainLiteral> literals) const;

  /// For each set of quadrilaterals the least extra cost of links of theirs that connect what all links
  /// connect, if all links of other quadrilaterals are there. `rise[q]`: what label true of q costs more than
  /// false. The cheaper label is free; a quadrilateral has at most one link.
  [[nodiscard]] Cost least_forests(const std::vector<std::vector<Index>>& sets,
                                   const std::vector<Cost>& rise) const;

 private:
  [[nodiscard]] const PlainLink* link_of(Index quadrilateral) const;

  std::vector<PlainLink> links_;
  std::vector<Index> by_quadrilateral_;  ///< index of its link, or kNone
  std::vector<std::vector<Index>> at_;   ///< by node: indices of links
};

}  // namespace thalweg::verify
