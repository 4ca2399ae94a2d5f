#pragma once

/// The problem behind the optimiser, without geometry: a label 0 or 1 for each variable.

#include "optimize/cost.hpp"
#include "optimize/label.hpp"
#include "optimize/tables.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace thalweg {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// An edge between two nodes of a multigraph that exists while its variable has the label `helpful`: One if
/// the smaller node comes first.
struct Link {
  std::uint32_t a = kNone;  ///< the same as b: the variable has no edge
  std::uint32_t b = kNone;

  Link() = default;
  Link(std::uint32_t one, std::uint32_t other, Label helpful)
      : a(helpful == Label::One ? std::min(one, other) : std::max(one, other)),
        b(helpful == Label::One ? std::max(one, other) : std::min(one, other)) {}
  [[nodiscard]] bool exists() const { return a != b; }
  [[nodiscard]] Label helpful() const { return a < b ? Label::One : Label::Zero; }
};

/// What label 1 of each variable costs by itself: its levels, and where the variable is a diagonal, one flip
/// and its tie.
template <std::size_t Criteria>
class UnaryCosts {
 public:
  [[nodiscard]] std::size_t size() const { return tie_.size(); }
  void reserve(std::size_t count) {
    levels_.reserve(count);
    tie_.reserve(count);
  }
  /// New variables cost nothing.
  void resize(std::size_t count) {
    levels_.resize(count);
    tie_.resize(count);
  }
  /// Pre: one flip and a tie, or neither.
  void push_back(const Cost<Criteria>& cost) {
    Weight<Criteria>& levels = levels_.emplace_back();
    std::copy_n(cost.level.begin(), Criteria, levels.begin());
    tie_.push_back(cost.level[Criteria + 1]);
  }
  [[nodiscard]] Cost<Criteria> operator[](std::size_t q) const {
    Cost<Criteria> cost;
    std::copy_n(levels_[q].begin(), Criteria, cost.level.begin());
    cost.level[Criteria] = tie_[q] == 0 ? 0 : 1;
    cost.level[Criteria + 1] = tie_[q];
    return cost;
  }
  [[nodiscard]] std::vector<Cost<Criteria>> all() const {
    std::vector<Cost<Criteria>> costs;
    costs.reserve(size());
    for (std::size_t q = 0; q < size(); ++q) costs.push_back((*this)[q]);
    return costs;
  }

  /// By variable.
  [[nodiscard]] std::span<Weight<Criteria>> levels() { return levels_; }
  [[nodiscard]] std::span<const Weight<Criteria>> levels() const { return levels_; }
  [[nodiscard]] std::span<std::int64_t> ties() { return tie_; }
  [[nodiscard]] std::span<const std::int64_t> ties() const { return tie_; }

 private:
  std::vector<Weight<Criteria>> levels_;
  std::vector<std::int64_t> tie_;
};

/// Wanted: the labelling of least cost among those whose links connect all that the links together can
/// connect. Cost = sum of unary[q] over labels 1 + sum of weights over neighbours that both have label 1 +
/// sum of tables; any function of pairs of labels has the form of the first two, up to a constant.
template <std::size_t Criteria>
struct Labelling {
  UnaryCosts<Criteria> unary;
  /// Neighbours of q: neighbour[first[q]] to neighbour[first[q + 1]], weights alongside, each pair at both
  /// ends.
  std::vector<std::uint32_t> first = {0};
  std::vector<std::uint32_t> neighbour;
  std::vector<Weight<Criteria>> weight;
  Tables<Criteria> tables;       ///< indexed
  std::vector<Link> link;        ///< by variable; empty where nothing has to be connected
  std::uint32_t node_count = 0;  ///< of the multigraph

  [[nodiscard]] std::size_t size() const { return unary.size(); }
  /// An order of the variables that does not depend on their numbers, but where ties are equal.
  [[nodiscard]] bool before(std::uint32_t a, std::uint32_t b) const {
    return std::pair(unary.ties()[a], a) < std::pair(unary.ties()[b], b);
  }
  [[nodiscard]] bool has_link(std::size_t q) const { return !link.empty() && link[q].exists(); }
};

}  // namespace thalweg
