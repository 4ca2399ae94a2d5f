// Scenes by rejection: sites one by one, then constraint edges one by one, each kept if the scene stays
// sound.
//
// Polygons: a random closed tour, uncrossed by reversing stretches until it is simple; each step shortens it.
#include <support/oracle/random_scenes.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

namespace thalweg::oracle {

namespace {

std::uint64_t hash(std::string_view text) {  // FNV-1a
  std::uint64_t value = 0xcbf29ce484222325U;
  for (const char c : text) value = (value ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  return value;
}

bool add_constraint(Scene& scene, Edge edge) {
  if (edge.first == edge.second || scene.constrained(edge.first, edge.second)) return false;
  if (!sees(scene, edge.first, edge.second)) return false;
  for (int v = 0; v < scene.size(); ++v) {
    if (inside_segment(scene.at(edge.first), scene.at(edge.second), scene.at(v))) return false;
  }
  scene.constraints.push_back(edge_of(edge.first, edge.second));
  return true;
}

void add_constraints(Dice& dice, Scene& scene, int most) {
  const int wanted = dice.between(0, most);
  const bool chains = dice.between(0, 2) == 0;
  int last = dice.between(0, scene.size() - 1);
  for (int tries = 0, added = 0; tries < 8 * most && added < wanted; ++tries) {
    const int from = chains ? last : dice.between(0, scene.size() - 1);
    const int to = dice.between(0, scene.size() - 1);
    if (!add_constraint(scene, {from, to})) continue;
    ++added;
    last = to;
  }
  std::sort(scene.constraints.begin(), scene.constraints.end());
}

void add_sites(Dice& dice, Scene& scene, int count, int range) {
  for (int tries = 0; scene.size() < count && tries < 1000; ++tries) {
    const Site site{dice.between(0, range), dice.between(0, range)};
    if (in_general_position(scene.sites, site)) scene.sites.push_back(site);
  }
}

bool all_collinear(const std::vector<Site>& sites) {
  return std::all_of(sites.begin(), sites.end(), [&](Site s) { return turn(sites[0], sites[1], s) == 0; });
}

bool tour_is_simple_after_uncrossing(const Scene& scene, std::vector<int>& tour) {
  const std::size_t n = tour.size();
  for (int rounds = 0; rounds < 1000; ++rounds) {
    bool crossed = false;
    for (std::size_t i = 0; i + 2 < n && !crossed; ++i) {
      for (std::size_t j = i + 2; j < n && !crossed; ++j) {
        if (i == 0 && j + 1 == n) continue;
        const auto spot = [&](std::size_t k) { return spot_of(scene.at(tour[k % n])); };
        if (!segments_meet(spot(i), spot(i + 1), spot(j), spot(j + 1))) continue;
        std::reverse(tour.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                     tour.begin() + static_cast<std::ptrdiff_t>(j) + 1);
        crossed = true;
      }
    }
    if (!crossed) return true;
  }
  return false;
}

// Marks the ring as constraint and boundary.
void add_ring(Scene& scene, const std::vector<int>& ring) {
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Edge e = edge_of(ring[i], ring[(i + 1) % ring.size()]);
    scene.constraints.push_back(e);
    scene.boundary.push_back(e);
  }
}

// A triangular hole between three sites that are not on the boundary, if one fits.
void try_hole(Dice& dice, Scene& scene, int first_inner) {
  if (scene.size() - first_inner < 3) return;
  for (int tries = 0; tries < 5; ++tries) {
    Scene holed = scene;
    std::array<int, 3> ring{};
    for (int& v : ring) v = dice.between(first_inner, scene.size() - 1);
    if (ring[0] == ring[1] || ring[1] == ring[2] || ring[2] == ring[0]) continue;
    if (!sees(scene, ring[0], ring[1]) || !sees(scene, ring[1], ring[2]) || !sees(scene, ring[2], ring[0]))
      continue;
    add_ring(holed, {ring.begin(), ring.end()});
    if (!defect(holed).empty()) continue;
    scene = holed;
    return;
  }
}

}  // namespace

Dice::Dice(std::string_view name) : state_(hash(name)) {
  const char* const extra = std::getenv("THALWEG_SEED");
  if (extra != nullptr) state_ ^= hash(extra);
}

std::uint64_t Dice::next() {
  state_ += 0x9e3779b97f4a7c15U;
  std::uint64_t z = state_;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31U);
}

int Dice::between(int low, int high) {
  return low + static_cast<int>(next() % static_cast<std::uint64_t>(high - low + 1));
}

bool in_general_position(const std::vector<Site>& sites, Site candidate) {
  for (std::size_t a = 0; a < sites.size(); ++a) {
    if (sites[a] == candidate) return false;
    for (std::size_t b = 0; b < a; ++b) {
      if (turn(sites[a], sites[b], candidate) == 0) return false;
      for (std::size_t c = 0; c < b; ++c) {
        if (power(sites[a], sites[b], sites[c], candidate) == 0) return false;
      }
    }
  }
  return true;
}

Scene random_scene(Dice& dice, const SceneOptions& options) {
  Scene scene;
  add_sites(dice, scene, dice.between(options.fewest, options.most), options.range);
  add_constraints(dice, scene, options.constraints);
  return scene;
}

Scene random_lattice_scene(Dice& dice, const SceneOptions& options) {
  const int count = dice.between(options.fewest, options.most);
  const int columns = dice.between(2, 5), spacing_x = dice.between(1, 3), spacing_y = dice.between(1, 3);
  const int rows = std::max(2, (count + columns - 1) / columns + dice.between(0, 1));
  std::vector<Site> lattice;
  for (int x = 0; x < columns; ++x) {
    for (int y = 0; y < rows; ++y) lattice.push_back({x * spacing_x, y * spacing_y});
  }
  for (std::size_t i = lattice.size(); i > 1; --i) {
    std::swap(lattice[i - 1], lattice[static_cast<std::size_t>(dice.between(0, static_cast<int>(i) - 1))]);
  }
  lattice.resize(std::min(lattice.size(), static_cast<std::size_t>(count)));
  if (all_collinear(lattice)) return random_lattice_scene(dice, options);
  Scene scene;
  scene.sites = lattice;
  add_constraints(dice, scene, options.constraints);
  return scene;
}

Scene random_circle_scene(Dice& dice, const SceneOptions& options) {
  constexpr int kRadius = 65;  // 36 lattice points on the circle
  std::vector<Site> rim;
  for (int x = -kRadius; x <= kRadius; ++x) {
    for (int y = -kRadius; y <= kRadius; ++y) {
      if (x * x + y * y == kRadius * kRadius) rim.push_back({x, y});
    }
  }
  Scene scene;
  const auto add = [&scene](Site site) {
    if (std::find(scene.sites.begin(), scene.sites.end(), site) == scene.sites.end())
      scene.sites.push_back(site);
  };
  const int count = std::max(4, dice.between(options.fewest, options.most));
  for (int i = 0; i < 3 * count && scene.size() < count; ++i) {
    const Site on = rim[static_cast<std::size_t>(dice.between(0, static_cast<int>(rim.size()) - 1))];
    const int kind = dice.between(0, 3);
    if (kind == 0 && scene.size() + 2 <= count) {
      add({on.x - on.y, on.y + on.x});  // the two ends of an edge that touches the circle in its middle
      add({on.x + on.y, on.y - on.x});
    } else if (kind == 1) {
      add({dice.between(-kRadius, kRadius), dice.between(-kRadius, kRadius)});
    } else {
      add(on);
    }
  }
  if (all_collinear(scene.sites)) return random_circle_scene(dice, options);
  for (int v = 0; options.constraints > 0 && v + 1 < scene.size(); ++v) {
    const Site a = scene.at(v), b = scene.at(v + 1);
    if (a.x * b.y - a.y * b.x == -2 * kRadius * kRadius && dice.between(0, 1) == 0)
      add_constraint(scene, {v, v + 1});
  }
  add_constraints(dice, scene, options.constraints);
  return scene;
}

Scene random_polygon(Dice& dice, const SceneOptions& options) {
  for (;;) {
    Scene scene;
    add_sites(dice, scene, dice.between(options.fewest, options.most), options.range);
    std::vector<int> tour(scene.sites.size());
    std::iota(tour.begin(), tour.end(), 0);
    if (!tour_is_simple_after_uncrossing(scene, tour)) continue;
    add_ring(scene, tour);
    std::sort(scene.constraints.begin(), scene.constraints.end());
    return scene;
  }
}

Scene random_ground(Dice& dice, const SceneOptions& options) {
  for (;;) {
    SceneOptions rim = options;
    rim.most = std::max(options.fewest, (options.most + options.fewest) / 2);
    Scene scene = random_polygon(dice, rim);
    const int first_inner = scene.size();
    for (int tries = 0; scene.size() < options.most && tries < 100; ++tries) {
      const Site site{dice.between(0, options.range), dice.between(0, options.range)};
      if (in_general_position(scene.sites, site) && in_ground(scene, spot_of(site)))
        scene.sites.push_back(site);
    }
    if (dice.between(0, 1) == 0) try_hole(dice, scene, first_inner);
    add_constraints(dice, scene, options.constraints);
    if (defect(scene).empty()) return scene;
  }
}

}  // namespace thalweg::oracle
