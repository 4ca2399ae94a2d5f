// Vector layers of a TIN, by GDAL: all of them in a GeoPackage, or one in a format that holds one.
//
// 1. One transaction; SQLite's own journal and syncs are off, because the file is a temporary one that is
//    flushed as a whole before it gets its name.
// 2. Features and geometries are made once a layer and refilled.
// 3. GDAL's close returns nothing: what it said while closing decides whether the file is whole.
// 4. The spatial index is filled at once when all features are there (spatial_index.cpp).
// The date of last change in the file is fixed, so that equal input gives equal bytes.
// One-layer formats are made in memory and copied out: a shapefile is several files, and the drivers of
// FlatGeobuf and GeoJSON do not notice a full disk. GeoJSON is rounded to about 15 digits by its driver.
// Longitudes on both sides of the antimeridian run on beyond 180 or below -180, whichever is narrower: a
// triangle or line that jumped would be drawn around the whole earth.
// Triangles are polygons everywhere: OGR's type TIN is refused or lost by half of the drivers.
#include "io/antimeridian.hpp"
#include "io/edge_chains.hpp"
#include "io/gdal_session.hpp"
#include "io/memory_folder.hpp"
#include "io/spatial_index.hpp"
#include "io/spatial_reference.hpp"
#include "io/tin_format.hpp"

#include <thalweg/mesh/conflict_name.hpp>

#include <cpl_conv.h>
#include <cpl_string.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <memory>
#include <numbers>
#include <optional>

namespace thalweg {

namespace {

struct Field {
  const char* name;
  OGRFieldType type;
};

enum class Transactions : std::uint8_t { One, None };

/// How a driver is spoken to.
struct LayerFormat {
  const char* driver;
  Transactions transactions;
  std::vector<std::string> layers;
  std::vector<std::string> layer_options;
  bool indexed = false;
};

class LayerWriter {
 public:
  LayerWriter(const TinWriteJob& job, const std::string& path, LayerFormat format)
      : job_(job),
        tin_(job.view.tin),
        xy_(job.xy()),
        format_(std::move(format)),
        journal_("OGR_SQLITE_JOURNAL", "OFF", false),
        synchronous_("OGR_SQLITE_SYNCHRONOUS", "OFF", false),
        date_("OGR_CURRENT_DATE", "2000-01-01T00:00:00.000Z", false) {
    if (!job.view.crs_wkt.empty())
      reference_ = parse_reference(job.view.crs_wkt);
    else if (!job.view.crs_authority.empty())
      reference_ = parse_reference(job.view.crs_authority);
    if (reference_ && reference_->IsGeographic() != 0) {
      turn_ = across_antimeridian(xy_, 2 * std::numbers::pi / reference_->GetAngularUnits());
      if (turn_) {
        west_ = std::ranges::min(xy_, {}, &Point2::x).x < 0 ? -turn_->period / 2 : 0;
        std::ranges::transform(xy_, std::back_inserter(turned_), *turn_);
        xy_ = turned_;
      }
    }
    if (reference_ && format_.driver == std::string_view("GeoJSON"))
      reference_ = horizontal_part(*reference_);
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName(format_.driver);
    if (driver == nullptr) {
      throw Error(ErrorCode::Unsupported,
                  job.target + ": this GDAL has no driver " + format_.driver + "; write another format");
    }
    dataset_.reset(driver->Create(path.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    if (!dataset_) fail();
    if (format_.transactions == Transactions::One && dataset_->StartTransaction() != OGRERR_NONE) fail();
    session_.reset();
  }

  void write() {
    const auto wanted = [&](const char* name) {
      return std::find(format_.layers.begin(), format_.layers.end(), name) != format_.layers.end();
    };
    if (wanted("triangles")) write_triangles(), close_layer();
    if (wanted("edges")) write_edges(), close_layer();
    if (wanted("vertices")) write_vertices(), close_layer();
    if (wanted("breaklines")) write_breaklines(), close_layer();
    // A TIN that was read does not know them, and none is not the same as unknown.
    if (wanted("conflicts") && job_.view.conflicts) write_conflicts(), close_layer();
    if (dataset_->GetLayerCount() == 0) {
      throw Error(ErrorCode::Usage, job_.target +
                                        ": conflicts are known of what `thalweg build` makes, not of a "
                                        "TIN that was read; choose another layer");
    }
    if (format_.transactions == Transactions::One && dataset_->CommitTransaction() != OGRERR_NONE) fail();
    feature_.reset();
    dataset_.reset();
    if (session_.failed()) fail();
  }

 private:
  [[noreturn]] void fail() {
    session_.fail_to_write(job_.target + ": could not be written whole",
                           "free some space or choose another place; no partial file is left");
  }

  /// Fields for attributes follow the others.
  void create_layer(const char* name, OGRwkbGeometryType type, std::initializer_list<Field> fields,
                    std::span<const TinAttribute> attributes = {}) {
    CPLStringList options;
    if (turn_ && dataset_->GetDriver()->GetDescription() == std::string_view("GPKG")) {
      options.SetNameValue("DESCRIPTION", describe_turned(west_).c_str());
    }
    for (const std::string& option : format_.layer_options) options.AddString(option.c_str());
    layer_ = dataset_->CreateLayer(name, reference_ ? &*reference_ : nullptr, type, options.List());
    if (layer_ == nullptr) fail();
    for (const Field& field : fields) {
      OGRFieldDefn definition(field.name, field.type);
      if (layer_->CreateField(&definition) != OGRERR_NONE) fail();
    }
    for (const TinAttribute& attribute : attributes) {
      OGRFieldDefn definition(attribute.name.c_str(), OFTReal);
      if (layer_->CreateField(&definition) != OGRERR_NONE) fail();
    }
    feature_ = std::make_unique<OGRFeature>(layer_->GetLayerDefn());
    if (format_.indexed) index_.emplace(*dataset_, name, job_.target);
    job_.progress.start_phase(std::string("write layer ") + name);
  }

  void create_feature(std::size_t row, std::size_t count) {
    constexpr std::size_t kProgressStep = 1U << 12U;
    if (row % kProgressStep == 0)
      job_.progress.advance(static_cast<double>(row) / static_cast<double>(count));
    feature_->SetFID(OGRNullFID);
    if (layer_->CreateFeature(feature_.get()) != OGRERR_NONE) fail();
    if (!index_) return;
    OGREnvelope box;
    feature_->GetGeometryRef()->getEnvelope(&box);
    index_->add({box.MinX, box.MinY, box.MaxX, box.MaxY});
  }

  void close_layer() {
    if (index_) index_->finish(job_.progress);
    index_.reset();
  }

  void set_attributes(int first_field, std::span<const TinAttribute> attributes, std::size_t row) {
    for (const TinAttribute& attribute : attributes) {
      if (std::isnan(attribute.values[row])) {
        feature_->SetFieldNull(first_field++);
      } else {
        feature_->SetField(first_field++, attribute.values[row]);
      }
    }
  }

  // Gives the layer's one feature a geometry, to be refilled for each row.
  template <class Geometry>
  Geometry* adopt(std::unique_ptr<Geometry> geometry) {
    Geometry* const plain = geometry.get();
    feature_->SetGeometryDirectly(geometry.release());
    return plain;
  }

  void set_point(OGRSimpleCurve& curve, int i, VertexId v) const {
    const Point2 p = xy_[v.index()];
    curve.setPoint(i, p.x, p.y, tin_.height(v));
  }

  void write_triangles() {
    create_layer("triangles", wkbPolygon25D,
                 {{"a", OFTInteger64}, {"b", OFTInteger64}, {"c", OFTInteger64}, {"order", OFTInteger}});
    auto polygon = std::make_unique<OGRPolygon>();
    auto* const ring = new OGRLinearRing;
    ring->setNumPoints(4);
    polygon->addRingDirectly(ring);
    polygon->set3D(TRUE);
    adopt(std::move(polygon));
    for (std::size_t t = 0; t < tin_.triangle_count(); ++t) {
      const Triangle& triangle = tin_.triangle(TriangleId{t});
      for (int i = 0; i < 4; ++i) set_point(*ring, i, triangle[static_cast<std::size_t>(i) % 3]);
      for (int i = 0; i < 3; ++i)
        feature_->SetField(i, static_cast<GIntBig>(triangle[static_cast<std::size_t>(i)].value()));
      if (!job_.view.triangle_orders.empty())
        feature_->SetField(3, static_cast<int>(job_.view.triangle_orders[t]));
      create_feature(t, tin_.triangle_count());
    }
  }

  void write_edges() {
    create_layer("edges", wkbLineString25D,
                 {{"a", OFTInteger64}, {"b", OFTInteger64}, {"kind", OFTString}, {"kind_bits", OFTInteger}},
                 job_.view.edge_attributes);
    OGRLineString* const line = adopt(std::make_unique<OGRLineString>());
    line->setNumPoints(2);
    std::size_t row = 0;
    for (std::size_t i = 0; i < tin_.halfedge_count(); ++i) {
      const HalfedgeId h{i};
      if (!tin_.represents_edge(h)) continue;
      const auto [a, b] = std::minmax({tin_.origin(h), tin_.target(h)});
      set_point(*line, 0, a);
      set_point(*line, 1, b);
      feature_->SetField(0, static_cast<GIntBig>(a.value()));
      feature_->SetField(1, static_cast<GIntBig>(b.value()));
      feature_->SetField(2, kind_words(tin_.kind(h)).c_str());
      feature_->SetField(3, static_cast<int>(tin_.kind(h)));
      set_attributes(4, job_.view.edge_attributes, row);
      create_feature(row++, tin_.edge_count());
    }
  }

  void write_vertices() {
    create_layer("vertices", wkbPoint25D,
                 {{"id", OFTInteger64}, {"is_pit", OFTInteger}, {"source", OFTString}},
                 job_.view.vertex_attributes);
    OGRPoint* const point = adopt(std::make_unique<OGRPoint>(0, 0, 0));
    for (std::size_t v = 0; v < tin_.vertex_count(); ++v) {
      point->setX(xy_[v].x);
      point->setY(xy_[v].y);
      point->setZ(tin_.heights()[v]);
      feature_->SetField(0, static_cast<GIntBig>(v));
      if (!job_.view.is_pit.empty()) feature_->SetField(1, job_.view.is_pit[v] != 0 ? 1 : 0);
      if (!job_.view.vertex_source.empty())
        feature_->SetField(2, source_word(job_.view.vertex_source[v]).c_str());
      set_attributes(3, job_.view.vertex_attributes, v);
      create_feature(v, tin_.vertex_count());
    }
  }

  void write_breaklines() {
    create_layer("breaklines", wkbLineString25D, {{"kind", OFTString}, {"kind_bits", OFTInteger}});
    OGRLineString* const line = adopt(std::make_unique<OGRLineString>());
    const std::vector<ConstraintEdge> edges = tin_.constraint_edges();
    const std::vector<EdgeChain> chains = chain_edges(edges);
    for (std::size_t row = 0; row < chains.size(); ++row) {
      const std::vector<VertexId>& vertices = chains[row].vertices;
      line->setNumPoints(static_cast<int>(vertices.size()));
      for (std::size_t i = 0; i < vertices.size(); ++i) set_point(*line, static_cast<int>(i), vertices[i]);
      feature_->SetField(0, kind_words(chains[row].kind).c_str());
      feature_->SetField(1, static_cast<int>(chains[row].kind));
      create_feature(row, chains.size());
    }
  }

  void write_conflicts() {
    const std::span<const Conflict> conflicts = *job_.view.conflicts;
    create_layer("conflicts", wkbPoint25D,
                 {{"kind", OFTString},
                  {"z_a", OFTReal},
                  {"z_b", OFTReal},
                  {"z_used", OFTReal},
                  {"source_a", OFTString},
                  {"source_b", OFTString}});
    OGRPoint* const point = adopt(std::make_unique<OGRPoint>(0, 0, 0));
    for (std::size_t row = 0; row < conflicts.size(); ++row) {
      const Conflict& conflict = conflicts[row];
      const Point2 xy = turn_ ? (*turn_)(conflict.xy) : conflict.xy;
      point->setX(xy.x);
      point->setY(xy.y);
      point->setZ(conflict.z_used);
      feature_->SetField(0, std::string(conflict_name(conflict.kind)).c_str());
      feature_->SetField(1, conflict.z_a);
      feature_->SetField(2, conflict.z_b);
      feature_->SetField(3, conflict.z_used);
      feature_->SetField(4, conflict.source_a.c_str());
      feature_->SetField(5, conflict.source_b.c_str());
      create_feature(row, conflicts.size());
    }
  }

  const TinWriteJob& job_;
  const Tin& tin_;
  std::span<const Point2> xy_;
  std::optional<Turn> turn_;
  double west_ = 0;             // of the turn in which longitudes were
  std::vector<Point2> turned_;  // xy_, where they were turned
  LayerFormat format_;
  GdalSession session_;
  CPLConfigOptionSetter journal_, synchronous_, date_;
  std::optional<OGRSpatialReference> reference_;
  GDALDatasetUniquePtr dataset_;
  OGRLayer* layer_ = nullptr;
  std::optional<SpatialIndex> index_;  // of the layer
  std::unique_ptr<OGRFeature> feature_;
};

void write_one_layer(const TinWriteJob& job, const char* driver, std::vector<std::string> layer_options) {
  const MemoryFolder folder(job.target);
  LayerWriter(job, folder.path(),
              {driver, Transactions::None, job.options.list("LAYER"), std::move(layer_options)})
      .write();
  folder.deliver(job.path, job.pending, job.mode);
}

}  // namespace

void write_gpkg(const TinWriteJob& job) {
  const bool indexed = job.options.enabled("SPATIAL_INDEX");
  const char* const index = indexed ? "SPATIAL_INDEX=YES" : "SPATIAL_INDEX=NO";
  LayerWriter(job, job.path, {"GPKG", Transactions::One, job.options.list("LAYERS"), {index}, indexed})
      .write();
}

void write_flatgeobuf(const TinWriteJob& job) {
  write_one_layer(job, "FlatGeobuf", {});
}

void write_geojson(const TinWriteJob& job) {
  write_one_layer(job, "GeoJSON", {});
}

void write_shapefile(const TinWriteJob& job) {
  write_one_layer(job, "ESRI Shapefile",
                  {"DBF_DATE_LAST_UPDATE=2000-01-01", "ENCODING=UTF-8", "2GB_LIMIT=YES"});
}

}  // namespace thalweg
