// The panels of a triangle's picture.
#include "pipeline/order_picture.hpp"

#include "base/lower_case.hpp"

#include <thalweg/io/order_picture.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <vector>

namespace thalweg {

namespace {

/// What counts, in a few words.
const char* gist(OrderDefinition definition) {
  switch (definition) {
    case OrderDefinition::Std:
      return "every vertex in the circle";
    case OrderDefinition::Pathcon:
      return "joined to the triangle by a path in the circle";
    case OrderDefinition::SeesTriang:
      return "sees some of the triangle";
    case OrderDefinition::SeesVtx:
      return "sees some of the triangle, and a corner";
    case OrderDefinition::ConfEdge:
      return "sees, through the triangle, a corner or a vertex in the circle";
    case OrderDefinition::SeesOpp:
      return "sees the opposite corner";
    case OrderDefinition::Sees3vtx:
      return "sees all three corners";
    case OrderDefinition::EmptyQuad:
      return "makes an empty quadrilateral with the triangle";
  }
  return "";
}

std::vector<OrderPanel> panels_of(const ConstrainedOrder& orders, const Triangle& triangle) {
  OrderWorkspace workspace;
  const std::vector<VertexId> inside = orders.counted(triangle, OrderDefinition::Std, workspace);
  std::vector<OrderPanel> panels;
  for (const OrderDefinition definition : kOrderDefinitions) {
    OrderPanel panel{.title = std::string(definition_name(definition)),
                     .value = {},
                     .note = gist(definition),
                     .marked = orders.counted(triangle, definition, workspace),
                     .unmarked = {}};
    panel.value = std::to_string(panel.marked.size());
    std::set_difference(inside.begin(), inside.end(), panel.marked.begin(), panel.marked.end(),
                        std::back_inserter(panel.unmarked));
    panels.push_back(std::move(panel));
  }
  return panels;
}

OrderPanel panel_of_fault(const TriangleValidity& validity) {
  OrderPanel panel;
  switch (validity.fault) {
    case TriangleFault::Flat:
      panel.title = "flat";
      panel.note = "its corners lie on one line";
      break;
    case TriangleFault::Occupied:
      panel.title = fmt::format("occupied by {}", validity.by.value());
      panel.note = "another vertex lies in the closed triangle";
      panel.marked = {validity.by};
      break;
    case TriangleFault::Crossed:
      panel.title = fmt::format("crossed by {}-{}", validity.by.value(), validity.other.value());
      panel.note = "a constraint edge runs through it";
      panel.marked = {std::min(validity.by, validity.other), std::max(validity.by, validity.other)};
      break;
    case TriangleFault::Outside:
      panel.title = "outside";
      panel.note = "it does not lie on the ground";
      break;
    case TriangleFault::None:
      break;
  }
  return panel;
}

}  // namespace

void draw_answer(const ConstrainedOrder& orders, const TriangleOrders& answer, const std::string& path,
                 const std::string& target) {
  const auto [a, b, c] = answer.corners;
  const Triangle triangle{VertexId{a}, VertexId{b}, VertexId{c}};
  const bool valid = answer.validity.fault == TriangleFault::None;
  std::vector<OrderPanel> panels;
  if (valid) {
    panels = panels_of(orders, triangle);
  } else {
    panels.push_back(panel_of_fault(answer.validity));
  }
  const bool in_the_way = !valid && !panels[0].marked.empty();
  draw_order_picture(path, extension_of(target),
                     {.ground = orders.ground(),
                      .mode = orders.mode(),
                      .triangle = triangle,
                      .panels = panels,
                      .title = valid ? fmt::format("Triangle {}, {}, {}: its constrained orders", a, b, c)
                                     : fmt::format("{}, {}, {} is no valid triangle", a, b, c),
                      .marked_label = valid        ? "counts"
                                      : in_the_way ? "in the way"
                                                   : "",
                      .unmarked_label = valid ? "in the circle, does not count" : "",
                      .target = target});
}

}  // namespace thalweg
