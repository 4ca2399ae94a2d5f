// Refuses, before the work starts, what the memory cannot hold.
//
// The figures are measured: peak memory of whole runs of 10^2, 3 x 10^5 and 10^6 random points to PLY is 52
// MiB and 343 bytes a point at order 1 and below; at order 2 it is 1 500 bytes a point.
#include "pipeline/memory_estimate.hpp"

#include "base/memory.hpp"

#include <thalweg/base/error.hpp>

#include <fmt/format.h>

namespace thalweg {

namespace {

constexpr std::size_t kBytesOfProgram = std::size_t{52} << 20U;
constexpr std::size_t kBytesAVertex = 350;
constexpr std::size_t kBytesAVertexAboveOrder1 = 1500;

std::string in_mebibytes(std::size_t bytes) {
  return fmt::format("{} MiB", (bytes + 0xfffff) >> 20U);
}

}  // namespace

MemoryEstimate::MemoryEstimate(std::optional<std::size_t> limit, unsigned order)
    : bytes_a_vertex_(order > 1 ? kBytesAVertexAboveOrder1 : kBytesAVertex) {
  // The program itself is there already.
  const MemoryRoom room = memory_room();
  const std::size_t whole = room.bytes + kBytesOfProgram;
  room_ = whole < room.bytes ? room.bytes : whole;
  limited_by_ = room.limited_by;
  if (limit && *limit <= room_) {
    room_ = *limit;
    limited_by_ = "--memory-limit";
  }
}

void MemoryEstimate::require(std::size_t vertices) const {
  const std::size_t needed = kBytesOfProgram + vertices * bytes_a_vertex_;
  if (needed <= room_) return;
  throw Error(
      ErrorCode::OutOfMemory,
      fmt::format("{} points and line vertices need about {} of memory, and {} leaves {}; read a part "
                  "(--bbox) or thin them out",
                  vertices, in_mebibytes(needed), limited_by_, in_mebibytes(room_)));
}

}  // namespace thalweg
