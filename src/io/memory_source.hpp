#pragma once

/// Points and lines that a caller holds in memory, read like a file.

#include "io/source_reader.hpp"

#include <memory>
#include <span>

namespace thalweg {

/// Pre: the source outlives the reader.
std::unique_ptr<SourceReader> open_memory_points(const MemorySource& source);
std::unique_ptr<SourceReader> open_memory_lines(const MemorySource& source);

}  // namespace thalweg
