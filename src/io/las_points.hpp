#pragma once

/// Points of LAS files (ASPRS LAS 1.2 to 1.4, uncompressed).

#include "io/source_reader.hpp"

#include <memory>

namespace thalweg {

/// True for the extensions .las and .laz.
bool is_las(const SourceSpec& spec);

/// Throws: Error{NotFound}, Error{Unreadable}; Error{BadFormat} for a broken header; Error{Unsupported} for
/// compressed files and other versions, with the remedy; Error{BadCrs}.
std::unique_ptr<SourceReader> open_las(const SourceSpec& spec);

}  // namespace thalweg
