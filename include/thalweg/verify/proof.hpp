#pragma once

/// A proof that results are as good as a report says, as lines of text that need not be believed.
///
/// The problem is the terrain's: a label for each quadrilateral (+: diagonal st, -: diagonal uv), the terms
/// of the criteria as costs, and where pits come first, the condition that chosen diagonals connect all
/// plateaus that diagonals can connect. A proof says by which steps to bound the costs from below; the
/// verifier takes each step on its own numbers. A wrong step makes the bound weaker or is refused, so nothing
/// can be forged.
///
///     thalweg-proof 1
///     digest HEX                    of the terrain, as in the report
///     definition NAME
///     criteria A,B,...              as in the report
///     quadrilaterals N              then N lines: variables 0 ... N - 1
///     q S U T V                     corners counter-clockwise, ids of the TIN; UV is the Delaunay diagonal
///     stage K                       what follows bounds the first K criteria together, lexicographically; if
///                                   the K-th is a largest or smallest value, the cost counts the terms that
///                                   are no better than its bound, and some must remain
///     stage K alone                 the same of the K-th, a largest or smallest value, whatever the others
///     cut L L ...                   literals (7+ or 7-), one of which is true in every labelling that
///                                   connects: without these diagonals some plateaus would fall apart. One of
///                                   more than three is a chain of clauses through new variables, numbered
///                                   on: a or b or y, not y or c or z, not z or d or e
///     fix L L ...                   literals that may be taken, in whatever order: a label that never costs
///                                   more than the other one, or the only literal of a cut
///     eliminate V V ...             in this order: all costs with V become one of the variables beside V,
///                                   the least over V's labels
///     forest V V ...                links between plateaus, without costs in common: a spanning forest of
///                                   least cost, all other links taken to be there
///     conflict V V ...              costs of other variables count as the least they can be; these are
///                                   eliminated in this order: what remains are implications from x to not x
///                                   and back, one value below the bound
///     end
///
/// What is left when a stage ends counts as the least that it can be.

#include <cstdint>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

namespace thalweg::verify {

enum class StepKind : std::uint8_t { Cut, Fix, Eliminate, Forest, Conflict };

/// One line of a stage. Literals are 2 v + 1 for v+, 2 v for v-; variables and amounts stand as they are.
struct ProofStep {
  StepKind kind = StepKind::Cut;
  std::vector<std::int64_t> numbers;
  std::size_t line = 0;  ///< in the file, from 1
};

struct ProofStage {
  std::size_t criteria = 0;
  bool alone = false;
  std::vector<ProofStep> steps;
};

struct Proof {
  std::string digest;
  std::string definition;
  std::string criteria;
  std::size_t quadrilateral_count = 0;  ///< as announced
  std::vector<std::vector<std::int64_t>> quadrilaterals;
  std::vector<ProofStage> stages;
  bool complete = false;  ///< it ends as it should
};

/// Throws: Error{BadFormat} that names the line. `name` is the file's, for errors.
Proof read_proof(std::istream& text, const std::string& name);

}  // namespace thalweg::verify
