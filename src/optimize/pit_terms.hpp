#pragma once

/// Interior pits, or their depths, as a sum of tables, for where they cannot come first as a condition.

#include "optimize/bucket_elimination.hpp"
#include "optimize/labelling.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace thalweg {

/// An edge between two plateaus, or a plateau and node 0, that is there while the literal is true.
struct PitLink {
  std::uint32_t a = 0, b = 0;
  Literal when;
};

/// Counts the components without node 0, each by the weight of its nodes: for every labelling at most their
/// sum, and exactly that where `refine` says so.
class PitTerms {
 public:
  /// `weight`: by node, steps; that of node 0 is not looked at. Pre: links join different nodes, those
  /// between others than node 0 such as have equal weights. The tables do not depend on the numbers of nodes
  /// if `tie`, by variable, and the order of links do not.
  PitTerms(std::vector<PitLink> links, std::vector<std::int64_t> weight, std::span<const std::int64_t> tie);

  /// Adds the terms to a level, with auxiliary variables, which cost nothing, after those
  /// that are there. The sum less `constant` is the least over their labels.
  template <std::size_t Criteria>
  void add_to(Labelling<Criteria>& labelling, std::size_t level) const;
  /// Steps for plateaus that no link can reach.
  [[nodiscard]] std::int64_t constant() const;
  enum class Outcome : std::uint8_t { Exact, Refined, TooLarge };
  /// Whether the terms count the pits of this labelling exactly; if not, they will, unless that takes a table
  /// that is too large.
  Outcome refine(std::span<const Label> label);

 private:
  template <std::size_t Criteria>
  class Writer;

  [[nodiscard]] std::vector<std::uint32_t> components(std::span<const Label> label) const;
  bool merge(std::span<const std::uint32_t> nodes);

  std::vector<PitLink> links_;
  std::vector<std::int64_t> weight_;                  ///< by node
  std::vector<std::vector<std::uint32_t>> links_at_;  ///< by node
  std::vector<std::uint32_t> group_;                  ///< by node
  std::vector<std::vector<std::uint32_t>> nodes_of_;  ///< by group; empty: none
};

}  // namespace thalweg
