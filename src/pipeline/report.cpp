// The report as JSON and as text. Both are views of the same struct; nothing is computed here.
#include "base/printable.hpp"
#include "pipeline/lengths.hpp"
#include "pipeline/water_json.hpp"

#include <thalweg/mesh/conflict_name.hpp>
#include <thalweg/pipeline/report.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <iterator>
#include <string>
#include <string_view>

namespace thalweg {

namespace {

using Json = nlohmann::ordered_json;

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
          {"outside_bbox", input.outside_bbox},
          {"nodata_skipped", input.nodata_skipped},
          {"nodata_holes_bridged", input.nodata_holes_bridged},
          {"nodata_cells_bridged", input.nodata_cells_bridged},
          {"breaklines_read", input.breaklines_read},
          {"breakline_vertices", input.breakline_vertices},
          {"lines_outside_bbox", input.lines_outside_bbox},
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
          {"lengths_m", lengths_json(tin.lengths)},
          {"lengths_geodesic_m", tin.lengths_geodesic ? lengths_json(*tin.lengths_geodesic) : Json(nullptr)},
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
          {"over", higher.only_flips ? "flips" : "all"},
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

Json conditioned_json(const ReportConditioned& conditioned) {
  Json json = condition_json(conditioned.figures);
  json["steps"] = conditioned.steps;
  Json& changes = json["changes"] = Json::array();
  for (const ReportChange& c : conditioned.changes) {
    changes.push_back({{"vertex", c.vertex},
                       {"x", c.x},
                       {"y", c.y},
                       {"z_before", c.before},
                       {"z_after", c.after},
                       {"step", c.step}});
  }
  return json;
}

Json consistency_pair(const ReportConsistency& consistency) {
  return {{"delaunay", consistency_json(consistency.delaunay)},
          {"result", consistency_json(consistency.result)}};
}

}  // namespace

std::string version() {
  return THALWEG_VERSION;
}

std::string to_json(const Report& report) {
  const PhaseSeconds& s = report.timings_s;
  const Json json = {
      {"thalweg", {{"version", version()}, {"command", report.command}, {"engine", report.engine}}},
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
      {"arithmetic",
       "each term is rounded once to an integer multiple of 2^-32 of its unit (areas: 2^-22); sums are "
       "exact"},
      {"criteria", criteria_json(report.criteria)},
      {"pits", {{"delaunay", pits_json(report.pits_delaunay)}, {"result", pits_json(report.pits_result)}}},
      {"consistency", report.consistency ? consistency_pair(*report.consistency) : Json(nullptr)},
      {"conditioned", report.conditioned ? conditioned_json(*report.conditioned) : Json(nullptr)},
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

/// Rows of a name and a value, aligned.
class Rows {
 public:
  explicit Rows(std::string& text) : text_(text) {}
  void title(std::string_view name) { text_ += fmt::format("{}\n", name); }
  void row(std::string_view name, std::string_view value) {
    text_ += fmt::format("  {:<26}{:>16}\n", name, value);
  }
  void count(std::string_view name, std::size_t value) { row(name, fmt::format("{}", value)); }
  void count_if_any(std::string_view name, std::size_t value) {
    if (value > 0) count(name, value);
  }

 private:
  std::string& text_;
};

void add_surface(Rows rows, const Report& r) {
  rows.title("Input");
  rows.count("points read", r.input.points_read);
  rows.count("points used", r.input.points_used);
  rows.count_if_any("duplicates merged", r.input.duplicates_merged);
  rows.count_if_any("outside the boundary", r.input.outside_boundary);
  rows.count_if_any("nodata skipped", r.input.nodata_skipped);
  rows.count_if_any("nodata holes bridged", r.input.nodata_holes_bridged);
  rows.count_if_any("lines read", r.input.breaklines_read);
  rows.count_if_any("line vertices", r.input.breakline_vertices);
  rows.count_if_any("crossings", r.input.crossings);
  rows.count_if_any("lakes", r.input.lakes);
  rows.count_if_any("points that lakes level", r.input.points_in_lakes);
  rows.count_if_any("height conflicts", r.conflicts.size());
  rows.title("TIN");
  rows.count("vertices", r.tin.vertices);
  rows.count("triangles", r.tin.triangles);
  rows.count("constraint edges", r.tin.constraint_edges);
  rows.count_if_any("dropped rim triangles", r.tin.dropped_rim_triangles);
  rows.count_if_any("vertices left out", r.tin.vertices_left_out);
  rows.row("area, m2", fmt::format("{:.1f}", r.tin.area_m2));
  rows.row("smallest angle, degrees", fmt::format("{:.3f}", r.tin.min_angle_deg));
  rows.count("flat triangles", r.tin.flat_triangles);
  if (r.simplification) {
    const ReportSimplification& s = *r.simplification;
    rows.title("Simplification");
    rows.row("stopped by", s.stopped_by);
    rows.count("source points", s.source_points);
    rows.count("vertices of lines, outline", s.fixed_vertices);
    rows.count("vertices inserted", s.inserted_vertices);
    rows.count("diagonals barred", s.barred_diagonals);
    rows.row("largest error, m", fmt::format("{:.4f}", s.largest_error_m[1]));
    rows.row("rms error, m", fmt::format("{:.4f}", s.rms_error_m[1]));
  }
}

void add_structure(Rows rows, const Report& r) {
  if (r.higher_order) {
    rows.title(fmt::format("Structure at order {}", r.higher_order->order));
    rows.row("definition", r.higher_order->definition);
    if (r.higher_order->only_flips) rows.row("chosen from", "flips of Delaunay edges");
    rows.count("faces", r.higher_order->faces);
    rows.count_if_any("faces not searched whole", r.higher_order->partial_faces);
    rows.count("largest face, triangles", r.higher_order->largest_face);
    rows.count("labels", r.higher_order->labels);
    rows.count("most labels of a face", r.higher_order->most_labels);
    rows.count("new edges", r.higher_order->new_edges);
    rows.row("triangles by order", fmt::format("{}", fmt::join(r.higher_order->order_histogram, " ")));
    rows.count("fixed by elimination", r.higher_order->fixed_by_elimination);
    rows.count("pieces left", r.higher_order->pieces);
    rows.count("largest piece", r.higher_order->largest_piece);
    rows.count("width", r.higher_order->width);
    return;
  }
  if (r.first_order.definition.empty()) return;
  rows.title("First-order structure");
  rows.row("definition", r.first_order.definition);
  rows.count("quadrilaterals", r.first_order.quadrilaterals);
  rows.count("flipped diagonals", r.first_order.flipped);
  rows.count("fixed by elimination", r.first_order.fixed_by_elimination);
  rows.count("pieces left", r.first_order.pieces);
  rows.count("largest piece", r.first_order.largest_piece);
  rows.count("width", r.first_order.width);
}

void add_water(std::string& text, const Report& r) {
  auto out = std::back_inserter(text);
  if (r.consistency) {
    const auto row = [&](const char* name, const auto& value) {
      fmt::format_to(out, "  {:<26}{:>16}{:>16}\n", name, value(r.consistency->delaunay),
                     value(r.consistency->result));
    };
    if (r.consistency->result.valley_edges > 0) {
      row("drawn valleys that drain", [](const Consistency& c) {
        return fmt::format("{:.1f} %", 100 * c.draining_length_m / c.valley_length_m);
      });
      row("valley edges that rise", [](const Consistency& c) { return c.rising_edges; });
      row("triangles on valleys", [](const Consistency& c) { return c.triangles_on_valleys; });
    }
    if (r.consistency->result.ridge_edges > 0) {
      row("ridge edges crossed", [](const Consistency& c) { return c.crossed_ridge_edges; });
    }
  }
  if (!r.conditioned) return;
  const ConditionReport& c = r.conditioned->figures;
  fmt::format_to(out, "Conditioned: {} heights changed, by {:.2f} m together, {:.2f} m at most", c.changed,
                 c.sum_m, c.max_m);
  if (c.left && c.pits_before > 0) {
    fmt::format_to(out, "; of {} pits {} filled, {} breached, {} left", c.pits_before, c.filled, c.breached,
                   *c.left);
  }
  text += '\n';
}

}  // namespace

std::string to_text(const Report& r) {
  std::string text;
  auto out = std::back_inserter(text);
  add_surface(Rows(text), r);
  add_structure(Rows(text), r);
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
  add_water(text, r);
  const PhaseSeconds& s = r.timings_s;
  if (!r.engine.empty() && r.engine != "flat") text += fmt::format("Triangulated by {}\n", r.engine);
  text += "Seconds\n";
  fmt::format_to(out,
                 "  read {:.2f}  triangulate {:.2f}  simplify {:.2f}  orders {:.2f}  optimize {:.2f}  check "
                 "{:.2f}  write {:.2f}"
                 "  total {:.2f}\n",
                 s.read, s.triangulate, s.simplify, s.orders, s.optimize, s.check, s.write, s.total);
  fmt::format_to(out, "  peak memory {:.0f} MiB\n", static_cast<double>(r.peak_memory_bytes) / 0x1p20);
  for (const std::string& note : r.notes) fmt::format_to(out, "Note: {}\n", printable(note));
  return text;
}

}  // namespace thalweg
