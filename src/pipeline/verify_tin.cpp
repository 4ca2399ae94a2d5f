// Files and claims for the verifier; nothing is decided here.
#include "base/printable.hpp"
#include "pipeline/plane.hpp"
#include "pipeline/reference.hpp"
#include "pipeline/verify_sources.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/io/read_tin.hpp>
#include <thalweg/pipeline/verify_tin.hpp>
#include <thalweg/verify/sources.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

namespace thalweg {

namespace {

using Json = nlohmann::ordered_json;
using verify::Finding;
using verify::Verdict;

Json read_report(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(ErrorCode::NotFound, path + " cannot be opened; give the report of a build");
  try {
    Json report = Json::parse(file);
    if (!report.is_object() || !report.contains("thalweg")) {
      throw Error(ErrorCode::BadFormat, path + " is no report of this program; give what --report wrote");
    }
    return report;
  } catch (const Json::exception& error) {
    throw Error(ErrorCode::BadFormat, path + " is no JSON: " + error.what());
  }
}

template <class T>
std::optional<T> read(const Json& report, const std::string& pointer) {
  const Json::json_pointer at(pointer);
  if (!report.contains(at) || report.at(at).is_null()) return std::nullopt;
  return report.at(at).get<T>();
}

std::optional<verify::PitsClaim> read_pits(const Json& report, const std::string& which) {
  const auto interior = read<std::size_t>(report, "/pits/" + which + "/interior");
  if (!interior) return std::nullopt;
  return verify::PitsClaim{.interior = *interior,
                           .boundary = read<std::size_t>(report, "/pits/" + which + "/boundary").value_or(0),
                           .lake = read<std::size_t>(report, "/pits/" + which + "/lake").value_or(0)};
}

verify::Claims read_claims(const Json& report) {
  verify::Claims claims;
  claims.digest = read<std::string>(report, "/digest");
  claims.vertices = read<std::size_t>(report, "/tin/vertices");
  claims.triangles = read<std::size_t>(report, "/tin/triangles");
  claims.edges = read<std::size_t>(report, "/tin/edges");
  claims.constraint_edges = read<std::size_t>(report, "/tin/constraint_edges");
  claims.quadrilaterals = read<std::size_t>(report, "/first_order/quadrilaterals");
  claims.barred = read<std::size_t>(report, "/simplification/barred_diagonals").value_or(0);
  claims.flipped = read<std::size_t>(report, "/first_order/flipped");
  claims.max_order = read<std::size_t>(report, "/tin/max_order");
  claims.order_histogram = read<std::vector<std::size_t>>(report, "/higher_order/order_histogram")
                               .value_or(claims.order_histogram);
  for (const Json& c : report.value("criteria", Json::array())) {
    claims.criteria.push_back({.name = c.at("name").get<std::string>(),
                               .delaunay = c.at("delaunay").get<double>(),
                               .result = c.at("result").get<double>(),
                               .bound = c.at("bound").get<double>(),
                               .optimal = c.at("optimal").get<bool>()});
  }
  claims.pits_delaunay = read_pits(report, "delaunay");
  claims.pits_result = read_pits(report, "result");
  return claims;
}

/// The largest order that the report allows: one with first-order quadrilaterals allows 1.
unsigned order_of(const Json& report) {
  const auto order = read<unsigned>(report, "/tin/max_order").value_or(1);
  const bool first_order = read<std::size_t>(report, "/first_order/quadrilaterals").value_or(0) > 0;
  return std::max({order, first_order ? 1U : 0U, read<unsigned>(report, "/higher_order/order").value_or(0)});
}

/// What the report says of the sources.
void read_source_claims(const Json& report, const Plane& plane, verify::Sources& sources) {
  sources.conflicts.emplace();
  for (const Json& c : report.value("conflicts", Json::array())) {
    Conflict conflict;
    conflict.xy = plane.to_plane(Point2{c.at("x").get<double>(), c.at("y").get<double>()});
    conflict.z_a = c.at("z_a").get<double>();
    conflict.z_b = c.at("z_b").get<double>();
    conflict.z_used = c.at("z_used").get<double>();
    sources.conflicts->push_back(conflict);
  }
  for (const Json& c : read<Json>(report, "/conditioned/changes").value_or(Json::array())) {
    sources.conditioned.push_back(
        {.xy = plane.to_plane(Point2{c.at("x").get<double>(), c.at("y").get<double>()}),
         .before = c.at("z_before").get<double>(),
         .after = c.at("z_after").get<double>()});
  }
  sources.positions_left_out = read<std::size_t>(report, "/input/outside_boundary").value_or(0) +
                               read<std::size_t>(report, "/tin/vertices_left_out").value_or(0);
  if (const auto error = read<double>(report, "/simplification/largest_error_m/result")) {
    sources.largest_error = *error / plane.vertical_metres_per_unit();
  }
  sources.is_cut = sources.is_cut || read<std::size_t>(report, "/tin/dropped_rim_triangles").value_or(0) > 0;
}

std::vector<Finding> check_sources_of(const VerifyConfig& config, const TinFile& file, const Plane& plane,
                                      const std::optional<Json>& report, const verify::Subject& subject,
                                      Progress& progress) {
  progress.start_phase("read sources");
  const ReadResult read_in = read_survey(config.points, config.lines, config.read, progress);
  const CrsInfo crs = describe_crs(file.crs);
  if (crs.known && read_in.crs.known && !means_same_crs(crs.wkt, read_in.crs.wkt)) {
    throw Error(ErrorCode::BadCrs, "the sources are in " + read_in.crs.name + ", the TIN is in " + crs.name +
                                       "; give --s-crs, --t-crs or --a-crs as to build");
  }
  const double pixel = report ? read<double>(*report, "/input/snapping_pixel").value_or(0) : 0;
  verify::Sources sources = sources_in_plane(read_in.survey, plane, pixel, progress);
  sources.snap = config.snap_m / plane.metres_per_unit();
  if (report) read_source_claims(*report, plane, sources);
  return verify::check_sources(subject, sources, progress);
}

std::string_view verdict_name(Verdict verdict) {
  switch (verdict) {
    case Verdict::Holds:
      return "holds";
    case Verdict::Broken:
      return "BROKEN";
    case Verdict::NotChecked:
      break;
  }
  return "not checked";
}

}  // namespace

bool VerifyResult::holds() const {
  return std::none_of(findings.begin(), findings.end(),
                      [](const Finding& finding) { return finding.verdict == Verdict::Broken; });
}

VerifyResult verify_tin(const VerifyConfig& config, Progress& progress) {
  progress.start_phase("read");
  const TinFile file = read_tin(config.input, progress);
  const CrsInfo crs = describe_crs(file.crs);
  std::optional<Json> report;
  if (!config.report_path.empty()) report = read_report(config.report_path);
  try {
    const auto proj_string = report ? read<std::string>(*report, "/crs/metric_projection") : std::nullopt;
    const Plane plane = proj_string ? Plane(crs, *proj_string) : Plane(crs, file.points);
    const std::vector<Point2> points = plane.to_plane(file.points, progress);
    const std::vector<Point2> continuous =
        plane.projected() ? plane.to_lonlat(file.points) : std::vector<Point2>();
    ReferencePoints reference;
    if (config.reference) reference = read_reference(*config.reference, crs, plane, progress);
    verify::Claims claims = report ? read_claims(*report) : verify::Claims();
    if (report) claims.orders = file.triangle_orders;  // under the definition that the report names
    const auto against_reference = [](const auto& claim) { return claim.name == "vertical-error"; };
    if (config.reference && std::none_of(claims.criteria.begin(), claims.criteria.end(), against_reference)) {
      throw Error(ErrorCode::Usage,
                  "--reference serves vertical-error, of which no --report claims anything");
    }
    if (!config.proof_path.empty()) {
      std::ifstream proof(config.proof_path, std::ios::binary);
      if (!proof)
        throw Error(ErrorCode::NotFound, config.proof_path + " cannot be opened; give what --proof wrote");
      claims.proof = verify::read_proof(proof, config.proof_path);
    }
    verify::Subject subject{.points = points,
                            .written = file.points,
                            .continuous = continuous,
                            .heights = file.heights,
                            .triangles = file.triangles,
                            .constraints = file.constraints,
                            .reference_points = reference.points,
                            .reference_heights = reference.heights,
                            .horizontal_metres_per_unit = plane.metres_per_unit(),
                            .vertical_metres_per_unit = plane.vertical_metres_per_unit()};
    if (report) {
      subject.order = order_of(*report);
      auto name = read<std::string>(*report, "/first_order/definition");
      if (!name) name = read<std::string>(*report, "/higher_order/definition");
      if (name && !name->empty()) subject.definition = parse_definition(*name);
    }
    if (config.order) subject.order = *config.order;
    if (config.definition) subject.definition = *config.definition;
    VerifyResult result{config.input, verify::check(subject, claims, progress)};
    if (!config.points.empty() || !config.lines.empty()) {
      std::vector<Finding> more = check_sources_of(config, file, plane, report, subject, progress);
      result.findings.insert(result.findings.end(), std::make_move_iterator(more.begin()),
                             std::make_move_iterator(more.end()));
    }
    return result;
  } catch (const Json::exception& error) {
    throw Error(ErrorCode::BadFormat,
                config.report_path + ": a key does not hold what it should: " + error.what());
  }
}

std::string to_json(const VerifyResult& result) {
  Json lines = Json::array();
  for (const Finding& f : result.findings) {
    const std::string_view verdict = f.verdict == Verdict::Broken ? "broken" : verdict_name(f.verdict);
    lines.push_back({{"claim", f.claim}, {"verdict", verdict}, {"detail", f.detail}});
  }
  const Json json = {{"path", result.path}, {"holds", result.holds()}, {"findings", lines}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string to_text(const VerifyResult& result) {
  std::size_t width = 0, broken = 0, unchecked = 0;
  for (const Finding& f : result.findings) width = std::max(width, f.claim.size());
  std::string text;
  for (const Finding& f : result.findings) {
    broken += f.verdict == Verdict::Broken ? 1 : 0;
    unchecked += f.verdict == Verdict::NotChecked ? 1 : 0;
    const std::string line =
        fmt::format("{:<{}}  {:<11}  {}", f.claim, width, verdict_name(f.verdict), printable(f.detail));
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  text += fmt::format("{}: {} claims hold, {} broken, {} not checked\n", result.path,
                      result.findings.size() - broken - unchecked, broken, unchecked);
  return text;
}

}  // namespace thalweg
