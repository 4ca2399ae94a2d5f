// Coordinates out of rows of text, fast.
//
// One walk along the row: fields before a wanted column are passed over, wanted ones go through
// std::from_chars, and the walk ends with the last wanted column. Only if that fails, or decimals are written
// with a comma, the row is split and looked at field by field.
#include "io/row_parser.hpp"

#include "io/source_reader.hpp"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

namespace thalweg {

RowParser::RowParser(const TextFormat& format, std::string name, const ReadOptions& options)
    : name_(std::move(name)),
      separator_(format.separator),
      decimal_(format.decimal),
      heights_(options.heights),
      names_(format.names),
      form_(options.coords.value_or(PositionForm::Dms)),
      position_(format.position) {
  if (position_.empty()) columns_ = {{format.x, 0}, {format.y, 1}};
  if (format.z) columns_.push_back({*format.z, 2});
  std::sort(columns_.begin(), columns_.end(),
            [](const Column& a, const Column& b) { return a.index < b.index; });
}

const char* RowParser::skip_blanks(const char* p, const char* end) const {
  while (p != end && (*p == ' ' || *p == '\r' || (*p == '\t' && separator_ != '\t'))) ++p;
  return p;
}

/// From within a field to the begin of the next; null if there is none.
const char* RowParser::next_field(const char* p, const char* end) const {
  if (separator_ == ' ') {
    while (p != end && *p != ' ' && *p != '\t') ++p;
    p = skip_blanks(p, end);
    return p == end ? nullptr : p;
  }
  const char* const text = skip_blanks(p, end);
  if (text != end && *text == '"') {
    p = std::find(text + 1, end, '"');
  }
  p = std::find(p, end, separator_);
  return p == end ? nullptr : p + 1;
}

/// Parses the field at p. Its end is where the separator stands, or in a row separated by blanks where it
/// begins.
RowParser::Parsed RowParser::parse_field(const char* p, const char* end) const {
  const char* const field = p;
  p = skip_blanks(p, end);
  const bool quoted = p != end && *p == '"';
  if (quoted) p = skip_blanks(p + 1, end);
  if (end - p > 1 && p[0] == '+' && p[1] != '-') ++p;
  double value = 0;
  const auto [rest, error] = std::from_chars(p, end, value);
  if (error != std::errc() || !is_usable(value)) return {};
  p = rest;
  if (quoted) {
    p = skip_blanks(p, end);
    if (p == end || *p != '"') return {};
    ++p;
  }
  if (separator_ == ' ') {
    const bool ends = p == end || skip_blanks(p, end) != p;
    return ends ? Parsed{field, value} : Parsed{};
  }
  p = skip_blanks(p, end);
  return p == end || *p == separator_ ? Parsed{p, value} : Parsed{};
}

std::optional<RowParser::Coordinates> RowParser::parse(const char* begin, const char* end) const {
  if (!position_.empty() || decimal_ != '.') return std::nullopt;
  Coordinates coordinates{};
  const char* p = skip_blanks(begin, end);
  if (p != end && (*p == '#' || *p == '/')) return std::nullopt;  // a comment, or no number
  std::size_t index = 0;
  for (const Column& column : columns_) {
    for (; index < column.index; ++index) {
      p = next_field(p, end);
      if (p == nullptr) return std::nullopt;
    }
    const Parsed parsed = parse_field(p, end);
    if (parsed.end == nullptr) return std::nullopt;
    coordinates[column.axis] = parsed.value;
    p = parsed.end;
  }
  return coordinates;
}

std::string_view RowParser::field_at(const std::vector<std::string_view>& fields, std::size_t column,
                                     const std::string& row) const {
  if (column < fields.size()) return fields[column];
  throw Error(ErrorCode::BadFormat, row + " ends before column " + std::to_string(column + 1) + " (" +
                                        names_[column] + "); it has " + std::to_string(fields.size()) +
                                        (fields.size() == 1 ? " column" : " columns") +
                                        "; complete it, or put # before it");
}

Point2 RowParser::position_in(const std::vector<std::string_view>& fields, const std::string& row) const {
  std::vector<std::string_view> parts;
  for (const std::size_t column : position_) parts.push_back(field_at(fields, column, row));
  try {
    return parse_position(parts, form_);
  } catch (const Error& error) {
    throw Error(error.code(), row + ": " + error.what() + "; correct the row, or put # before it");
  }
}

RowParser::Coordinates RowParser::parse_or_explain(std::string_view row, std::size_t number) const {
  const std::vector<std::string_view> fields = split_row(row, separator_);
  const std::string where = name_ + " row " + std::to_string(number);
  Coordinates coordinates{};
  for (const Column& column : columns_) {
    const bool optional = column.axis == 2 && heights_ == HeightRule::Optional;
    if (optional && (column.index >= fields.size() || fields[column.index].empty())) continue;
    const std::string_view field = field_at(fields, column.index, where);
    const std::optional<double> value = to_number(field, decimal_);
    if (!value || !is_usable(*value)) throw explain(field, column, where);
    coordinates[column.axis] = *value;
  }
  if (!position_.empty()) {
    const Point2 position = position_in(fields, where);
    coordinates[0] = position.x;
    coordinates[1] = position.y;
  }
  return coordinates;
}

Error RowParser::explain(std::string_view field, const Column& column, const std::string& row) const {
  constexpr std::size_t kShown = 40;
  const std::string shown(field.size() > kShown ? std::string(field.substr(0, kShown)) + "..."
                                                : std::string(field));
  const std::string place =
      row + ": column " + std::to_string(column.index + 1) + " (" + names_[column.index] + ")";
  if (field.empty() && column.axis == 2) {
    return {ErrorCode::MissingHeight, place + " is empty; fill in a height, or put # before the row"};
  }
  double value = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  const bool whole = end == field.data() + field.size();
  const bool other_decimal = decimal_ == ',' ? field.find('.') != std::string_view::npos
                                             : error == std::errc() && *end == ',' && separator_ != ',';
  if (other_decimal && !(whole && decimal_ == '.')) {
    return {ErrorCode::BadFormat, place + " holds \"" + shown +
                                      "\"; write all decimals of a file with a point, or all with a comma"};
  }
  if (whole && error != std::errc::invalid_argument) {
    return {
        ErrorCode::BadCoordinate,
        place + " holds " + shown + ", which is no usable coordinate; correct the row, or put # before it"};
  }
  return {ErrorCode::BadFormat,
          place + " holds \"" + shown + "\", not a number; correct the row, or put # before it"};
}

}  // namespace thalweg
