#pragma once

/// The triangles that triangulations of an order can be made of, as far as their sides tell, with their
/// edges, and the faces into which the edges that none of them crosses cut the ground.

#include <thalweg/base/progress.hpp>
#include <thalweg/order/fixed_faces.hpp>
#include <thalweg/order/order_triangles.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace thalweg::detail {

using Candidates = FixedFaces;

/// Of the given triangles those that have, beyond each side off the rim, another one that does, too. Every
/// triangulation that is made of the given triangles is made of these.
/// Pre: `triangles` are valid, sorted, counter-clockwise. Throws: Error{SizeLimit} if so many edges cross
/// each other that memory would not do; {Cancelled}. Complexity: sorting; the faces of the ground that edges
/// cross, and pairs of edges that meet in one face.
Candidates find_candidates(const Tin& ground, std::vector<OrderTriangle> triangles, const Progress& progress);

/// Without the triangles that are marked with 1, and edges of no other triangle; faces are gone.
/// Complexity: linear.
void drop_triangles(Candidates& candidates, std::span<const std::uint8_t> dropped);

/// Sets which edges are free, and the faces, from triangles, sides and crossings. Complexity: near-linear.
void cut_into_faces(Candidates& candidates, const Progress& progress);

/// Whether every edge of the rim and every constraint edge has candidates: else there is no triangulation.
bool cover_ground(const Candidates& candidates, const Tin& ground);

}  // namespace thalweg::detail
