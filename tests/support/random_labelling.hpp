#pragma once

/// Random labelling problems, and their answer by trying everything.

#include "optimize/decomposition.hpp"
#include "support/random.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace thalweg::test {

struct LabellingShape {
  std::size_t variables = 10;
  double pairs_per_variable = 1.5;
  std::size_t nodes = 0;   ///< of the graph of links; 0: no links
  std::size_t tables = 0;  ///< terms of up to five variables
  int range = 6;           ///< costs are from -range to range, so that many tie
};

template <std::size_t Criteria>
Labelling<Criteria> random_labelling(const LabellingShape& shape, Random& random) {
  Labelling<Criteria> problem;
  const auto count = static_cast<std::uint32_t>(shape.variables);
  std::vector<std::vector<std::pair<std::uint32_t, Weight<Criteria>>>> rows(count);
  const auto pairs = static_cast<std::size_t>(shape.pairs_per_variable * static_cast<double>(count));
  for (std::size_t i = 0; count > 1 && i < pairs; ++i) {
    const std::uint32_t a = random.integer(0U, count - 1);
    const std::uint32_t b = (a + random.integer(1U, count - 1)) % count;
    Weight<Criteria> weight;
    for (std::int64_t& level : weight) level = random.integer(-shape.range, shape.range);
    rows[a].emplace_back(b, weight);
    rows[b].emplace_back(a, weight);
  }
  for (std::uint32_t q = 0; q < count; ++q) {
    Cost<Criteria> unary;
    for (std::size_t i = 0; i < Criteria; ++i) unary.level[i] = random.integer(-shape.range, shape.range);
    unary.level[Criteria] = 1;
    unary.level[Criteria + 1] = random.integer(1, 1 << 20);
    problem.unary.push_back(unary);
    for (const auto& [neighbour, weight] : rows[q]) {
      problem.neighbour.push_back(neighbour);
      problem.weight.push_back(weight);
    }
    problem.first.push_back(static_cast<std::uint32_t>(problem.neighbour.size()));
  }
  for (std::size_t i = 0; i < shape.tables && count > 0; ++i) {
    Table<Criteria> table;
    for (std::uint32_t q = 0; q < count; ++q) table.scope.push_back(q);
    std::shuffle(table.scope.begin(), table.scope.end(), random.engine());
    table.scope.resize(random.integer<std::size_t>(1, std::min<std::size_t>(5, count)));
    table.entry.resize(std::size_t{1} << table.scope.size());
    for (Weight<Criteria>& entry : table.entry) {
      for (std::int64_t& level : entry)
        level = random.integer(0, 1) * random.integer(-shape.range, shape.range);
    }
    problem.tables.append(table);
  }
  problem.tables.index(count);
  if (shape.nodes == 0) return problem;
  problem.node_count = static_cast<std::uint32_t>(shape.nodes);
  for (std::uint32_t q = 0; q < count; ++q) {
    const std::uint32_t a = random.integer(0U, problem.node_count - 1);
    const std::uint32_t b = random.integer(0U, problem.node_count - 1);
    const Label helpful = random.integer(0, 1) == 0 ? Label::Zero : Label::One;
    problem.link.push_back(random.integer(0, 4) == 0 ? Link{} : Link{a, b, helpful});
  }
  return problem;
}

/// Number of components of the graph of links that are there; a link is there under label Open.
template <std::size_t Criteria>
std::size_t plain_components(const Labelling<Criteria>& problem, const std::vector<Label>& label) {
  std::vector<std::size_t> name(problem.node_count);
  std::iota(name.begin(), name.end(), std::size_t{0});
  std::size_t components = name.size();
  for (std::size_t q = 0; q < problem.link.size(); ++q) {
    const Link& link = problem.link[q];
    if (link.a == link.b || (label[q] != Label::Open && label[q] != link.helpful())) continue;
    const std::size_t from = name[link.a], to = name[link.b];
    if (from == to) continue;
    --components;
    for (std::size_t& n : name) n = n == from ? to : n;
  }
  return components;
}

template <std::size_t Criteria>
bool connects_all(const Labelling<Criteria>& problem, const std::vector<Label>& label) {
  const std::vector<Label> open(problem.size(), Label::Open);
  return plain_components(problem, label) == plain_components(problem, open);
}

template <std::size_t Criteria>
Cost<Criteria> plain_cost(const Labelling<Criteria>& problem, const std::vector<Label>& label) {
  Cost<Criteria> twice;  // pairs are listed at both ends
  for (std::size_t q = 0; q < problem.size(); ++q) {
    if (label[q] != Label::One) continue;
    for (std::size_t i = 0; i < Criteria + 2; ++i) twice.level[i] += 2 * problem.unary[q].level[i];
    for (std::size_t j = problem.first[q]; j < problem.first[q + 1]; ++j) {
      if (label[problem.neighbour[j]] != Label::One) continue;
      for (std::size_t i = 0; i < Criteria; ++i) twice.level[i] += problem.weight[j][i];
    }
  }
  for (std::int64_t& level : twice.level) level /= 2;
  for (std::size_t t = 0; t < problem.tables.size(); ++t) {
    std::size_t index = 0, bit = 1;
    for (const std::uint32_t q : problem.tables.scope(t)) {
      index += label[q] == Label::One ? bit : 0;
      bit *= 2;
    }
    for (std::size_t i = 0; i < Criteria; ++i) twice.level[i] += problem.tables.entries(t)[index][i];
  }
  return twice;
}

/// Least cost of all labellings that connect what can be connected.
template <std::size_t Criteria>
Cost<Criteria> plain_minimum(const Labelling<Criteria>& problem) {
  Cost<Criteria> best = Cost<Criteria>::infeasible();
  for (std::size_t bits = 0; bits < std::size_t{1} << problem.size(); ++bits) {
    std::vector<Label> label;
    for (std::size_t q = 0; q < problem.size(); ++q)
      label.push_back((bits >> q & 1U) != 0 ? Label::One : Label::Zero);
    const Cost<Criteria> cost = plain_cost(problem, label);
    if (cost < best && connects_all(problem, label)) best = cost;
  }
  return best;
}

}  // namespace thalweg::test
