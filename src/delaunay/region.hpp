#pragma once

/// The ground inside of boundaries and outside of holes.

#include "drawing.hpp"

#include <thalweg/mesh/tin.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace thalweg {

/// Which areas something is in: the exclusive or of numbers of theirs that look random.
struct Membership {
  std::uint64_t boundaries = 0;
  std::uint64_t holes = 0;

  Membership& operator^=(const Membership& other) {
    boundaries ^= other.boundaries;
    holes ^= other.holes;
    return *this;
  }
};

/// A piece of a ring in a triangulation. Whoever crosses it changes the membership by `toggles`.
struct RingEdge {
  std::uint32_t low = 0;
  std::uint32_t high = 0;
  Membership toggles;
};

/// Whether the survey has a boundary, or a hole with an edge among the constraint edges: one that is no more
/// than a point bounds nothing.
bool has_region(const Survey& survey, std::span<const ConstraintEdge> edges);

/// Throws: Error{WrongGeometry} naming the first ring of a boundary, hole or lake that is not closed.
void check_rings(const Survey& survey, const MergedVertices& merged);

/// The pieces of all rings, between vertices of the drawing; what is drawn twice may cancel out.
std::vector<RingEdge> ring_edges(const Survey& survey, const Drawing& drawing);

/// For each triangle: true if it lies in an area of a boundary (or there is none) and in no hole. An area is
/// what an odd number of the rings of a feature surrounds. Pre: the ring edges, in order of (low, high), are
/// constraint edges of the TIN.
std::vector<bool> inside_region(const Survey& survey, const Tin& tin, std::span<const RingEdge> edges);

}  // namespace thalweg
