#pragma once

/// Hints to the processor; only speed depends on them.

namespace thalweg {

/// The memory at `place` will be read soon.
inline void prefetch(const void* place) {
  __builtin_prefetch(place);
}

/// The memory at `place` will be written soon.
inline void prefetch_to_write(void* place) {
  __builtin_prefetch(place, 1);
}

}  // namespace thalweg
