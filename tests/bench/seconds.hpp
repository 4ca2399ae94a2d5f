#pragma once

#include <chrono>
#include <ctime>

namespace thalweg::bench {

/// Seconds by the clock, and of the processor, all threads together.
struct Seconds {
  double wall = 0;
  double processor = 0;
  Seconds operator-(const Seconds& earlier) const {
    return {wall - earlier.wall, processor - earlier.processor};
  }
  static Seconds now() {
    return {std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(),
            static_cast<double>(std::clock()) / CLOCKS_PER_SEC};
  }
};

}  // namespace thalweg::bench
