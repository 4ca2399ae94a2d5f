// Reading CRS definitions.
//
// 1. OGRSpatialReference understands the definition (without asking the network) and tells the kind, the
//    horizontal unit and the ellipsoid.
// 2. The unit of heights stands in the coordinate system of the vertical part, which OGRSpatialReference
//    shows only for compound CRSs; PROJJSON shows it always: the last axis, if there are three, or the
//    vertical component.
#include "io/gdal_session.hpp"
#include "io/spatial_reference.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/geodesy/geodesic.hpp>
#include <thalweg/io/crs.hpp>

#include <cpl_conv.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace thalweg {

namespace {

using Json = nlohmann::json;

struct FreeCpl {
  void operator()(char* text) const { CPLFree(text); }
};
using CplText = std::unique_ptr<char, FreeCpl>;

/// The axes of a CRS, those of all components one after the other.
void collect_axes(const Json& crs, Json& axes) {
  if (crs.contains("source_crs")) return collect_axes(crs["source_crs"], axes);
  if (crs.contains("components")) {
    for (const Json& component : crs["components"]) collect_axes(component, axes);
  }
  if (!crs.contains("coordinate_system")) return;
  for (const Json& axis : crs["coordinate_system"]["axis"]) axes.push_back(axis);
}

std::optional<double> vertical_unit(const OGRSpatialReference& reference) {
  char* text = nullptr;
  reference.exportToPROJJSON(&text, nullptr);
  const CplText owned(text);
  if (text == nullptr) return std::nullopt;
  const Json crs = Json::parse(text, nullptr, false);
  if (crs.is_discarded()) return std::nullopt;
  Json axes = Json::array();
  collect_axes(crs, axes);
  if (axes.size() < 3 || !axes[2].contains("unit")) return std::nullopt;
  const Json& unit = axes[2]["unit"];
  if (unit == "metre") return 1;
  if (!unit.is_object() || !unit.contains("conversion_factor")) return std::nullopt;
  return unit["conversion_factor"].get<double>();
}

std::string authority_of(const OGRSpatialReference& reference) {
  const auto code_of = [](const OGRSpatialReference& crs) -> std::string {
    const char* name = crs.GetAuthorityName(nullptr);
    const char* code = crs.GetAuthorityCode(nullptr);
    return name != nullptr && code != nullptr ? std::string(name) + ":" + code : std::string();
  };
  std::string authority = code_of(reference);
  if (!authority.empty()) return authority;
  // 90 of 100 and more: same name and equivalent definition; the limit that GDAL's own drivers use.
  constexpr int kSure = 90;
  int count = 0;
  int* confidence = nullptr;
  OGRSpatialReferenceH* matches = reference.FindMatches(nullptr, &count, &confidence);
  if (count == 1 && confidence[0] >= kSure) authority = code_of(*OGRSpatialReference::FromHandle(matches[0]));
  OSRFreeSRSArray(matches);
  CPLFree(confidence);
  return authority;
}

/// Definitions hold angles and angular units with 15 digits: 12 digits of their degrees are sure.
double round_degrees(double degrees) {
  constexpr double kDigits = 1e12;
  return std::round(degrees * kDigits) / kDigits;
}

std::string to_wkt(const OGRSpatialReference& reference) {
  const char* const options[] = {"FORMAT=WKT2_2019", "MULTILINE=NO", nullptr};
  char* text = nullptr;
  const OGRErr error = reference.exportToWkt(&text, options);
  const CplText owned(text);
  return error == OGRERR_NONE && text != nullptr ? text : "";
}

}  // namespace

OGRSpatialReference parse_reference(const std::string& definition) {
  GdalSession session;
  OGRSpatialReference reference;
  const char* const options[] = {"ALLOW_NETWORK_ACCESS=NO", "ALLOW_FILE_ACCESS=YES", nullptr};
  if (reference.SetFromUserInput(definition.c_str(), options) != OGRERR_NONE) {
    throw Error(ErrorCode::BadCrs, "CRS \"" + definition + "\" is not understood" + session.reason() +
                                       "; give EPSG:n, WKT, a PROJ string or a .prj file");
  }
  reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return reference;
}

bool means_same_crs(const OGRSpatialReference& a, const OGRSpatialReference& b) {
  const char* const options[] = {"IGNORE_DATA_AXIS_TO_SRS_AXIS_MAPPING=YES",
                                 "CRITERION=EQUIVALENT_EXCEPT_AXIS_ORDER_GEOGCRS", nullptr};
  if (a.IsSame(&b, options) != 0) return true;
  // Esri's dialect does not tell the order of a projected CRS's axes.
  const std::string authority = authority_of(a);
  return !authority.empty() && authority == authority_of(b);
}

bool means_same_crs(const std::string& a, const std::string& b) {
  if (a == b) return true;
  try {
    return means_same_crs(parse_reference(a), parse_reference(b));
  } catch (const Error&) {
    return false;
  }
}

bool is_same_unit(double a, double b) {
  constexpr double kRelative = 1e-9;
  return std::abs(a / b - 1) < kRelative;
}

std::optional<OGRSpatialReference> with_heights_in(const OGRSpatialReference& plane, double metres_per_unit) {
  const auto is = [metres_per_unit](double unit) { return is_same_unit(metres_per_unit, unit); };
  const char* const name = is(1)               ? "metre"
                           : is(0.3048)        ? "foot"
                           : is(1200.0 / 3937) ? "US survey foot"
                                               : "unit of heights";
  const OGRSpatialReference heights =
      parse_reference(fmt::format("VERTCRS[\"height ({0})\",VDATUM[\"unknown\"],CS[vertical,1],"
                                  "AXIS[\"gravity-related height (H)\",up],LENGTHUNIT[\"{0}\",{1}]]",
                                  name, metres_per_unit));
  OGRSpatialReference compound;
  const std::string both = fmt::format("{} + height ({})", plane.GetName(), name);
  if (compound.SetCompoundCS(both.c_str(), &plane, &heights) != OGRERR_NONE) return std::nullopt;
  compound.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return compound;
}

bool means_none(const OGRSpatialReference& reference) {
  const char* const name = reference.GetName();  // null of one that is empty
  return name != nullptr && std::string_view(name).starts_with("Undefined");
}

OGRSpatialReference horizontal_part(const OGRSpatialReference& reference) {
  OGRSpatialReference part(reference);
  if (part.IsCompound()) {
    part.StripVertical();
  } else if (part.GetAxesCount() == 3) {
    part.DemoteTo2D(nullptr);
  }
  part.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return part;
}

CrsInfo describe_reference(const OGRSpatialReference& reference, const std::string& origin) {
  CrsInfo info;
  if (reference.IsEmpty()) return info;
  GdalSession session;
  const bool planar = reference.IsProjected() || reference.IsLocal();
  if (reference.IsGeocentric() || (!planar && !reference.IsGeographic())) {
    throw Error(ErrorCode::BadCrs, "the CRS of " + origin +
                                       " has no plane of east and north; give a projected or geographic one");
  }
  info.known = true;
  info.wkt = to_wkt(reference);
  const char* name = reference.GetName();
  info.name = name != nullptr ? name : "";
  if (info.name.empty() || info.name == "unknown") info.name = "(no name)";  // as of a PROJ string
  info.authority = authority_of(reference);
  info.geographic = !planar;
  if (info.geographic) {
    info.degrees_per_unit = round_degrees(reference.GetAngularUnits() * 180 / std::numbers::pi);
    info.prime_meridian_deg = round_degrees(reference.GetPrimeMeridian());
  } else {
    info.horizontal_metres_per_unit = reference.GetLinearUnits();
  }
  const std::optional<double> unit = vertical_unit(reference);
  info.vertical_unit_told = unit.has_value();
  info.vertical_metres_per_unit = unit.value_or(info.horizontal_metres_per_unit);
  OGRErr error = OGRERR_NONE;
  const double radius = reference.GetSemiMajor(&error);
  if (error == OGRERR_NONE) {
    const double inverse_flattening = reference.GetInvFlattening();
    info.equatorial_radius_m = radius;
    info.flattening = inverse_flattening > 0 ? 1 / inverse_flattening : 0;
  }
  return info;
}

std::optional<CrsScale> scale_at(const CrsInfo& crs, Point2 place) {
  if (!crs.known || crs.geographic) return std::nullopt;
  const OGRSpatialReference plane = horizontal_part(parse_reference(crs.wkt));
  GdalSession session;
  OGRSpatialReference angles;
  if (!plane.IsProjected() || angles.CopyGeogCSFrom(&plane) != OGRERR_NONE) return std::nullopt;
  angles.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::unique_ptr<OGRCoordinateTransformation> way(OGRCreateCoordinateTransformation(&plane, &angles));
  if (!way) return std::nullopt;
  constexpr double kStep = 100;  // metres, to each side
  const double step = kStep / crs.horizontal_metres_per_unit;
  std::array<double, 5> x{place.x, place.x - step, place.x + step, place.x, place.x};
  std::array<double, 5> y{place.y, place.y, place.y, place.y - step, place.y + step};
  if (way->Transform(static_cast<int>(x.size()), x.data(), y.data()) == 0) return std::nullopt;
  const double degrees = angles.GetAngularUnits() * 180 / std::numbers::pi;
  std::vector<Point2> lonlat;
  for (std::size_t i = 0; i < x.size(); ++i) {
    lonlat.push_back({x[i] * degrees + angles.GetPrimeMeridian(), y[i] * degrees});
  }
  const auto lengths = geodesic_lengths_m(
      lonlat, std::vector{std::pair(VertexId{1}, VertexId{2}), std::pair(VertexId{3}, VertexId{4})},
      {crs.equatorial_radius_m, crs.flattening});
  if (!(lengths[0] > 0 && lengths[1] > 0)) return std::nullopt;
  return CrsScale{lonlat[0], 2 * kStep / lengths[0], 2 * kStep / lengths[1]};
}

CrsInfo describe_crs(const std::string& definition) {
  if (definition.empty()) return {};
  return describe_reference(parse_reference(definition), "definition \"" + definition + "\"");
}

}  // namespace thalweg
