#include "fuzz/laws.hpp"

#include "fuzz/target.hpp"
#include "pipeline/plane.hpp"

#include <thalweg/mesh/validate.hpp>
#include <thalweg/verify/verify.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace thalweg::fuzz {

namespace {

verify::PitsClaim claim_of(const ReportPits& pits) {
  return {.interior = pits.interior, .boundary = pits.boundary, .lake = pits.lake};
}

verify::Claims claims_of(const Report& report) {
  verify::Claims claims;
  claims.digest = report.digest;
  claims.vertices = report.tin.vertices;
  claims.triangles = report.tin.triangles;
  claims.edges = report.tin.edges;
  claims.constraint_edges = report.tin.constraint_edges;
  if (!report.higher_order) {
    claims.quadrilaterals = report.first_order.quadrilaterals;
    claims.flipped = report.first_order.flipped;
  }
  if (report.simplification) claims.barred = report.simplification->barred_diagonals;
  for (const ReportCriterion& c : report.criteria) {
    claims.criteria.push_back({c.name, c.delaunay, c.result, c.bound, c.optimal});
  }
  claims.pits_delaunay = claim_of(report.pits_delaunay);
  claims.pits_result = claim_of(report.pits_result);
  return claims;
}

}  // namespace

void check_built(const BuiltTin& built, OrderDefinition definition) {
  for (const Violation& violation : validate(built.tin, {}, IsolatedVertices::Report)) {
    throw Finding("law " + std::to_string(violation.code) + ": " + violation.what);
  }
  const Report& report = built.report;
  const auto constraints = built.tin.constraint_edges();
  const Plane plane(built.crs, report.crs.metric_projection);
  const std::vector<Point2> continuous =
      plane.projected() ? plane.to_lonlat(built.written) : std::vector<Point2>();
  const verify::Subject subject{
      .points = built.tin.points(),
      .written = built.written,
      .continuous = continuous,
      .heights = built.tin.heights(),
      .triangles = built.tin.triangles(),
      .constraints = constraints,
      .horizontal_metres_per_unit = report.crs.horizontal_metres_per_unit,
      .vertical_metres_per_unit = report.crs.vertical_metres_per_unit,
      .definition = definition,
      .order = std::max({report.tin.max_order, report.first_order.quadrilaterals > 0 ? 1U : 0U,
                         report.higher_order ? report.higher_order->order : 0U})};
  Progress progress;
  for (const verify::Finding& finding : verify::check(subject, claims_of(report), progress)) {
    if (finding.verdict == verify::Verdict::Broken) throw Finding(finding.claim + ": " + finding.detail);
  }
}

std::optional<ErrorCode> error_of(void (*work)(void*), void* context) {
  try {
    work(context);
    return {};
  } catch (const Error& error) {
    const std::string_view what = error.what();
    if (error.code() == ErrorCode::Internal) throw Finding("internal: " + std::string(what));
    if (what.empty()) throw Finding("an error says nothing");
    return error.code();
  }
}

}  // namespace thalweg::fuzz
