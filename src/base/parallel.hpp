#pragma once

/// Loops over index ranges on all threads, in blocks whose borders do not depend on the thread count.

#include <thalweg/base/progress.hpp>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>

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

}  // namespace thalweg
