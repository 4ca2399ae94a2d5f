#pragma once

/// The points of compressed LAS files (LAZ), by PDAL where Thalweg was built with it.

#include <thalweg/io/format_info.hpp>

#include <array>
#include <cstdint>
#include <functional>
#include <string>

namespace thalweg {

/// One point of a LAS file, whatever the format of its record.
struct LasRecord {
  std::array<std::int32_t, 3> xyz{};  ///< before scale and offset
  unsigned return_number = 0;
  unsigned returns = 0;
  unsigned point_class = 0;
  bool is_withheld = false;
};

/// What of a file's header has to be known.
struct LazHeader {
  std::array<double, 3> scale{};
  std::array<double, 3> offset{};
  bool has_new_format = false;  ///< point formats 6 to 10
};

/// Gives each point to `take`, in file order; what that throws comes out. Throws: Error{Unsupported} where
/// `reads_laz` is false, with the remedy; Error{BadFormat} with PDAL's words.
void read_laz(const std::string& path, const LazHeader& header,
              const std::function<void(const LasRecord&)>& take);

}  // namespace thalweg
