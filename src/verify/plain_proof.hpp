#pragma once

/// The steps of a proof, taken on the verifier's own numbers.

#include "verify/plain_pits.hpp"
#include "verify/plain_terms.hpp"

#include <thalweg/base/progress.hpp>
#include <thalweg/verify/proof.hpp>

#include <string>
#include <vector>

namespace thalweg::verify {

/// The quadrilaterals in the order of the proof; none if they are not the same.
std::optional<std::vector<PlainQuadrilateral>> in_order_of(
    const Proof& proof, const std::vector<PlainQuadrilateral>& quadrilaterals);

/// What a stage shows.
struct StageBound {
  Cost bound{};       ///< no labelling that meets the conditions costs less, lexicographically
  std::string fault;  ///< why it shows nothing
};

/// `factors` are those of the terms in which the stage counts; `plateaus` is null where pits are no
/// condition. Throws: Error{Cancelled}.
StageBound take_steps(const ProofStage& stage, std::size_t variables, std::vector<Factor> factors,
                      const PlainPlateaus* plateaus, Progress& progress);

}  // namespace thalweg::verify
