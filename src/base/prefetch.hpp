#pragma once

/// Hints to the processor; only speed depends on them.

namespace thalweg {

/// The memory at `place` will be read soon.
inline void prefetch(const void* place) {
  __builtin_prefetch(place);
}

}  // namespace thalweg
