// Conditions on the attributes of rows of text: OGR's evaluator, run on one feature that is refilled for each
// row with the columns that the condition names.
#include "io/row_filter.hpp"

#include "io/gdal_session.hpp"

#include <thalweg/base/error.hpp>

#include <ogr_feature.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace thalweg {

struct RowFilter::Query {
  char separator = ',';
  char decimal = '.';
  OGRFeatureDefn* definition = new OGRFeatureDefn("rows");  // counts its references
  std::unique_ptr<OGRFeature> feature;
  OGRFeatureQuery query;
  std::vector<int> used_columns;

  Query() { definition->Reference(); }
  ~Query() {
    feature.reset();
    definition->Release();
  }
  Query(const Query&) = delete;
  Query& operator=(const Query&) = delete;
};

namespace {

/// For each column: true if all its filled fields are numbers, and one is.
std::vector<bool> find_numeric_columns(const TextFormat& format, std::string_view sample) {
  std::vector<bool> numbers(format.names.size(), true);
  std::vector<bool> filled(format.names.size(), false);
  for (std::size_t row_number = 0; !sample.empty(); ++row_number) {
    const std::size_t end = sample.find('\n');
    const std::string_view row = sample.substr(0, end);
    sample.remove_prefix(end + 1);
    if (row_number < format.header_rows || is_passed_over(row)) continue;
    const std::vector<std::string_view> fields = split_row(row, format.separator);
    for (std::size_t i = 0; i < std::min(fields.size(), numbers.size()); ++i) {
      if (fields[i].empty()) continue;
      filled[i] = true;
      if (numbers[i] && !to_number(fields[i], format.decimal)) numbers[i] = false;
    }
  }
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = numbers[i] && filled[i];
  return numbers;
}

}  // namespace

RowFilter::RowFilter(const TextFormat& format, std::string_view sample, const std::string& condition,
                     std::string name)
    : name_(std::move(name)), query_(std::make_unique<Query>()) {
  GdalSession session;
  query_->separator = format.separator;
  query_->decimal = format.decimal;
  const std::vector<bool> numbers = find_numeric_columns(format, sample);
  for (std::size_t i = 0; i < format.names.size(); ++i) {
    OGRFieldDefn field(format.names[i].c_str(), numbers[i] ? OFTReal : OFTString);
    query_->definition->AddFieldDefn(&field);
  }
  if (query_->query.Compile(query_->definition, condition.c_str()) != OGRERR_NONE) {
    throw Error(ErrorCode::Usage,
                name_ + ": the condition " + condition + " cannot be used" + session.reason());
  }
  char** const used = query_->query.GetUsedFields();
  for (char** field = used; field != nullptr && *field != nullptr; ++field) {
    const int index = query_->definition->GetFieldIndex(*field);
    if (index >= 0) query_->used_columns.push_back(index);
  }
  CSLDestroy(used);
  query_->feature = std::make_unique<OGRFeature>(query_->definition);
}

RowFilter::~RowFilter() = default;

bool RowFilter::accepts(std::string_view row, std::size_t number) {
  const std::vector<std::string_view> fields = split_row(row, query_->separator);
  OGRFeature& feature = *query_->feature;
  for (const int column : query_->used_columns) {
    const auto index = static_cast<std::size_t>(column);
    const std::string_view field = index < fields.size() ? fields[index] : std::string_view();
    if (field.empty()) {
      feature.SetFieldNull(column);
    } else if (feature.GetFieldDefnRef(column)->GetType() == OFTString) {
      feature.SetField(column, std::string(field).c_str());
    } else if (const std::optional<double> value = to_number(field, query_->decimal)) {
      feature.SetField(column, *value);
    } else {
      throw Error(ErrorCode::BadFormat, name_ + " row " + std::to_string(number) + ": column " +
                                            feature.GetFieldDefnRef(column)->GetNameRef() + " holds \"" +
                                            std::string(field) +
                                            "\" among numbers, which --where cannot compare");
    }
  }
  return query_->query.Evaluate(&feature) != 0;
}

}  // namespace thalweg
