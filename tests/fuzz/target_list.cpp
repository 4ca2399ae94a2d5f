#include "fuzz/target_list.hpp"

#include <tbb/global_control.h>

#include <algorithm>
#include <array>

namespace thalweg::fuzz {

std::span<const Target> targets() {
  // Inputs are small: more threads would only wait for each other.
  static const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  static const std::array all{terrain_target(), mesh_target(),   points_target(),
                              lines_target(),   report_target(), proof_target()};
  return all;
}

const Target& find_target(std::string_view name) {
  const auto found = std::ranges::find(targets(), name, &Target::name);
  if (found == targets().end()) throw std::invalid_argument("no target " + std::string(name));
  return *found;
}

}  // namespace thalweg::fuzz
