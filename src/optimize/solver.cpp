// What to do in which order.
//
// 1. Dead-end elimination, contraction, bridges; pieces; dynamic programming or a spanning forest for each
//    (decomposition.cpp).
// 2. A piece that is too wide: labels that a maximum flow proves (roof_duality.cpp); if there are any, what
//    is left is a smaller problem, back to 1. If there are none, a labelling and a bound (wide.cpp).
#include "optimize/solver.hpp"

#include "optimize/piece.hpp"
#include "optimize/roof_duality.hpp"
#include "optimize/wide.hpp"

#include <algorithm>

namespace thalweg {

namespace {

template <std::size_t Criteria>
class WidePieces {
 public:
  WidePieces(const SolverLimits& limits, std::size_t whole_size, const Progress& progress)
      : limits_(limits), whole_size_(whole_size), progress_(progress) {}

  /// `known` is empty, or a labelling of the piece.
  Solution<Criteria> solve(const Labelling<Criteria>& piece, std::span<const Label> known) const {
    const RoofDual dual = find_roof_dual(piece, progress_);
    std::vector<std::uint32_t> open;
    for (std::uint32_t q = 0; q < piece.size(); ++q) {
      if (dual.label[q] == Label::Open) open.push_back(q);
    }
    if (open.size() == piece.size()) {
      const double share = static_cast<double>(piece.size()) / static_cast<double>(whole_size_);
      const auto effort = static_cast<std::uint64_t>(share * static_cast<double>(limits_.effort));
      return bracket(piece, known, dual.bound, limits_.width, effort, progress_);
    }
    const Labelling<Criteria> rest = fix_labels<Criteria>(piece, dual.label, open);
    const std::vector<Label> known_rest = select(known, open);
    Solution<Criteria> solution = decompose<Criteria>(rest, limits_.width, handler(known_rest), progress_);
    const Cost<Criteria> gap = solution.value - solution.bound;
    std::vector<Label> label = dual.label;
    for (std::size_t i = 0; i < open.size(); ++i) label[open[i]] = solution.label[i];
    solution.label = std::move(label);
    solution.value = cost_of<Criteria>(piece, solution.label);
    solution.bound = solution.value - gap;
    solution.figures.used_roof_duality = true;
    return solution;
  }

  [[nodiscard]] WideSolver<Criteria> handler(std::span<const Label> known) const {
    return [this, known](const Labelling<Criteria>& piece, std::span<const std::uint32_t> variables) {
      return solve(piece, select(known, variables));
    };
  }

 private:
  static std::vector<Label> select(std::span<const Label> known, std::span<const std::uint32_t> variables) {
    std::vector<Label> selected;
    for (std::size_t i = 0; !known.empty() && i < variables.size(); ++i) {
      selected.push_back(known[variables[i]]);
    }
    return selected;
  }

  const SolverLimits& limits_;
  std::size_t whole_size_;
  const Progress& progress_;
};

}  // namespace

template <std::size_t Criteria>
Solution<Criteria> solve(const Labelling<Criteria>& problem, const SolverLimits& limits,
                         const Progress& progress, std::span<const Label> known) {
  const WidePieces<Criteria> wide(limits, problem.size(), progress);
  return decompose<Criteria>(problem, limits.width, wide.handler(known), progress);
}

template Solution<1> solve(const Labelling<1>&, const SolverLimits&, const Progress&, std::span<const Label>);
template Solution<2> solve(const Labelling<2>&, const SolverLimits&, const Progress&, std::span<const Label>);
template Solution<4> solve(const Labelling<4>&, const SolverLimits&, const Progress&, std::span<const Label>);

}  // namespace thalweg
