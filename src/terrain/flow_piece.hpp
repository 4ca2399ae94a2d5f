#pragma once

/// The parts of a TIN's edges by what their water comes to, in memory that threads fill side by side.

#include "base/large_pages.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <mutex>
#include <vector>

namespace thalweg {

/// What water comes to first: a channel, by its number, or a vertex; one number for all.
using FlowNode = std::uint32_t;
constexpr FlowNode kNoNode = std::numeric_limits<FlowNode>::max();
constexpr FlowNode kNodeBits = kNoNode >> 1U;  // those that a piece holds

/// A part of an edge all of whose water comes to one channel or vertex.
struct FlowPiece {
  double end;  ///< share of the halfedge's way, from its origin
  FlowNode node : 31;
  std::uint32_t last : 1;  ///< of its halfedge
  /// Where the line that ends the piece comes from, downhill: a piece of the edge below (its index), or
  /// kFromCorner: the corner across.
  std::uint32_t from;
  static constexpr std::uint32_t kFromCorner = std::numeric_limits<std::uint32_t>::max();
};

/// Pieces by index. Those of one halfedge follow each other, and stay where they are. Which index a piece has
/// depends on threads.
class PieceStore {
 public:
  static constexpr std::size_t kMostPieces = std::size_t{1} << 31U;

  PieceStore() : blocks_(kMostPieces / kBlock) {}
  PieceStore(const PieceStore&) = delete;
  PieceStore& operator=(const PieceStore&) = delete;
  ~PieceStore();

  [[nodiscard]] const FlowPiece* at(std::uint32_t index) const {
    return blocks_[index / kBlock] + index % kBlock;
  }
  /// All indices are less.
  [[nodiscard]] std::size_t end() const { return kBlock * used_; }

  /// Builds the pieces of one halfedge after another, in place. Errors: Error{SizeLimit}.
  class Writer {
   public:
    explicit Writer(PieceStore& store) : store_(&store) {}
    void start() { next_ = first_; }
    /// Adds a piece after the others, or makes the last one longer if both come to the same.
    void add(double end, FlowNode node, std::uint32_t from) {
      if (next_ != first_ && next_[-1].node == node) {
        --next_;
      } else if (next_ == limit_) {
        make_room();
      }
      *next_++ = {.end = end, .node = node & kNodeBits, .last = 0, .from = from};
    }
    /// True if all comes to one node.
    [[nodiscard]] bool is_one() const { return next_ - first_ == 1; }
    [[nodiscard]] FlowNode node() const { return first_->node; }
    /// The index of the first piece of those that were added, which are kept.
    std::uint32_t keep() {
      next_[-1].last = 1;
      const std::size_t index = index_;
      index_ += static_cast<std::size_t>(next_ - first_);
      first_ = next_;
      return static_cast<std::uint32_t>(index);
    }

   private:
    void make_room();

    PieceStore* store_;
    FlowPiece* first_ = nullptr;  // of the halfedge at hand
    FlowPiece* next_ = nullptr;
    FlowPiece* limit_ = nullptr;
    std::size_t index_ = 0;  // of `first_`
  };

 private:
  static constexpr std::size_t kBlock = kLargePage / sizeof(FlowPiece);
  struct Run {
    FlowPiece* memory;
    std::size_t pieces;
  };

  std::vector<FlowPiece*> blocks_;
  std::mutex adding_;  // guards what follows
  std::size_t used_ = 0;
  std::vector<Run> runs_;
};

}  // namespace thalweg
