#pragma once

/// Seeded random scenes: the same seed gives the same scenes on every machine.

#include <support/oracle/scene.hpp>

#include <cstdint>
#include <string>
#include <string_view>

namespace thalweg::oracle {

/// A small generator of its own (splitmix64), because the standard distributions differ between libraries.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : state_(seed) {}
  /// Seeded by a name, so that each test has its own stream; environment THALWEG_SEED is mixed in where it is
  /// set.
  explicit Dice(std::string_view name);
  std::uint64_t next();
  /// Uniform in low .. high, both included.
  int between(int low, int high);
  [[nodiscard]] std::uint64_t state() const { return state_; }

 private:
  std::uint64_t state_;
};

struct SceneOptions {
  int fewest = 4;       ///< sites
  int most = 16;        ///< sites
  int range = 100;      ///< coordinates are 0 .. range
  int constraints = 8;  ///< at most that many constraint edges besides the boundary
};

/// Sites of which no three are collinear and no four cocircular; constraint edges between them at random,
/// often as chains that share ends. Plane mode.
Scene random_scene(Dice& dice, const SceneOptions& options);
/// Sites on a small lattice, many collinear and cocircular; constraint edges between them. Plane mode.
Scene random_lattice_scene(Dice& dice, const SceneOptions& options);
/// Many sites on one circle, some inside it, and some on its tangents; constraint edges that touch the
/// circle, end on it and cross it. Plane mode. options.range is not used.
Scene random_circle_scene(Dice& dice, const SceneOptions& options);
/// A simple polygon through all sites, in general position. Polygon mode. options.constraints is not used.
Scene random_polygon(Dice& dice, const SceneOptions& options);
/// A polygon with further sites and constraint edges inside, and now and then a hole. Polygon mode.
Scene random_ground(Dice& dice, const SceneOptions& options);

/// True if site v can be added: no three collinear, no four cocircular with the earlier ones.
bool in_general_position(const std::vector<Site>& sites, Site candidate);

}  // namespace thalweg::oracle
