#pragma once

/// Ids that belong together, such as those that one thread may write to.

#include <cstdint>

namespace thalweg {

/// From `begin` to before `end`.
struct IdRange {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
  [[nodiscard]] bool contains(std::uint32_t id) const { return id - begin < end - begin; }
};

}  // namespace thalweg
