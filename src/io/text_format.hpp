#pragma once

/// How the rows of a text file are to be understood.

#include <thalweg/io/source.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace thalweg {

/// Separator and columns of a table of points.
struct TextFormat {
  char separator = ',';  ///< ',', ';', tab; ' ' stands for runs of blanks and tabs
  char decimal = '.';    ///< or ',', in files that ; or tabs separate
  std::size_t header_rows =
      0;  ///< rows to pass over before the first point, comments and blank rows included
  std::vector<std::string> names;  ///< of the columns; field_1, field_2, ... where the file has none
  std::size_t x = 0;               ///< column
  std::size_t y = 1;
  std::optional<std::size_t> z;       ///< none: points have no height
  bool has_z_field = false;           ///< the column that was asked for is there
  std::vector<std::size_t> position;  ///< columns of a position in text; then x and y mean nothing
  bool is_geographic = false;         ///< the columns are called longitude and latitude
  std::vector<std::string> notes;
};

/// The names of all columns, separated by commas.
std::string list_columns(const TextFormat& format);
/// True for blank rows and comments: what begins with # or //.
bool is_passed_over(std::string_view row);
/// The fields of a row, without surrounding blanks and quotes.
std::vector<std::string_view> split_row(std::string_view row, char separator);
/// The whole text as a number whose decimals follow `decimal`; none if it is not one.
std::optional<double> to_number(std::string_view text, char decimal = '.');

/// Finds out separator, header and columns from a file's first rows.
/// A header is a first row without numbers or with the names of x and y, or a comment right before the first
/// row that names x and y. Columns are taken by name; else the first three, if no name contradicts. Where
/// positions are text a header is a first row without digits; UTM stands in columns zone, x, y or utm, MGRS
/// in mgrs, else in the first. Throws: Error{BadFormat}, Error{MissingHeight}, Error{EmptyInput}, naming
/// `name`.
TextFormat detect_format(std::string_view rows, const std::string& name, const ReadOptions& options);

}  // namespace thalweg
