#pragma once

/// A second answer to the question of `path_by_parity.hpp`, by a quite different method: to check the first.

#include <support/oracle/scene.hpp>

namespace thalweg::oracle {

/// As path_joins, from a decomposition of the disc into vertical slabs, computed with a hundred decimal
/// digits. Pre: as path_joins. Complexity: slow; thousands of calls a second at best.
bool path_joins_by_slabs(const Scene& scene, Corners t, int p);

}  // namespace thalweg::oracle
