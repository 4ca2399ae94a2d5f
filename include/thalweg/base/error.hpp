#pragma once

/// The one error type of the library.

#include <stdexcept>
#include <string>
#include <string_view>

namespace thalweg {

/// What went wrong; a closed list, which scripts may match by `error_name`.
enum class ErrorCode {
  Usage,          ///< an option or argument is off
  NotFound,       ///< a file or layer is missing
  Unreadable,     ///< a file exists, but cannot be opened or read
  BadFormat,      ///< a file's content breaks its format (file and row named)
  BadCoordinate,  ///< a coordinate or height is not finite, or out of range
  EmptyInput,     ///< a source holds nothing usable
  WrongGeometry,  ///< a layer holds another geometry type than the one needed
  MissingHeight,  ///< a point has no height and none can be derived
  TooFewPoints,   ///< fewer than three distinct points
  Collinear,      ///< all points on one line: no triangle exists
  CrossingLines,  ///< lines cross and the rule says that they must not
  OutsideHull,    ///< a vertex without height lies outside of the points' hull
  TooClose,       ///< coordinates too close together for double arithmetic
  BadCrs,         ///< a CRS is unreadable, or two sources cannot be brought together
  InvalidTin,     ///< a mesh breaks a law of `validate`
  Unsupported,    ///< known, but not available
  SizeLimit,      ///< larger than a stated limit
  OutputExists,   ///< the output is there and overwriting was not asked for
  WriteFailed,    ///< the output could not be written whole
  OutOfMemory,    ///< the machine has not enough memory
  Cancelled,      ///< stopped on request
  Internal        ///< a law of the library itself was broken: a bug
};

/// Stable name of a code, as printed by the command line: "not-found", "bad-format", ...
std::string_view error_name(ErrorCode code);

/// Thrown for everything that is wrong with a user's input or machine.
/// `what()` is one line: what, where (file, layer, feature, row), the limit, and what to do.
class Error : public std::runtime_error {
 public:
  /// Zero bytes of the message become \x00, for what() ends at the first.
  Error(ErrorCode code, const std::string& message);
  [[nodiscard]] ErrorCode code() const noexcept { return code_; }

 private:
  ErrorCode code_;
};

}  // namespace thalweg
