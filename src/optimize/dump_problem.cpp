// The labelling problem as a cost function network.
//
// Pits. The links have to connect whatever they can (plateaus.cpp), block by block (blocks.hpp). In a block
// one node is the sink; every other node P has an outlet variable, whose values are the links at P. Outlet =
// link forbids the link's unhelpful label. If outlets have no cycle, following them ends at the sink, so the
// block is connected; in a connected block the edges of a tree towards the sink are such outlets. Cycles are
// excluded by a height for each node, which has to fall along the outlet, the sink being lowest; blocks in
// which all links meet the sink need none.
#include "optimize/blocks.hpp"
#include "optimize/first_order_problem.hpp"

#include <thalweg/base/error.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ostream>
#include <string>

namespace thalweg {

namespace {

/// A block with its nodes numbered 0, 1, ..., the sink last.
struct LinkBlock {
  std::vector<std::uint32_t> variable;  ///< quadrilateral of each link
  std::vector<NodePair> ends;
  std::uint32_t node_count = 0;
  [[nodiscard]] std::uint32_t sink() const { return node_count - 1; }
  [[nodiscard]] bool needs_heights() const {
    return std::any_of(ends.begin(), ends.end(),
                       [&](const NodePair& e) { return e.first != sink() && e.second != sink(); });
  }
};

/// Numbers the nodes of a block such that one with most links is the sink.
void number_nodes(LinkBlock& block) {
  std::vector<std::uint32_t> nodes;
  for (const auto& [a, b] : block.ends) nodes.insert(nodes.end(), {a, b});
  std::sort(nodes.begin(), nodes.end());
  std::uint32_t sink = 0;
  std::ptrdiff_t most = 0;
  for (auto run = nodes.begin(); run != nodes.end();) {
    const auto end = std::upper_bound(run, nodes.end(), *run);
    if (end - run > most) {
      most = end - run;
      sink = *run;
    }
    run = end;
  }
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  std::erase(nodes, sink);
  block.node_count = static_cast<std::uint32_t>(nodes.size() + 1);
  const auto number = [&](std::uint32_t node) {
    if (node == sink) return block.sink();
    return static_cast<std::uint32_t>(std::lower_bound(nodes.begin(), nodes.end(), node) - nodes.begin());
  };
  for (auto& [a, b] : block.ends) {
    a = number(a);
    b = number(b);
  }
}

std::vector<LinkBlock> link_blocks(const PlateauGraph& graph) {
  std::vector<NodePair> edges;
  std::vector<std::uint32_t> variable;
  for (std::uint32_t q = 0; q < graph.link.size(); ++q) {
    if (!graph.link[q].exists()) continue;
    edges.emplace_back(graph.link[q].a, graph.link[q].b);
    variable.push_back(q);
  }
  const Blocks found = find_blocks(edges, graph.node_count);
  std::vector<LinkBlock> blocks(found.size.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    blocks[found.block[i]].variable.push_back(variable[i]);
    blocks[found.block[i]].ends.push_back(edges[i]);
  }
  for (LinkBlock& block : blocks) number_nodes(block);
  return blocks;
}

template <std::size_t Criteria>
class Writer {
 public:
  Writer(std::ostream& out, FirstOrderProblem<Criteria> problem)
      : out_(out),
        problem_(std::move(problem)),
        level_(problem_.sums.empty() ? Criteria : 0),  // the level after the sums counts flips
        forbidden_(more_than_any()) {
    if (problem_.pits_first) blocks_ = link_blocks(problem_.connectivity());
  }

  void write(const Progress& progress) {
    const std::string name = problem_.sums.empty() ? "flips" : problem_.sums[0].name();
    out_ << "{\n\"problem\": {\"name\": \"" << name << "\", \"mustbe\": \"<" << forbidden_ << "\"},\n";
    write_variables();
    progress.check();
    out_ << "\"functions\": {\n\"constant\": {\"scope\": [], \"costs\": [" << constant() << "]}";
    write_costs();
    write_tables();
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      progress.check();
      for (std::size_t i = 0; i < blocks_[b].ends.size(); ++i) write_link(b, i);
    }
    out_ << "\n}\n}\n";
  }

 private:
  [[nodiscard]] std::int64_t constant() const {
    if (problem_.sums.empty()) return 0;
    auto sum = static_cast<std::int64_t>(problem_.delaunay[0]);
    for (std::size_t i = 0; i < problem_.labelling.tables.size(); ++i) sum += least_of_table(i);
    return sum;
  }
  [[nodiscard]] std::int64_t least_of_table(std::size_t i) const {
    std::int64_t least = 0;
    for (const Weight<Criteria>& entry : problem_.labelling.tables.entries(i)) {
      least = std::min(least, entry[0]);
    }
    return least;
  }
  [[nodiscard]] std::int64_t weight(std::size_t i) const {
    return problem_.sums.empty() ? 0 : problem_.labelling.weight[i][0];
  }

  [[nodiscard]] std::int64_t more_than_any() const {
    std::int64_t sum = std::abs(constant()) + 1;
    for (std::size_t q = 0; q < problem_.labelling.size(); ++q) {
      sum += std::abs(problem_.labelling.unary[q].level[level_]);
    }
    for (std::size_t i = 0; i < problem_.labelling.weight.size(); ++i) sum += std::abs(weight(i));
    const Tables<Criteria>& tables = problem_.labelling.tables;
    for (std::size_t i = 0; i < tables.size(); ++i) {
      std::int64_t most = 0;
      for (const Weight<Criteria>& entry : tables.entries(i)) most = std::max(most, std::abs(entry[0]));
      sum += most;
    }
    return sum;
  }

  static std::string outlet(std::size_t block, std::uint32_t node) {
    return "o" + std::to_string(block) + "_" + std::to_string(node);
  }
  static std::string height(std::size_t block, std::uint32_t node) {
    return "h" + std::to_string(block) + "_" + std::to_string(node);
  }

  void write_variables() {
    out_ << "\"variables\": {";
    for (std::size_t q = 0; q < problem_.labelling.size(); ++q) {
      out_ << (q == 0 ? "\n" : ",\n") << "\"q" << q << "\": 2";
    }
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      for (std::uint32_t node = 0; node < blocks_[b].sink(); ++node) {
        out_ << ",\n\"" << outlet(b, node) << "\": " << links_at(b, node).size();
        if (blocks_[b].needs_heights()) out_ << ",\n\"" << height(b, node) << "\": " << blocks_[b].sink();
      }
    }
    out_ << "\n},\n";
  }

  void write_costs() {
    const Labelling<Criteria>& labelling = problem_.labelling;
    for (std::size_t q = 0; q < labelling.size(); ++q) {
      out_ << ",\n\"u" << q << "\": {\"scope\": [\"q" << q << "\"], \"costs\": [0, "
           << labelling.unary[q].level[level_] << "]}";
      for (std::size_t i = labelling.first[q]; i < labelling.first[q + 1]; ++i) {
        const std::uint32_t p = labelling.neighbour[i];
        if (p > q || weight(i) == 0) continue;
        out_ << ",\n\"w" << i << "\": {\"scope\": [\"q" << p << "\", \"q" << q << "\"], \"costs\": [0, 0, 0, "
             << weight(i) << "]}";
      }
    }
  }

  /// In a file the last variable of a scope turns fastest, here the first. Not all versions of toulbar2 take
  /// negative costs in large scopes, so what all labels cost alike is part of the constant.
  void write_tables() {
    const Tables<Criteria>& tables = problem_.labelling.tables;
    for (std::size_t i = 0; i < tables.size() && !problem_.sums.empty(); ++i) {
      out_ << ",\n\"t" << i << "\": {\"scope\": [";
      const std::span<const std::uint32_t> scope = tables.scope(i);
      for (std::size_t j = scope.size(); j-- > 0;) out_ << "\"q" << scope[j] << (j == 0 ? "\"" : "\", ");
      out_ << "], \"costs\": [";
      const char* separator = "";
      for (const Weight<Criteria>& entry : tables.entries(i)) {
        out_ << separator << entry[0] - least_of_table(i);
        separator = ", ";
      }
      out_ << "]}";
    }
  }

  [[nodiscard]] std::vector<std::size_t> links_at(std::size_t b, std::uint32_t node) const {
    std::vector<std::size_t> links;
    for (std::size_t i = 0; i < blocks_[b].ends.size(); ++i) {
      if (blocks_[b].ends[i].first == node || blocks_[b].ends[i].second == node) links.push_back(i);
    }
    return links;
  }

  /// What it means that a link is the outlet of one of its ends.
  void write_link(std::size_t b, std::size_t i) {
    const LinkBlock& block = blocks_[b];
    const std::uint32_t q = block.variable[i];
    const int unhelpful = problem_.connectivity().link[q].helpful() == Label::One ? 0 : 1;
    const auto& [first, second] = block.ends[i];
    for (const auto& [node, next] : {NodePair{first, second}, NodePair{second, first}}) {
      if (node == block.sink()) continue;
      const std::vector<std::size_t> links = links_at(b, node);
      const auto value = std::find(links.begin(), links.end(), i) - links.begin();
      out_ << ",\n\"n" << functions_++ << "\": {\"scope\": [\"" << outlet(b, node) << "\", \"q" << q
           << "\"], \"defaultcost\": 0, \"costs\": [" << value << ", " << unhelpful << ", " << forbidden_
           << "]}";
      if (next == block.sink()) continue;
      out_ << ",\n\"n" << functions_++ << "\": {\"scope\": [\"" << outlet(b, node) << "\", \""
           << height(b, node) << "\", \"" << height(b, next) << "\"], \"defaultcost\": 0, \"costs\": [";
      const char* separator = "";
      for (std::uint32_t here = 0; here < block.sink(); ++here) {
        for (std::uint32_t there = here; there < block.sink(); ++there) {
          out_ << separator << value << ", " << here << ", " << there << ", " << forbidden_;
          separator = ", ";
        }
      }
      out_ << "]}";
    }
  }

  std::ostream& out_;
  FirstOrderProblem<Criteria> problem_;
  std::size_t level_;       ///< of the costs that are written
  std::int64_t forbidden_;  ///< more than any labelling costs
  std::vector<LinkBlock> blocks_;
  std::size_t functions_ = 0;
};

/// Where the first value is that of the worst term: counts the terms that are no better than what the
/// optimiser gives.
template <std::size_t Criteria>
void count_no_better(FirstOrderProblem<Criteria>& problem, const Tin& tin,
                     std::span<const Quadrilateral> quadrilaterals, const OptimizeOptions& options,
                     Progress& progress) {
  const Objective objective = problem.sums[0];
  OptimizeOptions alone = options;
  alone.criteria.resize(count_leading_pits(options.criteria), objective);
  alone.criteria.push_back(objective);
  const double result = optimize_first_order(tin, quadrilaterals, alone, progress).criteria.back().result;
  const TermScan scan(tin, quadrilaterals, problem.owner,
                      {options.horizontal_metres_per_unit, options.vertical_metres_per_unit},
                      options.reference, most_at_vertex(options.width_limit));
  const Extreme extreme = find_extreme(scan, objective, problem.labelling.first, progress);
  const auto better = static_cast<std::int64_t>(std::llround(result * steps_per_unit(objective))) - 1;
  problem.delaunay[0] =
      count_excess(scan, objective, {better, extreme.vertex ? &*extreme.vertex : nullptr, {}}, 0,
                   problem.labelling, progress);
}

}  // namespace

void dump_problem(std::ostream& out, const Tin& tin, std::span<const Quadrilateral> quadrilaterals,
                  const OptimizeOptions& options, Progress& progress) {
  if (options.criteria.empty()) {
    throw Error(ErrorCode::Usage, "without a criterion there is no problem to write; choose one");
  }
  progress.start_phase("write the problem");
  with_levels(options.criteria, [&](auto levels) {
    auto problem = build_problem<levels()>(tin, quadrilaterals, options, progress);
    if (!problem.sums.empty() && problem.sums[0].is_extreme()) {
      count_no_better(problem, tin, quadrilaterals, options, progress);
    }
    Writer<levels()>(out, std::move(problem)).write(progress);
  });
}

}  // namespace thalweg
