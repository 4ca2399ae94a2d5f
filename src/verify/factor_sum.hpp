#pragma once

/// A sum of costs of few variables each, and the steps by which its least value is found or bounded.

#include "verify/plain_mesh.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace thalweg::verify {

/// Compared lexicographically, added component by component.
using Cost = std::array<std::int64_t, 6>;

Cost plus(const Cost& a, const Cost& b);
Cost minus(const Cost& a, const Cost& b);

/// A cost that depends on few variables, each of which is false or true.
struct Factor {
  std::vector<Index> scope;  ///< ascending
  std::vector<Cost> table;   ///< bit i of the index is the label of scope[i]
};

/// The sum of all factors at given labels.
Cost cost_of(std::span<const Factor> factors, const std::vector<bool>& labels);

/// What elimination leaves behind: the variable's best label, given those of its neighbours.
struct Elimination {
  Index variable = 0;
  std::vector<Index> scope;
  std::vector<bool> choice;
};

/// Variables on which a factor does not depend leave its scope.
class FactorSum {
 public:
  FactorSum(std::size_t variables, std::vector<Factor> factors);

  [[nodiscard]] std::size_t size() const { return of_.size(); }
  [[nodiscard]] const Cost& constant() const { return constant_; }
  /// Neither fixed nor eliminated.
  [[nodiscard]] bool is_open(Index q) const { return open_[q]; }
  /// Other variables in the factors of q, ascending.
  [[nodiscard]] std::vector<Index> neighbours(Index q) const;
  /// The most that a label of q can cost more than the other one: at most the sum of each factor's most.
  [[nodiscard]] Cost worst(Index q, bool label) const;
  /// Takes the label; returns the variables whose factors changed. Pre: open.
  std::vector<Index> fix(Index q, bool label);
  /// Puts, in place of all factors of q, their least value over its labels. Pre: open.
  Elimination eliminate(Index q);

  /// A new variable in no factor.
  Index add_variable();
  void add_factor(const Factor& factor);
  /// A cost paid if q is true.
  void add_cost(Index q, const Cost& cost);
  /// Writes each factor of two variables as a constant and a cost of each variable when true, where both
  /// together cost nothing more.
  void split_loose_pairs();
  /// Puts their least value for all factors with a variable outside of `kept`.
  void keep_only(std::span<const Index> kept);
  /// The constant and the least value of each factor: no labelling costs less.
  [[nodiscard]] Cost bound() const;

 private:
  [[nodiscard]] static Cost cost_of_both(const Factor& pair);
  void split_pair(Index f);
  void detach(Index factor);
  void attach(Factor factor);
  void replace(Index factor, Factor by);

  std::vector<Factor> factors_;
  std::vector<std::vector<Index>> of_;  ///< by variable
  std::vector<bool> open_;
  Cost constant_{};
};

}  // namespace thalweg::verify
