// Small pieces. The greedy order is that of elimination_order.cpp, the tables are those of
// bucket_elimination.cpp: bit 0 of an entry's index is the label of the variable that is eliminated, the
// next ones are those of its scope in order of elimination.
#include "optimize/small_piece.hpp"

#include <algorithm>
#include <bit>
#include <tuple>
#include <utility>

namespace thalweg {

namespace {

constexpr std::uint64_t bit(std::uint32_t i) {
  return std::uint64_t{1} << i;
}

/// Takes the lowest member out of a set.
std::uint32_t take_lowest(std::uint64_t& set) {
  const auto lowest = static_cast<std::uint32_t>(std::countr_zero(set));
  set &= set - 1;
  return lowest;
}

}  // namespace

template <std::size_t Criteria>
bool SmallPiece<Criteria>::solve(const Labelling<Criteria>& problem, const Reduction& fixed,
                                 const Selection& selection, std::uint32_t width_limit) {
  if (selection.variables.size() > kMostVariables || !problem.tables.empty()) return false;
  if (!load(problem, fixed, selection) || !find_order(std::min(width_limit, kMostWidth))) return false;
  sort_pairs();
  messages_.clear();
  one_.clear();
  table_entries_ = 0;
  for (std::uint32_t i = 0; i < count_; ++i) {
    fill_table(i);
    minimise_table(i);
  }
  trace_back();
  return true;
}

template <std::size_t Criteria>
bool SmallPiece<Criteria>::load(const Labelling<Criteria>& problem, const Reduction& fixed,
                                const Selection& selection) {
  count_ = static_cast<std::uint32_t>(selection.variables.size());
  pairs_.clear();
  for (std::uint32_t j = 0; j < count_; ++j) {
    const std::uint32_t q = selection.variables[j];
    if (fixed.links.of(q) != kNone) return false;
    unary_[j] = problem.unary[q];
    adjacent_[j] = 0;
    for (std::size_t i = problem.first[q]; i < problem.first[q + 1]; ++i) {
      const std::uint32_t p = problem.neighbour[i];
      const Label label = fixed.label[p];
      if (label == Label::Zero) continue;
      if (label == Label::One) {
        add(unary_[j], problem.weight[i]);
      } else if (!is_zero<Criteria>(problem.weight[i])) {
        const std::uint32_t k = selection.index[p];
        adjacent_[j] |= bit(k);
        if (k < j) pairs_.push_back({k, j, problem.weight[i], kNone});
      }
    }
  }
  return !pairs_.empty();
}

/// Pairs of neighbours of v that are no neighbours of each other.
template <std::size_t Criteria>
std::uint32_t SmallPiece<Criteria>::fill_of(std::uint32_t v) const {
  int fill = 0;
  for (Set rest = adjacent_[v]; rest != 0;) {
    const std::uint32_t a = take_lowest(rest);
    fill += std::popcount(rest & ~adjacent_[a]);
  }
  return static_cast<std::uint32_t>(fill);
}

/// False if a scope would be larger than the limit.
template <std::size_t Criteria>
bool SmallPiece<Criteria>::find_order(std::uint32_t width_limit) {
  using Key = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>;  // fill, degree, variable
  std::array<Key, kMostVariables> key;
  const auto update = [&](std::uint32_t v) {
    key[v] = {fill_of(v), static_cast<std::uint32_t>(std::popcount(adjacent_[v])), v};
  };
  for (std::uint32_t v = 0; v < count_; ++v) update(v);
  width_ = 0;
  std::array<Set, kMostVariables> met;  // by step, as variables
  Set left = count_ == kMostVariables ? ~Set{0} : bit(count_) - 1;
  for (std::uint32_t i = 0; i < count_; ++i) {
    Set rest = left;
    std::uint32_t best = take_lowest(rest);
    while (rest != 0) {
      const std::uint32_t v = take_lowest(rest);
      if (key[v] < key[best]) best = v;
    }
    const Set row = met[i] = adjacent_[best];
    width_ = std::max(width_, static_cast<std::uint32_t>(std::popcount(row)));
    if (width_ > width_limit) return false;
    steps_[i] = {.variable = best};
    position_[best] = i;
    left &= ~bit(best);
    for (Set members = row; members != 0;) {
      const std::uint32_t a = take_lowest(members);
      adjacent_[a] = (adjacent_[a] | row) & ~(bit(a) | bit(best));
    }
    for (Set members = row; members != 0;) update(take_lowest(members));
  }
  for (std::uint32_t i = 0; i < count_; ++i) {
    for (Set members = met[i]; members != 0;) steps_[i].scope |= bit(position_[take_lowest(members)]);
  }
  return true;
}

/// Each pair to the one of its variables that is eliminated first; its ends become steps.
template <std::size_t Criteria>
void SmallPiece<Criteria>::sort_pairs() {
  for (std::uint32_t p = 0; p < pairs_.size(); ++p) {
    const auto [low, high] = std::minmax(position_[pairs_[p].a], position_[pairs_[p].b]);
    pairs_[p].a = low;
    pairs_[p].b = high;
    pairs_[p].next = std::exchange(steps_[low].first_pair, p);
  }
}

/// For each entry of table i, the entry of a message over `from` under the same labels. Pre: i is in `from`,
/// all others are in its scope.
template <std::size_t Criteria>
void SmallPiece<Criteria>::project(std::uint32_t i, Set from) {
  projection_.resize(table_.size());
  projection_[0] = 0;
  projection_[1] = 1;
  std::size_t known = 2;
  std::uint32_t shift = 2;
  for (Set scope = steps_[i].scope; scope != 0; known *= 2) {
    const bool meant = (from & bit(take_lowest(scope))) != 0;
    for (std::size_t e = 0; e < known; ++e) projection_[known + e] = projection_[e] + (meant ? shift : 0);
    if (meant) shift *= 2;
  }
}

template <std::size_t Criteria>
void SmallPiece<Criteria>::fill_table(std::uint32_t i) {
  const Step& step = steps_[i];
  const std::size_t size = std::size_t{2} << std::popcount(step.scope);
  table_entries_ += size;
  table_.assign(size, {});
  for (std::size_t e = 1; e < size; e += 2) table_[e] = unary_[step.variable];
  for (std::uint32_t p = step.first_pair; p != kNone; p = pairs_[p].next) {
    const std::size_t both = 1 | std::size_t{2} << std::popcount(step.scope & (bit(pairs_[p].b) - 1));
    for (std::size_t e = both; e < size; e = (e + 1) | both) add(table_[e], pairs_[p].weight);
  }
  for (std::uint32_t sender = step.first_sender; sender != kNone; sender = steps_[sender].next_sender) {
    project(i, steps_[sender].scope);
    const Cost<Criteria>* const message = messages_.data() + steps_[sender].first_entry;
    for (std::size_t e = 0; e < size; ++e) {
      for (std::size_t k = 0; k < Cost<Criteria>::kLevels; ++k) {
        table_[e].level[k] += message[projection_[e]].level[k];
      }
    }
  }
}

template <std::size_t Criteria>
void SmallPiece<Criteria>::minimise_table(std::uint32_t i) {
  Step& step = steps_[i];
  step.first_entry = messages_.size();
  for (std::size_t e = 0; e < table_.size(); e += 2) {
    const bool one = table_[e + 1] < table_[e];
    messages_.push_back(table_[e + (one ? 1 : 0)]);
    one_.push_back(one ? 1 : 0);
  }
  if (step.scope == 0) return;
  const auto receiver = static_cast<std::uint32_t>(std::countr_zero(step.scope));
  step.next_sender = std::exchange(steps_[receiver].first_sender, i);
}

template <std::size_t Criteria>
void SmallPiece<Criteria>::trace_back() {
  label_.resize(count_);
  for (std::uint32_t i = count_; i-- > 0;) {
    std::size_t e = 0;
    std::size_t place = 1;
    for (Set scope = steps_[i].scope; scope != 0; place *= 2) {
      e += label_[steps_[take_lowest(scope)].variable] == Label::One ? place : 0;
    }
    label_[steps_[i].variable] = one_[steps_[i].first_entry + e] != 0 ? Label::One : Label::Zero;
  }
}

template class SmallPiece<1>;
template class SmallPiece<2>;
template class SmallPiece<4>;

}  // namespace thalweg
