// Values by one loop over triangles, edges or vertices.
//
// Terms are computed in extended precision by other formulas than the optimiser's, then rounded to steps of
// 2^-32, so they may differ by one step. Whether an edge is convex is decided exactly: the sign of the volume
// of its four corners.
#include "verify/plain_criteria.hpp"

#include "verify/exact.hpp"
#include "verify/plain_water.hpp"

#include <boost/multiprecision/cpp_int.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>

namespace thalweg::verify {

namespace {

using Extended = long double;
constexpr Extended kSteps = 0x1p32L;
constexpr Extended kLargestRatio = 0x1p20L;
constexpr Extended kDegrees = 180 / std::numbers::pi_v<Extended>;

std::int64_t to_steps(Extended value) {
  constexpr Extended kMost = 0x1p30L;
  const Extended within = std::isnan(value) ? kMost : std::clamp(value, -kMost, kMost);  // beyond all numbers
  return static_cast<std::int64_t>(std::floor(within * kSteps + 0.5L));
}

struct Known {
  const char* name;
  Depends depends;
  Combines combines;
  bool maximised;
  bool counts;
};

constexpr std::array<Known, 19> kKnown = {
    {{"local-minima", Depends::OnPlateau, Combines::Sum, false, true},
     {"normal-angle-sum", Depends::OnEdge, Combines::Sum, false, false},
     {"normal-angle-squares", Depends::OnEdge, Combines::Sum, false, false},
     {"normal-angle-max", Depends::OnEdge, Combines::Largest, false, false},
     {"max-area", Depends::OnTriangle, Combines::Largest, false, false},
     {"max-angle", Depends::OnTriangle, Combines::Largest, false, false},
     {"min-angle", Depends::OnTriangle, Combines::Smallest, true, false},
     {"edge-length", Depends::OnEdge, Combines::Sum, false, false},
     {"area-ratio-max", Depends::OnEdge, Combines::Largest, false, false},
     {"area-ratio-sum", Depends::OnEdge, Combines::Sum, false, false},
     {"convex-edges", Depends::OnEdge, Combines::Sum, true, true},
     {"flat-triangles", Depends::OnTriangle, Combines::Sum, false, true},
     {"vertical-error", Depends::OnTriangle, Combines::Sum, false, false},
     {"convex-vertices", Depends::OnVertex, Combines::Sum, true, true},
     {"mixed-vertices", Depends::OnVertex, Combines::Sum, false, true},
     {"max-degree", Depends::OnVertex, Combines::Largest, false, true},
     {"pit-depth", Depends::OnPlateau, Combines::Sum, false, false},
     {"valley-triangles", Depends::OnTriangle, Combines::Sum, false, true},
     {"draining-valleys", Depends::OnEdge, Combines::Sum, true, false}}};

const Known* find_known(const std::string& name) {
  const auto* known =
      std::find_if(kKnown.begin(), kKnown.end(), [&](const Known& k) { return name == k.name; });
  return known == kKnown.end() ? nullptr : known;
}

// Twice the area in the plane, in square metres.
Extended doubled_area(const PlainMesh& mesh, PlainScale scale, Index a, Index b, Index c) {
  const Point2 p = mesh.at(a), q = mesh.at(b), r = mesh.at(c);
  return ((Extended{q.x} - p.x) * (Extended{r.y} - p.y) - (Extended{q.y} - p.y) * (Extended{r.x} - p.x)) *
         scale.horizontal * scale.horizontal;
}

using Normal = std::array<Extended, 3>;

Normal cross(const Normal& p, const Normal& q) {
  return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
}

/// From a to v, in metres.
Normal side_of(const PlainMesh& mesh, PlainScale scale, Index a, Index v) {
  return {(Extended{mesh.at(v).x} - mesh.at(a).x) * scale.horizontal,
          (Extended{mesh.at(v).y} - mesh.at(a).y) * scale.horizontal,
          (Extended{mesh.z[v]} - mesh.z[a]) * scale.vertical};
}

/// Upwards, as long as twice the area.
Normal normal_of(const PlainMesh& mesh, PlainScale scale, Index a, Index b, Index c) {
  return cross(side_of(mesh, scale, a, b), side_of(mesh, scale, a, c));
}

Extended length_of(const Normal& n) {
  return std::hypot(n[0], n[1], n[2]);
}

// The angle's tangent is the length of the cross product over the dot.
Extended normal_angle(const PlainMesh& mesh, PlainScale scale, Index a, Index b, Index l, Index r) {
  const Normal m = normal_of(mesh, scale, a, b, l), n = normal_of(mesh, scale, b, a, r);
  return std::atan2(length_of(cross(m, n)), m[0] * n[0] + m[1] * n[1] + m[2] * n[2]);
}

Extended corner_angle(const PlainMesh& mesh, Index at, Index b, Index c) {
  const Extended bx = Extended{mesh.at(b).x} - mesh.at(at).x, by = Extended{mesh.at(b).y} - mesh.at(at).y,
                 cx = Extended{mesh.at(c).x} - mesh.at(at).x, cy = Extended{mesh.at(c).y} - mesh.at(at).y;
  return std::atan2(std::abs(bx * cy - by * cx), bx * cx + by * cy) * kDegrees;
}

// The volume of r above the plane of a, b, l, and the size of what it is the sum of: below it is convex.
struct Volume {
  Extended value = 0, magnitude = 0;
};

Volume volume_at(const PlainMesh& mesh, Index a, Index b, Index l, Index r) {
  const auto difference = [&](Index v) {
    return std::array<Extended, 3>{Extended{mesh.at(v).x} - mesh.at(a).x,
                                   Extended{mesh.at(v).y} - mesh.at(a).y, Extended{mesh.z[v]} - mesh.z[a]};
  };
  const auto p = difference(b), q = difference(l), s = difference(r);
  Volume volume;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    volume.value += s[i] * (p[j] * q[k] - p[k] * q[j]);
    volume.magnitude += std::abs(s[i]) * (std::abs(p[j] * q[k]) + std::abs(p[k] * q[j]));
  }
  return volume;
}

}  // namespace

int bend(const PlainMesh& mesh, Index a, Index b, Index l, Index r) {
  const Volume volume = volume_at(mesh, a, b, l, r);
  if (std::abs(volume.value) > volume.magnitude * 0x1p-58L) return volume.value < 0 ? 1 : -1;
  using Rational = boost::multiprecision::cpp_rational;
  const auto exact = [&](Index v) {
    return std::array<Rational, 3>{Rational(mesh.at(v).x) - Rational(mesh.at(a).x),
                                   Rational(mesh.at(v).y) - Rational(mesh.at(a).y),
                                   Rational(mesh.z[v]) - Rational(mesh.z[a])};
  };
  const auto ep = exact(b), eq = exact(l), es = exact(r);
  Rational sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    sum += es[i] * (ep[j] * eq[k] - ep[k] * eq[j]);
  }
  return -sum.sign();
}

namespace {

Extended triangle_part(const PlainMesh& mesh, PlainScale scale, const PlainCriterion& criterion,
                       const std::string& name, Index a, Index b, Index c) {
  if (name == "vertical-error") {
    return criterion.reference->squares(mesh, a, b, c) * scale.vertical * scale.vertical;
  }
  if (name == "max-area") return doubled_area(mesh, scale, a, b, c) / 2 / criterion.term_unit;
  if (name == "flat-triangles") return mesh.z[a] == mesh.z[b] && mesh.z[b] == mesh.z[c] ? 1 : 0;
  if (name == "valley-triangles") return mesh.on_valley[a] && mesh.on_valley[b] && mesh.on_valley[c] ? 1 : 0;
  const Extended first = corner_angle(mesh, a, b, c), second = corner_angle(mesh, b, c, a),
                 third = corner_angle(mesh, c, a, b);
  return name == "max-angle" ? std::max({first, second, third}) : std::min({first, second, third});
}

Extended edge_part(const PlainMesh& mesh, PlainScale scale, const std::string& name, Index a, Index b,
                   Index l, Index r) {
  const bool of_valleys = name == "draining-valleys";
  if (of_valleys && !look_at_valley(mesh, a, b, l, r).drains) return 0;
  if (of_valleys || name == "edge-length") {
    return std::hypot(Extended{mesh.at(b).x} - mesh.at(a).x, Extended{mesh.at(b).y} - mesh.at(a).y) *
           scale.horizontal;
  }
  if (name == "convex-edges") return bend(mesh, a, b, l, r) > 0 ? 1 : 0;
  if (name.starts_with("area-ratio")) {
    const Extended left = doubled_area(mesh, scale, a, b, l), right = doubled_area(mesh, scale, b, a, r);
    const Extended least = std::min(left, right);
    return least > 0 ? std::min(std::max(left, right) / least, kLargestRatio) : kLargestRatio;
  }
  const Extended angle = normal_angle(mesh, scale, a, b, l, r);
  if (name == "normal-angle-squares") return angle * angle;
  return name == "normal-angle-max" ? angle * kDegrees : angle;
}

// Calls f(a, b, l, r) for every edge with triangles on both sides.
template <class F>
void for_inner_edges(const PlainMesh& mesh, const F& f) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Index other = mesh.across[t][i];
      if (other == kNone || other < t) continue;
      const Index a = mesh.triangles[t][i], b = mesh.triangles[t][(i + 1) % 3];
      Index r = kNone;
      for (const Index v : mesh.triangles[other]) {
        if (v != a && v != b) r = v;
      }
      f(a, b, mesh.triangles[t][(i + 2) % 3], r);
    }
  }
}

}  // namespace

std::vector<bool> rim_of(const PlainMesh& mesh) {
  std::vector<bool> rim(mesh.xy.size(), false);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (mesh.across[t][i] != kNone) continue;
      rim[mesh.triangles[t][i]] = rim[mesh.triangles[t][(i + 1) % 3]] = true;
    }
  }
  return rim;
}

namespace {

Extended vertex_part(const std::string& name, const PlainRing& ring) {
  if (name == "max-degree") return static_cast<Extended>(ring.edges);
  if (ring.on_rim) return 0;
  if (name == "convex-vertices") return ring.convex == ring.edges ? 1 : 0;
  return ring.convex > 0 && ring.reflex > 0 ? 1 : 0;  // mixed-vertices
}

/// Of all vertices that are in a triangle.
std::vector<PlainRing> rings_of(const PlainMesh& mesh) {
  std::vector<PlainRing> rings(mesh.xy.size());
  const std::vector<bool> rim = rim_of(mesh);
  for (std::size_t v = 0; v < rings.size(); ++v) rings[v].on_rim = rim[v];
  for_inner_edges(mesh, [&](Index a, Index b, Index l, Index r) {
    const int side = bend(mesh, a, b, l, r);
    for (const Index v : {a, b}) {
      ++rings[v].edges;
      rings[v].convex += side > 0 ? 1 : 0;
      rings[v].reflex += side < 0 ? 1 : 0;
    }
  });
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (mesh.across[t][i] != kNone) continue;
      ++rings[mesh.triangles[t][i]].edges;
      ++rings[mesh.triangles[t][(i + 1) % 3]].edges;
    }
  }
  std::erase_if(rings, [](const PlainRing& ring) { return ring.edges == 0; });
  return rings;
}

// A set's representative, with the path to it halved on the way.
Index find(std::vector<Index>& parent, Index v) {
  while (parent[v] != v) v = parent[v] = parent[parent[v]];
  return v;
}

}  // namespace

std::optional<PlainCriterion> plain_criterion(const std::string& name, const PlainReference* reference) {
  PlainCriterion criterion;
  if (name.find("vertical-error") != std::string::npos && reference == nullptr) return std::nullopt;
  if (const Known* known = find_known(name)) {
    criterion = {{{1, name}}, known->depends, known->combines, known->maximised, known->counts, reference};
    if (name == "max-area") criterion.term_unit = 1024;
    return criterion;
  }
  criterion.reference = reference;
  criterion.counts = false;
  std::size_t at = 0;
  while (at < name.size()) {
    std::size_t used = 0;
    double weight = 0;
    try {
      weight = std::stod(name.substr(at), &used);
    } catch (const std::exception&) {
      return std::nullopt;
    }
    at += used;
    if (at >= name.size() || name[at] != '*') return std::nullopt;
    std::size_t end = at + 1;  // a name holds hyphens: the next part begins at a sign before a digit
    while (end < name.size() &&
           !((name[end] == '+' || name[end] == '-') && end + 1 < name.size() &&
             (std::isdigit(static_cast<unsigned char>(name[end + 1])) != 0 || name[end + 1] == '.'))) {
      ++end;
    }
    const std::string part = name.substr(at + 1, end - at - 1);
    const Known* known = find_known(part);
    if (known == nullptr || known->combines != Combines::Sum || known->depends == Depends::OnPlateau) {
      return std::nullopt;
    }
    criterion.parts.push_back({weight, part});
    criterion.depends = std::max(criterion.depends, known->depends);
    at = end;
  }
  return criterion.parts.empty() ? std::nullopt : std::optional(criterion);
}

std::int64_t triangle_term(const PlainMesh& mesh, PlainScale scale, const PlainCriterion& criterion, Index a,
                           Index b, Index c) {
  std::int64_t steps = 0;
  for (const PlainCriterion::Part& part : criterion.parts) {
    if (find_known(part.name)->depends != Depends::OnTriangle) continue;
    steps += to_steps(part.weight * triangle_part(mesh, scale, criterion, part.name, a, b, c));
  }
  return steps;
}

std::int64_t edge_term(const PlainMesh& mesh, PlainScale scale, const PlainCriterion& criterion, Index a,
                       Index b, Index l, Index r) {
  std::int64_t steps = 0;
  for (const PlainCriterion::Part& part : criterion.parts) {
    if (find_known(part.name)->depends != Depends::OnEdge) continue;
    steps += to_steps(part.weight * edge_part(mesh, scale, part.name, a, b, l, r));
  }
  return steps;
}

std::int64_t vertex_term(const PlainCriterion& criterion, const PlainRing& ring) {
  std::int64_t steps = 0;
  for (const PlainCriterion::Part& part : criterion.parts) {
    if (find_known(part.name)->depends != Depends::OnVertex) continue;
    steps += to_steps(part.weight * vertex_part(part.name, ring));
  }
  return steps;
}

bool has_vertex_part(const PlainCriterion& criterion) {
  return std::any_of(criterion.parts.begin(), criterion.parts.end(), [](const PlainCriterion::Part& part) {
    return find_known(part.name)->depends == Depends::OnVertex;
  });
}

std::int64_t constant_term(const PlainMesh& mesh, PlainScale scale, const PlainCriterion& criterion) {
  std::int64_t steps = 0;
  for (const PlainCriterion::Part& part : criterion.parts) {
    if (part.name != "vertical-error") continue;
    steps +=
        to_steps(part.weight * criterion.reference->squares_left(mesh) * scale.vertical * scale.vertical);
  }
  return steps;
}

// A crossing of lines was placed in the plane; its written coordinates lead back to within nanometres. So far
// edges that are nearly flat cannot be told from flat or slightly bent ones, which are so many.
std::size_t count_uncertain_bends(const PlainMesh& mesh) {
  constexpr Extended kFlat = 1e-8L;
  std::size_t count = 0;
  if (mesh.written.empty()) return count;
  for_inner_edges(mesh, [&](Index a, Index b, Index l, Index r) {
    const Volume volume = volume_at(mesh, a, b, l, r);
    if (volume.magnitude > 0 && std::abs(volume.value) <= kFlat * volume.magnitude) ++count;
  });
  return count;
}

/// Length of drawn valleys of which the same holds.
Extended uncertain_valleys(const PlainMesh& mesh, PlainScale scale) {
  Extended length = 0;
  for_inner_edges(mesh, [&](Index a, Index b, Index l, Index r) {
    if (look_at_valley(mesh, a, b, l, r).certain) return;
    length += edge_part(mesh, scale, "edge-length", a, b, l, r);
  });
  return length;
}

/// By what share another correct rounding may change a triangle's normal, if `in_space`, or its area: much
/// where it is so thin that its area is small beside the square of its longest side.
Extended rounding_of(const PlainMesh& mesh, PlainScale scale, bool in_space, Index a, Index b, Index c) {
  constexpr Extended kRounding = 0x1p-50L;
  if (!in_space) scale.vertical = 0;
  const Extended longest =
      std::max({length_of(side_of(mesh, scale, a, b)), length_of(side_of(mesh, scale, b, c)),
                length_of(side_of(mesh, scale, c, a))});
  const Extended area = length_of(normal_of(mesh, scale, a, b, c));
  return area > 0 ? kRounding * longest * longest / area : 1 / kRounding;
}

/// By how much another correct rounding may change the terms of such a part: all of them, or the one that
/// it changes most.
Extended rounding_of_edges(const PlainMesh& mesh, PlainScale scale, const std::string& name,
                           Combines combines) {
  constexpr Extended kHalfTurn = 180 / kDegrees;
  const bool of_normals = name.starts_with("normal-angle");
  Extended sum = 0, most = 0;
  if (!of_normals && !name.starts_with("area-ratio")) return 0;
  for_inner_edges(mesh, [&](Index a, Index b, Index l, Index r) {
    Extended change =
        rounding_of(mesh, scale, of_normals, a, b, l) + rounding_of(mesh, scale, of_normals, b, a, r);
    if (of_normals) change = std::min(change, kHalfTurn);
    if (name == "normal-angle-squares") change *= 2 * kHalfTurn;
    if (name == "normal-angle-max") change *= kDegrees;
    if (!of_normals) change = std::min(change * edge_part(mesh, scale, name, a, b, l, r), kLargestRatio);
    sum += change;
    most = std::max(most, change);
  });
  return combines == Combines::Sum ? sum : most;
}

PlainValue value_of(const PlainMesh& mesh, PlainScale scale, const PlainCriterion& criterion) {
  if (criterion.depends == Depends::OnPlateau) {
    if (criterion.parts.front().name == "pit-depth") return pit_depth(mesh, scale);
    return {static_cast<Extended>(count_pits(mesh).interior), 0};
  }
  std::vector<std::int64_t> terms;
  if (has_vertex_part(criterion)) {
    for (const PlainRing& ring : rings_of(mesh)) terms.push_back(vertex_term(criterion, ring));
  }
  for (const Corners& t : mesh.triangles) {
    const bool any = criterion.depends == Depends::OnTriangle || criterion.parts.size() > 1;
    if (any) terms.push_back(triangle_term(mesh, scale, criterion, t[0], t[1], t[2]));
  }
  if (criterion.depends == Depends::OnEdge || criterion.parts.size() > 1) {
    for_inner_edges(mesh, [&](Index a, Index b, Index l, Index r) {
      terms.push_back(edge_term(mesh, scale, criterion, a, b, l, r));
    });
  }
  if (criterion.combines != Combines::Sum) {
    const auto [least, most] = std::minmax_element(terms.begin(), terms.end());
    if (terms.empty()) return {};
    const Extended value = static_cast<Extended>(criterion.combines == Combines::Largest ? *most : *least) /
                           kSteps * criterion.term_unit;
    const Extended rounding =
        rounding_of_edges(mesh, scale, criterion.parts.front().name, criterion.combines);
    return {value,
            criterion.counts ? 0 : 2 * criterion.term_unit / kSteps + std::abs(value) * 1e-12L + rounding};
  }
  Extended sum = std::accumulate(terms.begin(), terms.end(), Extended{0},
                                 [](Extended s, std::int64_t t) { return s + static_cast<Extended>(t); });
  sum += static_cast<Extended>(constant_term(mesh, scale, criterion));
  const Extended parts = static_cast<Extended>(criterion.parts.size());
  Extended tolerance = criterion.counts ? 0
                                        : static_cast<Extended>(terms.size()) * parts / kSteps +
                                              std::abs(sum / kSteps) * 1e-12L;
  for (const PlainCriterion::Part& part : criterion.parts) {
    tolerance += std::abs(part.weight) * rounding_of_edges(mesh, scale, part.name, Combines::Sum);
    if (part.name == "draining-valleys") tolerance += std::abs(part.weight) * uncertain_valleys(mesh, scale);
    if (part.name != "convex-edges" && part.name != "convex-vertices" && part.name != "mixed-vertices")
      continue;
    const Extended ends = part.name == "convex-edges" ? 1 : 2;
    tolerance += ends * std::abs(part.weight) * static_cast<Extended>(count_uncertain_bends(mesh));
  }
  return {sum / kSteps, tolerance};
}

PlainPits count_pits(const PlainMesh& mesh) {
  std::vector<Index> parent(mesh.xy.size());
  std::iota(parent.begin(), parent.end(), Index{0});
  const auto for_edges = [&](const auto& f) {
    for (const Corners& t : mesh.triangles) {
      for (std::size_t i = 0; i < 3; ++i) f(t[i], t[(i + 1) % 3]);
    }
  };
  for_edges([&](Index a, Index b) {
    if (mesh.z[a] == mesh.z[b]) parent[find(parent, a)] = find(parent, b);
  });
  std::vector<bool> drained(parent.size(), false), outlet(parent.size(), false), lake(parent.size(), false),
      used(parent.size(), false);
  for_edges([&](Index a, Index b) {
    used[find(parent, a)] = true;
    if (mesh.z[a] < mesh.z[b]) drained[find(parent, b)] = true;
    if (mesh.z[b] < mesh.z[a]) drained[find(parent, a)] = true;
  });
  for (const auto& [edge, kind] : mesh.constraints) {
    if (has(kind, EdgeKind::Lake) && mesh.z[edge.first] == mesh.z[edge.second])
      lake[find(parent, edge.first)] = true;
  }
  const std::vector<bool> rim = rim_of(mesh);
  for (Index v = 0; v < rim.size(); ++v) {
    if (rim[v]) outlet[find(parent, v)] = true;
  }
  PlainPits pits;
  for (Index v = 0; v < parent.size(); ++v) {
    if (parent[v] != v || drained[v] || !used[v]) continue;
    ++(outlet[v] ? pits.boundary : lake[v] ? pits.lake : pits.interior);
  }
  return pits;
}

}  // namespace thalweg::verify
