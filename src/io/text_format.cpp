// How the rows of a text file are to be understood.
//
// 1. The first row that is no comment shows the separator: of ; tab , the first that stands outside of
//    quotes, else blanks. Numbers between which both tabs and blanks stand are separated by runs of them.
// 2. It is a header if it holds no number, or names x and y. If it holds numbers, the last comment before it
//    is the header if it has as many fields and names x and y (numpy, CloudCompare).
// 3. Decimals are written with a comma if the first number that has any is, and ; or tabs separate.
// 4. Columns by name. If x and y are not both named, the first three columns are x, y, z, unless a name that
//    is known stands in another place than it says.
// 5. Positions in text (UTM, MGRS) have columns of their own names; z is then named, or follows them.
#include "io/text_format.hpp"

#include "base/lower_case.hpp"

#include <thalweg/base/error.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace thalweg {

namespace {

using Names = std::span<const std::string_view>;
constexpr auto kXNames =
    std::to_array<std::string_view>({"x", "lon", "long", "lng", "longitude", "easting", "east"});
constexpr auto kYNames = std::to_array<std::string_view>({"y", "lat", "latitude", "northing", "north"});
constexpr auto kLongitudes = std::to_array<std::string_view>({"lon", "long", "lng", "longitude"});
constexpr auto kLatitudes = std::to_array<std::string_view>({"lat", "latitude"});
constexpr auto kZoneNames = std::to_array<std::string_view>({"zone", "utm_zone", "utmzone"});
constexpr auto kUtmNames = std::to_array<std::string_view>({"utm", "coords", "position"});
constexpr auto kMgrsNames = std::to_array<std::string_view>({"mgrs", "usng", "coords", "position"});
constexpr auto kZNames =
    std::to_array<std::string_view>({"z", "elev", "elevation", "height", "altitude", "alt"});

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

std::string_view trim(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string_view unquote(std::string_view field) {
  field = trim(field);
  if (field.size() >= 2 && field.front() == '"' && field.back() == '"')
    field = trim(field.substr(1, field.size() - 2));
  return field;
}

bool stands_outside_quotes(std::string_view row, char separator) {
  bool quoted = false, field_begins = true;
  for (const char c : row) {
    if (c == '"' && (quoted || field_begins)) quoted = !quoted;
    if (c == separator && !quoted) return true;
    field_begins = c == ',' || c == ';' || c == '\t' || (field_begins && is_blank(c));
  }
  return false;
}

char find_separator(std::string_view row) {
  if (stands_outside_quotes(row, ';')) return ';';
  if (stands_outside_quotes(row, '\t')) {
    const std::vector<std::string_view> by_blanks = split_row(row, ' ');
    const bool numbers = std::all_of(by_blanks.begin(), by_blanks.end(),
                                     [](std::string_view field) { return to_number(field).has_value(); });
    return numbers && by_blanks.size() > split_row(row, '\t').size() ? ' ' : '\t';
  }
  return stands_outside_quotes(row, ',') ? ',' : ' ';
}

std::optional<std::size_t> find_name(const std::vector<std::string>& names, Names wanted) {
  for (const std::string_view name : wanted) {
    for (std::size_t column = 0; column < names.size(); ++column) {
      if (lower(names[column]) == name) return column;
    }
  }
  return std::nullopt;
}

std::optional<std::size_t> find_field(const std::vector<std::string>& names, const std::string& field) {
  const auto exact = std::find(names.begin(), names.end(), field);
  if (exact != names.end()) return static_cast<std::size_t>(exact - names.begin());
  const std::string wanted = lower(field);
  const std::string_view only = wanted;
  return find_name(names, std::span(&only, 1));
}

bool names_x_and_y(const std::vector<std::string>& names) {
  return find_name(names, kXNames) && find_name(names, kYNames);
}

std::vector<std::string> to_names(const std::vector<std::string_view>& fields) {
  std::vector<std::string> names(fields.begin(), fields.end());
  for (std::size_t column = 0; column < names.size(); ++column) {
    if (names[column].empty()) names[column] = "field_" + std::to_string(column + 1);
  }
  return names;
}

/// The first row that is passed over by nothing, and the last comment before it.
struct FirstRow {
  std::string_view row;
  std::string_view comment;
  std::size_t rows_before = 0;
};

FirstRow find_first_row(std::string_view rows, const std::string& name) {
  FirstRow first;
  while (!rows.empty()) {
    const std::size_t end = rows.find('\n');
    const std::string_view row = rows.substr(0, end);
    rows.remove_prefix(std::min(rows.size(), end + 1));
    if (!is_passed_over(row)) {
      first.row = row;
      return first;
    }
    ++first.rows_before;
    if (!trim(row).empty()) first.comment = trim(row);
  }
  throw Error(ErrorCode::EmptyInput, name + " holds no rows with points");
}

/// The mark before the decimals of the first number that has some.
char find_decimal(std::string_view rows, char separator) {
  if (separator != ';' && separator != '\t') return '.';
  while (!rows.empty()) {
    const std::size_t end = rows.find('\n');
    const std::string_view row = rows.substr(0, end);
    rows.remove_prefix(std::min(rows.size(), end + 1));
    if (is_passed_over(row)) continue;
    for (const std::string_view field : split_row(row, separator)) {
      for (const char decimal : {'.', ','}) {
        if (field.find(decimal) != std::string_view::npos && to_number(field, decimal)) return decimal;
      }
    }
  }
  return '.';
}

/// Sets names and header_rows. Returns true if the names stand in the file.
bool find_names(const FirstRow& first, bool text_positions, TextFormat& format) {
  const std::vector<std::string_view> fields = split_row(first.row, format.separator);
  format.header_rows = first.rows_before;
  const auto is_number = [text_positions, decimal = format.decimal](std::string_view field) {
    const auto is_digit = [](unsigned char c) { return std::isdigit(c) != 0; };
    return text_positions ? std::ranges::any_of(field, is_digit) : to_number(field, decimal).has_value();
  };
  format.names = to_names(fields);
  if (std::none_of(fields.begin(), fields.end(), is_number) || names_x_and_y(format.names)) {
    ++format.header_rows;
    return true;
  }
  std::string_view comment = first.comment;
  while (!comment.empty() && (comment.front() == '#' || comment.front() == '/')) comment.remove_prefix(1);
  const std::vector<std::string> commented = to_names(split_row(comment, format.separator));
  if (commented.size() == fields.size() && names_x_and_y(commented)) {
    format.names = commented;
    return true;
  }
  format.names = to_names(std::vector<std::string_view>(fields.size()));
  return false;
}

void take_first_columns(TextFormat& format, bool named, const std::string& name) {
  const std::array<Names, 3> known = {kXNames, kYNames, kZNames};
  for (std::size_t axis = 0; axis < known.size(); ++axis) {
    const std::optional<std::size_t> column = find_name(format.names, known[axis]);
    if (column && *column != axis) {
      throw Error(ErrorCode::BadFormat, name + ": the columns of x and y cannot be told from the header (" +
                                            list_columns(format) + "); name them x and y");
    }
  }
  format.x = 0;
  format.y = 1;
  if (named)
    format.notes.push_back(name + ": the first columns (" + list_columns(format) + ") are taken as x, y, z");
}

void find_columns(TextFormat& format, bool named, const std::string& name) {
  const std::optional<std::size_t> x = find_name(format.names, kXNames);
  const std::optional<std::size_t> y = find_name(format.names, kYNames);
  if (format.names.size() < 2) {
    throw Error(ErrorCode::BadFormat,
                name + " row " + std::to_string(format.header_rows + (named ? 0 : 1)) +
                    " has one column; points need x, y and z, separated by , ; tab or blanks");
  }
  if (x && y) {
    format.x = *x;
    format.y = *y;
    format.is_geographic =
        x == find_name(format.names, kLongitudes) && y == find_name(format.names, kLatitudes);
    if (!format.z) format.z = find_name(format.names, kZNames);
    const bool first_two = *x + *y == 1;
    if (!format.z && first_two && format.names.size() == 3) {
      format.z = 2;
      format.notes.push_back(name + ": column " + format.names[2] + " is taken as z");
    }
    return;
  }
  take_first_columns(format, named, name);
  if (!format.z && format.names.size() >= 3) format.z = 2;
}

/// Where a zone or grid reference stands, and the height after it.
void find_position_columns(TextFormat& format, bool named, std::string_view first_field, PositionForm form,
                           const std::string& name) {
  const bool utm = form == PositionForm::Utm;
  const std::optional<std::size_t> zone = find_name(format.names, kZoneNames);
  const std::optional<std::size_t> x = find_name(format.names, kXNames);
  const std::optional<std::size_t> y = find_name(format.names, kYNames);
  const std::optional<std::size_t> whole =
      find_name(format.names, utm ? Names(kUtmNames) : Names(kMgrsNames));
  if (utm && zone && x && y) {
    format.position = {*zone, *x, *y};
  } else if (whole) {
    format.position = {*whole};
  } else if (named) {
    throw Error(ErrorCode::BadFormat,
                name + ": no column holds the positions (its columns: " + list_columns(format) + "); name " +
                    (utm ? "them zone, x, y, or one utm" : "one mgrs"));
  } else {
    const bool parted = utm && first_field.find(' ') == std::string_view::npos;
    format.position = parted ? std::vector<std::size_t>{0, 1, 2} : std::vector<std::size_t>{0};
  }
  if (!format.z) format.z = find_name(format.names, kZNames);
  const std::size_t next = format.position.size();
  if (!format.z && !named && format.names.size() > next) format.z = next;
}

}  // namespace

std::string list_columns(const TextFormat& format) {
  std::string text;
  for (const std::string& name : format.names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

bool is_passed_over(std::string_view row) {
  row = trim(row);
  return row.empty() || row.front() == '#' || row.substr(0, 2) == "//";
}

std::vector<std::string_view> split_row(std::string_view row, char separator) {
  row = separator == '\t' ? row.substr(0, row.find_last_not_of("\r\n") + 1) : trim(row);
  std::vector<std::string_view> fields;
  std::size_t begin = 0;
  bool quoted = false;
  for (std::size_t i = 0; i <= row.size(); ++i) {
    const bool opens = !quoted && trim(row.substr(begin, i - begin)).empty();  // else it is a mark of seconds
    if (i < row.size() && row[i] == '"' && (quoted || opens)) quoted = !quoted;
    const bool ends =
        i == row.size() || (!quoted && (separator == ' ' ? is_blank(row[i]) : row[i] == separator));
    if (!ends) continue;
    if (separator != ' ' || i > begin) fields.push_back(unquote(row.substr(begin, i - begin)));
    begin = i + 1;
  }
  return fields;
}

std::optional<double> to_number(std::string_view text, char decimal) {
  text = trim(text);
  if (decimal == ',' && text.find_first_of(",.") != std::string_view::npos) {
    std::string with_point(text);
    const std::size_t comma = with_point.find(',');
    if (with_point.find('.') != std::string::npos) return std::nullopt;  // thousands, or two ways at once
    with_point[comma] = '.';
    return to_number(with_point);
  }
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

TextFormat detect_format(std::string_view rows, const std::string& name, const ReadOptions& options) {
  constexpr std::size_t kSniffed = 4096;
  if (rows.substr(0, kSniffed).find('\0') != std::string_view::npos) {
    throw Error(ErrorCode::BadFormat,
                name + " is no text in UTF-8 or ASCII (it holds zero bytes); save it as UTF-8");
  }
  const FirstRow first = find_first_row(rows, name);
  TextFormat format;
  format.separator = find_separator(first.row);
  format.decimal = find_decimal(rows, format.separator);
  if (format.decimal == ',') format.notes.push_back(name + ": decimals are written with a comma");
  const bool named = find_names(first, options.coords.has_value(), format);
  if (!options.z_field.empty()) {
    format.z = find_field(format.names, options.z_field);
    format.has_z_field = format.z.has_value();
  }
  if (options.coords && *options.coords != PositionForm::Dms) {
    find_position_columns(format, named, split_row(first.row, format.separator).front(), *options.coords,
                          name);
  } else {
    find_columns(format, named, name);
    if (options.coords) format.position = {format.x, format.y};
  }
  if (!format.z && options.heights == HeightRule::Required) {
    throw Error(ErrorCode::MissingHeight, name + " has no column with heights (its columns: " +
                                              list_columns(format) + "); name one z, or give --z-field NAME");
  }
  return format;
}

}  // namespace thalweg
