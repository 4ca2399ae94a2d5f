#pragma once

/// The steps that prove a bound of a labelling problem, as lines for the verifier (thalweg/verify/proof.hpp).

#include "optimize/labelling.hpp"

#include <thalweg/base/progress.hpp>

#include <cstdint>
#include <iosfwd>
#include <span>

namespace thalweg {

/// Writes the steps. False if a piece is wider than the limit: then what was written
/// proves nothing. The problem is solved once more on the way, so that the solver needs to keep nothing.
/// Complexity: as solving.
template <std::size_t Criteria>
bool write_steps(std::ostream& out, const Labelling<Criteria>& problem, std::uint32_t width_limit,
                 const Progress& progress);

}  // namespace thalweg
