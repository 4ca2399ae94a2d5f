#pragma once

/// How much memory the machine leaves this process.

#include <cstddef>
#include <string>

namespace thalweg {

struct MemoryRoom {
  std::size_t bytes = 0;
  std::string limited_by;  ///< as a message names it: "the machine", "ulimit -v", "the control group"
};

/// The least of what is available in memory, what the control groups leave, and what the limits of the
/// process (address space, data) leave. What the system does not tell does not count.
MemoryRoom memory_room();

}  // namespace thalweg
