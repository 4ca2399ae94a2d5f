#pragma once

/// Loops whose results are taken in order: for sums and choices that shall not depend on threads.

#include <thalweg/base/progress.hpp>

#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace thalweg {

/// Calls `make(begin, end, slot)` for blocks of at most `block` indices that tile [0, count), in parallel,
/// and `take(begin, end, slot)` with what it made of each, one after the other in the order of the blocks. A
/// slot serves one block after another. Cancel is checked before each block. Exceptions reach the caller.
template <class Slot, class Make, class Take>
void for_each_block_in_order(std::size_t count, std::size_t block, const Progress& progress, const Make& make,
                             const Take& take) {
  if (count == 0) return;
  const std::size_t blocks = (count + block - 1) / block;
  const auto tokens = 2 * static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  // Blocks end in order, and no more are under way than there are slots, so the slot of a block is free.
  std::vector<Slot> slots(std::min(tokens, blocks));
  std::size_t next = 0;
  const auto count_up =
      tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order, [&](tbb::flow_control& control) {
        if (next < blocks) return next++;
        control.stop();
        return next;
      });
  const auto make_block =
      tbb::make_filter<std::size_t, std::size_t>(tbb::filter_mode::parallel, [&](std::size_t b) {
        progress.check();
        make(b * block, std::min(count, (b + 1) * block), slots[b % slots.size()]);
        return b;
      });
  const auto take_block = tbb::make_filter<std::size_t, void>(
      tbb::filter_mode::serial_in_order,
      [&](std::size_t b) { take(b * block, std::min(count, (b + 1) * block), slots[b % slots.size()]); });
  tbb::parallel_pipeline(slots.size(), count_up & make_block & take_block);
}

/// What `list(begin, end, found)` appends to `found`, for blocks as above, in their order.
template <class Item, class List>
std::vector<Item> list_in_order(std::size_t count, std::size_t block, const Progress& progress,
                                const List& list) {
  std::vector<Item> all;
  using Found = std::vector<Item>;
  for_each_block_in_order<Found>(
      count, block, progress,
      [&](std::size_t begin, std::size_t end, Found& found) {
        found.clear();
        list(begin, end, found);
      },
      [&](std::size_t, std::size_t, const Found& found) {
        all.insert(all.end(), found.begin(), found.end());
      });
  return all;
}

}  // namespace thalweg
