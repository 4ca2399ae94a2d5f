#pragma once

/// A whole file in memory, and scanning it as text.

#include <thalweg/base/error.hpp>
#include <thalweg/io/pending_outputs.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace thalweg {

/// The bytes of a file; GDAL's virtual paths (/vsizip/, /vsicurl/) work.
/// Throws: Error{NotFound}, Error{Unreadable}.
class FileContent {
 public:
  explicit FileContent(const std::string& path);
  [[nodiscard]] std::string_view bytes() const { return {data_.get(), size_}; }

 private:
  std::unique_ptr<char[]> data_;
  std::size_t size_ = 0;
};

/// The first `most` bytes of a file, fewer if it is shorter.
/// Throws: Error{NotFound}, Error{Unreadable}.
std::string read_head(const std::string& path, std::size_t most);

/// The trimmed content of the file beside `path` that ends in .prj, or empty.
std::string read_prj_sidecar(const std::string& path);
/// Whether the .prj of an output is there already and says the same as `wkt` (empty: no CRS): then it stays,
/// it may be of another format of the same name. Throws: Error{Usage} if it says something else, and is to be
/// overwritten, but another file beside it has its CRS from there.
bool keeps_prj(const std::string& prj, const std::string& wkt, const std::string& target, Overwrite mode);

/// Reads words and numbers off a text, and knows the line for its errors.
class TextScanner {
 public:
  TextScanner(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  /// The next word of this line, empty at its end. Words are separated by blanks and tabs; the ends of lines
  /// may be LF or CR LF.
  std::string_view word();
  /// The next word, on whatever line it stands; empty at the end of the text.
  std::string_view word_anywhere();
  /// The rest of this line, trimmed.
  std::string_view rest_of_line();
  /// True if no word is left on this line.
  bool line_ended();
  /// Goes to the start of the next line; false if there is none.
  bool next_line();
  [[nodiscard]] bool at_end() const { return position_ >= text_.size(); }
  [[nodiscard]] std::size_t position() const { return position_; }
  [[nodiscard]] std::size_t size() const { return text_.size(); }
  [[nodiscard]] double fraction() const;

  /// Reads a word of this line as a finite number. `what` names it in errors.
  /// Throws: Error{BadFormat}, Error{BadCoordinate}.
  double number(std::string_view what);
  /// Reads a word of this line as an integer. Throws: Error{BadFormat}.
  std::int64_t integer(std::string_view what);
  /// Throws: Error with the file and the line of the last word put before the message.
  [[noreturn]] void fail(ErrorCode code, const std::string& message) const;

 private:
  std::string_view take_word();

  std::string_view text_;
  const std::string& file_;
  std::size_t position_ = 0;
  std::size_t word_start_ = 0;
};

/// A text as a double, whatever the locale; nothing if it is not all of a number. A leading '+' is accepted.
std::optional<double> parse_number(std::string_view word);
/// A text as an integer; nothing if it is not all of one.
std::optional<std::int64_t> parse_integer(std::string_view word);

}  // namespace thalweg
