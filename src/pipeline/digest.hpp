#pragma once

/// The digest that names a terrain: equal vertices and constraint edges give equal digests.

#include <thalweg/mesh/tin.hpp>

#include <span>
#include <string>

namespace thalweg {

/// SHA-256, in lower-case hexadecimal, of the little-endian doubles x, y, z of all vertices sorted by (x, y),
/// followed by x, y, x, y of all constraint edges, each with its lower end first, sorted.
/// `written` are the coordinates as written to files; empty: those of the plane.
std::string digest_of(const Tin& tin, std::span<const Point2> written);

}  // namespace thalweg
