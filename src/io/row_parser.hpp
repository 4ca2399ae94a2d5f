#pragma once

/// Coordinates out of rows of text, fast.

#include "io/text_format.hpp"

#include <thalweg/base/error.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace thalweg {

/// Parses the columns x, y, z of the rows of one file.
class RowParser {
 public:
  using Coordinates = std::array<double, 3>;

  RowParser(const TextFormat& format, std::string name, const ReadOptions& options);

  /// Parses the row [begin, end) without its line feed; none if something is wrong with it, if its
  /// position is text, or if decimals are written with a comma.
  std::optional<Coordinates> parse(const char* begin, const char* end) const;
  /// What `parse` could not: a position in text; decimals with a comma; a row whose height is missing, where
  /// heights are optional.
  /// Throws: the error that names the row, counted from 1, the column, what stands there, and the remedy.
  Coordinates parse_or_explain(std::string_view row, std::size_t number) const;

 private:
  struct Column {
    std::size_t index = 0;
    std::size_t axis = 0;
  };
  struct Parsed {
    const char* end = nullptr;  // null: no usable number
    double value = 0;
  };
  const char* next_field(const char* p, const char* end) const;
  Parsed parse_field(const char* p, const char* end) const;
  const char* skip_blanks(const char* p, const char* end) const;
  [[nodiscard]] std::string_view field_at(const std::vector<std::string_view>& fields, std::size_t column,
                                          const std::string& row) const;
  [[nodiscard]] Point2 position_in(const std::vector<std::string_view>& fields, const std::string& row) const;
  [[nodiscard]] Error explain(std::string_view field, const Column& column, const std::string& row) const;

  std::string name_;
  char separator_;
  char decimal_;
  HeightRule heights_;
  std::vector<std::string> names_;
  std::vector<Column> columns_;  // of numbers, by index
  PositionForm form_ = PositionForm::Dms;
  std::vector<std::size_t> position_;  // columns of a position in text; empty: none
};

}  // namespace thalweg
