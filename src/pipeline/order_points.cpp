// Constrained orders on request: read, triangulate, then ask module order.
#include "pipeline/order_lists.hpp"
#include "pipeline/order_picture.hpp"
#include "pipeline/plane_survey.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/io/pending_outputs.hpp>
#include <thalweg/order/quadrilaterals.hpp>
#include <thalweg/pipeline/order_points.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <iterator>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace thalweg {

namespace {

void check_ids(const std::array<std::uint32_t, 3>& corners, std::size_t vertices) {
  const auto [a, b, c] = corners;
  for (const std::uint32_t id : corners) {
    if (id < vertices) continue;
    throw Error(ErrorCode::Usage,
                fmt::format("--triangle {},{},{}: id {} is out of range, there are {} vertices "
                            "(0 to {})",
                            a, b, c, id, vertices, vertices - 1));
  }
  if (a == b || b == c || c == a) {
    throw Error(ErrorCode::Usage, fmt::format("--triangle {},{},{} repeats a vertex", a, b, c));
  }
}

// Under Std more than triangles alone.
bool asks_for_std(const OrderConfig& config) {
  return config.definition == OrderDefinition::Std && config.triangles.empty();
}

TriangleOrders ask(const ConstrainedOrder& orders, const std::array<std::uint32_t, 3>& corners,
                   OrderWorkspace& workspace) {
  check_ids(corners, orders.ground().vertex_count());
  const Triangle triangle{VertexId{corners[0]}, VertexId{corners[1]}, VertexId{corners[2]}};
  TriangleOrders answer{.corners = corners, .validity = orders.validity(triangle, workspace)};
  if (answer.validity.fault != TriangleFault::None) return answer;
  for (std::size_t d = 0; d < kOrderDefinitions.size(); ++d) {
    answer.orders[d] = orders.order(triangle, kOrderDefinitions[d], workspace);
  }
  return answer;
}

void check_picture(const OrderConfig& config) {
  if (config.picture_path.empty() || config.triangles.size() == 1) return;
  const std::string what = "--picture " + config.picture_path + " shows one triangle, and ";
  if (config.triangles.empty()) throw Error(ErrorCode::Usage, what + "there is no --triangle A,B,C");
  throw Error(ErrorCode::Usage, fmt::format("{}--triangle was given {} times; draw each in a run of its own",
                                            what, config.triangles.size()));
}

std::string fault_name(TriangleFault fault) {
  switch (fault) {
    case TriangleFault::Flat:
      return "flat";
    case TriangleFault::Occupied:
      return "occupied";
    case TriangleFault::Crossed:
      return "crossed";
    case TriangleFault::Outside:
      return "outside";
    case TriangleFault::None:
      break;
  }
  return "";
}

nlohmann::ordered_json answer_json(const TriangleOrders& answer) {
  nlohmann::ordered_json json = {{"triangle", answer.corners},
                                 {"valid", answer.validity.fault == TriangleFault::None}};
  if (answer.validity.fault == TriangleFault::None) {
    for (std::size_t d = 0; d < kOrderDefinitions.size(); ++d) {
      json["orders"][std::string(definition_name(kOrderDefinitions[d]))] = answer.orders[d];
    }
    return json;
  }
  json["reason"] = fault_name(answer.validity.fault);
  if (answer.validity.by.valid()) json["by"] = answer.validity.by.value();
  if (answer.validity.other.valid()) {
    json["edge"] = {answer.validity.by.value(), answer.validity.other.value()};
  }
  return json;
}

/// Where lists of an order are written; empty: not asked for.
struct ListFiles {
  std::string triangles, edges, conflicts;
};

void write_lists(const OrderConfig& config, const ListFiles& files, const ConstrainedOrder& orders,
                 const Tin& tin, OrderResult& result, Progress& progress) {
  if (files.triangles.empty() && files.edges.empty() && files.conflicts.empty()) return;
  progress.start_phase("triangles");
  std::vector<OrderTriangle> triangles = find_order_triangles(
      orders, {.definition = config.definition, .max_order = config.max_order}, progress);
  if (!files.triangles.empty()) {
    result.order_triangles = triangles.size();
    write_text(files.triangles, config.triangles_path, triangle_list(triangles));
  }
  if (!files.conflicts.empty()) {
    progress.start_phase("conflicts");
    const auto faces = find_fixed_faces(tin, triangles, {}, progress);
    const EdgeConflicts conflicts = faces ? find_edge_conflicts(*faces, {}, progress) : EdgeConflicts{};
    result.conflicts = conflicts.pairs.size();
    result.undecided_faces = conflicts.undecided_faces;
    write_text(files.conflicts, config.conflicts_path, conflict_list(conflicts.pairs));
  }
  if (!files.edges.empty()) {
    progress.start_phase("useful edges");
    const std::vector<UsefulEdge> edges =
        find_useful_edges(orders, std::move(triangles),
                          {.definition = config.definition, .max_order = config.max_order}, progress);
    result.useful_edges = edges.size();
    result.unknown_edges = static_cast<std::size_t>(std::count_if(
        edges.begin(), edges.end(), [](const UsefulEdge& edge) { return !edge.order.has_value(); }));
    write_text(files.edges, config.edges_path, edge_list(edges));
  }
}

std::vector<std::string> sources_of(const OrderConfig& config) {
  std::vector<std::string> sources;
  for (const SourceSpec& points : config.points) sources.push_back(points.path);
  for (const LineSource& lines : config.lines) sources.push_back(lines.source.path);
  return sources;
}

// Orders know no heights: lines need none, and may disagree.
void flatten(Survey& survey) {
  std::fill(survey.points.z.begin(), survey.points.z.end(), 0.0);
  for (SurveyLine& line : survey.lines) line.z.assign(line.xy.size(), 0.0);
}

}  // namespace

OrderResult order_points(const OrderConfig& config, Progress& progress) {
  check_picture(config);
  PendingOutputs outputs(sources_of(config));
  const auto reserve = [&](const std::string& path) {
    return path.empty() ? std::string()
                        : outputs.add(path, config.overwrite ? Overwrite::Yes : Overwrite::No);
  };
  const std::string triangles_file = reserve(config.triangles_path);
  const std::string edges_file = reserve(config.edges_path);
  const std::string quadrilaterals_file = reserve(config.quadrilaterals_path);
  const std::string conflicts_file = reserve(config.conflicts_path);
  const std::string picture_file = reserve(config.picture_path);
  progress.start_phase("read");
  PlaneSurvey survey = read_into_plane(config.points, config.lines, config.read, progress).survey;
  flatten(survey.survey);
  progress.start_phase("triangulate");
  const Ground ground = build_ground(survey.survey, config.ground, progress);
  OrderResult result{.vertices = ground.tin.vertex_count(),
                     .triangles = ground.tin.triangle_count(),
                     .constraint_edges = ground.tin.constraint_edges().size(),
                     .definition = std::string(definition_name(config.definition)),
                     .max_order = config.max_order};

  progress.start_phase("orders");
  const ConstrainedOrder orders(ground.tin, ground.mode);
  OrderWorkspace workspace;
  for (const auto& corners : config.triangles) result.asked.push_back(ask(orders, corners, workspace));
  if (!picture_file.empty()) draw_answer(orders, result.asked.front(), picture_file, config.picture_path);
  write_lists(config, {triangles_file, edges_file, conflicts_file}, orders, ground.tin, result, progress);
  if (!quadrilaterals_file.empty()) {
    const std::vector<Quadrilateral> quadrilaterals =
        find_quadrilaterals(ground.tin, {.definition = config.definition, .mode = ground.mode}, progress);
    result.quadrilaterals = quadrilaterals.size();
    write_text(quadrilaterals_file, config.quadrilaterals_path, quadrilateral_list(quadrilaterals));
  }
  if (config.census) take_census(orders, result, progress);
  if (!orders.unconstrained() && (config.census || asks_for_std(config))) {
    result.std_order = find_std_order_interval(orders, progress);
    result.worst_triangle = ground.tin.triangle(result.std_order->worst);
  }
  progress.advance(1);
  if (config.announce) config.announce(result);
  outputs.commit();
  return result;
}

namespace {

nlohmann::ordered_json census_json(const OrderResult& result) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  const auto per_point = [&](std::size_t count) {
    return static_cast<double>(count) / static_cast<double>(result.vertices);
  };
  for (const CensusRow& row : result.census) {
    rows.push_back({{"definition", definition_name(row.definition)},
                    {"order", row.order},
                    {"triangles", row.triangles},
                    {"edges", row.edges},
                    {"unknown_edges", row.unknown_edges},
                    {"triangles_per_point", per_point(row.triangles)},
                    {"edges_per_point", per_point(row.edges)}});
  }
  return rows;
}

nlohmann::ordered_json std_order_json(const OrderResult& result) {
  const StdOrderInterval& interval = *result.std_order;
  nlohmann::ordered_json json = {{"at_least", interval.at_least}, {"at_most", interval.at_most}};
  if (interval.demand) {
    const auto& [a, b, triangle, order] = *interval.demand;
    json["demand"] = {{"edge", {a.value(), b.value()}},
                      {"triangle", {triangle[0].value(), triangle[1].value(), triangle[2].value()}},
                      {"order", order}};
  }
  const Triangle& worst = result.worst_triangle;
  json["delaunay_triangle"] = {worst[0].value(), worst[1].value(), worst[2].value()};
  return json;
}

std::string std_order_text(const OrderResult& result) {
  const StdOrderInterval& interval = *result.std_order;
  std::string text =
      fmt::format("std: with these lines the smallest order of a triangulation is from {} to {}",
                  interval.at_least, interval.at_most);
  if (interval.at_least == interval.at_most) {
    text = fmt::format("std: with these lines the smallest order of a triangulation is {}", interval.at_most);
  }
  if (interval.demand) {
    const auto& [a, b, triangle, order] = *interval.demand;
    text += fmt::format(
        "; on the left of constraint edge {}-{} no triangle has an order below {}, that of {}, "
        "{}, {}",
        a.value(), b.value(), order, triangle[0].value(), triangle[1].value(), triangle[2].value());
  }
  const Triangle& worst = result.worst_triangle;
  return text + fmt::format("; the constrained Delaunay triangulation has order {}, at {}, {}, {}\n",
                            interval.at_most, worst[0].value(), worst[1].value(), worst[2].value());
}

std::string census_text(const OrderResult& result) {
  std::string text = fmt::format("{:<12}{:>6}{:>12}{:>12}{:>12}{:>12}{:>12}\n", "definition", "order",
                                 "triangles", "per point", "edges", "per point", "unknown");
  for (const CensusRow& row : result.census) {
    const auto vertices = static_cast<double>(result.vertices);
    text += fmt::format("{:<12}{:>6}{:>12}{:>12.3f}{:>12}{:>12.3f}{:>12}\n", definition_name(row.definition),
                        row.order, row.triangles, static_cast<double>(row.triangles) / vertices, row.edges,
                        static_cast<double>(row.edges) / vertices, row.unknown_edges);
  }
  for (const std::string& reason : result.not_taken) text += reason + "\n";
  return text;
}

}  // namespace

std::string to_json(const OrderResult& result) {
  using Json = nlohmann::ordered_json;
  if (result.asked.size() == 1) return answer_json(result.asked.front()).dump() + "\n";
  if (!result.asked.empty()) {
    Json list = Json::array();
    for (const TriangleOrders& answer : result.asked) list.push_back(answer_json(answer));
    return list.dump(2) + "\n";
  }
  Json json = {{"vertices", result.vertices},
               {"triangles", result.triangles},
               {"constraint_edges", result.constraint_edges},
               {"definition", result.definition},
               {"order", result.max_order}};
  if (result.order_triangles) json["order_triangles"] = *result.order_triangles;
  if (result.useful_edges) json["useful_edges"] = *result.useful_edges;
  if (result.unknown_edges) json["unknown_edges"] = *result.unknown_edges;
  if (result.quadrilaterals) json["quadrilaterals"] = *result.quadrilaterals;
  if (result.conflicts) json["conflicts"] = *result.conflicts;
  if (result.undecided_faces) json["undecided_faces"] = *result.undecided_faces;
  if (result.std_order) json["std_order"] = std_order_json(result);
  if (!result.census.empty()) json["census"] = census_json(result);
  if (!result.not_taken.empty()) json["not_taken"] = result.not_taken;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string to_text(const OrderResult& result) {
  std::string text = fmt::format("{} vertices, {} triangles, {} constraint edges\n", result.vertices,
                                 result.triangles, result.constraint_edges);
  if (result.order_triangles) {
    text += fmt::format("{} valid triangles of order at most {} under {}\n", *result.order_triangles,
                        result.max_order, result.definition);
  }
  if (result.useful_edges) {
    text += fmt::format("{} edges useful at order {} under {}", *result.useful_edges, result.max_order,
                        result.definition);
    if (*result.unknown_edges > 0) {
      text += fmt::format(", of {} of which it is not known whether they are", *result.unknown_edges);
    }
    text += "\n";
  }
  if (result.quadrilaterals) {
    text += fmt::format("{} quadrilaterals under {}\n", *result.quadrilaterals, result.definition);
  }
  if (result.conflicts) {
    text += fmt::format("{} pairs of edges that exclude each other at order {} under {}", *result.conflicts,
                        result.max_order, result.definition);
    if (*result.undecided_faces > 0) {
      text += fmt::format("; {} faces have too many triangulations, of these the pairs that cross",
                          *result.undecided_faces);
    }
    text += "\n";
  }
  if (result.std_order) text += std_order_text(result);
  if (!result.census.empty()) text += census_text(result);
  for (const TriangleOrders& answer : result.asked) {
    text += fmt::format("triangle {}, {}, {}", answer.corners[0], answer.corners[1], answer.corners[2]);
    if (answer.validity.fault != TriangleFault::None) {
      text += fmt::format(" is not valid: {}", fault_name(answer.validity.fault));
      if (answer.validity.by.valid()) text += fmt::format(" by {}", answer.validity.by.value());
      if (answer.validity.other.valid()) text += fmt::format("-{}", answer.validity.other.value());
      text += "\n";
      continue;
    }
    text += "\n";
    for (std::size_t d = 0; d < kOrderDefinitions.size(); ++d) {
      text += fmt::format("  {:<12}{:>6}\n", definition_name(kOrderDefinitions[d]), answer.orders[d]);
    }
  }
  return text;
}

}  // namespace thalweg
