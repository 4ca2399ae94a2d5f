// Sums of terms as a quadratic function of labels.
//
// A term of two labels is written f00 + (f10 - f00) x + (f01 - f00) y + w x y, w = f11 - f10 - f01 + f00, in
// steps: each value is weighted and rounded once, all that follows is exact. Unary costs are added atomically:
// the order of integer additions does not matter; what a block adds to one quadrilateral in a row is added at
// once.
#include "optimize/sums.hpp"

#include <thalweg/base/error.hpp>

#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <string>

namespace thalweg {

namespace {

template <std::size_t Criteria>
class SumSink {
 public:
  SumSink(Labelling<Criteria>& labelling, std::size_t level, double factor)
      : labelling_(labelling), level_(level), factor_(factor) {}

  [[nodiscard]] WideSteps delaunay() const { return delaunay_; }

  class Block {
   public:
    explicit Block(SumSink& sink) : sink_(sink) {}
    Block(const Block&) = delete;
    Block& operator=(const Block&) = delete;
    ~Block() {
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
    [[nodiscard]] std::int64_t steps(double value) const { return to_steps(sink_.factor_ * value); }
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
    std::atomic_ref(labelling_.unary[q].level[level_]).fetch_add(steps, std::memory_order_relaxed);
  }

  Labelling<Criteria>& labelling_;
  std::size_t level_;
  double factor_;
  std::mutex mutex_;
  WideSteps delaunay_ = 0;
};

/// No sum of costs of the level, over whatever labels, may leave the range of 64 bits.
template <std::size_t Criteria>
void refuse_overflow(const Labelling<Criteria>& labelling, std::size_t level, const Objective& objective) {
  double most = 0;
  for (const Cost<Criteria>& cost : labelling.unary) {
    most += std::abs(static_cast<double>(cost.level[level]));
  }
  for (const Weight<Criteria>& weight : labelling.weight) {
    most += std::abs(static_cast<double>(weight[level])) / 2;
  }
  if (most < 0x1p62) return;
  throw Error(ErrorCode::SizeLimit, "the values of " + objective.name() +
                                        " are too large to be added exactly; split the area, or scale it by "
                                        "a small weight, such as 0.001*" +
                                        objective.name());
}

}  // namespace

template <std::size_t Criteria>
WideSteps add_objective(const TermScan& scan, const Objective& objective, std::size_t level,
                        Labelling<Criteria>& labelling, const Progress& progress) {
  WideSteps delaunay = 0;
  for (const Objective::Part& part : objective.parts) {
    const double sign = objective.direction() == Direction::Maximise ? -1 : 1;
    SumSink<Criteria> sink(labelling, level, sign * part.weight);
    scan.run(declaration_of(part.criterion), labelling.first, sink, progress);
    delaunay += sink.delaunay();
  }
  refuse_overflow(labelling, level, objective);
  return delaunay;
}

template WideSteps add_objective(const TermScan&, const Objective&, std::size_t, Labelling<1>&,
                                 const Progress&);
template WideSteps add_objective(const TermScan&, const Objective&, std::size_t, Labelling<2>&,
                                 const Progress&);
template WideSteps add_objective(const TermScan&, const Objective&, std::size_t, Labelling<4>&,
                                 const Progress&);

}  // namespace thalweg
