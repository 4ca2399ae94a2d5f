#pragma once

/// Writing a TIN as a mesh or as vector layers.

#include <thalweg/base/progress.hpp>
#include <thalweg/io/format_info.hpp>
#include <thalweg/io/pending_outputs.hpp>
#include <thalweg/mesh/survey.hpp>
#include <thalweg/mesh/tin.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace thalweg {

/// A value for every vertex, or for every edge in the order of the halfedges that represent them; NaN: none.
/// UGRID and GeoPackage hold such values; other formats do not.
struct TinAttribute {
  std::string name;         ///< a word, as "upstream_area"
  std::string description;  ///< for people, with what NaN says
  std::string unit;         ///< "m2"; "1" for numbers and codes
  std::vector<double> values;
};

/// A TIN and what is known about it. Spans may be empty (not known), else they have one value an element.
struct TinView {
  const Tin& tin;
  std::span<const Point2> written_xy =
      {};                          ///< coordinates to write instead of tin.points(): those that came in
  std::string crs_wkt = {};        ///< CRS of the written coordinates, or empty
  std::string crs_authority = {};  ///< "EPSG:n", or empty
  std::span<const std::uint8_t> is_pit = {};
  std::span<const std::uint8_t> vertex_source = {};  ///< 0 point, 1 line vertex, 2 crossing
  std::span<const std::uint16_t> triangle_orders = {};
  std::optional<std::span<const Conflict>> conflicts = {};  ///< none: not known; no layer of them then
  std::span<const TinAttribute> vertex_attributes = {};
  std::span<const TinAttribute> edge_attributes = {};
};

struct WriteOptions {
  std::string format = {};  ///< a name of `tin_formats`, any case; empty: by the path's extension
  std::vector<std::string> creation_options = {};  ///< "KEY=VALUE", any case of key
};

/// Throws what `write_tin` would throw for a format, extension or creation option that is not known: so that
/// a long run can say so before it starts. Throws: also Error{Unsupported} if the path is a stream
/// (`is_stream`), and the format needs a file.
void check_write_options(const std::string& path, const WriteOptions& options);

/// Writes the TIN, and a sidecar NAME.prj where the format cannot hold the CRS.
///
/// Coordinates and heights read back as the same doubles in every text and binary format. Equal input gives
/// equal bytes. Vertex ids are the TIN's (2DM and OBJ count from 1). The files appear when `pending` is
/// committed. Throws: Error{Usage} for an unknown format, extension or creation option, listing the known
/// ones; what `PendingOutputs::add` throws; Error{WriteFailed} if not every byte could be written (disk
/// full); Error{Cancelled}. Complexity: linear; memory O(1) beyond the TIN, except for a list of the edges.
void write_tin(const std::string& path, const TinView& view, const WriteOptions& options,
               PendingOutputs& pending, Overwrite mode, Progress& progress);

/// All formats of TIN files that are read or written.
std::span<const FormatInfo> tin_formats();

}  // namespace thalweg
