// Sums of terms as a quadratic function of labels.
//
// A term of two labels is written f00 + (f10 - f00) x + (f01 - f00) y + w x y, w = f11 - f10 - f01 + f00, in
// steps: each value is weighted and rounded once, all that follows is exact. Unary costs are added
// atomically: the order of integer additions does not matter; what a block adds to one quadrilateral in a row
// is added at once.
#include "optimize/sums.hpp"

#include "base/parallel.hpp"
#include "optimize/vertex_terms.hpp"

#include <thalweg/base/error.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace thalweg {

namespace {

constexpr std::size_t kSumBlock = 1 << 15;

/// A term in steps, weighted; or, with a limit, 1 if it is beyond it and 0 if not.
struct Measure {
  double factor = 1;
  std::optional<std::int64_t> limit;
  double most_units = kMostUnits;
  std::int64_t operator()(double value) const {
    const std::int64_t steps = to_steps(factor * value, most_units);
    if (!limit) return steps;
    return steps > *limit ? 1 : 0;
  }
};

template <std::size_t Criteria>
class SumSink {
 public:
  SumSink(Labelling<Criteria>& labelling, std::size_t level, Measure measure)
      : labelling_(labelling), level_(level), measure_(measure) {}

  [[nodiscard]] WideSteps delaunay() const { return delaunay_; }

  class Block {
   public:
    explicit Block(SumSink& sink) : sink_(sink) {}
    Block(const Block&) = delete;
    Block& operator=(const Block&) = delete;
    void finish() {
      flush();
      const std::lock_guard lock(sink_.mutex_);
      sink_.delaunay_ += delaunay_;
    }

    void constant(double value) { delaunay_ += steps(value); }

    template <std::size_t Terms>
    void single(std::uint32_t q, const std::array<double, Terms>& f0, const std::array<double, Terms>& f1) {
      turn_to(q);
      for (std::size_t i = 0; i < Terms; ++i) {
        const std::int64_t kept = steps(f0[i]);
        delaunay_ += kept;
        own_ += steps(f1[i]) - kept;
      }
    }

    void pair(const Neighbours& at, const PairValues& f) {
      turn_to(at.q);
      const std::int64_t f00 = steps(f[0]), f10 = steps(f[1]), f01 = steps(f[2]), f11 = steps(f[3]);
      delaunay_ += f00;
      own_ += f10 - f00;
      sink_.add(at.p, f01 - f00);
      const std::int64_t weight = f11 - f10 - (f01 - f00);
      sink_.labelling_.weight[at.q_slot][sink_.level_] += weight;
      sink_.labelling_.weight[at.p_slot][sink_.level_] += weight;
    }

   private:
    [[nodiscard]] std::int64_t steps(double value) const { return sink_.measure_(value); }
    void turn_to(std::uint32_t q) {
      if (q == current_) return;
      flush();
      current_ = q;
    }
    void flush() {
      if (own_ != 0) sink_.add(current_, own_);
      own_ = 0;
    }

    SumSink& sink_;
    std::uint32_t current_ = kNone;
    std::int64_t own_ = 0;
    WideSteps delaunay_ = 0;
  };

 private:
  void add(std::uint32_t q, std::int64_t steps) {
    std::atomic_ref(labelling_.unary.levels()[q][level_]).fetch_add(steps, std::memory_order_relaxed);
  }

  Labelling<Criteria>& labelling_;
  std::size_t level_;
  Measure measure_;
  std::mutex mutex_;
  WideSteps delaunay_ = 0;
};

/// No sum of costs of the level, over whatever labels, may leave the range of 64 bits.
template <std::size_t Criteria>
void refuse_overflow(const Labelling<Criteria>& labelling, std::size_t level, const Objective& objective,
                     const Progress& progress) {
  const auto sum_of = [&](std::span<const Weight<Criteria>> values) {
    std::vector<double> parts((values.size() + kSumBlock - 1) / kSumBlock);
    for_each_block(values.size(), kSumBlock, progress, [&](std::size_t begin, std::size_t end) {
      double& sum = parts[begin / kSumBlock];
      for (std::size_t i = begin; i < end; ++i) sum += std::abs(static_cast<double>(values[i][level]));
    });
    return std::accumulate(parts.begin(), parts.end(), 0.0);
  };
  double most = sum_of(labelling.unary.levels()) + sum_of(labelling.weight) / 2;
  for (std::size_t i = 0; i < labelling.tables.size(); ++i) {
    double largest = 0;
    for (const Weight<Criteria>& entry : labelling.tables.entries(i)) {
      largest = std::max(largest, std::abs(static_cast<double>(entry[level])));
    }
    most += largest;
  }
  if (most < 0x1p62) return;
  throw Error(ErrorCode::SizeLimit, "the values of " + objective.name() +
                                        " are too large to be added exactly; split the area, or scale it by "
                                        "a small weight, such as 0.001*" +
                                        objective.name());
}

/// Adds the tables of vertices to a level. Returns their value under labels 0.
template <std::size_t Criteria>
WideSteps add_tables(const VertexTerms& terms, Measure measure, std::span<const std::uint8_t> counted,
                     std::size_t level, Labelling<Criteria>& labelling) {
  WideSteps kept = 0;
  for (const std::int64_t value : terms.constants) kept += measure(static_cast<double>(value));
  for (std::size_t i = 0; i < terms.tables.size(); ++i) {
    if (!counted.empty() && counted[i] == 0) continue;
    const std::span<const std::uint32_t> scope = terms.tables.scope(i);
    Table<Criteria> table{{scope.begin(), scope.end()}, {}};
    for (const Weight<1>& value : terms.tables.entries(i)) {
      table.entry.emplace_back()[level] = measure(static_cast<double>(value[0]));
    }
    const std::int64_t zero = table.entry.front()[level];
    kept += zero;
    for (Weight<Criteria>& entry : table.entry) entry[level] -= zero;
    table = without_idle(std::move(table));
    if (!table.scope.empty()) labelling.tables.append(table);
  }
  return kept;
}

/// The least that a wide star measures.
std::int64_t least_of(const SpokedStar& star, VertexTerm term, Measure measure,
                      std::optional<std::pair<std::uint32_t, Label>> fixed = std::nullopt) {
  std::int64_t least = std::numeric_limits<std::int64_t>::max();
  for (const Star& reached : star.reachable(fixed)) {
    least = std::min(least, measure(static_cast<double>(term(reached))));
  }
  return least;
}

/// Adds all terms of a criterion to a level. Returns their value on the given TIN.
template <std::size_t Criteria>
WideSteps add_terms(const TermScan& scan, const Declaration& declaration, Measure measure, std::size_t level,
                    Labelling<Criteria>& labelling, const Progress& progress) {
  if (declaration.vertex == nullptr) {
    SumSink<Criteria> sink(labelling, level, measure);
    scan.run(declaration, labelling.first, sink, progress);
    return sink.delaunay();
  }
  const VertexTerms terms = find_vertex_terms(scan, declaration.vertex, progress);
  WideSteps delaunay = add_tables(terms, measure, {}, level, labelling);
  const std::vector<Label> kept(labelling.size(), Label::Zero);
  for (const SpokedStar& star : terms.wide) {
    delaunay += measure(static_cast<double>(declaration.vertex(star.under(kept))));
  }
  return delaunay;
}

double sign_of(const Objective& objective) {
  return objective.direction() == Direction::Maximise ? -1 : 1;
}

}  // namespace

template <std::size_t Criteria>
WideSteps add_objective(const TermScan& scan, const Objective& objective, std::size_t level,
                        Labelling<Criteria>& labelling, const Progress& progress) {
  // A cost is the sum of at most five differences of terms a part: it fits 64 bits before all are looked at.
  const double most_units = kMostUnits / 8 / static_cast<double>(objective.parts.size());
  WideSteps delaunay = 0;
  for (const Objective::Part& part : objective.parts) {
    const Measure measure{sign_of(objective) * part.weight, std::nullopt, most_units};
    delaunay += add_terms(scan, declaration_of(part.criterion), measure, level, labelling, progress);
  }
  labelling.tables.index(labelling.size());
  refuse_overflow(labelling, level, objective, progress);
  return delaunay;
}

namespace {

/// Gathers the values of terms, and the least value that each of them alone leaves possible.
class ExtremeSink {
 public:
  explicit ExtremeSink(double sign) : measure_{sign, std::nullopt} {}

  class Block {
   public:
    explicit Block(ExtremeSink& sink) : sink_(sink) {}
    Block(const Block&) = delete;
    Block& operator=(const Block&) = delete;
    void finish() {
      const std::lock_guard lock(sink_.mutex_);
      sink_.least_ = std::max(sink_.least_, least_);
      sink_.delaunay_ = std::max(sink_.delaunay_, delaunay_);
      sink_.values_.insert(sink_.values_.end(), values_.begin(), values_.end());
    }
    void constant(double value) { note(sink_.measure_(value), sink_.measure_(value)); }
    template <std::size_t Terms>
    void single(std::uint32_t /*q*/, const std::array<double, Terms>& f0,
                const std::array<double, Terms>& f1) {
      const std::int64_t zero = worst(f0), one = worst(f1);
      note(zero, std::min(zero, one));
      values_.push_back(one);
    }
    void pair(const Neighbours& /*at*/, const PairValues& f) {
      std::array<std::int64_t, 4> steps{};
      std::transform(f.begin(), f.end(), steps.begin(), sink_.measure_);
      note(steps[0], *std::min_element(steps.begin(), steps.end()));
      values_.insert(values_.end(), steps.begin() + 1, steps.end());
    }
    /// No labelling has a worst term less than this.
    void at_least(std::int64_t value) {
      least_ = std::max(least_, sink_.measure_(static_cast<double>(value)));
    }
    void table(std::span<const Weight<1>> entries) {
      std::vector<std::int64_t> steps;
      for (const Weight<1>& entry : entries) steps.push_back(sink_.measure_(static_cast<double>(entry[0])));
      const std::int64_t kept = steps.front();
      std::sort(steps.begin(), steps.end());
      steps.erase(std::unique(steps.begin(), steps.end()), steps.end());
      note(kept, steps.front());
      values_.insert(values_.end(), steps.begin(), steps.end());
    }

   private:
    void note(std::int64_t kept, std::int64_t least) {
      delaunay_ = std::max(delaunay_, kept);
      least_ = std::max(least_, least);
      values_.push_back(kept);
    }
    template <std::size_t Terms>
    [[nodiscard]] std::int64_t worst(const std::array<double, Terms>& f) const {
      std::int64_t most = kLowest;
      for (const double value : f) most = std::max(most, sink_.measure_(value));
      return most;
    }

    ExtremeSink& sink_;
    std::int64_t least_ = kLowest, delaunay_ = kLowest;
    std::vector<std::int64_t> values_;
  };

  Extreme take() {
    if (values_.empty()) return {0, {0}};
    std::erase_if(values_, [&](std::int64_t value) { return value < least_; });
    std::sort(values_.begin(), values_.end());
    values_.erase(std::unique(values_.begin(), values_.end()), values_.end());
    return {delaunay_, std::move(values_)};
  }

 private:
  static constexpr std::int64_t kLowest = std::numeric_limits<std::int64_t>::min();
  Measure measure_;
  std::mutex mutex_;
  std::int64_t least_ = kLowest, delaunay_ = kLowest;
  std::vector<std::int64_t> values_;
};

/// The worst term under given labels.
class LabelledSink {
 public:
  LabelledSink(double sign, std::span<const Label> label) : measure_{sign, std::nullopt}, label_(label) {}
  [[nodiscard]] std::int64_t worst() const { return worst_ == kLowest ? 0 : worst_; }

  class Block {
   public:
    explicit Block(LabelledSink& sink) : sink_(sink) {}
    Block(const Block&) = delete;
    Block& operator=(const Block&) = delete;
    void finish() {
      const std::lock_guard lock(sink_.mutex_);
      sink_.worst_ = std::max(sink_.worst_, worst_);
    }
    void constant(double value) { worst_ = std::max(worst_, sink_.measure_(value)); }
    template <std::size_t Terms>
    void single(std::uint32_t q, const std::array<double, Terms>& f0, const std::array<double, Terms>& f1) {
      for (const double value : sink_.is_one(q) ? f1 : f0) constant(value);
    }
    void pair(const Neighbours& at, const PairValues& f) {
      constant(f[(sink_.is_one(at.q) ? 1U : 0U) + (sink_.is_one(at.p) ? 2U : 0U)]);
    }

   private:
    LabelledSink& sink_;
    std::int64_t worst_ = kLowest;
  };

 private:
  static constexpr std::int64_t kLowest = std::numeric_limits<std::int64_t>::min();
  [[nodiscard]] bool is_one(std::uint32_t q) const { return label_[q] == Label::One; }
  Measure measure_;
  std::span<const Label> label_;
  std::mutex mutex_;
  std::int64_t worst_ = kLowest;
};

/// Of all terms under labels 0, rounded up.
std::int64_t mean_of(const VertexTerms& terms, std::span<const std::int64_t> wide) {
  std::int64_t sum = 0;
  for (const std::int64_t value : terms.constants) sum += value;
  for (std::size_t i = 0; i < terms.tables.size(); ++i) sum += terms.tables.entries(i).front()[0];
  for (const std::int64_t value : wide) sum += value;
  const auto count = static_cast<std::int64_t>(terms.constants.size() + terms.tables.size() + wide.size());
  return count == 0 ? 0 : (sum + count - 1) / count;
}

}  // namespace

LeftOut find_left_out(const TermScan& scan, const Objective& objective, std::span<const Label> label,
                      const Progress& progress) {
  LeftOut left_out;
  const std::vector<Label> kept(label.size(), Label::Zero);
  for (const Objective::Part& part : objective.parts) {
    const VertexTerm term = declaration_of(part.criterion).vertex;
    if (term == nullptr) continue;
    const Measure measure{sign_of(objective) * part.weight, std::nullopt};
    for (const SpokedStar& star : find_vertex_terms(scan, term, progress).wide) {
      const std::int64_t zero = measure(static_cast<double>(term(star.under(kept))));
      left_out.value += measure(static_cast<double>(term(star.under(label)))) - zero;
      left_out.least += least_of(star, term, measure) - zero;
    }
  }
  return left_out;
}

Extreme find_extreme(const TermScan& scan, const Objective& objective, std::span<const std::uint32_t> first,
                     const Progress& progress) {
  ExtremeSink sink(sign_of(objective));
  const Declaration& declaration = declaration_of(objective.parts.front().criterion);
  if (declaration.vertex == nullptr) {
    scan.run(declaration, first, sink, progress);
    return sink.take();
  }
  VertexTerms terms = find_vertex_terms(scan, declaration.vertex, progress);
  const std::vector<Label> kept(scan.quadrilaterals().size(), Label::Zero);
  std::vector<std::int64_t> wide;
  ExtremeSink::Block block(sink);
  for (const std::int64_t value : terms.constants) block.constant(static_cast<double>(value));
  for (std::size_t i = 0; i < terms.tables.size(); ++i) block.table(terms.tables.entries(i));
  for (const SpokedStar& star : terms.wide) {
    wide.push_back(declaration.vertex(star.under(kept)));
    std::vector<Weight<1>> values = {{wide.back()}};
    for (const Star& reached : star.reachable()) values.push_back({declaration.vertex(reached)});
    block.table(values);
  }
  if (declaration.sum_is_fixed) block.at_least(mean_of(terms, wide));
  block.finish();
  Extreme extreme = sink.take();
  extreme.vertex = std::move(terms);
  return extreme;
}

std::int64_t extreme_of(const TermScan& scan, const Objective& objective,
                        std::span<const std::uint32_t> first, std::span<const Label> label,
                        const Progress& progress, const VertexTerms* known) {
  LabelledSink sink(sign_of(objective), label);
  const Declaration& declaration = declaration_of(objective.parts.front().criterion);
  if (declaration.vertex == nullptr) {
    scan.run(declaration, first, sink, progress);
    return sink.worst();
  }
  const VertexTerms found =
      known == nullptr ? find_vertex_terms(scan, declaration.vertex, progress) : VertexTerms{};
  const VertexTerms& terms = known == nullptr ? found : *known;
  LabelledSink::Block block(sink);
  for (const std::int64_t value : terms.constants) block.constant(static_cast<double>(value));
  for (std::size_t i = 0; i < terms.tables.size(); ++i) {
    const Slice slice = slice_of(terms.tables.scope(i), label);
    block.constant(static_cast<double>(terms.tables.entries(i)[slice.base][0]));
  }
  for (const SpokedStar& star : terms.wide) {
    block.constant(static_cast<double>(declaration.vertex(star.under(label))));
  }
  block.finish();
  return sink.worst();
}

namespace {

/// A wide star within the limit or not: as much of that as single labels decide.
template <std::size_t Criteria>
WideSteps add_forced_labels(const SpokedStar& star, VertexTerm term, Measure measure, std::size_t level,
                            Labelling<Criteria>& labelling) {
  WideSteps kept = least_of(star, term, measure);
  if (kept > 0) return kept;
  for (const std::uint32_t q : star.scope) {
    if (least_of(star, term, measure, std::pair(q, Label::One)) > 0) ++labelling.unary.levels()[q][level];
    if (least_of(star, term, measure, std::pair(q, Label::Zero)) == 0) continue;
    --labelling.unary.levels()[q][level];
    ++kept;
  }
  return kept;
}

template <std::size_t Criteria>
WideSteps add_wide(const ExcessOptions& options, VertexTerm term, double sign, std::size_t level,
                   Labelling<Criteria>& labelling) {
  WideSteps kept = 0;
  for (const SpokedStar& star : options.vertex->wide) {
    const std::int64_t least = least_of(star, term, {sign, std::nullopt});
    const std::int64_t most = options.wide == WideStars::Least ? std::min(least, options.most) : options.most;
    kept += add_forced_labels(star, term, {sign, most}, level, labelling);
  }
  return kept;
}

}  // namespace

template <std::size_t Criteria>
std::int64_t count_excess(const TermScan& scan, const Objective& objective, const ExcessOptions& options,
                          std::size_t level, Labelling<Criteria>& labelling, const Progress& progress) {
  for (Weight<Criteria>& levels : labelling.unary.levels()) levels[level] = 0;
  for (Weight<Criteria>& weight : labelling.weight) weight[level] = 0;
  labelling.tables.clear_level(level);
  const Declaration& declaration = declaration_of(objective.parts.front().criterion);
  const Measure measure{sign_of(objective), options.most};
  WideSteps excess = 0;
  if (options.vertex == nullptr) {
    excess = add_terms(scan, declaration, measure, level, labelling, progress);
  } else {
    excess = add_tables(*options.vertex, measure, options.counted, level, labelling);
    excess += add_wide(options, declaration.vertex, sign_of(objective), level, labelling);
  }
  labelling.tables.index(labelling.size());
  return static_cast<std::int64_t>(excess);
}

bool mark_excess(const VertexTerms& terms, const Objective& objective, std::int64_t most,
                 std::span<const Label> label, std::vector<std::uint8_t>& marked) {
  const Measure measure{sign_of(objective), most};
  bool any_new = false;
  for (std::size_t i = 0; i < terms.tables.size(); ++i) {
    const Slice slice = slice_of(terms.tables.scope(i), label);
    const auto value = static_cast<double>(terms.tables.entries(i)[slice.base][0]);
    if (marked[i] != 0 || measure(value) == 0) continue;
    marked[i] = 1;
    any_new = true;
  }
  return any_new;
}

template std::int64_t count_excess(const TermScan&, const Objective&, const ExcessOptions&, std::size_t,
                                   Labelling<1>&, const Progress&);
template std::int64_t count_excess(const TermScan&, const Objective&, const ExcessOptions&, std::size_t,
                                   Labelling<2>&, const Progress&);
template std::int64_t count_excess(const TermScan&, const Objective&, const ExcessOptions&, std::size_t,
                                   Labelling<4>&, const Progress&);

template WideSteps add_objective(const TermScan&, const Objective&, std::size_t, Labelling<1>&,
                                 const Progress&);
template WideSteps add_objective(const TermScan&, const Objective&, std::size_t, Labelling<2>&,
                                 const Progress&);
template WideSteps add_objective(const TermScan&, const Objective&, std::size_t, Labelling<4>&,
                                 const Progress&);

}  // namespace thalweg
