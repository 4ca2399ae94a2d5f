// Reduce, split, eliminate, add up.
//
// 1. Labels that an optimum does without go (label_reduction.cpp); what is open falls into pieces.
// 2. A piece is eliminated (label_elimination.cpp): solved, or given a bound and a first choice.
// 3. That choice is improved: around one variable after the other, the best labels of those near it are
//    found, exactly, while all others keep theirs; until none helps or the effort is spent.
#include "optimize/label_solver.hpp"

#include "base/parallel.hpp"
#include "optimize/label_elimination.hpp"
#include "optimize/label_reduction.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

namespace thalweg {

namespace {

constexpr std::size_t kBatch = 16;
constexpr std::size_t kNear = 48;  ///< variables that are improved together
constexpr std::uint32_t kOutside = 0xffffffffU;

template <std::size_t Criteria>
class Improver {
 public:
  Improver(const LabelNetwork<Criteria>& network, std::vector<std::uint32_t> chosen,
           std::uint64_t most_entries, const Progress& progress)
      : network_(network),
        chosen_(std::move(chosen)),
        most_entries_(most_entries),
        progress_(progress),
        rows_(pair_terms_by_variable(network)),
        index_(network.size(), kOutside) {}

  std::vector<std::uint32_t> run(std::uint64_t effort) {
    std::uint64_t spent = 0;
    std::size_t since_gain = 0;
    for (std::uint32_t v = 0; since_gain < network_.size(); v = v + 1 == network_.size() ? 0 : v + 1) {
      progress_.check();
      const std::vector<std::uint32_t> around = near(v);
      const LabelNetwork<Criteria> part = restrict_to(around);
      const Eliminated<Criteria> best = eliminate(part, most_entries_, progress_);
      spent += best.table_entries;
      std::vector<std::uint32_t> now;
      now.reserve(around.size());
      for (const std::uint32_t u : around) now.push_back(chosen_[u]);
      const bool gains = cost_of(part, best.chosen) < cost_of(part, now);
      since_gain = gains ? 0 : since_gain + 1;
      for (std::size_t i = 0; i < around.size(); ++i) {
        if (gains) chosen_[around[i]] = best.chosen[i];
        index_[around[i]] = kOutside;
      }
      if (spent >= effort) break;
    }
    return std::move(chosen_);
  }

 private:
  [[nodiscard]] std::span<const std::uint32_t> row(std::uint32_t v) const {
    return std::span(rows_.item).subspan(rows_.first[v], rows_.first[v + 1] - rows_.first[v]);
  }

  std::vector<std::uint32_t> near(std::uint32_t v) {
    std::vector<std::uint32_t> around = {v};
    index_[v] = 0;
    for (std::size_t i = 0; i < around.size() && around.size() < kNear; ++i) {
      for (const std::uint32_t c : row(around[i])) {
        const PairTerm& pair = network_.pairs[c];
        const std::uint32_t u = pair.a == around[i] ? pair.b : pair.a;
        if (index_[u] != kOutside || around.size() == kNear) continue;
        index_[u] = static_cast<std::uint32_t>(around.size());
        around.push_back(u);
      }
    }
    return around;
  }

  /// Pre: index_ numbers the variables.
  [[nodiscard]] LabelNetwork<Criteria> restrict_to(std::span<const std::uint32_t> variables) const {
    LabelNetwork<Criteria> part;
    for (const std::uint32_t v : variables) {
      const auto begin = network_.unary.begin() + network_.first_label[v];
      part.unary.insert(part.unary.end(), begin, begin + network_.label_count(v));
      part.first_label.push_back(static_cast<std::uint32_t>(part.unary.size()));
    }
    for (const std::uint32_t v : variables) {
      for (const std::uint32_t c : row(v)) {
        const PairTerm& pair = network_.pairs[c];
        const bool is_a = pair.a == v;
        const std::uint32_t u = is_a ? pair.b : pair.a;
        if (index_[u] == kOutside) {
          for (std::uint32_t i = 0; i < network_.label_count(v); ++i) {
            add(part.unary[part.first_label[index_[v]] + i],
                is_a ? network_.weight(pair, i, chosen_[u]) : network_.weight(pair, chosen_[u], i));
          }
        } else if (is_a) {
          take(part, pair);
        }
      }
    }
    return part;
  }

  void take(LabelNetwork<Criteria>& part, const PairTerm& pair) const {
    const auto copy_classes = [&](std::size_t classes, std::uint32_t v) {
      const std::size_t first = part.classes.size();
      const auto begin = network_.classes.begin() + static_cast<std::ptrdiff_t>(classes);
      part.classes.insert(part.classes.end(), begin, begin + network_.label_count(v));
      return first;
    };
    PairTerm moved = pair;
    moved.a = index_[pair.a];
    moved.b = index_[pair.b];
    moved.class_a = copy_classes(pair.class_a, pair.a);
    moved.class_b = copy_classes(pair.class_b, pair.b);
    moved.weight = part.weights.size();
    const auto begin = network_.weights.begin() + static_cast<std::ptrdiff_t>(pair.weight);
    part.weights.insert(part.weights.end(), begin, begin + std::ptrdiff_t{pair.classes_a} * pair.classes_b);
    part.pairs.push_back(moved);
  }

  const LabelNetwork<Criteria>& network_;
  std::vector<std::uint32_t> chosen_;
  std::uint64_t most_entries_;
  const Progress& progress_;
  PairTermRows rows_;
  std::vector<std::uint32_t> index_;
};

}  // namespace

template <std::size_t Criteria>
NetworkSolution<Criteria> solve(const LabelNetwork<Criteria>& network, const SolverLimits& limits,
                                const Progress& progress) {
  const std::vector<std::uint8_t> stays = find_useful_labels(network, progress);
  const std::vector<LabelPiece<Criteria>> pieces = split<Criteria>(network, stays);
  NetworkSolution<Criteria> solution;
  SolverFigures& figures = solution.figures;
  solution.chosen.assign(network.size(), 0);
  for (std::size_t v = 0; v < network.size(); ++v) {
    while (stays[network.first_label[v] + solution.chosen[v]] == 0) ++solution.chosen[v];
  }
  figures.pieces = pieces.size();
  figures.fixed_by_elimination = network.size();
  std::vector<std::uint32_t> turn(pieces.size());
  std::iota(turn.begin(), turn.end(), 0U);
  std::stable_sort(turn.begin(), turn.end(), [&](std::uint32_t a, std::uint32_t b) {
    return pieces[a].variable.size() > pieces[b].variable.size();
  });
  const std::uint64_t most_entries = std::uint64_t{1} << limits.width;
  std::vector<Eliminated<Criteria>> outcome(pieces.size());
  for_each_block(turn.size(), kBatch, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const LabelNetwork<Criteria>& piece = pieces[turn[i]].network;
      Eliminated<Criteria>& own = outcome[turn[i]];
      own = eliminate(piece, most_entries, progress);
      if (own.exact) continue;
      const double share = static_cast<double>(piece.size()) / static_cast<double>(network.size());
      const auto effort = static_cast<std::uint64_t>(share * static_cast<double>(limits.effort));
      own.chosen = Improver<Criteria>(piece, std::move(own.chosen), most_entries, progress).run(effort);
    }
  });
  Cost<Criteria> gap;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const LabelPiece<Criteria>& piece = pieces[i];
    for (std::size_t v = 0; v < piece.variable.size(); ++v) {
      solution.chosen[piece.variable[v]] = piece.label[piece.network.first_label[v] + outcome[i].chosen[v]];
    }
    if (!outcome[i].exact) gap += cost_of(piece.network, outcome[i].chosen) - outcome[i].bound;
    figures.fixed_by_elimination -= piece.variable.size();
    figures.largest_piece = std::max(figures.largest_piece, piece.variable.size());
    figures.width = std::max<std::size_t>(
        figures.width, std::bit_width(std::max<std::uint64_t>(outcome[i].largest_table, 1) - 1));
    figures.table_entries += outcome[i].table_entries;
    figures.used_tables = true;
    figures.used_relaxation = figures.used_relaxation || !outcome[i].exact;
  }
  solution.value = cost_of(network, solution.chosen);
  solution.bound = solution.value - gap;
  return solution;
}

template NetworkSolution<1> solve(const LabelNetwork<1>&, const SolverLimits&, const Progress&);
template NetworkSolution<2> solve(const LabelNetwork<2>&, const SolverLimits&, const Progress&);
template NetworkSolution<5> solve(const LabelNetwork<5>&, const SolverLimits&, const Progress&);

}  // namespace thalweg
