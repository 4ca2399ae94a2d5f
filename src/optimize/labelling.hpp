#pragma once

/// The problem behind the optimiser, without geometry: a label 0 or 1 for each variable.

#include "optimize/cost.hpp"
#include "optimize/label.hpp"
#include "optimize/tables.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace thalweg {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// An edge between two nodes of a multigraph that exists while its variable has the label `helpful`.
struct Link {
  std::uint32_t a = kNone;  ///< kNone: the variable has no edge
  std::uint32_t b = kNone;
  Label helpful = Label::One;
  [[nodiscard]] bool exists() const { return a != b; }
};

/// Wanted: the labelling of least cost among those whose links connect all that the links together can
/// connect. Cost = sum of unary[q] over labels 1 + sum of weights over neighbours that both have label 1 +
/// sum of tables; any function of pairs of labels has the form of the first two, up to a constant.
template <std::size_t Criteria>
struct Labelling {
  std::vector<Cost<Criteria>> unary;
  /// Neighbours of q: neighbour[first[q]] to neighbour[first[q + 1]], weights alongside, each pair at both
  /// ends.
  std::vector<std::uint32_t> first = {0};
  std::vector<std::uint32_t> neighbour;
  std::vector<Weight<Criteria>> weight;
  Tables<Criteria> tables;       ///< indexed
  std::vector<Link> link;        ///< by variable; empty where nothing has to be connected
  std::uint32_t node_count = 0;  ///< of the multigraph

  [[nodiscard]] std::size_t size() const { return unary.size(); }
  [[nodiscard]] bool has_link(std::size_t q) const { return !link.empty() && link[q].exists(); }
};

}  // namespace thalweg
