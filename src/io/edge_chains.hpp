#pragma once

/// Constraint edges as lines, and the words for their kinds and for the sources of vertices.

#include <thalweg/mesh/tin.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace thalweg {

/// A line of constraint edges of one kind. A closed line repeats its first vertex at the end.
struct EdgeChain {
  EdgeKind kind = EdgeKind::None;
  std::vector<VertexId> vertices;
};

/// Joins edges of equal kind into lines that end where other than two of them meet.
/// Laws: (1) each edge is in exactly one line; (2) the result does not depend on the edges' order; lines are
/// sorted by kind, then open before closed, then by their first edge. Pre: no edge is given twice.
/// Complexity: O(n log n).
std::vector<EdgeChain> chain_edges(std::span<const ConstraintEdge> edges);

/// "valley", "ridge+boundary", in the order of the bits; "none" for no kind.
std::string kind_words(EdgeKind kind);
/// The inverse of `kind_words`; nothing if a word is unknown.
std::optional<EdgeKind> parse_kind_words(std::string_view words);

/// "point", "line vertex", "crossing", in the order of TinView::vertex_source; "unknown" for others.
std::string source_word(std::uint8_t source);
/// The inverse of `source_word`; nothing if the word is unknown.
std::optional<std::uint8_t> parse_source_word(std::string_view word);

}  // namespace thalweg
