// Refuses, before the work starts, what the memory cannot hold.
//
// The figures are measured: peak memory of whole runs of 10^4 to 4 x 10^6 points to PLY is 53 MiB and up to
// 203 bytes a random point, 210 a lattice point at order 1 and below; at orders 2 and 3 it is 1 051 and 1 220
// bytes a random point, at order 1 under definitions with overlaps up to 1 000. Longitudes and latitudes take
// up to 314, a simplification that keeps most points 392, both 535. Rasters of 10^8 cells take 20 bytes a
// cell as GeoTIFF in single precision, 32 in double.
#include "pipeline/memory_estimate.hpp"

#include "base/memory.hpp"

#include <thalweg/base/error.hpp>

#include <fmt/format.h>

namespace thalweg {

namespace {

constexpr std::size_t kBytesOfProgram = std::size_t{53} << 20U;
constexpr std::size_t kBytesAVertex = 220;
constexpr std::size_t kBytesAVertexByFaces = 1500;
constexpr std::size_t kBytesToProject = 125;
constexpr std::size_t kBytesToSimplify = 200;

std::string in_mebibytes(std::size_t bytes) {
  return fmt::format("{} MiB", (bytes + 0xfffff) >> 20U);
}

}  // namespace

MemoryEstimate::MemoryEstimate(const BuildConfig& config)
    : bytes_a_vertex_(config.labelling.by_faces() ? kBytesAVertexByFaces : kBytesAVertex) {
  if (config.max_error_m || config.max_points) bytes_a_vertex_ += kBytesToSimplify;
  // The program itself is there already.
  const MemoryRoom room = memory_room();
  const std::size_t whole = room.bytes + kBytesOfProgram;
  room_ = whole < room.bytes ? room.bytes : whole;
  limited_by_ = room.limited_by;
  if (config.memory_limit_bytes && *config.memory_limit_bytes <= room_) {
    room_ = *config.memory_limit_bytes;
    limited_by_ = "--memory-limit";
  }
}

void MemoryEstimate::add_projection() {
  bytes_a_vertex_ += kBytesToProject;
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

void require_memory(const RasterGrid& grid, RasterType type) {
  const std::size_t size = type == RasterType::Byte ? 1 : type == RasterType::Float32 ? 4 : 8;
  const std::size_t needed = grid.columns * grid.rows * (sizeof(double) + 3 * size);
  const MemoryRoom room = memory_room();
  if (needed <= room.bytes) return;
  throw Error(
      ErrorCode::OutOfMemory,
      fmt::format("{} x {} cells need about {} of memory, and {} leaves {}; choose a larger "
                  "--resolution, or a part with --extent",
                  grid.columns, grid.rows, in_mebibytes(needed), room.limited_by, in_mebibytes(room.bytes)));
}

}  // namespace thalweg
