#pragma once

/// Reading a TIN from a mesh file or from vector layers.

#include <thalweg/base/progress.hpp>
#include <thalweg/geometry/point.hpp>
#include <thalweg/mesh/tin.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace thalweg {

/// The content of a TIN file, as it stands there: ids count from 0 in the file's order, triangles are not
/// checked beyond their ids being in range.
struct TinFile {
  std::vector<Point2> points;
  std::vector<double> heights;
  std::vector<Triangle> triangles;
  std::vector<ConstraintEdge> constraints;
  std::vector<std::uint16_t> triangle_orders;  ///< one a triangle, or empty
  std::vector<std::uint8_t> vertex_source;     ///< as in TinView; or empty
  std::string crs;                 ///< "EPSG:n", the WKT that the file or its sidecar holds, or empty
  std::vector<std::string> notes;  ///< what was left out or taken otherwise than it stands there
};

/// Reads PLY (ascii, binary of either endianness; unknown elements and properties are skipped), 2DM, OBJ,
/// OFF, STL, UGRID, LandXML, and GPKG as written by `write_tin`. The content decides the format, not the
/// extension. Heights come in the unit that the CRS tells, upwards. Lines of other programs are breaklines as
/// far as they run along edges. Triangles that are all clockwise are turned. Throws: Error{NotFound},
/// Error{Unreadable}; Error{BadFormat} naming the line, offset or feature; Error{BadCoordinate} for values
/// that are not finite; Error{WrongGeometry} for faces with other than three corners; Error{Unsupported} if
/// no format is recognised; Error{Cancelled}. Memory is bounded by the file's size, whatever counts it
/// claims.
TinFile read_tin(const std::string& path, Progress& progress);

}  // namespace thalweg
