// Pieces: cutting them out, and solving those that are narrow.
//
// Exact solution. Without weights: a minimum spanning forest. Otherwise bucket elimination over the variables
// and over the auxiliary ones of long cuts, with the cuts that are known to matter; then those that the
// labels fail are added, until none is (cuts.cpp says why this ends, and with an optimum). A long cut is a
// chain of clauses, and the order along the chain decides the width: it follows the elimination tree of the
// terms that are short, so that what is eliminated together is close in the chain, and a table sees but the
// two ends of a stretch of it.
#include "optimize/piece.hpp"

#include "base/parallel.hpp"

#include <thalweg/base/assert.hpp>

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

namespace thalweg {

namespace {

constexpr std::size_t kBlock = 1 << 15;  // variables

/// Each once, by its first variable in the selection; scopes ascend.
template <std::size_t Criteria>
void restrict_tables(const Tables<Criteria>& tables, const Reduction& fixed, const Selection& selection,
                     Tables<Criteria>& out) {
  if (tables.empty()) return;
  std::vector<Table<Criteria>> found;
  for (const std::uint32_t q : selection.variables) {
    for (const std::uint32_t t : tables.of(q)) {
      Table<Criteria> table = condition<Criteria>(tables, t, fixed.label);
      const auto later = [&](std::uint32_t p) { return selection.index[p] < selection.index[q]; };
      if (std::find(table.scope.begin(), table.scope.end(), q) == table.scope.end()) continue;
      if (std::any_of(table.scope.begin(), table.scope.end(), later)) continue;
      for (std::uint32_t& variable : table.scope) variable = selection.index[variable];
      found.push_back(with_sorted_scope(table));
    }
  }
  std::stable_sort(found.begin(), found.end(), [](const Table<Criteria>& a, const Table<Criteria>& b) {
    return std::tie(a.scope, a.entry) < std::tie(b.scope, b.entry);
  });
  for (const Table<Criteria>& table : found) out.append(table);
  out.index(selection.variables.size());
}

}  // namespace

template <std::size_t Criteria>
Labelling<Criteria> restrict_to(const Labelling<Criteria>& problem, const Reduction& fixed,
                                std::span<const std::uint32_t> node, const Selection& selection) {
  Labelling<Criteria> part;
  const std::size_t count = selection.variables.size();
  part.unary.reserve(count);
  part.first.reserve(count + 1);
  std::vector<std::pair<std::uint32_t, Weight<Criteria>>> row;
  std::map<NodePair, std::uint32_t> number;  // of block and node
  for (const std::uint32_t q : selection.variables) {
    Cost<Criteria> unary = problem.unary[q];
    row.clear();
    for (std::size_t i = problem.first[q]; i < problem.first[q + 1]; ++i) {
      const std::uint32_t p = problem.neighbour[i];
      if (fixed.label[p] == Label::One) add(unary, problem.weight[i]);
      if (fixed.label[p] != Label::Open || is_zero<Criteria>(problem.weight[i])) continue;
      row.emplace_back(selection.index[p], problem.weight[i]);
    }
    std::sort(row.begin(), row.end());
    for (const auto& [neighbour, weight] : row) {
      part.neighbour.push_back(neighbour);
      part.weight.push_back(weight);
    }
    part.unary.push_back(unary);
    part.first.push_back(static_cast<std::uint32_t>(part.neighbour.size()));
    const std::uint32_t block = fixed.links.of(q);
    if (block == kNone) continue;
    const auto number_of = [&](std::uint32_t end) {
      const auto next = static_cast<std::uint32_t>(number.size());
      return number.try_emplace({block, node[end]}, next).first->second;
    };
    part.link.resize(count);
    const Link& link = problem.link[q];
    const std::uint32_t a = number_of(link.a), b = number_of(link.b);
    part.link[part.unary.size() - 1] = Link(a, b, link.helpful());
  }
  part.node_count = static_cast<std::uint32_t>(number.size());
  restrict_tables(problem.tables, fixed, selection, part.tables);
  return part;
}

template <std::size_t Criteria>
Cost<Criteria> cost_of(const Labelling<Criteria>& problem, std::span<const Label> label) {
  std::vector<Cost<Criteria>> parts((problem.size() + kBlock - 1) / kBlock);
  const Progress uncancelled;
  for_each_block(problem.size(), kBlock, uncancelled, [&](std::size_t begin, std::size_t end) {
    Cost<Criteria>& cost = parts[begin / kBlock];
    for (std::size_t q = begin; q < end; ++q) {
      if (label[q] != Label::One) continue;
      cost += problem.unary[q];
      for (std::size_t i = problem.first[q]; i < problem.first[q + 1]; ++i) {
        const std::uint32_t p = problem.neighbour[i];
        if (p < q && label[p] == Label::One) add(cost, problem.weight[i]);
      }
    }
  });
  auto cost = std::accumulate(parts.begin(), parts.end(), Cost<Criteria>{},
                              [](Cost<Criteria> sum, const Cost<Criteria>& part) { return sum += part; });
  for (std::size_t t = 0; t < problem.tables.size(); ++t) {
    add(cost, problem.tables.entries(t)[slice_of(problem.tables.scope(t), label).base]);
  }
  return cost;
}

template <std::size_t Criteria>
std::vector<PairCost<Criteria>> pairs_of(const Labelling<Criteria>& problem) {
  std::vector<PairCost<Criteria>> pairs;
  pairs.reserve(problem.neighbour.size() / 2);
  for (std::uint32_t q = 0; q < problem.size(); ++q) {
    for (std::size_t i = problem.first[q]; i < problem.first[q + 1]; ++i) {
      if (problem.neighbour[i] < q) pairs.push_back({problem.neighbour[i], q, problem.weight[i]});
    }
  }
  return pairs;
}

template <std::size_t Criteria>
Clauses shorten(const Labelling<Criteria>& problem, std::span<const PairCost<Criteria>> pairs,
                std::span<const Cut> cuts, std::uint32_t width_limit) {
  const auto is_long = [](const Cut& cut) { return cut.size() > std::tuple_size_v<Clause>; };
  std::size_t count = problem.size();
  std::vector<Cut> short_cuts;
  for (const Cut& cut : cuts) {
    count += is_long(cut) ? cut.size() - std::tuple_size_v<Clause> : 0;
    if (!is_long(cut)) short_cuts.push_back(cut);
  }
  std::vector<std::uint32_t> numbers;
  if (count > problem.size()) {
    const std::vector<Clause> clauses = split_cuts(short_cuts, {}, 0);
    const std::vector<Cost<Criteria>> unary = problem.unary.all();
    const TermSum<Criteria> sum{problem.size(), unary, pairs, clauses, &problem.tables};
    const EliminationOrder order = find_elimination_order(problem.size(), interactions(sum), width_limit);
    numbers.resize(problem.size());
    std::iota(numbers.begin(), numbers.end(), std::uint32_t{0});
    if (order.complete) numbers = tree_numbers(order);
  }
  return {split_cuts(cuts, numbers, static_cast<std::uint32_t>(problem.size())), count};
}

template <std::size_t Criteria>
std::optional<ExactLabels> solve_exactly(const Labelling<Criteria>& problem, std::uint32_t width_limit,
                                         const Progress& progress) {
  if (problem.neighbour.empty() && problem.tables.empty()) return ExactLabels{span_at_least_cost(problem)};
  const std::vector<PairCost<Criteria>> pairs = pairs_of(problem);
  const std::vector<Cost<Criteria>> unary = problem.unary.all();
  const std::vector<Label> none(problem.size(), Label::Open);
  std::vector<Cut> cuts = failed_cuts(problem.link, problem.node_count, none);
  ExactLabels exact;
  while (true) {
    Clauses clauses = shorten<Criteria>(problem, pairs, cuts, width_limit);
    const TermSum<Criteria> sum{clauses.variable_count, unary, pairs, clauses.clauses, &problem.tables};
    EliminationOrder order = find_elimination_order(clauses.variable_count, interactions(sum), width_limit);
    if (!order.complete) return std::nullopt;
    exact.width = std::max(exact.width, order.width);
    exact.table_entries += table_entries(order);
    Minimum<Criteria> minimum = minimise(sum, order, progress);
    THALWEG_ASSERT(!minimum.value.is_infeasible());
    minimum.label.resize(problem.size());
    const std::vector<Cut> failed = failed_cuts(problem.link, problem.node_count, minimum.label);
    if (failed.empty()) {
      exact.label = std::move(minimum.label);
      exact.clauses = std::move(clauses.clauses);
      exact.order = std::move(order);
      return exact;
    }
    cuts.insert(cuts.end(), failed.begin(), failed.end());
  }
}

template Labelling<1> restrict_to(const Labelling<1>&, const Reduction&, std::span<const std::uint32_t>,
                                  const Selection&);
template Labelling<2> restrict_to(const Labelling<2>&, const Reduction&, std::span<const std::uint32_t>,
                                  const Selection&);
template Labelling<4> restrict_to(const Labelling<4>&, const Reduction&, std::span<const std::uint32_t>,
                                  const Selection&);
template Cost<1> cost_of(const Labelling<1>&, std::span<const Label>);
template Cost<2> cost_of(const Labelling<2>&, std::span<const Label>);
template Cost<4> cost_of(const Labelling<4>&, std::span<const Label>);
template std::vector<PairCost<1>> pairs_of(const Labelling<1>&);
template std::vector<PairCost<2>> pairs_of(const Labelling<2>&);
template std::vector<PairCost<4>> pairs_of(const Labelling<4>&);
template Clauses shorten(const Labelling<1>&, std::span<const PairCost<1>>, std::span<const Cut>,
                         std::uint32_t);
template Clauses shorten(const Labelling<2>&, std::span<const PairCost<2>>, std::span<const Cut>,
                         std::uint32_t);
template Clauses shorten(const Labelling<4>&, std::span<const PairCost<4>>, std::span<const Cut>,
                         std::uint32_t);
template std::optional<ExactLabels> solve_exactly(const Labelling<1>&, std::uint32_t, const Progress&);
template std::optional<ExactLabels> solve_exactly(const Labelling<2>&, std::uint32_t, const Progress&);
template std::optional<ExactLabels> solve_exactly(const Labelling<4>&, std::uint32_t, const Progress&);

}  // namespace thalweg
