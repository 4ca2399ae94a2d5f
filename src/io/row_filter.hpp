#pragma once

/// Conditions on the attributes of rows of text.

#include "io/text_format.hpp"

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace thalweg {

/// A condition in OGR's SQL on the columns of a table. A column is a number if all its filled fields in the
/// sample are; else it is text.
class RowFilter {
 public:
  /// Throws: Error{Usage} if the condition cannot be used with these columns.
  RowFilter(const TextFormat& format, std::string_view sample, const std::string& condition,
            std::string name);
  ~RowFilter();

  /// True if the row, the `number`th of the file, meets the condition.
  /// Throws: Error{BadFormat} if a field of a numeric column is no number.
  bool accepts(std::string_view row, std::size_t number);

 private:
  struct Query;
  std::string name_;
  std::unique_ptr<Query> query_;
};

}  // namespace thalweg
