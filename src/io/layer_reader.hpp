#pragma once

/// Features of a layer, for the readers of points and of lines.

#include "io/dataset.hpp"
#include "io/gdal_session.hpp"
#include "io/source_reader.hpp"

#include <thalweg/base/error.hpp>

#include <ogrsf_frmts.h>

#include <memory>
#include <optional>
#include <string>

namespace thalweg {

/// A layer that is open.
class LayerReader : public SourceReader {
 public:
  /// Throws: as choose_layer.
  LayerReader(const SourceSpec& spec, OpenedDataset opened, LayerUse use);

 protected:
  /// Calls `work(feature, geometry)` for each feature that meets the run's condition and has a geometry that
  /// is not empty. Throws: Error{EmptyInput} if the layer has none; Error{Unreadable} if reading breaks off.
  template <class Work>
  void for_each_feature(ReadContext& run, const Work& work) {
    GdalSession session;
    start(run);
    while (const std::unique_ptr<OGRFeature> feature{layer_->GetNextFeature()}) {
      const OGRGeometry* const geometry = feature->GetGeometryRef();
      const bool empty = geometry == nullptr || geometry->IsEmpty();
      if (empty) ++features_empty_;
      if (!empty) work(*feature, *geometry);
      count(run);
    }
    finish(run, session);
  }

  /// The field of that name; none, and a refusal, if the layer has none. Pre: the name is not empty.
  std::optional<int> find_field(const std::string& field, OptionUse& use);
  /// The field's value; none if it is null. Throws: Error{BadFormat} if it is no usable number.
  std::optional<double> number_in(const OGRFeature& feature, int field) const;
  /// "file|layer feature 12".
  [[nodiscard]] std::string name_of(const OGRFeature& feature) const {
    return name() + " feature " + std::to_string(feature.GetFID());
  }
  /// The error of a feature whose geometry is not what is wanted.
  [[nodiscard]] Error wrong_geometry(const OGRFeature& feature, const OGRGeometry& geometry,
                                     LayerUse use) const;
  /// A vertex, x = east. Throws: Error{BadCoordinate} naming feature and vertex.
  Point2 position(const OGRFeature& feature, double x, double y, int vertex) const;
  /// A height. Throws: Error{BadCoordinate} naming feature and vertex.
  double height(const OGRFeature& feature, double z, int vertex) const;

 private:
  void start(ReadContext& run);
  void count(ReadContext& run);
  void finish(ReadContext& run, const GdalSession& session) const;

  GDALDatasetUniquePtr dataset_;
  OGRLayer* layer_;
  bool filtered_ = false;
  bool axes_are_swapped_ = false;
  double features_expected_ = 0;
  std::size_t features_read_ = 0;
  std::size_t features_empty_ = 0;
};

/// Throws: as choose_layer.
std::unique_ptr<SourceReader> open_layer_points(const SourceSpec& spec, OpenedDataset opened);

}  // namespace thalweg
