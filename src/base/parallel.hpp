#pragma once

/// Loops over index ranges on all threads, in blocks whose borders do not depend on the thread count.

#include <thalweg/base/progress.hpp>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>

namespace thalweg {

/// Calls `body(begin, end)` for blocks of at most `block` indices that tile [0, count), in parallel.
/// Cancel is checked before each block. Exceptions of the body reach the caller.
template <class Body>
void for_each_block(std::size_t count, std::size_t block, const Progress& progress, const Body& body) {
  const std::size_t blocks = (count + block - 1) / block;
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t b) {
    progress.check();
    body(b * block, std::min(count, (b + 1) * block));
  });
}

/// Into how many ranges of [0, count) a loop falls that reads everything in order, which costs little, and
/// writes at random, each thread within its range.
inline std::size_t range_count(std::size_t count) {
  constexpr std::size_t kLeastRange = 1 << 15;
  constexpr std::size_t kMostRanges = 8;  // each reads the same
  const auto threads = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  return std::clamp<std::size_t>(count / kLeastRange, 1, std::min(threads, kMostRanges));
}

/// Calls `body(begin, end)` for such ranges, in parallel; they tile [0, count), and depend on the thread
/// count: what is written must not.
template <class Body>
void for_each_range(std::size_t count, const Progress& progress, const Body& body) {
  const std::size_t ranges = range_count(count);
  for_each_block(ranges, 1, progress,
                 [&](std::size_t i, std::size_t) { body(count * i / ranges, count * (i + 1) / ranges); });
}

/// The part of a phase that a loop takes, as fractions of the phase.
struct Stretch {
  double from = 0;
  double to = 1;
};

/// The same, and reports the fraction done: the calling thread, which takes part in the loop, does so after
/// each of its blocks.
template <class Body>
void for_each_block(std::size_t count, std::size_t block, Progress& progress, Stretch stretch,
                    const Body& body) {
  const std::size_t blocks = (count + block - 1) / block;
  const std::thread::id lead = std::this_thread::get_id();
  std::atomic<std::size_t> done{0};
  for_each_block(count, block, progress, [&](std::size_t begin, std::size_t end) {
    body(begin, end);
    const std::size_t now = ++done;
    if (std::this_thread::get_id() != lead) return;
    progress.advance(stretch.from +
                     (stretch.to - stretch.from) * static_cast<double>(now) / static_cast<double>(blocks));
  });
  progress.advance(stretch.to);
}

}  // namespace thalweg
