// Lines and rings of a layer.
//
// Curves are linearised by OGR; collections are taken apart; a ring is closed by repeating its first vertex.
// With a box, a line stays if one of its segments meets it. For areas the decision falls on the whole
// feature: its rings stay if one of them meets the box or if the box lies inside. Boundaries always stay:
// without them their outside would become ground.
#include "base/lower_case.hpp"
#include "io/layer_reader.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/geometry/predicates.hpp>

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace thalweg {

namespace {

bool meets(const Box2& box, Point2 a, Point2 b) {
  if (box.contains(a) || box.contains(b)) return true;
  if (std::max(a.x, b.x) < box.x_min || std::min(a.x, b.x) > box.x_max) return false;
  if (std::max(a.y, b.y) < box.y_min || std::min(a.y, b.y) > box.y_max) return false;
  const int side = orientation(a, b, {box.x_min, box.y_min});
  return orientation(a, b, {box.x_max, box.y_min}) != side ||
         orientation(a, b, {box.x_max, box.y_max}) != side ||
         orientation(a, b, {box.x_min, box.y_max}) != side || side == 0;
}

bool meets(const Box2& box, std::span<const Point2> line) {
  if (line.size() == 1) return box.contains(line.front());
  for (std::size_t i = 1; i < line.size(); ++i) {
    if (meets(box, line[i - 1], line[i])) return true;
  }
  return false;
}

/// True if p is inside of the rings, by the number of edges to its right. Pre: p is on no ring.
bool is_inside(Point2 p, std::span<const SurveyLine> rings) {
  bool inside = false;
  for (const SurveyLine& ring : rings) {
    for (std::size_t i = 1; i < ring.xy.size(); ++i) {
      const Point2 a = ring.xy[i - 1];
      const Point2 b = ring.xy[i];
      if ((a.y > p.y) == (b.y > p.y)) continue;
      if ((orientation(a, b, p) > 0) == (b.y > a.y)) inside = !inside;
    }
  }
  return inside;
}

bool is_area(EdgeKind kind) {
  return has(kind, EdgeKind::Boundary | EdgeKind::Hole | EdgeKind::Lake);
}

/// The kind that an attribute's text says; none if it says neither ridge nor valley.
std::optional<EdgeKind> to_kind(std::string_view word) {
  std::string text = lower(word);
  text.erase(0, text.find_first_not_of(' '));
  if (text.rfind("ridge", 0) == 0) return EdgeKind::Ridge;
  if (text.rfind("valley", 0) == 0) return EdgeKind::Valley;
  return std::nullopt;
}

class LayerLines : public LayerReader {
 public:
  LayerLines(const LineSource& source, OpenedDataset opened)
      : LayerReader(source.source, std::move(opened), LayerUse::Lines), kind_(source.kind) {}

  void read(ReadContext& run, PlaneTransform& transform) override {
    if (!run.options.line_z_field.empty()) z_field_ = find_field(run.options.line_z_field, run.line_z_field);
    if (!run.options.kind_field.empty() && !is_area(kind_)) {
      kind_field_ = find_field(run.options.kind_field, run.kind_field);
    }
    for_each_feature(run, [&](const OGRFeature& feature, const OGRGeometry& geometry) {
      lines_.clear();
      take_apart(feature, geometry);
      for (SurveyLine& line : lines_) transform.apply(line.xy, line.z);
      keep_lines(run);
    });
    note_short_lines(run, short_);
  }

 private:
  void take_apart(const OGRFeature& feature, const OGRGeometry& geometry) {
    if (geometry.hasCurveGeometry(TRUE)) {
      const std::unique_ptr<OGRGeometry> linear(geometry.getLinearGeometry());
      if (!linear) throw wrong_geometry(feature, geometry, LayerUse::Lines);
      return take_apart(feature, *linear);
    }
    switch (wkbFlatten(geometry.getGeometryType())) {
      case wkbLineString:
        return add_line(feature, *geometry.toLineString());
      case wkbPolygon:
      case wkbTriangle:
        for (const OGRLinearRing* ring : *geometry.toPolygon()) add_ring(feature, *ring);
        return;
      case wkbMultiLineString:
      case wkbMultiPolygon:
      case wkbMultiCurve:
      case wkbMultiSurface:
      case wkbGeometryCollection:
        for (const OGRGeometry* part : *geometry.toGeometryCollection()) take_apart(feature, *part);
        return;
      default:
        throw wrong_geometry(feature, geometry, LayerUse::Lines);
    }
  }

  void add_ring(const OGRFeature& feature, const OGRSimpleCurve& ring) {
    if (ring.getNumPoints() == 0) return;
    add_line(feature, ring);
    SurveyLine& line = lines_.back();
    if (line.xy.front() == line.xy.back()) return;
    line.xy.push_back(line.xy.front());
    if (!line.z.empty()) line.z.push_back(line.z.front());
  }

  void add_line(const OGRFeature& feature, const OGRSimpleCurve& curve) {
    const int count = curve.getNumPoints();
    if (count == 0) return;
    SurveyLine line;
    line.kind = kind_of(feature);
    line.feature = feature.GetFID();
    line.part = static_cast<std::uint32_t>(lines_.size());
    line.xy.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) line.xy.push_back(position(feature, curve.getX(i), curve.getY(i), i));
    if (z_field_) {
      line.z.assign(line.xy.size(), field_height(feature));
    } else if (curve.Is3D()) {
      line.z.reserve(line.xy.size());
      for (int i = 0; i < count; ++i) line.z.push_back(height(feature, curve.getZ(i), i));
    }
    lines_.push_back(std::move(line));
  }

  double field_height(const OGRFeature& feature) const {
    if (const std::optional<double> z = number_in(feature, *z_field_)) return *z;
    throw Error(ErrorCode::MissingHeight, name_of(feature) + ": the field with heights, " +
                                              feature.GetFieldDefnRef(*z_field_)->GetNameRef() +
                                              ", is empty; fill it, or leave the feature out with --where");
  }

  EdgeKind kind_of(const OGRFeature& feature) const {
    if (!kind_field_) return kind_;
    return to_kind(feature.GetFieldAsString(*kind_field_)).value_or(kind_);
  }

  void keep_lines(ReadContext& run) {
    if (is_area(kind_)) {
      for (const SurveyLine& line : lines_) {
        if (line.xy.front() == line.xy.back()) continue;
        throw Error(ErrorCode::WrongGeometry, name() + " feature " + std::to_string(line.feature) + " part " +
                                                  std::to_string(line.part) +
                                                  " is no ring: areas need polygons or closed lines");
      }
    }
    ReadResult& result = run.result;
    const bool whole = !run.options.bbox || has(kind_, EdgeKind::Boundary) ||
                       (is_area(kind_) && area_meets(*run.options.bbox));
    for (SurveyLine& line : lines_) {
      if (!whole && (is_area(kind_) || !meets(*run.options.bbox, line.xy))) {
        ++result.lines_outside_bbox;
        continue;
      }
      if (!take_line(run, line)) {
        ++short_;
        continue;
      }
      line.source = static_cast<std::uint32_t>(result.survey.sources.size() - 1);
      result.survey.lines.push_back(std::move(line));
    }
  }

  [[nodiscard]] bool area_meets(const Box2& box) const {
    const auto touches = [&](const SurveyLine& ring) { return meets(box, ring.xy); };
    return std::any_of(lines_.begin(), lines_.end(), touches) || is_inside({box.x_min, box.y_min}, lines_);
  }

  EdgeKind kind_;
  std::optional<int> z_field_;
  std::optional<int> kind_field_;
  std::vector<SurveyLine> lines_;  // of the present feature
  std::size_t short_ = 0;
};

}  // namespace

std::unique_ptr<SourceReader> open_lines(const LineSource& source) {
  return std::make_unique<LayerLines>(source, open_dataset(source.source.path, LayerUse::Lines));
}

}  // namespace thalweg
