// 1. The network as nodes and conduits (swmm_network).
// 2. The flow is found once more, with all nodes as stations: their catchments are the subcatchments.
//
// What a terrain does not tell has one value throughout, for the modeller to replace: Manning's roughness,
// the depth of channels, ground cover, losses, rain (none). Roughness of channels is that of natural ones,
// clean and winding, in Chow, "Open-channel hydraulics", 1959, table 5-6; of the ground and its losses, the
// defaults of SWMM's own editor.
//
// Sections and columns: Rossman, "Storm Water Management Model user's manual version 5.1", 2015, appendix
// D.2.
#include "pipeline/swmm.hpp"

#include "pipeline/swmm_network.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/terrain/catchments.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <utility>
#include <vector>

namespace thalweg {

namespace {

constexpr double kRoughness = 0.04;
constexpr double kChannelDepthM = 2;
constexpr double kLeastSideSlope = 1e-3;  // of the ground beside a channel: SWMM takes no level side
constexpr double kSquareMetresPerHectare = 1e4;
constexpr std::size_t kNoNode = static_cast<std::size_t>(-1);

/// What drains to a node.
struct Ground {
  std::size_t node = kNoNode;
  double area_m2 = 0;
  std::vector<std::pair<double, double>> slopes;  // and areas, of triangles whose lowest corner drains here
  std::vector<std::vector<Point2>> rings;         // of all its parts and their holes, as written
};

/// SWMM knows polygons of one ring: parts and holes hang on the first one by cuts, there and back, so its
/// area is theirs.
std::vector<Point2> joined(const std::vector<std::vector<Point2>>& rings) {
  std::vector<Point2> all;
  for (const std::vector<Point2>& ring : rings) {
    if (all.empty()) {
      all = ring;
    } else if (!ring.empty()) {
      const Point2 start = ring.front();
      const auto nearest = std::ranges::min_element(
          all, {}, [&](Point2 p) { return std::hypot(p.x - start.x, p.y - start.y); });
      std::vector<Point2> detour(ring.begin(), ring.end());
      detour.insert(detour.end(), {start, *nearest});
      all.insert(nearest + 1, detour.begin(), detour.end());
    }
  }
  return all;
}

/// Area in square metres, and slope.
std::pair<double, double> measure(const Tin& tin, const Triangle& t, const MetricScale& scale) {
  const double h = scale.horizontal_metres_per_unit, v = scale.vertical_metres_per_unit;
  const Point2 a = tin.point(t[0]), b = tin.point(t[1]), c = tin.point(t[2]);
  const double x1 = (b.x - a.x) * h, y1 = (b.y - a.y) * h, x2 = (c.x - a.x) * h, y2 = (c.y - a.y) * h;
  const double z1 = (tin.height(t[1]) - tin.height(t[0])) * v, z2 = (tin.height(t[2]) - tin.height(t[0])) * v;
  const double doubled = x1 * y2 - x2 * y1;
  return {doubled / 2, std::hypot(z1 * y2 - z2 * y1, z2 * x1 - z1 * x2) / doubled};
}

/// Half of the area is steeper. A mean would be that of walls: triangles at the rim may be slivers.
double middle_slope(std::vector<std::pair<double, double>> slopes) {
  std::sort(slopes.begin(), slopes.end());
  double whole = 0, below = 0;
  for (const auto& [slope, area] : slopes) whole += area;
  for (const auto& [slope, area] : slopes) {
    below += area;
    if (below >= whole / 2) return slope;
  }
  return 0;
}

/// By sink of the flow that ends at nodes: the sink of the node to which its water comes, or itself.
std::vector<std::uint32_t> group_sinks(const Tin& tin, const SurfaceFlow& flow, const SwmmView& view,
                                       const std::vector<Ground>& ground) {
  const std::vector<bool> rim = tin.rim_vertices();
  std::vector<std::uint32_t> group;
  for (std::uint32_t s = 0; s < flow.sinks().size(); ++s) {
    std::uint32_t end = s;
    // Pits come first, and are the same ones in both flows.
    while (ground[end].node == kNoNode && end < view.spilling.overflow.size() &&
           view.spilling.overflow[end].valid()) {
      const VertexId overflow = view.spilling.overflow[end];
      const std::uint32_t next = flow.sink_of(overflow).value();
      if (rim[overflow.index()] && flow.sinks()[next].vertex != overflow) break;  // it leaves
      end = next;
    }
    group.push_back(end);
  }
  return group;
}

std::vector<Ground> find_grounds(const LoadedTin& loaded, const SwmmNetwork& network, const SwmmView& view,
                                 Progress& progress) {
  const Tin& tin = loaded.tin;
  std::vector<VertexId> stations;
  for (const SwmmNode& node : network.nodes) {
    if (node.at.vertex.valid()) stations.push_back(node.at.vertex);
  }
  const SurfaceFlow flow(tin, view.outlets, stations, progress);
  const MetricScale scale = loaded.plane.scale();
  std::vector<Ground> ground(flow.sinks().size());  // by sink
  for (std::size_t n = network.nodes.size(); n-- > 0;) {
    const VertexId v = network.nodes[n].at.vertex;
    if (v.valid()) ground[flow.sink_of(v).index()].node = n;  // of several outfalls the first
  }
  const std::vector<std::uint32_t> group = group_sinks(tin, flow, view, ground);
  const double square = scale.horizontal_metres_per_unit * scale.horizontal_metres_per_unit;
  for (std::size_t s = 0; s < ground.size(); ++s) ground[group[s]].area_m2 += flow.sinks()[s].area * square;
  for (const Catchment& catchment : outline_catchments(flow, group, progress)) {
    std::vector<std::vector<Point2>>& rings = ground[catchment.group].rings;
    for (const CatchmentPolygon& polygon : catchment.polygons) {
      rings.push_back(ring_of(loaded, polygon.outer).xy);
      for (const CatchmentRing& hole : polygon.holes) rings.push_back(ring_of(loaded, hole).xy);
    }
  }
  for (const Triangle& t : tin.triangles()) {
    const VertexId low = *std::min_element(
        t.begin(), t.end(), [&](VertexId a, VertexId b) { return tin.height(a) < tin.height(b); });
    const auto [area, slope] = measure(tin, t, scale);
    ground[group[flow.sink_of(low).index()]].slopes.emplace_back(slope, area);
  }
  std::erase_if(ground, [](const Ground& g) { return g.node == kNoNode || !(g.area_m2 > 0); });
  return ground;
}

class Writer {
 public:
  Writer(const LoadedTin& loaded, const SwmmView& view, const SwmmNetwork& network,
         const std::vector<Ground>& grounds)
      : loaded_(loaded), view_(view), network_(network), grounds_(grounds) {}

  SwmmFile run() {
    options();
    subcatchments();
    nodes();
    links();
    map();
    file_.report.conduits = network_.conduits.size();
    file_.report.subcatchments = grounds_.size();
    for (const Ground& ground : grounds_) file_.report.area_m2 += ground.area_m2;
    return std::move(file_);
  }

 private:
  template <class... Args>
  void line(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(file_.text), format, std::forward<Args>(args)...);
    file_.text += '\n';
  }
  void section(const char* name, const char* columns) { line("\n[{}]\n;;{}", name, columns); }
  [[nodiscard]] const std::string& name(std::size_t node) const { return network_.nodes[node].name; }
  [[nodiscard]] double elevation_m(const SwmmNode& node) const {
    return node.at.z * loaded_.plane.vertical_metres_per_unit();
  }

  void options() {
    line("[TITLE]\nDrainage network of a TIN, by Thalweg.");
    line("Of the terrain: places, lengths, areas, slopes, inverts, sides of channels, storage.");
    line("To be replaced: depth and roughness of channels, ground cover, losses, rain.");
    line("\n[OPTIONS]\nFLOW_UNITS CMS\nINFILTRATION HORTON\nFLOW_ROUTING DYNWAVE\nLINK_OFFSETS DEPTH");
    section("RAINGAGES", "name format interval snow source");
    line("RAIN INTENSITY 1:00 1.0 TIMESERIES RAIN");
    section("TIMESERIES", "name hours mm/h");
    line("RAIN 0:00 0");
  }

  void subcatchments() {
    section("SUBCATCHMENTS", "name rain outlet ha %impervious width_m %slope curb");
    for (const Ground& g : grounds_) {
      // Water comes from both sides of what ends here; at a head the ground is as wide as it is long.
      const double conduits = network_.nodes[g.node].conduits_m;
      const double width = conduits > 0 ? 2 * conduits : std::sqrt(g.area_m2);
      line("S{} RAIN {} {} 0 {} {} 0", name(g.node), name(g.node), g.area_m2 / kSquareMetresPerHectare, width,
           100 * middle_slope(g.slopes));
    }
    section("SUBAREAS", "name n_impervious n_pervious mm_impervious mm_pervious %no_storage route");
    for (const Ground& g : grounds_) line("S{} 0.01 0.1 1.27 1.27 25 OUTLET", name(g.node));
    section("INFILTRATION", "name most_mm/h least_mm/h decay_1/h dry_days most_mm");
    for (const Ground& g : grounds_) line("S{} 76.2 12.7 4 7 0", name(g.node));
  }

  void nodes() {
    section("JUNCTIONS", "name elevation_m depth_m initial surcharge ponded");
    for (const SwmmNode& node : network_.nodes) {
      if (node.kind != SwmmNode::Kind::Junction) continue;
      line("{} {} {} 0 0 0", node.name, elevation_m(node), kChannelDepthM);
      ++file_.report.junctions;
    }
    section("OUTFALLS", "name elevation_m type gated");
    for (const SwmmNode& node : network_.nodes) {
      if (node.kind != SwmmNode::Kind::Outfall) continue;
      line("{} {} FREE NO", node.name, elevation_m(node));
      ++file_.report.outfalls;
    }
    section("STORAGE",
            "name elevation_m depth_m initial curve coefficient exponent constant_m2 ponded evaporation");
    for (const SwmmNode& node : network_.nodes) {
      if (node.kind != SwmmNode::Kind::Storage) continue;
      const Pit& pit = view_.table.pits[*node.pit];
      line("{} {} {} 0 FUNCTIONAL 0 0 {} 0 0", node.name, elevation_m(node), pit.depth_m + kChannelDepthM,
           pit.volume_m3 / pit.depth_m);
      ++file_.report.storages;
    }
  }

  void links() {
    section("CONDUITS", "name from to length_m roughness offset_from_m offset_to_m initial most");
    for (std::size_t i = 0; i < network_.conduits.size(); ++i) {
      const SwmmConduit& conduit = network_.conduits[i];
      line("C{} {} {} {} {} {} 0 0 0", i, name(conduit.from), name(conduit.to), conduit.length_m, kRoughness,
           conduit.offset_m);
    }
    section("XSECTIONS", "name shape depth_m bottom_m left_run/rise right_run/rise barrels");
    for (std::size_t i = 0; i < network_.conduits.size(); ++i) {
      const SwmmConduit& conduit = network_.conduits[i];
      const auto run = [&](double slope) {
        return conduit.sides_m > 0 ? 1 / std::max(slope / conduit.sides_m, kLeastSideSlope) : 1;
      };
      line("C{} TRAPEZOIDAL {} 0 {} {} 1", i, kChannelDepthM, run(conduit.left), run(conduit.right));
    }
  }

  void map() {
    Box2 box;
    for (const SwmmNode& node : network_.nodes) box.add(line_of(loaded_, {&node.at, 1}).xy.front());
    for (const Ground& g : grounds_) {
      for (const std::vector<Point2>& ring : g.rings) {
        for (const Point2 p : ring) box.add(p);
      }
    }
    line("\n[MAP]\nDIMENSIONS {} {} {} {}\nUNITS {}", box.x_min, box.y_min, box.x_max, box.y_max,
         loaded_.written.empty() ? "None" : "Degrees");
    section("COORDINATES", "node x y");
    for (const SwmmNode& node : network_.nodes) {
      const FeatureLine at = line_of(loaded_, {&node.at, 1});
      line("{} {} {}", node.name, at.xy.front().x, at.xy.front().y);
    }
    section("VERTICES", "conduit x y");
    for (std::size_t i = 0; i < network_.conduits.size(); ++i) {
      const std::vector<Point2> xy = line_of(loaded_, network_.conduits[i].points).xy;
      for (std::size_t k = 1; k + 1 < xy.size(); ++k) line("C{} {} {}", i, xy[k].x, xy[k].y);
    }
    section("POLYGONS", "subcatchment x y");
    for (const Ground& g : grounds_) {
      for (const Point2 p : joined(g.rings)) line("S{} {} {}", name(g.node), p.x, p.y);
    }
  }

  const LoadedTin& loaded_;
  const SwmmView& view_;
  const SwmmNetwork& network_;
  const std::vector<Ground>& grounds_;
  SwmmFile file_;
};

}  // namespace

void check_swmm_path(const std::string& path) {
  if (std::filesystem::path(path).extension() == ".inp") return;
  throw Error(ErrorCode::Usage, "--swmm writes an input file of SWMM, .inp, not '" + path + "'");
}

SwmmFile write_swmm(const LoadedTin& loaded, const SwmmView& view, Progress& progress) {
  const SwmmNetwork network = find_swmm_network(loaded, view);
  const std::vector<Ground> grounds = find_grounds(loaded, network, view, progress);
  return Writer(loaded, view, network, grounds).run();
}

}  // namespace thalweg
