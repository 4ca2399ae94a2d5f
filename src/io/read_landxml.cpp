// LandXML: the one TIN surface of a file, by GDAL's plain XML parser.
//
// 1. Points have any ids, as words; positions are "northing easting elevation".
// 2. Faces are triangles of ids. Those marked invisible (i="1") are no surface: they close the hull.
// 3. Breaklines and boundaries of the source data name positions, not points. From a position that is a point
//    of the surface, to the last bit, edges along the line are constraint edges; else the program that made
//    the surface did not keep the line, and the piece is left out, and counted.
// 4. The unit of heights is part of the CRS. Positions are in the unit of the CRS, and no other.
#include "io/edge_chains.hpp"
#include "io/file_content.hpp"
#include "io/gdal_session.hpp"
#include "io/height_unit.hpp"
#include "io/line_matcher.hpp"
#include "io/tin_format.hpp"

#include <thalweg/io/crs.hpp>

#include <cpl_minixml.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
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
    TextScanner scanner(text, path_);
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
    for (std::size_t v = 0; v < tin_.points.size(); ++v) places_.emplace(key(tin_.points[v]), VertexId{v});
    LineMatcher matcher(tin_.points, tin_.triangles);
    for_each_child(source, "Breaklines", [&](CPLXMLNode* list) {
      for_each_child(list, "Breakline", [&](CPLXMLNode* line) {
        read_line(line, parse_kind_words(attribute(line, "desc")).value_or(EdgeKind::Breakline), matcher);
      });
    });
    for_each_child(source, "Boundaries", [&](CPLXMLNode* list) {
      for_each_child(list, "Boundary", [&](CPLXMLNode* line) {
        const bool is_hole = attribute(line, "bndType") == "void";
        read_line(line, is_hole ? EdgeKind::Hole : EdgeKind::Boundary, matcher);
      });
    });
    matcher.deliver(tin_, path_);
  }

  void read_line(CPLXMLNode* line, EdgeKind kind, LineMatcher& matcher) {
    for_each_child(line, "PntList3D", [&](CPLXMLNode* list) {
      const std::vector<double> values = numbers(list, "breakline", 0);
      LineMatcher::Piece piece;
      for (std::size_t i = 0; i + 2 < values.size(); i += 3) {
        piece.from = piece.to;
        piece.from_vertex = piece.to_vertex;
        piece.to = {values[i + 1], values[i]};
        const auto place = places_.find(key(piece.to));
        piece.to_vertex = place == places_.end() ? VertexId{} : place->second;
        if (i > 0) matcher.add(piece, kind);
      }
    });
  }

  void read_crs(CPLXMLNode* root) {
    CPLXMLNode* crs = CPLGetXMLNode(root, "CoordinateSystem");
    const std::string code = crs == nullptr ? "" : attribute(crs, "epsgCode");
    const std::string wkt = crs == nullptr ? "" : attribute(crs, "ogcWktCode");
    tin_.crs = code.empty() ? wkt : "EPSG:" + code;
    CPLXMLNode* units = CPLGetXMLNode(root, "Units");
    if (units == nullptr) return;
    for (CPLXMLNode* system = units->psChild; system != nullptr; system = system->psNext) {
      const std::string name = system->eType == CXT_Element ? attribute(system, "linearUnit") : "";
      if (name.empty()) continue;
      const auto* const unit = std::ranges::find(kUnits, name, &Unit::name);
      if (unit == kUnits.end()) fail(ErrorCode::Unsupported, "has the unknown linearUnit '" + name + "'");
      read_units(*unit, attribute(system, "elevationUnit"));
    }
  }

  struct Unit {
    std::string_view name, of_heights;
    double metres;
  };

  void read_units(const Unit& unit, const std::string& heights) {
    if (!tin_.crs.empty()) {
      check_unit(unit);
      if (!heights.empty()) take_height_unit(tin_, metres_of_heights(unit, heights), path_);
      return;
    }
    if (!heights.empty() && heights != unit.of_heights) {
      fail(ErrorCode::Unsupported, "has positions in the unit '" + std::string(unit.name) +
                                       "' and heights in '" + heights +
                                       "', but no CRS that tells it; export both in one unit, or with a CRS");
    }
    tin_.crs = local_crs(std::string(unit.name), unit.metres);
  }

  // Many programs write "foot" for both feet. Thalweg writes "meter" where the CRS has a unit that LandXML
  // does not know.
  void check_unit(const Unit& unit) const {
    const CrsInfo crs = describe_crs(tin_.crs);
    const double metres = crs.horizontal_metres_per_unit;
    const auto* const known =
        std::ranges::find_if(kUnits, [&](const Unit& other) { return is_same_unit(other.metres, metres); });
    const bool both_feet = known != kUnits.end() && unit.of_heights == "feet" && known->of_heights == "feet";
    const bool unknown = known == kUnits.end() && unit.metres == 1;
    if (crs.geographic || is_same_unit(unit.metres, metres) || both_feet || unknown) return;
    fail(
        ErrorCode::Unsupported,
        fmt::format("has the linearUnit '{}', but positions of its CRS {} are in {}; export both in one unit",
                    unit.name, crs.name,
                    known == kUnits.end() ? fmt::format("units of {:.12g} m", metres) : known->name));
  }

  [[nodiscard]] double metres_of_heights(const Unit& unit, const std::string& heights) const {
    if (heights == unit.of_heights) {
      // That the CRS counts in the other foot was let pass; then heights are in that one, too.
      const double crs = describe_crs(tin_.crs).horizontal_metres_per_unit;
      return heights == "feet" && std::abs(crs / unit.metres - 1) < 1e-5 ? crs : unit.metres;
    }
    const auto* const known = std::ranges::find(kUnits, heights, &Unit::of_heights);
    if (known != kUnits.end()) return known->metres;
    fail(ErrorCode::Unsupported, "has the unknown elevationUnit '" + heights + "'");
  }

  static constexpr std::array<Unit, 8> kUnits = {{{"meter", "meter", 1},
                                                  {"millimeter", "millimeter", 0.001},
                                                  {"centimeter", "centimeter", 0.01},
                                                  {"kilometer", "kilometer", 1000},
                                                  {"foot", "feet", 0.3048},
                                                  {"USSurveyFoot", "feet", 1200.0 / 3937},
                                                  {"inch", "inch", 0.0254},
                                                  {"mile", "miles", 1609.344}}};

  static std::pair<double, double> key(Point2 p) { return {p.x, p.y}; }

  static constexpr std::size_t kCheckStep = 4096;
  const std::string& path_;
  Progress& progress_;
  TinFile tin_;
  std::unordered_map<std::string, VertexId> ids_;
  std::map<std::pair<double, double>, VertexId> places_;
};

}  // namespace

TinFile read_landxml(const std::string& path, Progress& progress) {
  return LandXmlReader(path, progress).read();
}

}  // namespace thalweg
