#pragma once

/// Criteria of vertices by plain code: what is at each vertex, edge by edge.

#include <thalweg/mesh/tin.hpp>

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace thalweg::test {

class PlainStars {
 public:
  /// `bend`: 1 convex, -1 reflex, 0 flat or on the rim.
  void add(const std::pair<VertexId, VertexId>& edge, bool rim, int bend) {
    for (const VertexId v : {edge.first, edge.second}) {
      bends_[v].push_back(bend);
      rim_[v] = rim_[v] || rim;
    }
  }

  /// Less is better.
  [[nodiscard]] std::int64_t value(const std::string& name) const {
    std::int64_t convex = 0, mixed = 0, degree = 0;
    for (const auto& [v, bends] : bends_) {
      const auto number = [&, &all = bends](int bend) { return std::count(all.begin(), all.end(), bend); };
      degree = std::max(degree, static_cast<std::int64_t>(bends.size()));
      if (rim_.at(v)) continue;
      convex += number(0) == 0 && number(-1) == 0 ? 1 : 0;
      mixed += number(1) > 0 && number(-1) > 0 ? 1 : 0;
    }
    if (name == "convex-vertices") return -convex;
    return name == "mixed-vertices" ? mixed : degree;
  }

 private:
  std::map<VertexId, std::vector<int>> bends_;
  std::map<VertexId, bool> rim_;
};

}  // namespace thalweg::test
