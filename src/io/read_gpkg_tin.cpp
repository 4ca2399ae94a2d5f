// A TIN from the layers of a GeoPackage.
//
// 1. Vertices: the layer "vertices" in the order of its ids, if it is there; else the triangles' corners in
//    order of first appearance.
// 2. Corners are found by their exact coordinates: sorted once, then binary search. A corner whose height
//    differs from the vertex's is no part of this surface.
// 3. Constraint edges: the rows of "edges" with a kind, else the segments of "breaklines".
#include "base/release.hpp"
#include "io/antimeridian.hpp"
#include "io/edge_chains.hpp"
#include "io/gdal_session.hpp"
#include "io/spatial_reference.hpp"
#include "io/tin_format.hpp"

#include <thalweg/geometry/predicates.hpp>

#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace thalweg {

namespace {

struct Position {
  Point2 xy;
  double z = 0;
};

class GpkgReader {
 public:
  GpkgReader(const std::string& path, Progress& progress) : path_(path), progress_(progress) {
    const std::array<const char*, 2> drivers = {"GPKG", nullptr};
    dataset_.reset(GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY, drivers.data()));
    if (!dataset_)
      throw Error(ErrorCode::BadFormat, path + ": is no readable GeoPackage" + session_.reason());
  }

  TinFile read() {
    OGRLayer* const triangles = dataset_->GetLayerByName("triangles");
    if (triangles == nullptr) {
      throw Error(ErrorCode::BadFormat, path_ + ": has no layer 'triangles'; it was not written as a TIN");
    }
    read_corners(*triangles);
    if (OGRLayer* const vertices = dataset_->GetLayerByName("vertices"))
      read_vertices(*vertices);
    else
      collect_vertices();
    index_triangles();
    if (OGRLayer* const edges = dataset_->GetLayerByName("edges"))
      read_lines(*edges);
    else if (OGRLayer* const lines = dataset_->GetLayerByName("breaklines"))
      read_lines(*lines);
    if (tin_.triangle_orders.size() != tin_.triangles.size()) tin_.triangle_orders.clear();
    if (tin_.vertex_source.size() != tin_.points.size()) tin_.vertex_source.clear();
    read_crs(*triangles);
    turn_back(*triangles);
    return std::move(tin_);
  }

 private:
  [[noreturn]] void fail(ErrorCode code, const char* layer, GIntBig feature,
                         const std::string& message) const {
    throw Error(code, path_ + "|layername=" + layer + " feature " + std::to_string(feature) + ": " + message);
  }

  template <class Visit>
  void for_each_feature(OGRLayer& layer, const Visit& visit) {
    constexpr std::size_t kProgressStep = 1U << 12U;
    const double count = static_cast<double>(std::max<GIntBig>(layer.GetFeatureCount(), 1));
    std::size_t row = 0;
    layer.ResetReading();
    while (const OGRFeatureUniquePtr feature{layer.GetNextFeature()}) {
      if (row++ % kProgressStep == 0) progress_.advance(std::min(1.0, static_cast<double>(row) / count));
      visit(*feature);
    }
    if (session_.failed()) {
      throw Error(ErrorCode::Unreadable, path_ + "|layername=" + layer.GetName() +
                                             ": cannot be read to its end" + session_.reason());
    }
  }

  Position finite(const char* layer, GIntBig feature, const Position& position) const {
    if (std::isfinite(position.xy.x) && std::isfinite(position.xy.y) && std::isfinite(position.z))
      return position;
    fail(ErrorCode::BadCoordinate, layer, feature, "a coordinate is not finite");
  }

  void read_corners(OGRLayer& layer) {
    const int order_field = layer.GetLayerDefn()->GetFieldIndex("order");
    for_each_feature(layer, [&](const OGRFeature& feature) {
      const OGRGeometry* const geometry = feature.GetGeometryRef();
      if (geometry == nullptr || wkbFlatten(geometry->getGeometryType()) != wkbPolygon) {
        fail(ErrorCode::WrongGeometry, "triangles", feature.GetFID(), "is no polygon");
      }
      const OGRPolygon& polygon = *geometry->toPolygon();
      const OGRLinearRing* const ring = polygon.getExteriorRing();
      if (ring == nullptr || ring->getNumPoints() != 4 || !ring->get_IsClosed() ||
          polygon.getNumInteriorRings() > 0) {
        fail(ErrorCode::WrongGeometry, "triangles", feature.GetFID(), "is no triangle");
      }
      if (!polygon.Is3D())
        fail(ErrorCode::MissingHeight, "triangles", feature.GetFID(), "has no heights (z)");
      for (int i = 0; i < 3; ++i) {
        corners_.push_back(
            finite("triangles", feature.GetFID(), {{ring->getX(i), ring->getY(i)}, ring->getZ(i)}));
      }
      fids_.push_back(feature.GetFID());
      if (order_field >= 0 && feature.IsFieldSetAndNotNull(order_field)) read_order(feature, order_field);
    });
  }

  void read_order(const OGRFeature& feature, int field) {
    const int order = feature.GetFieldAsInteger(field);
    if (order < 0 || order > std::numeric_limits<std::uint16_t>::max()) {
      fail(ErrorCode::BadFormat, "triangles", feature.GetFID(), "its order is " + std::to_string(order));
    }
    tin_.triangle_orders.push_back(static_cast<std::uint16_t>(order));
  }

  void add_vertex(const Position& position) {
    tin_.points.push_back(position.xy);
    tin_.heights.push_back(position.z);
  }

  void read_vertices(OGRLayer& layer) {
    struct Row {
      GIntBig id;
      Position position;
      std::optional<std::uint8_t> source;
    };
    std::vector<Row> rows;
    const int id_field = layer.GetLayerDefn()->GetFieldIndex("id");
    const int source_field = layer.GetLayerDefn()->GetFieldIndex("source");
    for_each_feature(layer, [&](const OGRFeature& feature) {
      const OGRGeometry* const geometry = feature.GetGeometryRef();
      if (geometry == nullptr || wkbFlatten(geometry->getGeometryType()) != wkbPoint || !geometry->Is3D()) {
        fail(ErrorCode::WrongGeometry, "vertices", feature.GetFID(), "is no point with a height (z)");
      }
      const OGRPoint& point = *geometry->toPoint();
      const GIntBig id = id_field >= 0 ? feature.GetFieldAsInteger64(id_field) : feature.GetFID();
      rows.push_back(
          {id, finite("vertices", feature.GetFID(), {{point.getX(), point.getY()}, point.getZ()}),
           source_field < 0 ? std::nullopt : parse_source_word(feature.GetFieldAsString(source_field))});
    });
    std::stable_sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.id < b.id; });
    for (const Row& row : rows) {
      add_vertex(row.position);
      if (row.source) tin_.vertex_source.push_back(*row.source);
    }
    sort_vertices();
    for (std::size_t i = 0; i + 1 < by_position_.size(); ++i) {
      if (point(i) == point(i + 1)) {
        fail(ErrorCode::BadFormat, "vertices", rows[by_position_[i].index()].id,
             "another vertex has its position");
      }
    }
  }

  // Equal positions become one vertex, numbered by the first corner that has it.
  void collect_vertices() {
    std::vector<std::uint32_t> order(corners_.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::uint32_t>(i);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::pair(corners_[a].xy, a) < std::pair(corners_[b].xy, b);
    });
    std::vector<bool> is_first(corners_.size(), false);
    for (std::size_t i = 0; i < order.size(); ++i) {
      is_first[order[i]] = i == 0 || corners_[order[i]].xy != corners_[order[i - 1]].xy;
    }
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      if (is_first[i]) add_vertex(corners_[i]);
    }
    sort_vertices();
  }

  Point2 point(std::size_t rank) const { return tin_.points[by_position_[rank].index()]; }

  void sort_vertices() {
    by_position_.resize(tin_.points.size());
    for (std::size_t v = 0; v < by_position_.size(); ++v) by_position_[v] = VertexId{v};
    std::sort(by_position_.begin(), by_position_.end(),
              [&](VertexId a, VertexId b) { return tin_.points[a.index()] < tin_.points[b.index()]; });
  }

  VertexId find_vertex(const char* layer, GIntBig feature, const Position& position) const {
    const auto found = std::lower_bound(by_position_.begin(), by_position_.end(), position.xy,
                                        [&](VertexId v, Point2 p) { return tin_.points[v.index()] < p; });
    if (found == by_position_.end() || tin_.points[found->index()] != position.xy) {
      fail(ErrorCode::BadFormat, layer, feature, "a corner lies at no vertex");
    }
    if (tin_.heights[found->index()] != position.z) {
      fail(ErrorCode::BadFormat, layer, feature, "a corner's height differs from its vertex's");
    }
    return *found;
  }

  void index_triangles() {
    tin_.triangles.reserve(fids_.size());
    for (std::size_t t = 0; t < fids_.size(); ++t) {
      Triangle triangle;
      for (std::size_t i = 0; i < 3; ++i)
        triangle[i] = find_vertex("triangles", fids_[t], corners_[3 * t + i]);
      // A polygon's ring may run either way.
      if (orientation(corners_[3 * t].xy, corners_[3 * t + 1].xy, corners_[3 * t + 2].xy) < 0) {
        std::swap(triangle[1], triangle[2]);
      }
      tin_.triangles.push_back(triangle);
    }
    release(corners_);
  }

  void read_lines(OGRLayer& layer) {
    const int kind_field = layer.GetLayerDefn()->GetFieldIndex("kind");
    if (kind_field < 0)
      throw Error(ErrorCode::BadFormat, path_ + "|layername=" + layer.GetName() + ": has no field 'kind'");
    for_each_feature(layer, [&](const OGRFeature& feature) {
      const std::string words = feature.GetFieldAsString(kind_field);
      if (words == "none") return;
      const std::optional<EdgeKind> kind = parse_kind_words(words);
      if (!kind)
        fail(ErrorCode::BadFormat, layer.GetName(), feature.GetFID(), "'" + words + "' is no kind of edge");
      const OGRGeometry* const geometry = feature.GetGeometryRef();
      if (geometry == nullptr || wkbFlatten(geometry->getGeometryType()) != wkbLineString) {
        fail(ErrorCode::WrongGeometry, layer.GetName(), feature.GetFID(), "is no line");
      }
      const OGRLineString& line = *geometry->toLineString();
      VertexId previous;
      for (int i = 0; i < line.getNumPoints(); ++i) {
        const Position position{{line.getX(i), line.getY(i)}, line.getZ(i)};
        const VertexId v = find_vertex(layer.GetName(), feature.GetFID(), position);
        if (i > 0) tin_.constraints.push_back({previous, v, *kind});
        previous = v;
      }
    });
  }

  void read_crs(OGRLayer& layer) {
    const OGRSpatialReference* const reference = layer.GetSpatialRef();
    if (reference == nullptr || means_none(*reference)) return;
    const CrsInfo info = describe_reference(*reference, path_);
    tin_.crs = info.authority.empty() ? info.wkt : info.authority;
  }

  /// To the longitudes that the TIN had before it was written.
  void turn_back(OGRLayer& layer) {
    const OGRSpatialReference* const reference = layer.GetSpatialRef();
    const char* const description = layer.GetMetadataItem("DESCRIPTION");
    if (reference == nullptr || reference->IsGeographic() == 0 || description == nullptr) return;
    const std::optional<double> west = parse_turned(description);
    if (!west) return;
    const Turn turn{*west, 2 * std::numbers::pi / reference->GetAngularUnits()};
    for (Point2& p : tin_.points) p = turn(p);
  }

  const std::string& path_;
  Progress& progress_;
  GdalSession session_;
  GDALDatasetUniquePtr dataset_;
  TinFile tin_;
  std::vector<Position> corners_;      // three a triangle
  std::vector<GIntBig> fids_;          // of the triangles
  std::vector<VertexId> by_position_;  // sorted by x, then y
};

}  // namespace

TinFile read_gpkg_tin(const std::string& path, Progress& progress) {
  return GpkgReader(path, progress).read();
}

}  // namespace thalweg
