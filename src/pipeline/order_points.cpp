// Constrained orders on request: read, triangulate, then ask module order.
#include "pipeline/plane_survey.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/io/pending_outputs.hpp>
#include <thalweg/order/quadrilaterals.hpp>
#include <thalweg/pipeline/order_points.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
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

/// One row of the list: corners from the smallest id, and which of st, uv is the diagonal in the ground.
struct QuadrilateralRow {
  std::array<std::uint32_t, 4> corners{};
  bool delaunay_is_st = false;
  auto operator<=>(const QuadrilateralRow&) const = default;
};

QuadrilateralRow row_of(const Quadrilateral& q) {
  QuadrilateralRow row{{q.s.value(), q.u.value(), q.t.value(), q.v.value()}, false};
  while (row.corners[0] != *std::min_element(row.corners.begin(), row.corners.end())) {
    std::rotate(row.corners.begin(), row.corners.begin() + 1, row.corners.end());
    row.delaunay_is_st = !row.delaunay_is_st;
  }
  return row;
}

void write_quadrilaterals(const std::string& path, const std::string& target,
                          const std::vector<Quadrilateral>& quadrilaterals) {
  std::vector<QuadrilateralRow> rows;
  rows.reserve(quadrilaterals.size());
  std::transform(quadrilaterals.begin(), quadrilaterals.end(), std::back_inserter(rows), row_of);
  std::sort(rows.begin(), rows.end());
  std::string text = "s,u,t,v,delaunay\n";
  for (const QuadrilateralRow& row : rows) {
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{}\n", row.corners[0], row.corners[1],
                   row.corners[2], row.corners[3], row.delaunay_is_st ? "st" : "uv");
  }
  std::ofstream file(path, std::ios::binary);
  file.write(text.data(), static_cast<std::streamsize>(text.size()));
  file.close();
  if (!file) throw Error(ErrorCode::WriteFailed, target + " could not be written whole; is the disk full?");
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

}  // namespace

OrderResult order_points(const OrderConfig& config, Progress& progress) {
  PendingOutputs outputs;
  const std::string list =
      config.quadrilaterals_path.empty()
          ? std::string()
          : outputs.add(config.quadrilaterals_path, config.overwrite ? Overwrite::Yes : Overwrite::No);
  progress.start_phase("read");
  PlaneSurvey survey = read_into_plane(config.points, config.lines, config.read, progress).survey;
  progress.start_phase("triangulate");
  const Ground ground = build_ground(survey.survey, config.ground, progress);
  OrderResult result{.vertices = ground.tin.vertex_count(),
                     .triangles = ground.tin.triangle_count(),
                     .constraint_edges = ground.tin.constraint_edges().size(),
                     .definition = std::string(definition_name(config.definition))};

  progress.start_phase("orders");
  const ConstrainedOrder orders(ground.tin, ground.mode);
  OrderWorkspace workspace;
  for (const auto& corners : config.triangles) result.asked.push_back(ask(orders, corners, workspace));
  if (!list.empty()) {
    const std::vector<Quadrilateral> quadrilaterals =
        find_quadrilaterals(ground.tin, {.definition = config.definition, .mode = ground.mode}, progress);
    write_quadrilaterals(list, config.quadrilaterals_path, quadrilaterals);
    result.quadrilaterals = quadrilaterals.size();
    result.quadrilaterals_listed = true;
  }
  outputs.commit();
  progress.advance(1);
  return result;
}

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
               {"definition", result.definition}};
  if (result.quadrilaterals_listed) json["quadrilaterals"] = result.quadrilaterals;
  return json.dump(2) + "\n";
}

std::string to_text(const OrderResult& result) {
  std::string text = fmt::format("{} vertices, {} triangles, {} constraint edges\n", result.vertices,
                                 result.triangles, result.constraint_edges);
  if (result.quadrilaterals_listed) {
    text += fmt::format("{} quadrilaterals under {}\n", result.quadrilaterals, result.definition);
  }
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
