#pragma once

/// Drawn valleys as lines that run downstream.

#include <thalweg/mesh/tin.hpp>

#include <cstdint>
#include <vector>

namespace thalweg {

struct ValleyLines {
  std::vector<std::uint8_t> on_valley;       ///< by vertex
  std::vector<std::vector<VertexId>> lines;  ///< downstream
};

/// From one end or meeting of drawn valley edges to the next. A TIN does not keep in which direction a line
/// was drawn, so it is found: all water of a net of lines that hang together leaves at one vertex, that for
/// which the heights along lines have to change least (in sum, each line by itself) so that none rises
/// towards it; of equal ones the lowest, then the first by (x, y). Vertices inside of a line are looked at
/// where that saves more than half of what the line takes; there two lines were drawn towards each other.
/// Lines between whose ends there is another way run from the higher end to the lower one; a ring is two such
/// lines, from its highest vertex both ways to where it hangs on others, or from there both ways to its
/// lowest, as takes less change; one by itself, from its highest to its lowest. Left out: such lines with
/// level ends. No vertex comes after itself along lines. Other heights, on which
/// none of the lines rises, give no line that rises, but where ends were level. Complexity: n log n in
/// vertices of lines.
ValleyLines trace_valleys(const Tin& tin);

}  // namespace thalweg
