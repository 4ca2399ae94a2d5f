// LandXML: the one TIN surface of a file, by GDAL's plain XML parser.
//
// 1. Points have any ids, as words; positions are "northing easting elevation".
// 2. Faces are triangles of ids. Those marked invisible (i="1") are no surface: they close the hull.
// 3. Breaklines and boundaries of the source data name positions, not points. Consecutive positions that are
//    both a point of the surface, to the last bit, and joined by an edge of it, are a constraint edge; else
//    the program that made the surface did not keep the line, and the piece is left out.
#include "io/edge_chains.hpp"
#include "io/file_content.hpp"
#include "io/gdal_session.hpp"
#include "io/tin_format.hpp"

#include <cpl_minixml.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace thalweg {

namespace {

struct DestroyXml {
  void operator()(CPLXMLNode* node) const { CPLDestroyXMLNode(node); }
};

// Calls `visit` for the children elements of `node` with the given name.
template <class Visit>
void for_each_child(CPLXMLNode* node, const char* name, const Visit& visit) {
  if (node == nullptr) return;
  for (CPLXMLNode* child = node->psChild; child != nullptr; child = child->psNext) {
    if (child->eType == CXT_Element && std::strcmp(child->pszValue, name) == 0) visit(child);
  }
}

std::string attribute(CPLXMLNode* node, const char* name) {
  const char* text = CPLGetXMLValue(node, name, "");
  return text;
}

class LandXmlReader {
 public:
  LandXmlReader(const std::string& path, Progress& progress) : path_(path), progress_(progress) {}

  TinFile read() {
    const GdalSession session;
    std::string text(FileContent(path_).bytes());
    const std::unique_ptr<CPLXMLNode, DestroyXml> tree(CPLParseXMLString(text.c_str()));
    text = {};
    if (!tree) fail(ErrorCode::BadFormat, "is broken XML" + session.reason());
    CPLStripXMLNamespace(tree.get(), nullptr, TRUE);
    CPLXMLNode* root = CPLGetXMLNode(tree.get(), "=LandXML");
    if (root == nullptr) fail(ErrorCode::BadFormat, "is XML, but its root is not LandXML");
    CPLXMLNode* surface = find_surface(root);
    CPLXMLNode* definition = CPLGetXMLNode(surface, "Definition");
    progress_.advance(1.0 / 3);
    read_points(CPLGetXMLNode(definition, "Pnts"));
    for_each_child(definition, "Faces", [&](CPLXMLNode* faces) { read_faces(faces); });
    progress_.advance(2.0 / 3);
    read_lines(CPLGetXMLNode(surface, "SourceData"));
    read_crs(root);
    return std::move(tin_);
  }

 private:
  [[noreturn]] void fail(ErrorCode code, const std::string& what) const {
    throw Error(code, path_ + ": " + what);
  }

  [[nodiscard]] CPLXMLNode* find_surface(CPLXMLNode* root) const {
    std::vector<CPLXMLNode*> found;
    std::string names;
    for_each_child(root, "Surfaces", [&](CPLXMLNode* surfaces) {
      for_each_child(surfaces, "Surface", [&](CPLXMLNode* surface) {
        if (CPLGetXMLNode(surface, "Definition.Faces") == nullptr) return;
        found.push_back(surface);
        names += (names.empty() ? "" : ", ") + attribute(surface, "name");
      });
    });
    if (found.empty())
      fail(ErrorCode::EmptyInput, "holds no surface with faces; export the surface as a TIN");
    if (found.size() > 1) {
      fail(ErrorCode::Unsupported,
           "holds " + std::to_string(found.size()) + " surfaces (" + names + "); export one surface a file");
    }
    return found.front();
  }

  // The numbers of an element's text; its `row` names it in errors.
  [[nodiscard]] std::vector<double> numbers(CPLXMLNode* node, const char* what, std::size_t row) const {
    const std::string text = attribute(node, "");
    const std::string where = path_ + " " + what + " " + std::to_string(row);
    TextScanner scanner(text, where);
    std::vector<double> values;
    for (std::string_view word = scanner.word_anywhere(); !word.empty(); word = scanner.word_anywhere()) {
      const std::optional<double> value = parse_number(word);
      if (!value)
        fail(ErrorCode::BadFormat, std::string(what) + " " + std::to_string(row) + ": '" +
                                       std::string(word.substr(0, 40)) + "' is no number");
      if (!std::isfinite(*value)) {
        fail(ErrorCode::BadCoordinate, std::string(what) + " " + std::to_string(row) + " is not finite");
      }
      values.push_back(*value);
    }
    return values;
  }

  void read_points(CPLXMLNode* points) {
    if (points == nullptr) fail(ErrorCode::BadFormat, "the surface has no points (Pnts)");
    for_each_child(points, "P", [&](CPLXMLNode* node) {
      const std::size_t row = tin_.points.size() + 1;
      if (row % kCheckStep == 0) progress_.check();
      const std::vector<double> values = numbers(node, "point", row);
      if (values.size() != 3) {
        fail(ErrorCode::MissingHeight, "point " + std::to_string(row) + " has " +
                                           std::to_string(values.size()) +
                                           " coordinates; northing, easting and elevation are needed");
      }
      if (!ids_.emplace(attribute(node, "id"), VertexId{row - 1}).second) {
        fail(ErrorCode::BadFormat, "point id " + attribute(node, "id") + " is there twice");
      }
      tin_.points.push_back({values[1], values[0]});
      tin_.heights.push_back(values[2]);
    });
  }

  void read_faces(CPLXMLNode* faces) {
    std::size_t row = 0;
    for_each_child(faces, "F", [&](CPLXMLNode* node) {
      if (++row % kCheckStep == 0) progress_.check();
      if (attribute(node, "i") == "1") return;
      const std::string text = attribute(node, "");
      TextScanner scanner(text, path_);
      Triangle triangle;
      std::size_t corners = 0;
      for (std::string_view word = scanner.word_anywhere(); !word.empty(); word = scanner.word_anywhere()) {
        const auto id = ids_.find(std::string(word));
        if (id == ids_.end()) {
          fail(ErrorCode::BadFormat, "face " + std::to_string(row) + " names point " +
                                         std::string(word.substr(0, 40)) + ", which does not exist");
        }
        if (corners < 3) triangle[corners] = id->second;
        ++corners;
      }
      if (corners != 3) {
        fail(ErrorCode::WrongGeometry, "face " + std::to_string(row) + " has " + std::to_string(corners) +
                                           " corners; a TIN has triangles only");
      }
      tin_.triangles.push_back(triangle);
    });
  }

  void read_lines(CPLXMLNode* source) {
    if (source == nullptr) return;
    for (std::size_t v = 0; v < tin_.points.size(); ++v) places_.emplace(key(v), VertexId{v});
    for (const Triangle& t : tin_.triangles) {
      for (std::size_t i = 0; i < 3; ++i) edges_.push_back(std::minmax(t[i], t[(i + 1) % 3]));
    }
    std::sort(edges_.begin(), edges_.end());
    for_each_child(source, "Breaklines", [&](CPLXMLNode* list) {
      for_each_child(list, "Breakline", [&](CPLXMLNode* line) {
        read_line(line, parse_kind_words(attribute(line, "desc")).value_or(EdgeKind::Breakline));
      });
    });
    for_each_child(source, "Boundaries", [&](CPLXMLNode* list) {
      for_each_child(list, "Boundary", [&](CPLXMLNode* line) {
        read_line(line, attribute(line, "bndType") == "void" ? EdgeKind::Hole : EdgeKind::Boundary);
      });
    });
    for (const auto& [edge, kind] : constraints_) tin_.constraints.push_back({edge.first, edge.second, kind});
  }

  void read_line(CPLXMLNode* line, EdgeKind kind) {
    for_each_child(line, "PntList3D", [&](CPLXMLNode* list) {
      const std::vector<double> values = numbers(list, "breakline", 0);
      VertexId before;
      for (std::size_t i = 0; i + 2 < values.size(); i += 3) {
        const auto place = places_.find({values[i + 1], values[i]});
        const VertexId v = place == places_.end() ? VertexId{} : place->second;
        if (before.valid() && v.valid() && before != v) {
          const std::pair<VertexId, VertexId> edge = std::minmax(before, v);
          if (std::binary_search(edges_.begin(), edges_.end(), edge)) {
            EdgeKind& known = constraints_[edge];
            known = known | kind;
          }
        }
        before = v;
      }
    });
  }

  void read_crs(CPLXMLNode* root) {
    CPLXMLNode* crs = CPLGetXMLNode(root, "CoordinateSystem");
    const std::string code = crs == nullptr ? "" : attribute(crs, "epsgCode");
    const std::string wkt = crs == nullptr ? "" : attribute(crs, "ogcWktCode");
    tin_.crs = code.empty() ? wkt : "EPSG:" + code;
    if (tin_.crs.empty()) read_units(CPLGetXMLNode(root, "Units"));
  }

  // Without a CRS: one that knows the unit alone.
  void read_units(CPLXMLNode* units) {
    if (units == nullptr) return;
    for (CPLXMLNode* system = units->psChild; system != nullptr; system = system->psNext) {
      const std::string name = system->eType == CXT_Element ? attribute(system, "linearUnit") : "";
      if (name.empty()) continue;
      const auto unit = std::ranges::find(kUnits, name, &Unit::name);
      if (unit == kUnits.end()) fail(ErrorCode::Unsupported, "has the unknown linearUnit '" + name + "'");
      const std::string heights = attribute(system, "elevationUnit");
      if (!heights.empty() && heights != unit->of_heights) {
        fail(ErrorCode::Unsupported,
             "has positions in the unit '" + name + "' and heights in '" + heights +
                 "', but no CRS that tells it; export both in one unit, or with a CRS");
      }
      if (unit->metres == 1) return;
      tin_.crs = "LOCAL_CS[\"unknown, in " + name + "\",UNIT[\"" + name + "\"," +
                 fmt::format("{}", unit->metres) + "]]";
    }
  }

  struct Unit {
    std::string_view name, of_heights;
    double metres;
  };
  static constexpr std::array<Unit, 8> kUnits = {{{"meter", "meter", 1},
                                                  {"millimeter", "millimeter", 0.001},
                                                  {"centimeter", "centimeter", 0.01},
                                                  {"kilometer", "kilometer", 1000},
                                                  {"foot", "feet", 0.3048},
                                                  {"USSurveyFoot", "feet", 1200.0 / 3937},
                                                  {"inch", "inch", 0.0254},
                                                  {"mile", "miles", 1609.344}}};

  [[nodiscard]] std::pair<double, double> key(std::size_t v) const {
    return {tin_.points[v].x, tin_.points[v].y};
  }

  static constexpr std::size_t kCheckStep = 4096;
  const std::string& path_;
  Progress& progress_;
  TinFile tin_;
  std::unordered_map<std::string, VertexId> ids_;
  std::map<std::pair<double, double>, VertexId> places_;
  std::vector<std::pair<VertexId, VertexId>> edges_;
  std::map<std::pair<VertexId, VertexId>, EdgeKind> constraints_;
};

}  // namespace

TinFile read_landxml(const std::string& path, Progress& progress) {
  return LandXmlReader(path, progress).read();
}

}  // namespace thalweg
