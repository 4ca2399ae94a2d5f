#pragma once

/// The digest of a terrain, from the README's words.

#include "verify/plain_mesh.hpp"

#include <span>
#include <string>

namespace thalweg::verify {

/// `written` are the coordinates of the file, one a vertex.
std::string plain_digest(const PlainMesh& mesh, std::span<const Point2> written);

}  // namespace thalweg::verify
