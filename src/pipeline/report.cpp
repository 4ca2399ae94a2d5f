// The report as JSON and as text. Both are views of the same struct; nothing is computed here.
#include <thalweg/pipeline/report.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <iterator>
#include <string>
#include <string_view>

namespace thalweg {

namespace {

using Json = nlohmann::ordered_json;

std::string_view conflict_name(Conflict::Kind kind) {
  switch (kind) {
    case Conflict::Kind::DuplicatePoint:
      return "duplicate-point";
    case Conflict::Kind::PointOnLine:
      return "point-on-line";
    case Conflict::Kind::LineVertex:
      return "line-vertex";
    case Conflict::Kind::Crossing:
      return "crossing";
    case Conflict::Kind::Lake:
      return "lake";
  }
  return "crossing";
}

Json conflicts_json(const std::vector<Conflict>& conflicts) {
  Json list = Json::array();
  for (const Conflict& c : conflicts) {
    list.push_back({{"kind", conflict_name(c.kind)},
                    {"x", c.xy.x},
                    {"y", c.xy.y},
                    {"z_a", c.z_a},
                    {"z_b", c.z_b},
                    {"z_used", c.z_used},
                    {"source_a", c.source_a},
                    {"source_b", c.source_b}});
  }
  return list;
}

Json input_json(const ReportInput& input) {
  return {{"points_read", input.points_read},
          {"points_used", input.points_used},
          {"duplicates_merged", input.duplicates_merged},
          {"outside_boundary", input.outside_boundary},
          {"nodata_skipped", input.nodata_skipped},
          {"nodata_holes_bridged", input.nodata_holes_bridged},
          {"breaklines_read", input.breaklines_read},
          {"breakline_vertices", input.breakline_vertices},
          {"crossings", input.crossings},
          {"lakes", input.lakes},
          {"points_in_lakes", input.points_in_lakes},
          {"vertices_inserted_on_lines", input.vertices_inserted_on_lines},
          {"snapping_pixel", input.snapping_pixel}};
}

Json tin_json(const ReportTin& tin) {
  return {{"vertices", tin.vertices},
          {"triangles", tin.triangles},
          {"edges", tin.edges},
          {"constraint_edges", tin.constraint_edges},
          {"hull_vertices", tin.hull_vertices},
          {"dropped_rim_triangles", tin.dropped_rim_triangles},
          {"vertices_left_out", tin.vertices_left_out},
          {"area_m2", tin.area_m2},
          {"area_geodesic_m2", tin.area_geodesic_m2 ? Json(*tin.area_geodesic_m2) : Json(nullptr)},
          {"min_angle_deg", tin.min_angle_deg},
          {"angle_histogram", tin.angle_histogram},
          {"angle_histogram_delaunay", tin.angle_histogram_delaunay},
          {"flat_triangles", tin.flat_triangles},
          {"max_order", tin.max_order}};
}

Json criteria_json(const std::vector<ReportCriterion>& criteria) {
  Json list = Json::array();
  for (const ReportCriterion& c : criteria) {
    list.push_back({{"name", c.name},
                    {"unit", c.unit},
                    {"direction", c.direction},
                    {"delaunay", c.delaunay},
                    {"result", c.result},
                    {"bound", c.bound},
                    {"optimal", c.optimal},
                    {"method", c.method}});
  }
  return list;
}

Json simplification_json(const ReportSimplification& s) {
  const auto pair = [](const std::array<double, 2>& value) {
    return Json{{"delaunay", value[0]}, {"result", value[1]}};
  };
  return {{"max_error_m", s.max_error_m ? Json(*s.max_error_m) : Json(nullptr)},
          {"max_points", s.max_points ? Json(*s.max_points) : Json(nullptr)},
          {"stopped_by", s.stopped_by},
          {"source_points", s.source_points},
          {"fixed_vertices", s.fixed_vertices},
          {"inserted_vertices", s.inserted_vertices},
          {"barred_diagonals", s.barred_diagonals},
          {"largest_error_m", pair(s.largest_error_m)},
          {"rms_error_m", pair(s.rms_error_m)}};
}

Json first_order_json(const ReportFirstOrder& first) {
  return {{"definition", first.definition},
          {"quadrilaterals", first.quadrilaterals},
          {"flipped", first.flipped},
          {"fixed_by_elimination", first.fixed_by_elimination},
          {"pieces", first.pieces},
          {"largest_piece", first.largest_piece},
          {"width", first.width}};
}

Json higher_order_json(const ReportHigherOrder& higher) {
  return {{"definition", higher.definition},
          {"order", higher.order},
          {"faces", higher.faces},
          {"partial_faces", higher.partial_faces},
          {"largest_face", higher.largest_face},
          {"labels", higher.labels},
          {"most_labels", higher.most_labels},
          {"new_edges", higher.new_edges},
          {"order_histogram", higher.order_histogram},
          {"fixed_by_elimination", higher.fixed_by_elimination},
          {"pieces", higher.pieces},
          {"largest_piece", higher.largest_piece},
          {"width", higher.width}};
}

Json pits_json(const ReportPits& pits) {
  return {{"interior", pits.interior}, {"boundary", pits.boundary}, {"lake", pits.lake}};
}

}  // namespace

std::string version() {
  return THALWEG_VERSION;
}

std::string to_json(const Report& report) {
  const PhaseSeconds& s = report.timings_s;
  const Json json = {
      {"thalweg", {{"version", version()}, {"command", report.command}}},
      {"digest", report.digest},
      {"input", input_json(report.input)},
      {"conflicts", conflicts_json(report.conflicts)},
      {"crs",
       {{"wkt", report.crs.wkt},
        {"metric_projection", report.crs.metric_projection},
        {"horizontal_metres_per_unit", report.crs.horizontal_metres_per_unit},
        {"vertical_metres_per_unit", report.crs.vertical_metres_per_unit}}},
      {"tin", tin_json(report.tin)},
      {"simplification", report.simplification ? simplification_json(*report.simplification) : Json(nullptr)},
      {"first_order", report.higher_order ? Json(nullptr) : first_order_json(report.first_order)},
      {"higher_order", report.higher_order ? higher_order_json(*report.higher_order) : Json(nullptr)},
      {"arithmetic", "each term is rounded once to an integer multiple of 2^-32 of its unit; sums are exact"},
      {"criteria", criteria_json(report.criteria)},
      {"pits", {{"delaunay", pits_json(report.pits_delaunay)}, {"result", pits_json(report.pits_result)}}},
      {"timings_s",
       {{"read", s.read},
        {"triangulate", s.triangulate},
        {"simplify", s.simplify},
        {"orders", s.orders},
        {"optimize", s.optimize},
        {"check", s.check},
        {"write", s.write},
        {"total", s.total}}},
      {"peak_memory_bytes", report.peak_memory_bytes},
      {"notes", report.notes}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

namespace {

void add_rows(std::string& text, const Report& r) {
  auto out = std::back_inserter(text);
  const auto row = [&](std::string_view name, std::string_view value) {
    fmt::format_to(out, "  {:<26}{:>16}\n", name, value);
  };
  const auto count = [&](std::string_view name, std::size_t value) { row(name, fmt::format("{}", value)); };
  const auto count_if_any = [&](std::string_view name, std::size_t value) {
    if (value > 0) count(name, value);
  };
  text += "Input\n";
  count("points read", r.input.points_read);
  count("points used", r.input.points_used);
  count_if_any("duplicates merged", r.input.duplicates_merged);
  count_if_any("outside the boundary", r.input.outside_boundary);
  count_if_any("nodata skipped", r.input.nodata_skipped);
  count_if_any("nodata holes bridged", r.input.nodata_holes_bridged);
  count_if_any("lines read", r.input.breaklines_read);
  count_if_any("line vertices", r.input.breakline_vertices);
  count_if_any("crossings", r.input.crossings);
  count_if_any("lakes", r.input.lakes);
  count_if_any("points that lakes level", r.input.points_in_lakes);
  count_if_any("height conflicts", r.conflicts.size());
  text += "TIN\n";
  count("vertices", r.tin.vertices);
  count("triangles", r.tin.triangles);
  count("constraint edges", r.tin.constraint_edges);
  count_if_any("dropped rim triangles", r.tin.dropped_rim_triangles);
  count_if_any("vertices left out", r.tin.vertices_left_out);
  row("area, m2", fmt::format("{:.1f}", r.tin.area_m2));
  row("smallest angle, degrees", fmt::format("{:.3f}", r.tin.min_angle_deg));
  count("flat triangles", r.tin.flat_triangles);
  if (r.simplification) {
    const ReportSimplification& s = *r.simplification;
    text += "Simplification\n";
    row("stopped by", s.stopped_by);
    count("source points", s.source_points);
    count("vertices of lines, outline", s.fixed_vertices);
    count("vertices inserted", s.inserted_vertices);
    count("diagonals barred", s.barred_diagonals);
    row("largest error, m", fmt::format("{:.4f}", s.largest_error_m[1]));
    row("rms error, m", fmt::format("{:.4f}", s.rms_error_m[1]));
  }
  if (r.higher_order) {
    text += fmt::format("Structure at order {}\n", r.higher_order->order);
    row("definition", r.higher_order->definition);
    count("faces", r.higher_order->faces);
    count_if_any("faces not listed whole", r.higher_order->partial_faces);
    count("largest face, triangles", r.higher_order->largest_face);
    count("labels", r.higher_order->labels);
    count("most labels of a face", r.higher_order->most_labels);
    count("new edges", r.higher_order->new_edges);
    row("triangles by order", fmt::format("{}", fmt::join(r.higher_order->order_histogram, " ")));
    count("fixed by elimination", r.higher_order->fixed_by_elimination);
    count("pieces left", r.higher_order->pieces);
    count("largest piece", r.higher_order->largest_piece);
    count("width", r.higher_order->width);
    return;
  }
  if (r.first_order.definition.empty()) return;
  text += "First-order structure\n";
  row("definition", r.first_order.definition);
  count("quadrilaterals", r.first_order.quadrilaterals);
  count("flipped diagonals", r.first_order.flipped);
  count("fixed by elimination", r.first_order.fixed_by_elimination);
  count("pieces left", r.first_order.pieces);
  count("largest piece", r.first_order.largest_piece);
  count("width", r.first_order.width);
}

}  // namespace

std::string to_text(const Report& r) {
  std::string text;
  auto out = std::back_inserter(text);
  add_rows(text, r);
  fmt::format_to(out, "{:<28}{:>16}{:>16}{:>16}  {}\n", "Criteria", "Delaunay", "result", "bound", "proof");
  const auto number = [](const ReportCriterion& c, double value) {
    return c.unit == "count" ? fmt::format("{:.0f}", value) : fmt::format("{:.4f}", value);
  };
  for (const ReportCriterion& c : r.criteria) {
    fmt::format_to(out, "  {:<26}{:>16}{:>16}{:>16}  {}\n", c.name, number(c, c.delaunay),
                   number(c, c.result), number(c, c.bound), c.optimal ? "optimal" : "not proved");
  }
  fmt::format_to(out, "  {:<26}{:>16}{:>16}\n", "pits", r.pits_delaunay.interior, r.pits_result.interior);
  fmt::format_to(out, "  {:<26}{:>16}{:>16}\n", "pits on the boundary", r.pits_delaunay.boundary,
                 r.pits_result.boundary);
  if (r.pits_delaunay.lake > 0) {
    fmt::format_to(out, "  {:<26}{:>16}{:>16}\n", "lakes without outlet", r.pits_delaunay.lake,
                   r.pits_result.lake);
  }
  const PhaseSeconds& s = r.timings_s;
  text += "Seconds\n";
  fmt::format_to(out,
                 "  read {:.2f}  triangulate {:.2f}  simplify {:.2f}  orders {:.2f}  optimize {:.2f}  check "
                 "{:.2f}  write {:.2f}"
                 "  total {:.2f}\n",
                 s.read, s.triangulate, s.simplify, s.orders, s.optimize, s.check, s.write, s.total);
  fmt::format_to(out, "  peak memory {:.0f} MiB\n", static_cast<double>(r.peak_memory_bytes) / 0x1p20);
  for (const std::string& note : r.notes) fmt::format_to(out, "Note: {}\n", note);
  return text;
}

}  // namespace thalweg
