#pragma once

namespace thalweg::detail {

/// Whether `difference`, which is a - b rounded, is exact: what rounding took off, by Knuth's two-sum, is
/// zero.
inline bool is_exact_difference(double a, double b, double difference) {
  const double moved = a - difference;
  return (a - (difference + moved)) + (moved - b) == 0;
}

}  // namespace thalweg::detail
