#pragma once

/// Terms that depend on the labels of several variables, written out as tables.

#include "optimize/cost.hpp"
#include "optimize/label.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace thalweg {

/// A term by itself: bit j of an index into its entries is the label of variable j of its scope.
template <std::size_t Criteria>
struct Table {
  std::vector<std::uint32_t> scope;  ///< different variables
  std::vector<Weight<Criteria>> entry;
};

/// Many terms as flat arrays.
template <std::size_t Criteria>
class Tables {
 public:
  [[nodiscard]] std::size_t size() const { return first_entry_.size() - 1; }
  [[nodiscard]] bool empty() const { return size() == 0; }
  [[nodiscard]] std::span<const std::uint32_t> scope(std::size_t i) const {
    return std::span(variable_).subspan(first_variable_[i], first_variable_[i + 1] - first_variable_[i]);
  }
  [[nodiscard]] std::span<const Weight<Criteria>> entries(std::size_t i) const {
    return std::span(entry_).subspan(first_entry_[i], first_entry_[i + 1] - first_entry_[i]);
  }
  /// The terms that depend on a variable. Pre: the terms are indexed.
  [[nodiscard]] std::span<const std::uint32_t> of(std::uint32_t variable) const {
    if (first_of_.empty()) return {};
    return std::span(of_).subspan(first_of_[variable], first_of_[variable + 1] - first_of_[variable]);
  }
  /// Whether any term depends on labels at this level.
  [[nodiscard]] bool reach_level(std::size_t level) const;

  void append(const Table<Criteria>& table);
  void append(const Tables& tables);
  /// Makes all entries 0 at a level, and drops the terms that depend on no label any more; ends the index.
  void clear_level(std::size_t level);
  /// Lists the terms of each of the variables. Complexity: linear.
  void index(std::size_t variable_count);
  /// Replaces variable j of the scope of term i; ends the index.
  void replace(std::size_t i, std::size_t j, std::uint32_t variable) {
    variable_[first_variable_[i] + j] = variable;
    first_of_.clear();
  }

 private:
  std::vector<std::uint32_t> first_variable_ = {0}, variable_;
  std::vector<std::size_t> first_entry_ = {0};
  std::vector<Weight<Criteria>> entry_;
  std::vector<std::uint32_t> first_of_, of_;
};

/// The entries of a term that agree with labels: `base` with any of the bits of `open`.
struct Slice {
  std::size_t base = 0, open = 0;
};
Slice slice_of(std::span<const std::uint32_t> scope, std::span<const Label> label);

/// What is left of a term when the labels that are not Open are fixed; variables on which it does not depend
/// any more are not in its scope. Complexity: w 2^w for w open variables.
template <std::size_t Criteria>
Table<Criteria> condition(const Tables<Criteria>& tables, std::size_t i, std::span<const Label> label);

/// The same table without the variables on which it does not depend.
template <std::size_t Criteria>
Table<Criteria> without_idle(Table<Criteria> table);

/// The same table with an ascending scope.
template <std::size_t Criteria>
Table<Criteria> with_sorted_scope(const Table<Criteria>& table);

/// The least and the most that label 1 of a variable costs more than label 0 in term i, over the labels that
/// the others may have. Complexity: 2^w for w open variables.
template <std::size_t Criteria>
std::pair<Weight<Criteria>, Weight<Criteria>> spread(const Tables<Criteria>& tables, std::size_t i,
                                                     std::uint32_t variable, std::span<const Label> label);

}  // namespace thalweg
