// Enumeration: grow a patch of triangles over its open sides.
//
// 1. A directed edge has its triangle on the left. The candidates of a directed edge are the valid triangles
//    there; an edge without candidates has no ground on its left, and needs none.
// 2. Start with any directed edge of the rim and each of its candidates. While some side of the patch lacks
//    the triangle beyond it, take the side with the fewest candidates whose interiors meet no chosen
//    triangle's interior, and try each. The side depends on the patch only, so no triangulation is met twice.
// 3. No side is left: the patch is a triangulation. Valid triangles hold no site and no part of a constraint
//    edge inside, so all sites and constraint edges of the ground are vertices and edges of it.
#include <support/oracle/triangulations.hpp>

#include <algorithm>
#include <limits>
#include <optional>
#include <set>

namespace thalweg::oracle {

namespace {

using Bits = std::vector<std::uint64_t>;

bool has(const Bits& bits, int i) {
  return (bits[static_cast<std::size_t>(i) / 64] >> (i % 64) & 1U) != 0;
}

// True if some side of a has all of b on or beyond it. Pre: both counter-clockwise.
bool side_separates(const Scene& scene, const Corners& a, const Corners& b) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Site from = scene.at(a[i]), to = scene.at(a[(i + 1) % 3]);
    if (std::all_of(b.begin(), b.end(), [&](int v) { return turn(from, to, scene.at(v)) <= 0; })) return true;
  }
  return false;
}

class Search {
 public:
  Search(const Scene& scene, const std::vector<Corners>& triangles,
         const std::function<void(std::span<const int>)>& visit)
      : size_(scene.size()),
        triangles_(triangles),
        visit_(visit),
        candidates_(static_cast<std::size_t>(size_ * size_)),
        covered_(candidates_.size(), false) {
    const std::size_t words = triangles.size() / 64 + 1;
    apart_.assign(triangles.size(), Bits(words, 0));
    for (std::size_t a = 0; a < triangles.size(); ++a) {
      for (std::size_t i = 0; i < 3; ++i) candidates_[side(triangles[a], i)].push_back(static_cast<int>(a));
      for (std::size_t b = 0; b < triangles.size(); ++b) {
        if (a == b) continue;
        if (side_separates(scene, triangles[a], triangles[b]) ||
            side_separates(scene, triangles[b], triangles[a])) {
          apart_[a][b / 64] |= std::uint64_t{1} << (b % 64);
        }
      }
    }
    everything_.assign(words, ~std::uint64_t{0});
  }

  void run() {
    for (int from = 0; from < size_; ++from) {
      for (int to = 0; to < size_; ++to) {
        const auto& start = candidates_[index(from, to)];
        if (start.empty() || !candidates_[index(to, from)].empty()) continue;
        for (const int t : start) grow(t, everything_);
        return;
      }
    }
  }

 private:
  [[nodiscard]] std::size_t index(int from, int to) const {
    return static_cast<std::size_t>(from * size_ + to);
  }
  [[nodiscard]] std::size_t side(const Corners& t, std::size_t i) const {
    return index(t[i], t[(i + 1) % 3]);
  }
  [[nodiscard]] std::size_t beyond(const Corners& t, std::size_t i) const {
    return index(t[(i + 1) % 3], t[i]);
  }

  void grow(int t, const Bits& free) {
    const Corners& corners = triangles_[static_cast<std::size_t>(t)];
    Bits left = free;
    for (std::size_t w = 0; w < left.size(); ++w) left[w] &= apart_[static_cast<std::size_t>(t)][w];
    chosen_.push_back(t);
    for (std::size_t i = 0; i < 3; ++i) covered_[side(corners, i)] = true;
    extend(left);
    for (std::size_t i = 0; i < 3; ++i) covered_[side(corners, i)] = false;
    chosen_.pop_back();
  }

  void extend(const Bits& free) {
    std::optional<std::vector<int>> fewest;
    for (const int t : chosen_) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t open = beyond(triangles_[static_cast<std::size_t>(t)], i);
        if (covered_[open] || candidates_[open].empty()) continue;
        std::vector<int> fitting;
        for (const int c : candidates_[open]) {
          if (has(free, c)) fitting.push_back(c);
        }
        if (!fewest || fitting.size() < fewest->size()) fewest = std::move(fitting);
      }
    }
    if (!fewest) {
      visit_(chosen_);
      return;
    }
    for (const int t : *fewest) grow(t, free);
  }

  int size_;
  const std::vector<Corners>& triangles_;
  const std::function<void(std::span<const int>)>& visit_;
  std::vector<std::vector<int>> candidates_;
  std::vector<bool> covered_;
  std::vector<Bits> apart_;
  Bits everything_;
  std::vector<int> chosen_;
};

// The triangle on the left of a -> b with no site beyond its two other sides in its circle and seen from it.
std::optional<Corners> greedy_triangle(const Oracle& oracle, int a, int b) {
  const Scene& scene = oracle.scene();
  for (int s = 0; s < scene.size(); ++s) {
    if (s == a || s == b || turn(scene.at(a), scene.at(b), scene.at(s)) <= 0) continue;
    const Corners t{a, b, s};
    if (oracle.validity(t) != Validity::Valid) continue;
    const SiteSet seen = oracle.counted(t, Definition::SeesTriang);
    bool empty = true;
    for (int p = 0; p < scene.size(); ++p) {
      empty = empty && ((seen >> p & 1U) == 0 || turn(scene.at(a), scene.at(b), scene.at(p)) < 0);
    }
    if (empty) return t;
  }
  return std::nullopt;
}

bool crosses(const Scene& scene, Edge e, Edge f) {
  const Site a = scene.at(e.first), b = scene.at(e.second), c = scene.at(f.first), d = scene.at(f.second);
  return sign_of(turn(a, b, c)) * sign_of(turn(a, b, d)) < 0 &&
         sign_of(turn(c, d, a)) * sign_of(turn(c, d, b)) < 0;
}

Corners lowest_first(Corners t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

}  // namespace

void for_each_triangulation(const Scene& scene, const std::vector<Corners>& triangles,
                            const std::function<void(std::span<const int>)>& visit) {
  Search(scene, triangles, visit).run();
}

std::vector<Edge> edges_of(const std::vector<Corners>& triangles) {
  std::set<Edge> edges;
  for (const Corners& t : triangles) {
    for (std::size_t i = 0; i < 3; ++i) edges.insert(edge_of(t[i], t[(i + 1) % 3]));
  }
  return {edges.begin(), edges.end()};
}

Enumeration enumerate(const Oracle& oracle) {
  Enumeration all;
  all.triangles = oracle.valid_triangles();
  for (const Corners& t : all.triangles) all.orders.push_back(oracle.orders(t));
  for_each_triangulation(oracle.scene(), all.triangles, [&all](std::span<const int> chosen) {
    Orders largest{};
    for (const int t : chosen) {
      const Orders& orders = all.orders[static_cast<std::size_t>(t)];
      for (std::size_t d = 0; d < kDefinitionCount; ++d) largest[d] = std::max(largest[d], orders[d]);
    }
    all.members.emplace_back(chosen.begin(), chosen.end());
    std::sort(all.members.back().begin(), all.members.back().end());
    all.largest.push_back(largest);
  });
  return all;
}

std::vector<std::size_t> Enumeration::of_order(Definition definition, int k) const {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (largest[i][static_cast<std::size_t>(definition)] <= k) found.push_back(i);
  }
  return found;
}

std::map<Edge, int> Enumeration::useful_orders(Definition definition) const {
  std::map<Edge, int> smallest;
  for (std::size_t i = 0; i < members.size(); ++i) {
    const int k = largest[i][static_cast<std::size_t>(definition)];
    for (const int t : members[i]) {
      const Corners& corners = triangles[static_cast<std::size_t>(t)];
      for (std::size_t side = 0; side < 3; ++side) {
        const auto [at, fresh] = smallest.emplace(edge_of(corners[side], corners[(side + 1) % 3]), k);
        if (!fresh) at->second = std::min(at->second, k);
      }
    }
  }
  return smallest;
}

std::vector<Corners> delaunay_triangles(const Oracle& oracle) {
  std::vector<Corners> found;
  for (const Corners& t : oracle.valid_triangles()) {
    if (oracle.order(t, Definition::Pathcon) == 0) found.push_back(t);
  }
  return found;
}

std::vector<Corners> greedy_triangles(const Oracle& oracle, Edge edge) {
  const Scene& scene = oracle.scene();
  std::vector<Corners> result;
  std::set<Edge> kept;
  for (const Corners& t : delaunay_triangles(oracle)) {
    bool crossed = false;
    for (std::size_t i = 0; i < 3; ++i) {
      const Edge side = edge_of(t[i], t[(i + 1) % 3]);
      if (crosses(scene, edge, side)) {
        crossed = true;
      } else {
        kept.insert(side);
      }
    }
    if (!crossed) result.push_back(t);
  }
  if (kept.contains(edge)) return result;
  std::vector<Edge> open{edge, {edge.second, edge.first}};
  while (!open.empty()) {
    const auto [a, b] = open.back();
    open.pop_back();
    const std::optional<Corners> t = greedy_triangle(oracle, a, b);
    if (!t) return {};
    result.push_back(lowest_first(*t));
    const int s = (*t)[2];
    if (!kept.contains(edge_of(a, s))) open.emplace_back(a, s);
    if (!kept.contains(edge_of(s, b))) open.emplace_back(s, b);
  }
  std::sort(result.begin(), result.end());
  return result;
}

std::vector<Quadrilateral> first_order_quadrilaterals(const Oracle& oracle, Definition definition) {
  const Scene& scene = oracle.scene();
  const std::vector<Corners> delaunay = delaunay_triangles(oracle);
  if (definition == Definition::Std) {
    for (const Corners& t : delaunay) {
      if (oracle.order(t, Definition::Std) > 1) return {};
    }
  }
  std::map<Edge, int> apexes;  // of the triangle on the left of a directed edge
  for (const Corners& t : delaunay) {
    for (std::size_t i = 0; i < 3; ++i) apexes[{t[i], t[(i + 1) % 3]}] = t[(i + 2) % 3];
  }
  std::vector<Quadrilateral> found;
  for (const auto& [directed, s] : apexes) {
    const auto [u, v] = directed;
    const auto other = apexes.find({v, u});
    if (u > v || other == apexes.end() || scene.constrained(u, v)) continue;
    const int t = other->second;
    if (!crosses(scene, {u, v}, {s, t})) continue;
    if (oracle.order({s, u, t}, definition) > 1 || oracle.order({t, v, s}, definition) > 1) continue;
    std::array<int, 4> corners{u, t, v, s};
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    found.push_back({corners, {u, v}});
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace thalweg::oracle
