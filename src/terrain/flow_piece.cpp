#include "terrain/flow_piece.hpp"

#include <thalweg/base/error.hpp>

#include <algorithm>

namespace thalweg {

PieceStore::~PieceStore() {
  for (const Run& run : runs_) LargePageAllocator<FlowPiece>().deallocate(run.memory, run.pieces);
}

void PieceStore::Writer::make_room() {
  const auto begun = static_cast<std::size_t>(next_ - first_);
  const std::size_t blocks = 2 * begun / kBlock + 1;
  const std::scoped_lock lock(store_->adding_);
  if (store_->used_ + blocks > store_->blocks_.size()) {
    throw Error(ErrorCode::SizeLimit,
                "the flow parts the TIN's edges into more than 2147483647 pieces; split the area");
  }
  // The first is a little too small for a large page: where few pieces come, none is cleared for them.
  const std::size_t pieces = blocks * kBlock - (store_->used_ == 0 ? 1 : 0);
  const Run run{LargePageAllocator<FlowPiece>().allocate(pieces), pieces};
  store_->runs_.push_back(run);
  for (std::size_t b = 0; b < blocks; ++b) store_->blocks_[store_->used_ + b] = run.memory + b * kBlock;
  std::copy(first_, next_, run.memory);
  first_ = run.memory;
  next_ = first_ + begun;
  limit_ = first_ + run.pieces;
  index_ = store_->used_ * kBlock;
  store_->used_ += blocks;
}

}  // namespace thalweg
