#pragma once

/// A labelling problem with any number of labels a variable, and with terms of one and of two variables.

#include "optimize/cost.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace thalweg {

/// A term of two variables. It knows of a label only its class: so many labels of a face have the same
/// triangle at a side.
struct PairTerm {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  std::size_t class_a = 0;  ///< where in `classes` the class of a's first label is; the others follow
  std::size_t class_b = 0;
  std::size_t weight = 0;  ///< where in `weights` the row of class 0 of a starts; rows are of classes of b
  std::uint16_t classes_a = 0;
  std::uint16_t classes_b = 0;
};

/// Wanted: a label for each variable such that the sum of unary costs and of weights is least.
template <std::size_t Criteria>
struct LabelNetwork {
  /// Labels of all variables have one numbering: those of v are first_label[v] to first_label[v + 1].
  std::vector<std::uint32_t> first_label = {0};
  std::vector<Cost<Criteria>> unary;  ///< by label
  std::vector<PairTerm> pairs;
  std::vector<std::uint16_t> classes;
  std::vector<Weight<Criteria>> weights;

  [[nodiscard]] std::size_t size() const { return first_label.size() - 1; }
  [[nodiscard]] std::uint32_t label_count(std::size_t v) const { return first_label[v + 1] - first_label[v]; }
  /// `i`, `j`: labels of the pair's variables, counted from their first ones.
  [[nodiscard]] const Weight<Criteria>& weight(const PairTerm& c, std::size_t i, std::size_t j) const {
    return weights[c.weight + std::size_t{classes[c.class_a + i]} * c.classes_b + classes[c.class_b + j]];
  }
};

/// Couplings of each variable: those of v are item[first[v]] to item[first[v + 1]], ascending.
struct PairTermRows {
  std::vector<std::uint32_t> first;
  std::vector<std::uint32_t> item;
};

template <std::size_t Criteria>
PairTermRows pair_terms_by_variable(const LabelNetwork<Criteria>& network) {
  PairTermRows rows;
  rows.first.assign(network.size() + 1, 0);
  for (const PairTerm& c : network.pairs) {
    ++rows.first[c.a + 1];
    ++rows.first[c.b + 1];
  }
  for (std::size_t v = 0; v < network.size(); ++v) rows.first[v + 1] += rows.first[v];
  rows.item.resize(rows.first.back());
  std::vector<std::uint32_t> fill(rows.first.begin(), rows.first.end() - 1);
  for (std::uint32_t i = 0; i < network.pairs.size(); ++i) {
    rows.item[fill[network.pairs[i].a]++] = i;
    rows.item[fill[network.pairs[i].b]++] = i;
  }
  return rows;
}

/// Cost of a choice, labels counted from each variable's first one. Complexity: linear.
template <std::size_t Criteria>
Cost<Criteria> cost_of(const LabelNetwork<Criteria>& network, const std::vector<std::uint32_t>& chosen) {
  Cost<Criteria> cost;
  for (std::size_t v = 0; v < network.size(); ++v) cost += network.unary[network.first_label[v] + chosen[v]];
  for (const PairTerm& c : network.pairs) add(cost, network.weight(c, chosen[c.a], chosen[c.b]));
  return cost;
}

}  // namespace thalweg
