#pragma once

/// Lengths of the rim and of constraint edges.

#include "pipeline/plane.hpp"

#include <thalweg/mesh/tin.hpp>
#include <thalweg/pipeline/report.hpp>

#include <nlohmann/json_fwd.hpp>

#include <span>
#include <string>

namespace thalweg {

/// In the plane of the TIN.
ReportLengths plane_lengths(const Tin& tin, double metres_per_unit);
/// On the ellipsoid, along geodesics. Pre: one longitude and latitude, in degrees, a vertex.
ReportLengths geodesic_lengths(const Tin& tin, std::span<const Point2> lonlat_deg, Ellipsoid ellipsoid);

/// {"rim": metres, "breakline": metres, ...}, all kinds in the order of their bits.
nlohmann::ordered_json lengths_json(const ReportLengths& lengths);
/// "rim 812.3, valley 95.1": the kinds that there are.
std::string lengths_text(const ReportLengths& lengths);

}  // namespace thalweg
