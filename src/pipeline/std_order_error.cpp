// The error that says why there is no triangulation.
#include "pipeline/std_order_error.hpp"

#include <thalweg/order/std_order.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>

namespace thalweg {

namespace {

std::string places(const Terrain& terrain, std::span<const VertexId> vertices) {
  std::string text;
  for (const VertexId v : vertices) {
    const Point2 p = terrain.written.empty() ? terrain.ground.point(v) : terrain.written[v.index()];
    text += fmt::format("{}({:.6f}, {:.6f})", text.empty() ? "" : ", ", p.x, p.y);
  }
  return text;
}

}  // namespace

Error no_triangulation(const Terrain& terrain, const LabellingConfig& labelling, Progress& progress) {
  std::string text = fmt::format("no triangulation with these lines has order at most {} under {}",
                                 labelling.order, definition_name(labelling.definition));
  std::string remedy =
      "take a definition that knows of lines, such as pathcon or sees-opp, or a larger --order";
  if (labelling.definition == OrderDefinition::Std) {
    const StdOrderInterval interval =
        find_std_order_interval(ConstrainedOrder(terrain.ground, terrain.mode), progress);
    const auto at_least = std::max(interval.at_least, static_cast<std::uint32_t>(labelling.order) + 1);
    const std::uint32_t at_most = std::max(at_least, interval.at_most);
    text += at_least == at_most ? fmt::format(": the smallest order is {}", at_most)
                                : fmt::format(": the smallest order is from {} to {}", at_least, at_most);
    if (interval.demand) {
      const VertexId ends[] = {interval.demand->a, interval.demand->b};
      text += fmt::format("; at a side of constraint edge {} no triangle has an order below {}",
                          places(terrain, ends), interval.demand->order);
    }
    text += fmt::format("; the constrained Delaunay triangulation has order {}, at triangle {}",
                        interval.at_most, places(terrain, terrain.ground.triangle(interval.worst)));
  }
  return {ErrorCode::Unsupported, text + "; " + remedy};
}

}  // namespace thalweg
