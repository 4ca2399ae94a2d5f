// Sight and ground straight from their definitions.
//
// An open segment that meets no constraint edge lies wholly in the ground or wholly off it, so its midpoint
// decides; the ground is told by the parity of boundary edges above a point.
#include <support/oracle/scene.hpp>

#include <algorithm>

namespace thalweg::oracle {

bool Scene::constrained(int a, int b) const {
  return std::find(constraints.begin(), constraints.end(), edge_of(a, b)) != constraints.end();
}

Corners Scene::counter_clockwise(Corners t) const {
  if (turn(at(t[0]), at(t[1]), at(t[2])) < 0) std::swap(t[1], t[2]);
  return t;
}

bool in_ground(const Scene& scene, const Spot& point) {
  if (!scene.polygon_mode()) return true;
  bool inside = false;
  for (const auto& [a, b] : scene.boundary) {
    Site left = scene.at(a), right = scene.at(b);
    if (right.x < left.x) std::swap(left, right);
    const bool spans = left.x * point.w <= point.x && point.x < right.x * point.w;
    if (spans && turn_sign(spot_of(left), spot_of(right), point) < 0) inside = !inside;
  }
  return inside;
}

bool sees(const Scene& scene, int p, int q) {
  if (scene.constrained(p, q)) return true;
  const Site from = scene.at(p), to = scene.at(q);
  for (const auto& [a, b] : scene.constraints) {
    if (a == p || a == q || b == p || b == q) {
      const int other = a == p || a == q ? b : a;
      if (inside_segment(from, to, scene.at(other))) return false;
    } else if (segments_meet(spot_of(from), spot_of(to), spot_of(scene.at(a)), spot_of(scene.at(b)))) {
      return false;
    }
  }
  return in_ground(scene, {from.x + to.x, from.y + to.y, 2});
}

std::string defect(const Scene& scene) {
  if (scene.size() > kMaxSites) return "too many sites";
  const auto name = [](const Edge& e) { return std::to_string(e.first) + "-" + std::to_string(e.second); };
  for (int v = 0; v < scene.size(); ++v) {
    const Site s = scene.at(v);
    if (std::max({s.x, s.y, -s.x, -s.y}) > kCoordinateLimit) return "site out of range";
    for (int other = 0; other < v; ++other) {
      if (scene.at(other) == s) return "two sites at one place";
    }
  }
  for (std::size_t i = 0; i < scene.constraints.size(); ++i) {
    const Edge e = scene.constraints[i];
    if (e.first < 0 || e.second >= scene.size() || e.first >= e.second) return "bad constraint " + name(e);
    for (int v = 0; v < scene.size(); ++v) {
      if (inside_segment(scene.at(e.first), scene.at(e.second), scene.at(v)))
        return "a site lies inside constraint " + name(e);
    }
    for (std::size_t j = 0; j < i; ++j) {
      const Edge f = scene.constraints[j];
      if (e == f) return "constraint " + name(e) + " is given twice";
      if (e.first == f.first || e.first == f.second || e.second == f.first || e.second == f.second) continue;
      if (segments_meet(spot_of(scene.at(e.first)), spot_of(scene.at(e.second)), spot_of(scene.at(f.first)),
                        spot_of(scene.at(f.second)))) {
        return "constraints " + name(e) + " and " + name(f) + " meet";
      }
    }
  }
  std::vector<int> degree(scene.sites.size(), 0);
  for (const auto& [a, b] : scene.boundary) {
    if (std::count(scene.boundary.begin(), scene.boundary.end(), Edge{a, b}) > 1)
      return "boundary edge " + name({a, b}) + " is given twice";
    if (!scene.constrained(a, b)) return "boundary edge " + name({a, b}) + " is no constraint";
    ++degree[static_cast<std::size_t>(a)];
    ++degree[static_cast<std::size_t>(b)];
  }
  for (int v = 0; v < scene.size(); ++v) {
    const int rings = degree[static_cast<std::size_t>(v)];
    if (rings % 2 != 0) return "the boundary is open at site " + std::to_string(v);
    if (rings == 0 && !in_ground(scene, spot_of(scene.at(v))))
      return "site " + std::to_string(v) + " lies off the ground";
  }
  return {};
}

std::string to_text(const Scene& scene) {
  std::string text = "sites";
  for (const Site& s : scene.sites) text += " (" + std::to_string(s.x) + "," + std::to_string(s.y) + ")";
  const auto list = [&text](const char* title, const std::vector<Edge>& edges) {
    text += title;
    for (const auto& [a, b] : edges) text += " " + std::to_string(a) + "-" + std::to_string(b);
  };
  list(" constraints", scene.constraints);
  if (scene.polygon_mode()) list(" boundary", scene.boundary);
  return text;
}

}  // namespace thalweg::oracle
