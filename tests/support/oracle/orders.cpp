// One function a definition, each for one point p inside the circle of t = uvw, p lying beyond side uv.
//
// sees-triang: constraint edges cast closed shadows from p on the open side uv. Each shadow ends in the
// direction of a constraint edge's end or leaves uv, so between two directions that follow each other along
// uv all points of uv are seen or none is: one point between is tried for each pair.
#include <support/oracle/orders.hpp>
#include <support/oracle/path_by_parity.hpp>

#include <algorithm>
#include <bit>

namespace thalweg::oracle {

namespace {

constexpr SiteSet bit(int v) {
  return SiteSet{1} << v;
}

// The point (v * towards_v + u * towards_u) / (towards_v + towards_u) of a side uv.
struct Share {
  std::int64_t towards_v = 0;
  std::int64_t towards_u = 0;
};
bool nearer_u(const Share& a, const Share& b) {
  return Wide{a.towards_v} * b.towards_u < Wide{b.towards_v} * a.towards_u;
}

}  // namespace

// Site p inside the circle of the counter-clockwise triangle uvw, beyond side uv.
struct Oracle::Place {
  int u, v, w, p;
  SiteSet members;
};

std::string_view name_of(Definition definition) {
  constexpr std::array<std::string_view, kDefinitionCount> kNames{
      "std", "pathcon", "sees-triang", "sees-vtx", "conf-edge", "sees-opp", "sees-3vtx", "empty-quad"};
  return kNames[static_cast<std::size_t>(definition)];
}

Oracle::Oracle(Scene scene) : scene_(std::move(scene)), sights_(scene_.sites.size(), 0) {
  for (int p = 0; p < scene_.size(); ++p) {
    for (int q = 0; q < p; ++q) {
      if (!oracle::sees(scene_, p, q)) continue;
      sights_[static_cast<std::size_t>(p)] |= bit(q);
      sights_[static_cast<std::size_t>(q)] |= bit(p);
    }
  }
}

Validity Oracle::validity(Corners t) const {
  const Site a = scene_.at(t[0]), b = scene_.at(t[1]), c = scene_.at(t[2]);
  const std::int64_t area = turn(a, b, c);
  if (area == 0) return Validity::Flat;
  for (int x = 0; x < scene_.size(); ++x) {
    if (x == t[0] || x == t[1] || x == t[2]) continue;
    const Site s = scene_.at(x);
    const int sign = area > 0 ? 1 : -1;
    if (sign * turn(a, b, s) >= 0 && sign * turn(b, c, s) >= 0 && sign * turn(c, a, s) >= 0)
      return Validity::Occupied;
  }
  if (!in_ground(scene_, {a.x + b.x + c.x, a.y + b.y + c.y, 3})) return Validity::OffGround;
  return sees(t[0], t[1]) && sees(t[1], t[2]) && sees(t[2], t[0]) ? Validity::Valid : Validity::Crossed;
}

std::vector<Corners> Oracle::valid_triangles() const {
  std::vector<Corners> triangles;
  for (int a = 0; a < scene_.size(); ++a) {
    for (int b = a + 1; b < scene_.size(); ++b) {
      for (int c = b + 1; c < scene_.size(); ++c) {
        if (validity({a, b, c}) == Validity::Valid) triangles.push_back(scene_.counter_clockwise({a, b, c}));
      }
    }
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

SiteSet Oracle::members(Corners t) const {
  SiteSet inside = 0;
  for (int p = 0; p < scene_.size(); ++p) {
    if (p == t[0] || p == t[1] || p == t[2]) continue;
    if (member_of_circle(scene_.at(t[0]), scene_.at(t[1]), scene_.at(t[2]), scene_.at(p))) inside |= bit(p);
  }
  return inside;
}

SiteSet Oracle::counted(Corners t, Definition definition) const {
  t = scene_.counter_clockwise(t);
  const SiteSet inside = members(t);
  SiteSet result = 0;
  for (int p = 0; p < scene_.size(); ++p) {
    if ((inside & bit(p)) == 0) continue;
    for (std::size_t side = 0; side < 3; ++side) {
      const Place place{t[side], t[(side + 1) % 3], t[(side + 2) % 3], p, inside};
      if (turn(scene_.at(place.u), scene_.at(place.v), scene_.at(p)) < 0 && counts(place, definition))
        result |= bit(p);
    }
  }
  return result;
}

std::array<SiteSet, kDefinitionCount> Oracle::counted(Corners t) const {
  std::array<SiteSet, kDefinitionCount> all{};
  for (const Definition d : kDefinitions) all[static_cast<std::size_t>(d)] = counted(t, d);
  return all;
}

int Oracle::order(Corners t, Definition definition) const {
  return std::popcount(counted(t, definition));
}

Orders Oracle::orders(Corners t) const {
  Orders orders{};
  for (const Definition d : kDefinitions) orders[static_cast<std::size_t>(d)] = order(t, d);
  return orders;
}

bool Oracle::counts(const Place& place, Definition definition) const {
  const auto& [u, v, w, p, inside] = place;
  const bool open_side = !scene_.constrained(u, v);
  switch (definition) {
    case Definition::Std:
      return true;
    case Definition::Pathcon:
      return path_joins(scene_, {u, v, w}, p);
    case Definition::SeesTriang:
      return open_side && sees_side(place);
    case Definition::SeesVtx:
      return open_side && sees_side(place) && (sees(p, u) || sees(p, v) || sees(p, w));
    case Definition::ConfEdge:
      return has_conflicting_edge(place);
    case Definition::SeesOpp:
      return open_side && sees(p, w);
    case Definition::Sees3Vtx:
      return open_side && sees(p, u) && sees(p, v) && sees(p, w);
    case Definition::EmptyQuad:
      return open_side && sees(p, u) && sees(p, v) && sees(p, w) && spans_empty_triangle(place);
  }
  return false;
}

bool Oracle::sees_side(const Place& place) const {
  const Site u = scene_.at(place.u), v = scene_.at(place.v), p = scene_.at(place.p);
  std::vector<Share> shares{{0, 1}, {1, 0}};
  for (const auto& [a, b] : scene_.constraints) {
    for (const int end : {a, b}) {
      const Share share{turn(p, scene_.at(end), u), turn(p, v, scene_.at(end))};
      if (share.towards_v > 0 && share.towards_u > 0) shares.push_back(share);
    }
  }
  std::sort(shares.begin(), shares.end(), nearer_u);
  for (std::size_t i = 1; i < shares.size(); ++i) {
    if (!nearer_u(shares[i - 1], shares[i])) continue;
    const Wide to_v = shares[i - 1].towards_v + shares[i].towards_v;
    const Wide to_u = shares[i - 1].towards_u + shares[i].towards_u;
    const Spot between{to_v * v.x + to_u * u.x, to_v * v.y + to_u * u.y, to_v + to_u};
    const auto blocks = [&](const Edge& e) {
      if (e.first == place.p || e.second == place.p) return false;  // its shadow is one point at most
      return segments_meet(spot_of(p), between, spot_of(scene_.at(e.first)), spot_of(scene_.at(e.second)));
    };
    if (std::none_of(scene_.constraints.begin(), scene_.constraints.end(), blocks)) return true;
  }
  return false;
}

bool Oracle::has_conflicting_edge(const Place& place) const {
  const auto& [u, v, w, p, inside] = place;
  for (int r = 0; r < scene_.size(); ++r) {
    if (r == p || (inside & bit(r)) == 0) {
      if (r != w) continue;  // from beyond uv, neither pu nor pv meets the interior
    }
    // pr meets the interior of t if it ends beyond the line uv and passes strictly between u and v.
    const Site from = scene_.at(p), to = scene_.at(r);
    const bool through = turn(scene_.at(u), scene_.at(v), to) > 0 && turn(from, to, scene_.at(u)) > 0 &&
                         turn(from, scene_.at(v), to) > 0;
    if (through && sees(p, r)) return true;
  }
  return false;
}

bool Oracle::spans_empty_triangle(const Place& place) const {
  const Site u = scene_.at(place.u), v = scene_.at(place.v), p = scene_.at(place.p);
  for (int x = 0; x < scene_.size(); ++x) {
    if (x == place.u || x == place.v || x == place.p) continue;
    const Site s = scene_.at(x);
    if (turn(v, u, s) >= 0 && turn(u, p, s) >= 0 && turn(p, v, s) >= 0) return false;
  }
  return true;
}

}  // namespace thalweg::oracle
