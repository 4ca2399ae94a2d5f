// Pictures of scenes: the geometry is drawn once as a symbol and used in each panel, sites on top.
//
// Coordinates are scaled to a panel of fixed size around all sites and the first triangle's circle, and
// printed with one decimal, so that the same scene gives the same file everywhere.
#include <support/oracle/scene_file.hpp>
#include <support/oracle/triangulations.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iterator>

namespace thalweg::oracle {

namespace {

constexpr double kPanel = 200, kMargin = 14, kTitle = 18;

std::string number(double value) {
  const auto tenths = static_cast<std::int64_t>(std::floor(value * 10 + 0.5));
  const std::int64_t size = tenths < 0 ? -tenths : tenths;
  std::string text = (tenths < 0 ? "-" : "") + std::to_string(size / 10);
  if (size % 10 != 0) text += "." + std::to_string(size % 10);
  return text;
}

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) safe += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
  return safe;
}

struct Disc {
  double x = 0, y = 0, radius = 0;
};

Disc circle_of(const Scene& scene, Corners t) {
  const auto x = [&](std::size_t i) { return static_cast<double>(scene.at(t[i]).x - scene.at(t[0]).x); };
  const auto y = [&](std::size_t i) { return static_cast<double>(scene.at(t[i]).y - scene.at(t[0]).y); };
  const double d = 2 * (x(1) * y(2) - y(1) * x(2));
  const double b = x(1) * x(1) + y(1) * y(1), c = x(2) * x(2) + y(2) * y(2);
  const double ux = (y(2) * b - y(1) * c) / d, uy = (x(1) * c - x(2) * b) / d;
  return {static_cast<double>(scene.at(t[0]).x) + ux, static_cast<double>(scene.at(t[0]).y) + uy,
          std::hypot(ux, uy)};
}

// From the scene's plane to a panel: y runs down.
class Frame {
 public:
  explicit Frame(const SceneFile& file) {
    for (const Site& s : file.scene.sites) include(static_cast<double>(s.x), static_cast<double>(s.y));
    if (!file.triangles.empty() && file.triangles[0].validity != Validity::Flat) {
      const Disc disc = circle_of(file.scene, file.triangles[0].corners);
      include(disc.x - disc.radius, disc.y - disc.radius);
      include(disc.x + disc.radius, disc.y + disc.radius);
    }
    scale_ = (kPanel - 2 * kMargin) / std::max({high_x_ - low_x_, high_y_ - low_y_, 1.0});
  }
  [[nodiscard]] double x(double value) const { return kMargin + (value - low_x_) * scale_; }
  [[nodiscard]] double y(double value) const { return kMargin + (high_y_ - value) * scale_; }
  [[nodiscard]] std::string at(Site s) const {
    return number(x(static_cast<double>(s.x))) + "," + number(y(static_cast<double>(s.y)));
  }
  [[nodiscard]] std::string length(double value) const { return number(value * scale_); }
  [[nodiscard]] double height() const { return 2 * kMargin + (high_y_ - low_y_) * scale_; }

 private:
  void include(double x, double y) {
    low_x_ = std::min(low_x_, x), high_x_ = std::max(high_x_, x);
    low_y_ = std::min(low_y_, y), high_y_ = std::max(high_y_, y);
  }
  double low_x_ = 1e9, high_x_ = -1e9, low_y_ = 1e9, high_y_ = -1e9, scale_ = 1;
};

std::string lines(const Scene& scene, const Frame& frame, const std::vector<Edge>& edges, const char* style) {
  std::string path;
  for (const auto& [a, b] : edges) path += "M" + frame.at(scene.at(a)) + "L" + frame.at(scene.at(b));
  return path.empty() ? "" : "<path d=\"" + path + "\" " + style + "/>\n";
}

std::string geometry(const SceneFile& file, const Frame& frame) {
  const Scene& scene = file.scene;
  std::string text = "<defs><g id=\"scene\" fill=\"none\">\n";
  if (file.triangles.empty()) {
    text += lines(scene, frame, edges_of(delaunay_triangles(Oracle(scene))), "stroke=\"#999\"");
    for (const ExpectedEdge& e : file.edges) {
      text += lines(scene, frame, {e.edge}, "stroke=\"#c33\" stroke-dasharray=\"4 3\"");
    }
  } else {
    const Corners t = file.triangles[0].corners;
    if (file.triangles[0].validity != Validity::Flat) {
      const Disc disc = circle_of(scene, t);
      text += "<circle cx=\"" + number(frame.x(disc.x)) + "\" cy=\"" + number(frame.y(disc.y)) + "\" r=\"" +
              frame.length(disc.radius) + "\" stroke=\"#69c\"/>\n";
    }
    text += "<path d=\"M" + frame.at(scene.at(t[0])) + "L" + frame.at(scene.at(t[1])) + "L" +
            frame.at(scene.at(t[2])) + "Z\" fill=\"#ddd\" stroke=\"#666\"/>\n";
  }
  return text + lines(scene, frame, scene.constraints, "stroke=\"#000\" stroke-width=\"2\"") +
         "</g></defs>\n";
}

// Discs count, rings are members of the circle that do not, dots are the others.
std::string sites(const SceneFile& file, const Frame& frame, SiteSet counted, SiteSet members) {
  std::string text;
  for (int v = 0; v < file.scene.size(); ++v) {
    const Site s = file.scene.at(v);
    const double x = frame.x(static_cast<double>(s.x)), y = frame.y(static_cast<double>(s.y));
    const char* look = "r=\"1.8\"";
    if ((counted >> v & 1U) != 0) {
      look = "r=\"3\" fill=\"#c33\"";
    } else if ((members >> v & 1U) != 0) {
      look = "r=\"2.6\" fill=\"#fff\" stroke=\"#c33\" stroke-width=\"1.2\"";
    }
    text += "<circle cx=\"" + number(x) + "\" cy=\"" + number(y) + "\" " + look + "/>";
    text += "<text x=\"" + number(x + 4) + "\" y=\"" + number(y - 4) + "\">" +
            escaped(file.labels[static_cast<std::size_t>(v)]) + "</text>\n";
  }
  return text;
}

std::string filled(const Scene& scene, const Frame& frame, const Corners& t, const char* color) {
  return "<path d=\"M" + frame.at(scene.at(t[0])) + "L" + frame.at(scene.at(t[1])) + "L" +
         frame.at(scene.at(t[2])) + "Z\" fill=\"" + color + "\" stroke=\"#999\"/>\n";
}

struct Panel {
  std::string drawing;
  std::string title;
};

// Section 2 of the paper, Figure 6: the triangulation, the edge with its hull, and the triangles one by one.
std::vector<Panel> steps_of(const SceneFile& file, const ExpectedEdge& edge, const Frame& frame) {
  const Scene& scene = file.scene;
  const Oracle oracle(scene);
  const std::vector<Edge> delaunay = edges_of(delaunay_triangles(oracle));
  const std::vector<Edge> greedy = edges_of(greedy_triangles(oracle, edge.edge));
  std::vector<Edge> kept;
  std::set_intersection(delaunay.begin(), delaunay.end(), greedy.begin(), greedy.end(),
                        std::back_inserter(kept));
  const auto name = [&](int v) { return escaped(file.labels[static_cast<std::size_t>(v)]); };
  const std::string ends = name(edge.edge.first) + " " + name(edge.edge.second);
  std::vector<Panel> panels;
  for (std::size_t step = 0; step < edge.greedy.size() + 2; ++step) {
    std::string drawing;
    for (std::size_t i = 0; i + 2 <= step; ++i) {
      drawing += filled(scene, frame, edge.greedy[i], i + 2 == step ? "#bbb" : "#ddd");
    }
    drawing += lines(scene, frame, step == 0 ? delaunay : kept, "fill=\"none\" stroke=\"#999\"");
    drawing += lines(scene, frame, scene.constraints, "fill=\"none\" stroke=\"#000\" stroke-width=\"2\"");
    drawing += lines(scene, frame, {edge.edge},
                     step == 0 ? "fill=\"none\" stroke=\"#c33\" stroke-dasharray=\"4 3\""
                               : "fill=\"none\" stroke=\"#c33\" stroke-width=\"1.5\"");
    std::string title = step == 0 ? "order 0" : "hull of " + ends;
    if (step >= 2) {
      const Corners& t = edge.greedy[step - 2];
      title = std::to_string(step - 1) + ": " + name(t[0]) + " " + name(t[1]) + " " + name(t[2]);
    }
    panels.push_back({drawing + sites(file, frame, 0, 0), title});
  }
  return panels;
}

std::vector<Panel> panels_of(const SceneFile& file, const Frame& frame) {
  if (file.triangles.empty() || file.triangles[0].validity != Validity::Valid) {
    return {{"<use href=\"#scene\"/>\n" + sites(file, frame, 0, 0), ""}};
  }
  std::vector<Panel> panels;
  const auto& counted = file.triangles[0].counted;
  for (std::size_t i = 0; i < kDefinitionCount; ++i) {
    panels.push_back(
        {"<use href=\"#scene\"/>\n" + sites(file, frame, counted[i], counted[0]),
         std::string(name_of(kDefinitions[i])) + " " + std::to_string(std::popcount(counted[i]))});
  }
  for (const ExpectedEdge& edge : file.edges) {
    if (edge.greedy.empty()) continue;
    std::vector<Panel> steps = steps_of(file, edge, frame);
    std::move(steps.begin(), steps.end(), std::back_inserter(panels));
  }
  return panels;
}

}  // namespace

std::string picture_of(const SceneFile& file) {
  const Frame frame(file);
  const std::vector<Panel> panels = panels_of(file, frame);
  const std::size_t columns = std::min<std::size_t>(panels.size(), 4);
  const std::size_t rows = (panels.size() + columns - 1) / columns;
  const double row = frame.height() + kTitle;
  const std::string width = number(kPanel * static_cast<double>(columns));
  const std::string height = number(row * static_cast<double>(rows));
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + width + " " + height +
                    "\" width=\"" + width + "\" height=\"" + height +
                    "\" font-family=\"sans-serif\" font-size=\"9\">\n" +
                    "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n" + geometry(file, frame);
  for (std::size_t i = 0; i < panels.size(); ++i) {
    svg += "<g transform=\"translate(" + number(kPanel * static_cast<double>(i % columns)) + "," +
           number(row * static_cast<double>(i / columns)) + ")\">" + panels[i].drawing;
    if (!panels[i].title.empty()) {
      svg += "<text x=\"" + number(kMargin) + "\" y=\"" + number(frame.height() + 8) +
             "\" font-size=\"12\">" + panels[i].title + "</text>";
    }
    svg += "</g>\n";
  }
  return svg + "</svg>\n";
}

}  // namespace thalweg::oracle
