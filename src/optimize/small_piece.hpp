#pragma once

/// Exact solution of small pieces without links and tables, which are most: sets of variables are bits of a
/// word, and nothing is allocated a piece.

#include "optimize/piece.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace thalweg {

/// Solves one piece after the other, each as `solve_exactly` would: by the same order, with the same ties.
template <std::size_t Criteria>
class SmallPiece {
 public:
  static constexpr std::size_t kMostVariables = 64;
  static constexpr std::uint32_t kMostWidth = 10;

  /// Labels for the selected variables, given the labels of all others, as in `restrict_to`. False, and
  /// nothing is said, of a piece that is not small, or whose variables have links or tables to heed.
  bool solve(const Labelling<Criteria>& problem, const Reduction& fixed, const Selection& selection,
             std::uint32_t width_limit);
  /// In the order of the selection; valid until the next call.
  [[nodiscard]] std::span<const Label> label() const { return label_; }
  [[nodiscard]] std::uint32_t width() const { return width_; }
  [[nodiscard]] std::uint64_t table_entries() const { return table_entries_; }

 private:
  using Set = std::uint64_t;
  struct Pair {
    std::uint32_t a, b;
    Weight<Criteria> weight;
    std::uint32_t next;  ///< of the same bucket
  };
  /// The elimination of a variable.
  struct Step {
    Set scope = 0;                ///< the later steps that it meets
    std::size_t first_entry = 0;  ///< of its message
    std::uint32_t variable = 0;
    std::uint32_t first_pair = kNone;
    std::uint32_t first_sender = kNone;  ///< of messages to it: a step
    std::uint32_t next_sender = kNone;   ///< to the receiver of its own
  };

  bool load(const Labelling<Criteria>& problem, const Reduction& fixed, const Selection& selection);
  [[nodiscard]] std::uint32_t fill_of(std::uint32_t v) const;
  bool find_order(std::uint32_t width_limit);
  void sort_pairs();
  void project(std::uint32_t i, Set from);
  void fill_table(std::uint32_t i);
  void minimise_table(std::uint32_t i);
  void trace_back();

  std::uint32_t count_ = 0, width_ = 0;
  std::uint64_t table_entries_ = 0;
  std::array<Cost<Criteria>, kMostVariables> unary_;
  std::array<Set, kMostVariables> adjacent_{};
  std::vector<Pair> pairs_;
  std::array<Step, kMostVariables> steps_;
  std::array<std::uint32_t, kMostVariables> position_{};  ///< by variable: its step
  std::vector<Cost<Criteria>> table_, messages_;
  std::vector<std::uint8_t> one_;  ///< by message entry: the better label
  std::vector<std::uint32_t> projection_;
  std::vector<Label> label_;
};

}  // namespace thalweg
