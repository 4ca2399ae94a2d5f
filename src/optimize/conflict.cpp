// Two-satisfiability. Each term excludes some labels, or pairs of labels, of its variables; excluding (a, b)
// says that a implies not b, and b implies not a. There is no labelling exactly if some variable's labels
// imply each other: then both are in one strongly connected component. The conflict is a shortest chain each
// way. Based on: Aspvall, Plass, Tarjan, A linear-time algorithm for testing the truth of certain quantified
// Boolean formulas, 1979; components as in Tarjan 1972, with an explicit stack.
#include "optimize/conflict.hpp"

#include <algorithm>
#include <deque>
#include <limits>
#include <mutex>
#include <utility>

namespace thalweg {

namespace {

using Implication = std::pair<std::uint32_t, std::uint32_t>;  ///< of literals: 2 q + label

class ImplicationSink {
 public:
  ImplicationSink(double sign, std::int64_t most) : sign_(sign), most_(most) {}

  class Block {
   public:
    explicit Block(ImplicationSink& sink) : sink_(sink) {}
    Block(const Block&) = delete;
    Block& operator=(const Block&) = delete;
    void finish() {
      const std::lock_guard lock(sink_.mutex_);
      sink_.found_.insert(sink_.found_.end(), found_.begin(), found_.end());
      sink_.hopeless_ = sink_.hopeless_ || hopeless_;
    }
    void constant(double value) { hopeless_ = hopeless_ || sink_.beyond(value); }
    template <std::size_t Terms>
    void single(std::uint32_t q, const std::array<double, Terms>& f0, const std::array<double, Terms>& f1) {
      const auto bad = [&](double value) { return sink_.beyond(value); };
      if (std::any_of(f0.begin(), f0.end(), bad)) found_.emplace_back(2 * q, 2 * q + 1);
      if (std::any_of(f1.begin(), f1.end(), bad)) found_.emplace_back(2 * q + 1, 2 * q);
    }
    void pair(const Neighbours& at, const PairValues& f) {
      for (std::uint32_t i = 0; i < f.size(); ++i) {
        if (!sink_.beyond(f[i])) continue;
        const std::uint32_t q = 2 * at.q + (i & 1U), p = 2 * at.p + (i >> 1U);
        found_.emplace_back(q, p ^ 1U);
        found_.emplace_back(p, q ^ 1U);
      }
    }

   private:
    ImplicationSink& sink_;
    std::vector<Implication> found_;
    bool hopeless_ = false;
  };

  [[nodiscard]] bool hopeless() const { return hopeless_; }
  std::vector<Implication> take() {
    std::sort(found_.begin(), found_.end());
    found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
    return std::move(found_);
  }

 private:
  [[nodiscard]] bool beyond(double value) const { return to_steps(sign_ * value) > most_; }
  double sign_;
  std::int64_t most_;
  std::mutex mutex_;
  std::vector<Implication> found_;
  bool hopeless_ = false;
};

class Implications {
 public:
  Implications(std::vector<Implication>&& all, std::size_t literals)
      : all_(std::move(all)), first_(literals + 1, 0) {
    for (const Implication& implication : all_) ++first_[implication.first + 1];
    for (std::size_t i = 0; i < literals; ++i) first_[i + 1] += first_[i];
  }
  [[nodiscard]] std::size_t literals() const { return first_.size() - 1; }
  [[nodiscard]] std::uint32_t begin(std::uint32_t literal) const { return first_[literal]; }
  [[nodiscard]] std::uint32_t end(std::uint32_t literal) const { return first_[literal + 1]; }
  [[nodiscard]] std::uint32_t at(std::uint32_t i) const { return all_[i].second; }

  /// The component of each literal.
  [[nodiscard]] std::vector<std::uint32_t> components() const {
    std::vector<std::uint32_t> order(literals(), 0), low(literals(), 0), component(literals(), kNone), open;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> path;  // literal, next implication
    std::uint32_t visited = 0, count = 0;
    for (std::uint32_t root = 0; root < literals(); ++root) {
      if (order[root] != 0) continue;
      path.emplace_back(root, begin(root));
      order[root] = low[root] = ++visited;
      open.push_back(root);
      while (!path.empty()) {
        auto& [literal, next] = path.back();
        if (next < end(literal)) {
          const std::uint32_t to = at(next++);
          if (order[to] == 0) {
            path.emplace_back(to, begin(to));
            order[to] = low[to] = ++visited;
            open.push_back(to);
          } else if (component[to] == kNone) {
            low[literal] = std::min(low[literal], order[to]);
          }
          continue;
        }
        const std::uint32_t done = literal;
        path.pop_back();
        if (!path.empty()) low[path.back().first] = std::min(low[path.back().first], low[done]);
        if (low[done] != order[done]) continue;
        for (std::uint32_t member = kNone; member != done; open.pop_back()) {
          member = open.back();
          component[member] = count;
        }
        ++count;
      }
    }
    return component;
  }

  /// Literals on a shortest chain, both ends included.
  [[nodiscard]] std::vector<std::uint32_t> chain(std::uint32_t from, std::uint32_t to) const {
    std::vector<std::uint32_t> before(literals(), kNone);
    std::deque<std::uint32_t> queue = {from};
    before[from] = from;
    while (before[to] == kNone) {
      const std::uint32_t literal = queue.front();
      queue.pop_front();
      for (std::uint32_t i = begin(literal); i < end(literal); ++i) {
        if (before[at(i)] != kNone) continue;
        before[at(i)] = literal;
        queue.push_back(at(i));
      }
    }
    std::vector<std::uint32_t> chain = {to};
    while (chain.back() != from) chain.push_back(before[chain.back()]);
    std::reverse(chain.begin(), chain.end());
    return chain;
  }

 private:
  std::vector<Implication> all_;
  std::vector<std::uint32_t> first_;
};

}  // namespace

std::optional<std::vector<std::uint32_t>> find_conflict(const TermScan& scan, const Objective& objective,
                                                        std::span<const std::uint32_t> first,
                                                        std::int64_t most, std::size_t variable_count,
                                                        const Progress& progress) {
  const Declaration& declaration = declaration_of(objective.parts.front().criterion);
  if (declaration.traits.coupling == Coupling::VertexStar) return std::nullopt;  // terms of many variables
  ImplicationSink sink(objective.direction() == Direction::Maximise ? -1 : 1, most);
  scan.run(declaration, first, sink, progress);
  if (sink.hopeless()) return std::vector<std::uint32_t>();
  const Implications implications(sink.take(), 2 * variable_count);
  const std::vector<std::uint32_t> component = implications.components();
  for (std::uint32_t literal = 0; literal < component.size(); literal += 2) {
    if (component[literal] != component[literal + 1]) continue;
    std::vector<std::uint32_t> variables;
    for (const auto& [from, to] : {Implication{literal, literal + 1}, Implication{literal + 1, literal}}) {
      for (const std::uint32_t on_the_way : implications.chain(from, to)) {
        const std::uint32_t q = on_the_way / 2;
        const bool known = std::find(variables.begin(), variables.end(), q) != variables.end();
        if (q != literal / 2 && !known) variables.push_back(q);
      }
    }
    variables.push_back(literal / 2);
    return variables;
  }
  return std::nullopt;
}

}  // namespace thalweg
