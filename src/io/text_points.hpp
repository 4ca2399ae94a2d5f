#pragma once

/// Points from tables of text.

#include "io/source_reader.hpp"

#include <memory>

namespace thalweg {

/// True if the source is read as text: by extension (.csv .tsv .txt .xyz .asc .dat, .gz put after them, and
/// standard input), unless a raster format is recognised in a file with one of the extensions that such
/// formats share.
bool is_text(const SourceSpec& spec);

/// Throws: Error{NotFound}, Error{Unreadable}, Error{BadCrs} (of a .prj file next to it).
std::unique_ptr<SourceReader> open_text(const SourceSpec& spec, const ReadOptions& options);

}  // namespace thalweg
