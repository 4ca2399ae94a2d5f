// Bucket elimination.
//
// 1. Each term goes to the bucket of the variable of its scope that is eliminated first.
// 2. In order: a table over the scope of v, for both labels of v, sums the bucket's terms and messages; the
//    smaller of the two entries is the message, a term over v's scope, and goes to the bucket of its first
//    variable. One bit an entry remembers which it was.
// 3. Backwards: each variable reads its bit under the labels of its scope.
// A message's table has the bit of its first variable lowest. Entries of the receiving table find theirs by
// an array of projections, built by doubling. Based on: Bertele, Brioschi, Nonserial dynamic programming,
// 1972; Dechter, Bucket elimination, 1999.
#include "optimize/bucket_elimination.hpp"

#include <algorithm>
#include <numeric>

namespace thalweg {

namespace {

template <std::size_t Criteria>
class Eliminator {
 public:
  Eliminator(const TermSum<Criteria>& sum, const EliminationOrder& order, const Progress& progress)
      : sum_(sum), order_(order), progress_(progress), message_at_(sum.variable_count, kNone) {
    pairs_ =
        assign(sum.pairs, [&](const PairCost<Criteria>& pair) { return std::min(at(pair.a), at(pair.b)); });
    clauses_ = assign(sum.clauses, [&](const Clause& clause) {
      std::uint32_t earliest = kNone;
      for (const Literal& literal : clause) {
        if (literal.variable != kNone) earliest = std::min(earliest, at(literal.variable));
      }
      return earliest;
    });
    std::vector<std::uint32_t> numbers(sum.tables != nullptr ? sum.tables->size() : 0);
    std::iota(numbers.begin(), numbers.end(), std::uint32_t{0});
    tables_ = assign(std::span<const std::uint32_t>(numbers), [&](std::uint32_t table) {
      std::uint32_t earliest = kNone;
      for (const std::uint32_t variable : sum_.tables->scope(table)) {
        earliest = std::min(earliest, at(variable));
      }
      return earliest;
    });
  }

  Minimum<Criteria> run() {
    for (std::uint32_t i = 0; i < order_.order.size(); ++i) {
      if (i % 256 == 0) progress_.check();
      fill_table(i);
      minimise_table(i);
    }
    return {trace_back(), total_};
  }

 private:
  using Table = std::vector<Cost<Criteria>>;
  struct Message {
    Table table;
    std::uint32_t sender = 0;
    std::uint32_t next = kNone;  ///< of the same bucket, or of the free ones
  };
  struct Buckets {
    std::vector<std::uint32_t> first, item;
    [[nodiscard]] std::span<const std::uint32_t> at(std::size_t i) const {
      return std::span(item).subspan(first[i], first[i + 1] - first[i]);
    }
  };

  [[nodiscard]] std::uint32_t at(std::uint32_t variable) const { return order_.position[variable]; }

  template <class Term, class Position>
  Buckets assign(std::span<const Term> terms, const Position& position) const {
    Buckets buckets;
    buckets.first.assign(sum_.variable_count + 1, 0);
    for (const Term& term : terms) ++buckets.first[position(term) + 1];
    for (std::size_t i = 0; i < sum_.variable_count; ++i) buckets.first[i + 1] += buckets.first[i];
    buckets.item.resize(terms.size());
    std::vector<std::uint32_t> fill(buckets.first.begin(), buckets.first.end() - 1);
    for (std::uint32_t i = 0; i < terms.size(); ++i) buckets.item[fill[position(terms[i])]++] = i;
    return buckets;
  }

  /// Bit of a variable in the index of table i: 1 for the one being eliminated, then its scope.
  [[nodiscard]] std::size_t bit(std::uint32_t i, std::uint32_t variable) const {
    if (order_.order[i] == variable) return 1;
    const std::span<const std::uint32_t> scope = order_.scope_at(i);
    return std::size_t{2} << (std::find(scope.begin(), scope.end(), variable) - scope.begin());
  }

  void fill_table(std::uint32_t i) {
    const std::uint32_t variable = order_.order[i];
    const std::size_t size = std::size_t{2} << order_.scope_at(i).size();
    table_.assign(size, {});
    if (variable < sum_.unary.size()) {
      for (std::size_t e = 1; e < size; e += 2) table_[e] = sum_.unary[variable];
    }
    for (const std::uint32_t index : pairs_.at(i)) {
      const PairCost<Criteria>& pair = sum_.pairs[index];
      const std::size_t both = bit(i, pair.a) | bit(i, pair.b);
      for (std::size_t e = both; e < size; e = (e + 1) | both) add(table_[e], pair.weight);
    }
    for (const std::uint32_t index : tables_.at(i)) {
      project(i, sum_.tables->scope(index));
      const std::span<const Weight<Criteria>> entries = sum_.tables->entries(index);
      for (std::size_t e = 0; e < size; ++e) add(table_[e], entries[projection_[e]]);
    }
    for (std::uint32_t m = message_at_[i]; m != kNone;) {
      project(i, order_.scope_at(messages_[m].sender));
      for (std::size_t e = 0; e < size; ++e) table_[e] += messages_[m].table[projection_[e]];
      const std::uint32_t next = messages_[m].next;
      messages_[m].next = free_;
      free_ = m;
      m = next;
    }
    for (const std::uint32_t index : clauses_.at(i)) {
      std::size_t mask = 0, failing = 0;
      for (const Literal& literal : sum_.clauses[index]) {
        if (literal.variable == kNone) continue;
        mask |= bit(i, literal.variable);
        if (literal.label == Label::Zero) failing |= bit(i, literal.variable);
      }
      for (std::size_t e = 0; e < size; ++e) {
        if ((e & mask) == failing) table_[e] = Cost<Criteria>::infeasible();
      }
    }
  }

  /// For each entry of table i, the entry of a term over `from` under the same labels.
  void project(std::uint32_t i, std::span<const std::uint32_t> from) {
    projection_.assign(1, 0);
    projection_.resize(table_.size());
    std::size_t known = 1;
    const auto extend = [&](std::uint32_t variable) {
      const auto place = std::find(from.begin(), from.end(), variable);
      const std::uint32_t shift = place == from.end() ? 0 : std::uint32_t{1} << (place - from.begin());
      for (std::size_t e = 0; e < known; ++e) projection_[known + e] = projection_[e] + shift;
      known *= 2;
    };
    extend(order_.order[i]);
    for (const std::uint32_t variable : order_.scope_at(i)) extend(variable);
  }

  void minimise_table(std::uint32_t i) {
    const std::size_t size = table_.size() / 2;
    first_bit_.push_back(bits_.size());
    bits_.resize(bits_.size() + size);
    std::uint32_t m = free_;
    if (m == kNone) {
      m = static_cast<std::uint32_t>(messages_.size());
      messages_.emplace_back();
    } else {
      free_ = messages_[m].next;
    }
    Table& table = messages_[m].table;
    table.resize(size);
    for (std::size_t e = 0; e < size; ++e) {
      const bool one = table_[2 * e + 1] < table_[2 * e];
      table[e] = table_[2 * e + (one ? 1 : 0)];
      bits_[first_bit_[i] + e] = one;
    }
    const std::span<const std::uint32_t> scope = order_.scope_at(i);
    std::uint32_t* list = &free_;
    if (scope.empty()) {
      total_ += table[0];
    } else {
      list = &message_at_[at(scope[0])];
    }
    messages_[m].sender = i;
    messages_[m].next = *list;
    *list = m;
  }

  [[nodiscard]] std::vector<Label> trace_back() const {
    std::vector<Label> label(sum_.variable_count, Label::Zero);
    for (std::size_t i = order_.order.size(); i-- > 0;) {
      std::size_t e = 0;
      const std::span<const std::uint32_t> scope = order_.scope_at(i);
      for (std::size_t j = 0; j < scope.size(); ++j) {
        e |= (label[scope[j]] == Label::One ? std::size_t{1} : 0) << j;
      }
      label[order_.order[i]] = bits_[first_bit_[i] + e] ? Label::One : Label::Zero;
    }
    return label;
  }

  const TermSum<Criteria>& sum_;
  const EliminationOrder& order_;
  const Progress& progress_;
  Buckets pairs_, clauses_, tables_;
  std::vector<std::uint32_t> message_at_;  ///< by position: first of the bucket's messages
  std::vector<Message> messages_;
  std::uint32_t free_ = kNone;
  Table table_;
  std::vector<std::uint32_t> projection_;
  std::vector<bool> bits_;
  std::vector<std::size_t> first_bit_;
  Cost<Criteria> total_;
};

}  // namespace

template <std::size_t Criteria>
std::vector<NodePair> interactions(const TermSum<Criteria>& sum) {
  std::vector<NodePair> edges;
  for (const PairCost<Criteria>& pair : sum.pairs) edges.emplace_back(pair.a, pair.b);
  for (const Clause& clause : sum.clauses) {
    for (std::size_t i = 0; i < clause.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (clause[i].variable != kNone && clause[j].variable != kNone) {
          edges.emplace_back(clause[i].variable, clause[j].variable);
        }
      }
    }
  }
  for (std::size_t t = 0; sum.tables != nullptr && t < sum.tables->size(); ++t) {
    const std::span<const std::uint32_t> scope = sum.tables->scope(t);
    for (std::size_t i = 0; i < scope.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) edges.emplace_back(scope[i], scope[j]);
    }
  }
  return edges;
}

template <std::size_t Criteria>
Minimum<Criteria> minimise(const TermSum<Criteria>& sum, const EliminationOrder& order,
                           const Progress& progress) {
  return Eliminator<Criteria>(sum, order, progress).run();
}

template std::vector<NodePair> interactions(const TermSum<1>&);
template std::vector<NodePair> interactions(const TermSum<2>&);
template std::vector<NodePair> interactions(const TermSum<4>&);
template Minimum<1> minimise(const TermSum<1>&, const EliminationOrder&, const Progress&);
template Minimum<2> minimise(const TermSum<2>&, const EliminationOrder&, const Progress&);
template Minimum<4> minimise(const TermSum<4>&, const EliminationOrder&, const Progress&);

}  // namespace thalweg
