#pragma once

/// Points that are the vertices of a mesh.

#include "io/source_reader.hpp"

#include <memory>

namespace thalweg {

/// True for the extensions of mesh files that are nothing else: .ply, .2dm, .obj, .off, .stl, .xml, .landxml.
bool is_mesh(const SourceSpec& spec);

/// Reads the mesh. Throws: as the reader of its format; Error{Unsupported} if the content is of no mesh
/// format.
std::unique_ptr<SourceReader> open_mesh(const SourceSpec& spec, const Progress& progress);

}  // namespace thalweg
