#pragma once

/// Profiles of a TIN as a table.

#include "pipeline/loaded_tin.hpp"

#include <thalweg/base/progress.hpp>
#include <thalweg/pipeline/convert.hpp>

#include <cstddef>
#include <string>

namespace thalweg {

struct ProfileTable {
  std::string csv;
  std::size_t lines = 0;
  std::size_t rows = 0;
};

/// Reads the lines and traces each. Throws: what reading throws; Error{OutsideHull} if none meets the TIN.
ProfileTable profile_table(const LoadedTin& loaded, const ProfileConfig& config, Progress& progress);

}  // namespace thalweg
