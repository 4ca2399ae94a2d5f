#pragma once

/// Sums of doubles that carry twice their precision.

namespace thalweg {

/// A sum in double-double, by Knuth's TwoSum: its error is some 2^-100 of the sum of sizes, so the rounded
/// value does not depend on the order of terms in practice.
class DoubleDouble {
 public:
  void add(double x) {
    const double sum = high_ + x;
    const double moved = sum - high_;
    low_ += (high_ - (sum - moved)) + (x - moved);
    high_ = sum;
  }
  void add(const DoubleDouble& other) {
    add(other.high_);
    add(other.low_);
  }
  [[nodiscard]] double value() const { return high_ + low_; }

 private:
  double high_ = 0;
  double low_ = 0;
};

}  // namespace thalweg
