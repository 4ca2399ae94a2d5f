// Figures of drawn lines and of conditioning under the keys that `build` and `drain` share.
#include "pipeline/water_json.hpp"

namespace thalweg {

using Json = nlohmann::ordered_json;

Json consistency_json(const Consistency& c) {
  Json rising = Json::array();
  for (const Inconsistency& place : c.places) {
    if (place.kind != Inconsistency::Kind::ValleyRises) continue;
    rising.push_back({{"from", place.from.value()}, {"to", place.to.value()}, {"rise_m", place.rise_m}});
  }
  return {{"valley_edges", c.valley_edges},
          {"valley_length_m", c.valley_length_m},
          {"draining_length_m", c.draining_length_m},
          {"rising_edges", c.rising_edges},
          {"rise_sum_m", c.rise_sum_m},
          {"rise_max_m", c.rise_max_m},
          {"rising", rising},
          {"ridge_edges", c.ridge_edges},
          {"crossed_ridge_edges", c.crossed_ridge_edges},
          {"undrawn_valley_edges", c.undrawn_valley_edges},
          {"triangles_on_valleys", c.triangles_on_valleys},
          {"flat_triangles", c.flat_triangles},
          {"flat_edges", c.flat_edges}};
}

Json condition_json(const ConditionReport& r) {
  return {{"heights", r.changed},
          {"sum_m", r.sum_m},
          {"max_m", r.max_m},
          {"pits_before", r.pits_before},
          {"filled", r.filled},
          {"breached", r.breached},
          {"pits_left", r.left ? Json(*r.left) : Json(nullptr)}};
}

}  // namespace thalweg
