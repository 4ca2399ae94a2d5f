// Points and multipoints of a layer. A height comes from the field that was asked for, else from the
// geometry.
#include "io/layer_reader.hpp"
#include "io/point_collector.hpp"

#include <thalweg/base/error.hpp>

#include <optional>
#include <string>
#include <utility>

namespace thalweg {

namespace {

class LayerPoints : public LayerReader {
 public:
  LayerPoints(const SourceSpec& spec, OpenedDataset opened)
      : LayerReader(spec, std::move(opened), LayerUse::Points) {}

  void read(ReadContext& run, PlaneTransform& transform) override {
    heights_ = run.options.heights;
    if (!run.options.z_field.empty()) z_field_ = find_field(run.options.z_field, run.z_field);
    PointCollector points(run, transform);
    for_each_feature(run, [&](const OGRFeature& feature, const OGRGeometry& geometry) {
      const std::optional<double> z = z_field_ ? number_in(feature, *z_field_) : std::nullopt;
      add(feature, geometry, z, points);
    });
    points.finish();
  }

 private:
  void add(const OGRFeature& feature, const OGRGeometry& geometry, std::optional<double> z,
           PointCollector& points) {
    switch (wkbFlatten(geometry.getGeometryType())) {
      case wkbPoint: {
        const OGRPoint& point = *geometry.toPoint();
        if (!point.IsEmpty())
          points.add(position(feature, point.getX(), point.getY(), 0), height_of(feature, point, z));
        return;
      }
      case wkbMultiPoint:
      case wkbGeometryCollection:
        for (const OGRGeometry* part : *geometry.toGeometryCollection()) add(feature, *part, z, points);
        return;
      default:
        throw wrong_geometry(feature, geometry, LayerUse::Points);
    }
  }

  double height_of(const OGRFeature& feature, const OGRPoint& point, std::optional<double> z) const {
    if (z) return *z;
    if (!z_field_ && point.Is3D()) return height(feature, point.getZ(), 0);
    if (heights_ == HeightRule::Optional) return 0;
    if (z_field_) {
      throw Error(ErrorCode::MissingHeight, name_of(feature) + ": the field with heights, " +
                                                feature.GetFieldDefnRef(*z_field_)->GetNameRef() +
                                                ", is empty; fill it, or leave the feature out with --where");
    }
    throw Error(
        ErrorCode::MissingHeight,
        name_of(feature) + " has no height: the point has no z; name a field with heights by --z-field");
  }

  std::optional<int> z_field_;
  HeightRule heights_ = HeightRule::Required;
};

}  // namespace

std::unique_ptr<SourceReader> open_layer_points(const SourceSpec& spec, OpenedDataset opened) {
  return std::make_unique<LayerPoints>(spec, std::move(opened));
}

}  // namespace thalweg
