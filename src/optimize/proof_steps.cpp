// The way of the solver (decomposition.cpp), step by step, with what it finds out written down.
//
// 1. Bridges of the links, each a cut of its own; then all labels that the reduction fixes. The verifier
//    finds the order itself.
// 2. Each piece: without weights a spanning forest; else the cuts that its solution needed, and the order of
//    elimination. A cut that the solver wrote as a chain of clauses is put together again: the verifier makes
//    the same chain of it, its new variables numbered on.
#include "optimize/proof_steps.hpp"

#include "optimize/blocks.hpp"
#include "optimize/decomposition.hpp"
#include "optimize/piece.hpp"
#include "optimize/reduction.hpp"

#include <algorithm>
#include <ostream>
#include <vector>

namespace thalweg {

namespace {

template <std::size_t Criteria>
class StepWriter {
 public:
  StepWriter(std::ostream& out, const Labelling<Criteria>& problem, std::uint32_t width_limit,
             const Progress& progress)
      : out_(out),
        problem_(problem),
        width_limit_(width_limit),
        progress_(progress),
        next_(static_cast<std::uint32_t>(problem.size())) {}

  bool run() {
    Reduction reduction = reduce(problem_, progress_);
    write_bridges();
    write_fixed(reduction);
    Partition parts = split(problem_, reduction, progress_);
    std::vector<std::uint32_t> node(problem_.node_count), index(problem_.size());
    for (std::uint32_t i = 0; i < node.size(); ++i) node[i] = reduction.nodes.find(i);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      progress_.check();
      const std::span<std::uint32_t> variables =
          std::span(parts.variable).subspan(parts.first[i], parts.first[i + 1] - parts.first[i]);
      std::sort(variables.begin(), variables.end(),
                [&](std::uint32_t a, std::uint32_t b) { return problem_.before(a, b); });
      for (std::uint32_t j = 0; j < variables.size(); ++j) index[variables[j]] = j;
      if (!write_piece(restrict_to<Criteria>(problem_, reduction, node, {variables, index}), variables)) {
        return false;
      }
    }
    return true;
  }

 private:
  void write_literal(std::uint32_t variable, Label label) {
    out_ << ' ' << variable << (label == Label::One ? '+' : '-');
  }

  template <class Write>
  void write_line(const char* word, std::size_t count, const Write& write) {
    constexpr std::size_t kPerLine = 16;
    for (std::size_t i = 0; i < count; ++i) {
      if (i % kPerLine == 0) out_ << (i == 0 ? "" : "\n") << word;
      write(i);
    }
    if (count > 0) out_ << '\n';
  }

  void write_bridges() {
    std::vector<NodePair> edges;
    std::vector<std::uint32_t> variable;
    for (std::uint32_t q = 0; q < problem_.link.size(); ++q) {
      if (!problem_.link[q].exists()) continue;
      edges.emplace_back(problem_.link[q].a, problem_.link[q].b);
      variable.push_back(q);
    }
    const Blocks blocks = find_blocks(edges, problem_.node_count);
    is_bridge_.assign(problem_.size(), false);
    for (std::size_t i = 0; i < edges.size(); ++i) {
      if (blocks.size[blocks.block[i]] > 1) continue;
      is_bridge_[variable[i]] = true;
      out_ << "cut";
      write_literal(variable[i], problem_.link[variable[i]].helpful());
      out_ << '\n';
    }
  }

  // All in one line: its order is the verifier's to find.
  void write_fixed(const Reduction& reduction) {
    bool any = false;
    for (std::uint32_t q = 0; q < problem_.size(); ++q) {
      if (reduction.label[q] == Label::Open || is_bridge_[q]) continue;
      if (!any) out_ << "fix";
      any = true;
      write_literal(q, reduction.label[q]);
    }
    if (any) out_ << '\n';
  }

  bool write_piece(const Labelling<Criteria>& piece, std::span<const std::uint32_t> variables) {
    const auto whole = [&](std::size_t i) { out_ << ' ' << variables[i]; };
    if (piece.neighbour.empty() && piece.tables.empty()) {
      if (!piece.link.empty()) out_ << "forest";
      if (!piece.link.empty()) {
        for (std::size_t i = 0; i < variables.size(); ++i) whole(i);
        out_ << '\n';
      } else {
        write_line("eliminate", variables.size(), whole);
      }
      return true;
    }
    const auto exact = solve_exactly(piece, width_limit_, progress_);
    if (!exact) return false;
    write_cuts(exact->clauses, variables);
    write_order(exact->order, variables);
    return true;
  }

  /// Variables beyond those of the piece were introduced by its cuts, in this order.
  [[nodiscard]] std::uint32_t number_of(std::uint32_t local, std::span<const std::uint32_t> variables) const {
    if (local < variables.size()) return variables[local];
    return first_of_piece_ + local - static_cast<std::uint32_t>(variables.size());
  }

  void write_cuts(std::span<const Clause> clauses, std::span<const std::uint32_t> variables) {
    first_of_piece_ = next_;
    bool goes_on = false;
    for (const Clause& clause : clauses) {
      if (!goes_on) out_ << "cut";
      goes_on = false;
      for (const Literal& literal : clause) {
        if (literal.variable == kNone) continue;
        if (literal.variable < variables.size()) {
          write_literal(variables[literal.variable], literal.label);
        } else if (literal.label == Label::One) {
          goes_on = true;
          ++next_;
        }
      }
      if (!goes_on) out_ << '\n';
    }
  }

  void write_order(const EliminationOrder& order, std::span<const std::uint32_t> variables) {
    write_line("eliminate", order.order.size(),
               [&](std::size_t i) { out_ << ' ' << number_of(order.order[i], variables); });
  }

  std::ostream& out_;
  const Labelling<Criteria>& problem_;
  std::uint32_t width_limit_;
  const Progress& progress_;
  std::vector<bool> is_bridge_;
  std::uint32_t next_;                ///< number of the next new variable
  std::uint32_t first_of_piece_ = 0;  ///< number of the first one of the piece
};

}  // namespace

template <std::size_t Criteria>
bool write_steps(std::ostream& out, const Labelling<Criteria>& problem, std::uint32_t width_limit,
                 const Progress& progress) {
  return StepWriter<Criteria>(out, problem, width_limit, progress).run();
}

template bool write_steps(std::ostream&, const Labelling<1>&, std::uint32_t, const Progress&);
template bool write_steps(std::ostream&, const Labelling<2>&, std::uint32_t, const Progress&);
template bool write_steps(std::ostream&, const Labelling<4>&, std::uint32_t, const Progress&);

}  // namespace thalweg
