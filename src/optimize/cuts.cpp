// Clauses of a cut, and the case in which none are needed.
//
// A set of links connects a component if and only if it meets every cut of it. There are too many cuts to
// list; the caller adds those that its labels fail, and solves again. Each round adds a cut that no later
// labelling fails, and a graph has finitely many, so the rounds end; a labelling that fails none is least
// among all that meet the cuts listed so far, so also among the fewer that meet all.
#include "optimize/cuts.hpp"

#include "base/union_find.hpp"

#include <algorithm>

namespace thalweg {

std::vector<Cut> failed_cuts(std::span<const Link> links, std::size_t node_count,
                             std::span<const Label> labels) {
  UnionFind parts(node_count), components(node_count);
  for (std::uint32_t q = 0; q < links.size(); ++q) {
    if (!links[q].exists()) continue;
    components.unite(links[q].a, links[q].b);
    if (labels[q] == links[q].helpful()) parts.unite(links[q].a, links[q].b);
  }
  std::vector<Cut> around(node_count);
  for (std::uint32_t q = 0; q < links.size(); ++q) {
    if (!links[q].exists()) continue;
    const std::uint32_t a = parts.find(links[q].a), b = parts.find(links[q].b);
    if (a == b) continue;
    around[a].push_back({q, links[q].helpful()});
    around[b].push_back({q, links[q].helpful()});
  }
  std::vector<std::uint32_t> hub(node_count, kNone);
  for (std::uint32_t part = 0; part < node_count; ++part) {
    std::uint32_t& most = hub[components.find(part)];
    if (most == kNone || around[part].size() > around[most].size()) most = part;
  }
  for (const std::uint32_t part : hub) {
    if (part != kNone) around[part].clear();
  }
  std::erase_if(around, [](const Cut& cut) { return cut.empty(); });
  return around;
}

std::vector<Clause> split_cuts(std::span<const Cut> cuts, std::span<const std::uint32_t> numbers,
                               std::uint32_t next_variable) {
  std::vector<Clause> clauses;
  for (Cut cut : cuts) {
    if (cut.size() <= std::tuple_size_v<Clause>) {
      Clause clause;
      std::copy(cut.begin(), cut.end(), clause.begin());
      clauses.push_back(clause);
      continue;
    }
    std::sort(cut.begin(), cut.end(),
              [&](const Literal& a, const Literal& b) { return numbers[a.variable] < numbers[b.variable]; });
    Literal carried = cut[0];
    for (std::size_t i = 1; i + 2 < cut.size(); ++i) {
      clauses.push_back({carried, cut[i], {next_variable, Label::One}});
      carried = {next_variable++, Label::Zero};
    }
    clauses.push_back({carried, cut[cut.size() - 2], cut.back()});
  }
  return clauses;
}

template <std::size_t Criteria>
std::vector<Label> span_at_least_cost(const Labelling<Criteria>& problem) {
  const Cost<Criteria> zero{};
  const auto extra = [&](std::uint32_t q) {  // of the helpful label
    return problem.link[q].helpful() == Label::One ? problem.unary[q] : zero - problem.unary[q];
  };
  std::vector<Label> label(problem.size());
  std::vector<std::uint32_t> links;
  UnionFind nodes(problem.node_count);
  for (std::uint32_t q = 0; q < problem.size(); ++q) {
    label[q] = problem.unary[q] < zero ? Label::One : Label::Zero;
    if (!problem.has_link(q)) continue;
    if (label[q] == problem.link[q].helpful()) {
      nodes.unite(problem.link[q].a, problem.link[q].b);
    } else {
      links.push_back(q);
    }
  }
  std::stable_sort(links.begin(), links.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return extra(a) < extra(b); });
  for (const std::uint32_t q : links) {
    if (nodes.unite(problem.link[q].a, problem.link[q].b)) label[q] = problem.link[q].helpful();
  }
  return label;
}

template std::vector<Label> span_at_least_cost(const Labelling<1>&);
template std::vector<Label> span_at_least_cost(const Labelling<2>&);
template std::vector<Label> span_at_least_cost(const Labelling<4>&);

}  // namespace thalweg
