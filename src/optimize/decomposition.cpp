// Reduce, split, solve the pieces one by one, add up what they leave open.
//
// Pieces share no term and no block, so labels of different pieces may be put together, and gaps between
// value and bound add up. Most pieces are small and have a solver of their own. Large pieces go first, each
// as a task of its own; small ones follow in batches.
#include "optimize/decomposition.hpp"

#include "base/parallel.hpp"
#include "optimize/piece.hpp"
#include "optimize/reduction.hpp"
#include "optimize/small_piece.hpp"

#include <algorithm>
#include <mutex>

namespace thalweg {

namespace {

constexpr std::size_t kBatch = 64;
constexpr std::size_t kLarge = 256;

template <std::size_t Criteria>
class Decomposition {
 public:
  Decomposition(const Labelling<Criteria>& problem, std::uint32_t width_limit,
                const WideSolver<Criteria>& solve_wide, const Progress& progress)
      : problem_(problem),
        width_limit_(width_limit),
        solve_wide_(solve_wide),
        progress_(progress),
        reduction_(reduce(problem, progress)),
        parts_(split(problem, reduction_, progress)),
        label_(reduction_.label) {}

  Solution<Criteria> run() {
    node_.resize(problem_.node_count);
    for (std::uint32_t i = 0; i < node_.size(); ++i) node_[i] = reduction_.nodes.find(i);
    index_.resize(problem_.size());
    std::vector<std::uint32_t> large, small;
    for (std::uint32_t i = 0; i < parts_.size(); ++i) (part(i).size() >= kLarge ? large : small).push_back(i);
    solve_parts(large, 1);
    solve_parts(small, kBatch);
    return gather();
  }

 private:
  /// Of some pieces together.
  struct Outcome {
    Cost<Criteria> gap;
    SolverFigures figures;

    void add(const Cost<Criteria>& more_gap, const SolverFigures& more) {
      gap += more_gap;
      figures.width = std::max(figures.width, more.width);
      figures.table_entries += more.table_entries;
      figures.used_tables = figures.used_tables || more.used_tables;
      figures.used_forests = figures.used_forests || more.used_forests;
      figures.used_roof_duality = figures.used_roof_duality || more.used_roof_duality;
      figures.used_relaxation = figures.used_relaxation || more.used_relaxation;
    }
  };

  [[nodiscard]] std::span<std::uint32_t> part(std::size_t i) {
    return std::span(parts_.variable).subspan(parts_.first[i], parts_.first[i + 1] - parts_.first[i]);
  }

  void solve_parts(std::span<const std::uint32_t> parts, std::size_t batch) {
    for_each_block(parts.size(), batch, progress_, [&](std::size_t begin, std::size_t end) {
      SmallPiece<Criteria> small;
      Outcome outcome;
      for (std::size_t i = begin; i < end; ++i) solve_part(parts[i], small, outcome);
      const std::scoped_lock lock(mutex_);
      outcome_.add(outcome.gap, outcome.figures);
    });
  }

  void solve_part(std::size_t i, SmallPiece<Criteria>& small, Outcome& outcome) {
    const std::span<std::uint32_t> variables = part(i);
    std::sort(variables.begin(), variables.end(),
              [&](std::uint32_t a, std::uint32_t b) { return problem_.before(a, b); });
    for (std::uint32_t j = 0; j < variables.size(); ++j) index_[variables[j]] = j;
    const Selection selection{variables, index_};
    if (small.solve(problem_, reduction_, selection, width_limit_)) {
      outcome.add({}, {.width = small.width(), .table_entries = small.table_entries(), .used_tables = true});
      for (std::size_t j = 0; j < variables.size(); ++j) label_[variables[j]] = small.label()[j];
      return;
    }
    const Labelling<Criteria> piece = restrict_to<Criteria>(problem_, reduction_, node_, selection);
    std::vector<Label> label;
    if (auto exact = solve_exactly(piece, width_limit_, progress_)) {
      label = std::move(exact->label);
      outcome.add({}, {.width = exact->width,
                       .table_entries = exact->table_entries,
                       .used_tables = exact->table_entries > 0,
                       .used_forests = exact->table_entries == 0});
    } else {
      Solution<Criteria> wide = solve_wide_(piece, variables);
      label = std::move(wide.label);
      outcome.add(wide.value - wide.bound, wide.figures);
    }
    for (std::size_t j = 0; j < variables.size(); ++j) label_[variables[j]] = label[j];
  }

  Solution<Criteria> gather() {
    Solution<Criteria> solution;
    SolverFigures& figures = solution.figures;
    figures = outcome_.figures;
    figures.pieces = parts_.size();
    figures.fixed_by_elimination = problem_.size() - parts_.variable.size();
    solution.label = std::move(label_);
    solution.value = cost_of<Criteria>(problem_, solution.label);
    solution.bound = solution.value - outcome_.gap;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      figures.largest_piece = std::max(figures.largest_piece, part(i).size());
    }
    return solution;
  }

  const Labelling<Criteria>& problem_;
  std::uint32_t width_limit_;
  const WideSolver<Criteria>& solve_wide_;
  const Progress& progress_;
  Reduction reduction_;
  Partition parts_;
  std::vector<Label> label_;  ///< completed piece by piece
  std::vector<std::uint32_t> node_, index_;
  Outcome outcome_;
  std::mutex mutex_;  ///< of the outcome
};

}  // namespace

template <std::size_t Criteria>
Solution<Criteria> decompose(const Labelling<Criteria>& problem, std::uint32_t width_limit,
                             const WideSolver<Criteria>& solve_wide, const Progress& progress) {
  return Decomposition<Criteria>(problem, width_limit, solve_wide, progress).run();
}

template <std::size_t Criteria>
Labelling<Criteria> fix_labels(const Labelling<Criteria>& problem, std::span<const Label> label,
                               std::span<const std::uint32_t> open) {
  Reduction fixed;
  fixed.label.assign(label.begin(), label.end());
  std::vector<std::uint32_t> undecided;
  fixed.nodes = UnionFind(problem.node_count);
  for (std::size_t q = 0; q < problem.size(); ++q) {
    if (!problem.has_link(q)) continue;
    const Link& link = problem.link[q];
    if (label[q] == Label::Open) undecided.push_back(static_cast<std::uint32_t>(q));
    if (label[q] == link.helpful()) fixed.nodes.unite(link.a, link.b);
  }
  const std::vector<std::uint32_t> one_block(undecided.size(), 0);
  fixed.links = LinkBlocks(problem.size(), std::move(undecided), one_block);
  std::vector<std::uint32_t> node(problem.node_count), index(problem.size());
  for (std::uint32_t i = 0; i < node.size(); ++i) node[i] = fixed.nodes.find(i);
  for (std::uint32_t i = 0; i < open.size(); ++i) index[open[i]] = i;
  return restrict_to<Criteria>(problem, fixed, node, {open, index});
}

template Solution<1> decompose(const Labelling<1>&, std::uint32_t, const WideSolver<1>&, const Progress&);
template Solution<2> decompose(const Labelling<2>&, std::uint32_t, const WideSolver<2>&, const Progress&);
template Solution<4> decompose(const Labelling<4>&, std::uint32_t, const WideSolver<4>&, const Progress&);
template Labelling<1> fix_labels(const Labelling<1>&, std::span<const Label>, std::span<const std::uint32_t>);
template Labelling<2> fix_labels(const Labelling<2>&, std::span<const Label>, std::span<const std::uint32_t>);
template Labelling<4> fix_labels(const Labelling<4>&, std::span<const Label>, std::span<const std::uint32_t>);

}  // namespace thalweg
