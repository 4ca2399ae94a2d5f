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
  [[nodiscard]] std::span<const Label> label() const { return std::span(label_).first(count_); }
  [[nodiscard]] std::uint32_t width() const { return width_; }
  [[nodiscard]] std::uint64_t table_entries() const { return table_entries_; }

 private:
  using Set = std::uint64_t;
  struct Pair {
    std::uint32_t a, b;
    Weight<Criteria> weight;
    std::uint32_t next;  ///< of the same bucket
  };
  struct Message {
    std::size_t first;   ///< of its entries
    std::uint32_t next;  ///< position of the next sender to the same variable
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
  // By position in the order of elimination: the variable, and the later ones that it meets, as positions.
  std::array<std::uint32_t, kMostVariables> order_{}, position_{};
  std::array<Set, kMostVariables> scope_{};
  std::array<std::uint32_t, kMostVariables> first_pair_{}, first_message_{};
  std::array<Message, kMostVariables> message_{};
  std::vector<Cost<Criteria>> table_, messages_;
  std::vector<std::uint8_t> one_;  ///< by message entry: the better label
  std::vector<std::uint32_t> projection_;
  std::array<Label, kMostVariables> label_{};
};

}  // namespace thalweg
