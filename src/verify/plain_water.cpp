// Depths: edges in order of their higher ends join sets of vertices; where two sets meet, the one with the
// higher bottom is a pit that spills. Sets that touch the rim or a lake have no bottom.
#include "verify/plain_water.hpp"

#include <boost/multiprecision/cpp_int.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

namespace thalweg::verify {

namespace {

using Extended = long double;
constexpr Extended kSteps = 0x1p32L;
using Ends = std::pair<Index, Index>;

/// Every edge under its height; the node after the vertices is what water leaves by.
std::vector<std::pair<double, Ends>> edges_by_height(const PlainMesh& mesh,
                                                     const std::vector<Ends>& without) {
  std::vector<std::pair<double, Ends>> edges;
  const auto out = static_cast<Index>(mesh.xy.size());
  const std::vector<bool> rim = rim_of(mesh);
  for (Index v = 0; v < out; ++v) {
    if (rim[v]) edges.push_back({mesh.z[v], {v, out}});
  }
  for (const auto& [edge, kind] : mesh.constraints) {
    if (!has(kind, EdgeKind::Lake) || mesh.z[edge.first] != mesh.z[edge.second]) continue;
    edges.push_back({mesh.z[edge.first], {edge.first, out}});
    edges.push_back({mesh.z[edge.first], {edge.second, out}});
  }
  for (const Corners& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Ends ends = std::minmax(t[i], t[(i + 1) % 3]);
      if (std::binary_search(without.begin(), without.end(), ends)) continue;
      edges.push_back({std::max(mesh.z[ends.first], mesh.z[ends.second]), ends});
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), Index{0}); }
  Index find(Index v) {
    while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
    return v;
  }
  void join(Index a, Index b) { parent_[find(a)] = find(b); }

 private:
  std::vector<Index> parent_;
};

}  // namespace

PlainValue pit_depth(const PlainMesh& mesh, PlainScale scale,
                     std::span<const PlainQuadrilateral> quadrilaterals) {
  auto edges = edges_by_height(mesh, {});
  for (const PlainQuadrilateral& q : quadrilaterals) {
    edges.push_back({std::max(mesh.z[q.s], mesh.z[q.t]), {q.s, q.t}});
  }
  std::sort(edges.begin(), edges.end());
  std::vector<double> bottom = mesh.z;
  bottom.push_back(-std::numeric_limits<double>::infinity());
  Sets sets(bottom.size());
  const auto rounded = [&](double z) { return std::floor(Extended{z} * scale.vertical * kSteps + 0.5L); };
  PlainValue sum;
  for (const auto& [height, ends] : edges) {
    const Index a = sets.find(ends.first), b = sets.find(ends.second);
    if (a == b) continue;
    const double lower = std::min(bottom[a], bottom[b]), higher = std::max(bottom[a], bottom[b]);
    if (height > higher) {
      sum.value += rounded(height) - rounded(higher);
      sum.tolerance += 2 / kSteps;
    }
    sets.join(a, b);
    bottom[sets.find(a)] = lower;
  }
  sum.value /= kSteps;
  sum.tolerance += sum.value * 1e-15L;
  return sum;
}

PlainPlateaus find_spill_links(const PlainMesh& delaunay,
                               std::span<const PlainQuadrilateral> quadrilaterals) {
  std::vector<Ends> diagonals;
  std::vector<std::tuple<double, Index, bool, Ends>> choices;
  for (Index q = 0; q < quadrilaterals.size(); ++q) {
    const auto& [s, u, t, v, left, right] = quadrilaterals[q];
    diagonals.emplace_back(std::minmax(u, v));
    choices.emplace_back(std::max(delaunay.z[u], delaunay.z[v]), q, false, Ends{u, v});
    choices.emplace_back(std::max(delaunay.z[s], delaunay.z[t]), q, true, Ends{s, t});
  }
  std::sort(diagonals.begin(), diagonals.end());
  std::sort(choices.begin(), choices.end());
  const auto edges = edges_by_height(delaunay, diagonals);
  const auto out = static_cast<Index>(delaunay.xy.size());
  Sets sets(std::size_t{out} + 1);
  std::vector<PlainLink> links;
  Index nodes = 1;  // node 0 is what water leaves by
  auto edge = edges.begin();
  for (auto begin = choices.begin(); begin != choices.end();) {
    const double height = std::get<0>(*begin);
    for (; edge != edges.end() && edge->first <= height; ++edge) {
      sets.join(edge->second.first, edge->second.second);
    }
    std::map<Index, Index> node = {{sets.find(out), Index{0}}};
    auto end = begin;
    for (; end != choices.end() && std::get<0>(*end) == height; ++end) {
      const auto& [z, q, label, ends] = *end;
      const Index a = sets.find(ends.first), b = sets.find(ends.second);
      if (a == b) continue;
      for (const Index set : {a, b}) nodes += node.try_emplace(set, nodes).second ? 1 : 0;
      links.push_back({q, label, node[a], node[b]});
    }
    for (; begin != end; ++begin) sets.join(std::get<3>(*begin).first, std::get<3>(*begin).second);
  }
  return PlainPlateaus(PlainLinks(std::move(links), nodes), 0);
}

namespace {

/// How the triangle's plane rises from its side ab towards c, times a positive factor, by its gradient.
template <class Number>
Number rise(const PlainMesh& mesh, Index a, Index b, Index c, Number& magnitude) {
  const auto from_a = [&](Index v) {
    return std::array<Number, 3>{Number(mesh.at(v).x) - Number(mesh.at(a).x),
                                 Number(mesh.at(v).y) - Number(mesh.at(a).y),
                                 Number(mesh.z[v]) - Number(mesh.z[a])};
  };
  const auto [ux, uy, uz] = from_a(b);
  const auto [vx, vy, vz] = from_a(c);
  const auto size = [](const Number& x) { return x < 0 ? Number(-x) : x; };
  const Number gx = uz * vy - vz * uy, gy = vz * ux - uz * vx;
  magnitude = size(uy) * (size(Number(uz * vy)) + size(Number(vz * uy))) +
              size(ux) * (size(Number(vz * ux)) + size(Number(uz * vx)));
  return ux * gy - uy * gx;
}

}  // namespace

PlainValley look_at_valley(const PlainMesh& mesh, Index a, Index b, Index l, Index r) {
  const auto kind = mesh.constraints.find(std::minmax(a, b));
  PlainValley valley;
  valley.drawn = kind != mesh.constraints.end() && has(kind->second, EdgeKind::Valley);
  if (!valley.drawn || mesh.z[a] == mesh.z[b]) return valley;
  constexpr Extended kNear = 1e-8L, kRounding = 0x1p-58L;
  const auto sign_of = [&](Index from, Index to, Index apex) {
    Extended magnitude = 0;
    const Extended value = rise(mesh, from, to, apex, magnitude);
    if (!mesh.written.empty() && std::abs(value) <= kNear * magnitude) valley.certain = false;
    if (std::abs(value) > magnitude * kRounding) return value > 0 ? 1 : -1;
    using Rational = boost::multiprecision::cpp_rational;
    Rational exact_magnitude = 0;
    return rise(mesh, from, to, apex, exact_magnitude).sign();
  };
  const int left = sign_of(a, b, l), right = sign_of(b, a, r);
  valley.drains = left >= 0 && right >= 0 && left + right > 0;
  return valley;
}

}  // namespace thalweg::verify
