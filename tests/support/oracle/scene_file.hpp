#pragma once

/// Scenes kept as data: JSON files under tests/support/scenes (see the README there), and their pictures.

#include <support/oracle/orders.hpp>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace thalweg::oracle {

/// One triangle of a scene: which sites count under each definition, or why it has no order.
struct ExpectedTriangle {
  Corners corners{};
  std::string why;
  Validity validity = Validity::Valid;
  std::array<SiteSet, kDefinitionCount> counted{};  ///< empty where it is not valid
};

/// One edge of a scene and the smallest order at which it is useful, for some definitions.
struct ExpectedEdge {
  Edge edge;
  std::string why;
  std::map<Definition, int> useful;
  std::vector<Corners> greedy;  ///< triangles with which its greedy triangulation fills its hull, step by
                                ///< step; empty: not told
};

struct SceneFile {
  std::string name;                 ///< file name without extension
  std::string about;                ///< what the scene shows
  std::vector<std::string> labels;  ///< one a site: its name, or its number
  Scene scene;
  std::vector<ExpectedTriangle> triangles;
  std::vector<ExpectedEdge> edges;
};

/// Names of all scenes in the folder, sorted.
std::vector<std::string> scene_names(const std::string& folder);
/// Throws: std::runtime_error that names the file and what is wrong with it.
SceneFile read_scene(const std::string& folder, const std::string& name);
/// The scene as an SVG file: one panel a definition for its first triangle, counted sites as discs, members
/// of the circle that do not count as rings, others as dots; then, for each edge whose greedy triangulation
/// is told, the constrained Delaunay triangulation, the hull, and one panel a step. Without triangles the
/// constrained Delaunay triangulation alone.
std::string picture_of(const SceneFile& file);

}  // namespace thalweg::oracle
