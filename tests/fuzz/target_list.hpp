#pragma once

/// Where each target is made.

#include "fuzz/target.hpp"

namespace thalweg::fuzz {

Target terrain_target();
Target mesh_target();
Target points_target();
Target lines_target();
Target report_target();
Target proof_target();

}  // namespace thalweg::fuzz
