// Features of a layer, for the readers of points and of lines.
#include "io/layer_reader.hpp"

#include "io/spatial_reference.hpp"
#include "io/text_format.hpp"

#include <thalweg/base/error.hpp>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace thalweg {

namespace {

/// True if the layer's data have north (or latitude) as their first axis.
bool has_swapped_axes(const OGRSpatialReference& reference) {
  OGRSpatialReference traditional(reference);
  traditional.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::vector<int>& here = reference.GetDataAxisToSRSAxisMapping();
  const std::vector<int>& there = traditional.GetDataAxisToSRSAxisMapping();
  return here.size() >= 2 && there.size() >= 2 && here[0] == there[1] && here[1] == there[0];
}

}  // namespace

LayerReader::LayerReader(const SourceSpec& spec, OpenedDataset opened, LayerUse use)
    : SourceReader(spec), layer_(&choose_layer(*opened.dataset, spec, use)) {
  // A file's only layer needs no name in messages.
  if (opened.dataset->GetLayerCount() > 1) set_layer(layer_->GetName());
  const OGRSpatialReference* const reference = layer_->GetSpatialRef();
  if (lacks_declared_crs(opened, reference)) {
    set_unresolved_crs(opened.crs_errors);
  } else if (reference != nullptr && !means_none(*reference)) {
    axes_are_swapped_ = has_swapped_axes(*reference);
    OGRSpatialReference traditional(*reference);
    traditional.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    set_reference(traditional);
  }
  dataset_ = std::move(opened.dataset);
}

void LayerReader::start(ReadContext& run) {
  if (!run.options.where.empty()) {
    // Some drivers look at the condition only when they read: the first feature is tried.
    GdalSession session;
    filtered_ = layer_->SetAttributeFilter(run.options.where.c_str()) == OGRERR_NONE;
    if (filtered_) delete layer_->GetNextFeature();
    filtered_ = filtered_ && !session.failed();
    if (filtered_) {
      run.where.taken = true;
    } else {
      layer_->SetAttributeFilter(nullptr);
      run.where.refusals.push_back(name() + ": the condition " + run.options.where + " cannot be used" +
                                   session.reason());
    }
  }
  layer_->ResetReading();
  if (layer_->TestCapability(OLCFastFeatureCount)) {
    features_expected_ = static_cast<double>(layer_->GetFeatureCount(FALSE));
  }
}

void LayerReader::count(ReadContext& run) {
  constexpr std::size_t kReportEvery = 256;
  if (++features_read_ % kReportEvery != 0) return;
  run.advance(features_expected_ > 0 ? std::min(1.0, static_cast<double>(features_read_) / features_expected_)
                                     : 0);
}

void LayerReader::finish(ReadContext& run, const GdalSession& session) const {
  if (session.failed()) {
    throw Error(ErrorCode::Unreadable, name() + " cannot be read to its end: it breaks after feature " +
                                           std::to_string(features_read_) + session.reason());
  }
  if (!filtered_ && features_read_ == features_empty_) {
    throw Error(ErrorCode::EmptyInput,
                name() +
                    (features_read_ == 0 ? " holds no features"
                                         : " holds no geometry: none of its features has one") +
                    "; name another layer, or leave it out");
  }
  if (features_read_ == 0) run.note(name() + ": no feature meets the condition " + run.options.where);
  if (features_empty_ == 0) return;
  run.note(name() + ": " + std::to_string(features_empty_) + " features without geometry were skipped");
}

std::optional<int> LayerReader::find_field(const std::string& field, OptionUse& use) {
  OGRFeatureDefn& definition = *layer_->GetLayerDefn();
  const int index = definition.GetFieldIndex(field.c_str());
  if (index >= 0) {
    use.taken = true;
    return index;
  }
  std::string names;
  for (int i = 0; i < definition.GetFieldCount(); ++i)
    names += (i == 0 ? "" : ", ") + std::string(definition.GetFieldDefn(i)->GetNameRef());
  use.refusals.push_back(name() + " has no field " + field +
                         (names.empty() ? " (it has none)" : " (its fields: " + names + ")"));
  return std::nullopt;
}

std::optional<double> LayerReader::number_in(const OGRFeature& feature, int field) const {
  if (!feature.IsFieldSetAndNotNull(field)) return std::nullopt;
  const OGRFieldType type = feature.GetFieldDefnRef(field)->GetType();
  std::optional<double> value;
  if (type == OFTReal || type == OFTInteger || type == OFTInteger64) {
    value = feature.GetFieldAsDouble(field);
  } else {
    const std::string text = feature.GetFieldAsString(field);
    if (text.empty()) return std::nullopt;
    value = to_number(text);
  }
  if (value && is_usable(*value)) return value;
  throw Error(ErrorCode::BadFormat, name_of(feature) + ": field " +
                                        feature.GetFieldDefnRef(field)->GetNameRef() + " holds \"" +
                                        feature.GetFieldAsString(field) + "\", not a height");
}

Error LayerReader::wrong_geometry(const OGRFeature& feature, const OGRGeometry& geometry,
                                  LayerUse use) const {
  const bool points = use == LayerUse::Points;
  return {ErrorCode::WrongGeometry,
          name_of(feature) + " is a " + name_of_geometry(geometry.getGeometryType()) + ", not " +
              (points ? "a point; give lines with --breaklines, --ridges or --valleys"
                      : "a line or polygon; give points before the output")};
}

Point2 LayerReader::position(const OGRFeature& feature, double x, double y, int vertex) const {
  if (!is_usable(x) || !is_usable(y)) {
    throw Error(ErrorCode::BadCoordinate, name_of(feature) + ": vertex " + std::to_string(vertex) + " at (" +
                                              std::to_string(x) + ", " + std::to_string(y) +
                                              ") is no usable position; repair or remove the feature");
  }
  return axes_are_swapped_ ? Point2{y, x} : Point2{x, y};
}

double LayerReader::height(const OGRFeature& feature, double z, int vertex) const {
  if (!is_usable(z)) {
    throw Error(ErrorCode::BadCoordinate,
                name_of(feature) + ": vertex " + std::to_string(vertex) + " has the height " +
                    std::to_string(z) +
                    "; repair it, or take heights from a field (--z-field, --line-z-field)");
  }
  return z;
}

}  // namespace thalweg
