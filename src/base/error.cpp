// Names of error codes, and what a failed assertion does.
#include <thalweg/base/assert.hpp>
#include <thalweg/base/error.hpp>

#include <string>
#include <string_view>

namespace thalweg {

namespace {

std::string without_zeros(std::string text) {
  for (std::size_t at = text.find('\0'); at != std::string::npos; at = text.find('\0', at)) {
    text.replace(at, 1, "\\x00");
  }
  return text;
}

}  // namespace

Error::Error(ErrorCode code, const std::string& message)
    : std::runtime_error(without_zeros(message)), code_(code) {}

std::string_view error_name(ErrorCode code) {
  switch (code) {
    case ErrorCode::Usage:
      return "usage";
    case ErrorCode::NotFound:
      return "not-found";
    case ErrorCode::Unreadable:
      return "unreadable";
    case ErrorCode::BadFormat:
      return "bad-format";
    case ErrorCode::BadCoordinate:
      return "bad-coordinate";
    case ErrorCode::EmptyInput:
      return "empty-input";
    case ErrorCode::WrongGeometry:
      return "wrong-geometry";
    case ErrorCode::MissingHeight:
      return "missing-height";
    case ErrorCode::TooFewPoints:
      return "too-few-points";
    case ErrorCode::Collinear:
      return "collinear";
    case ErrorCode::CrossingLines:
      return "crossing-lines";
    case ErrorCode::OutsideHull:
      return "outside-hull";
    case ErrorCode::TooClose:
      return "too-close";
    case ErrorCode::BadCrs:
      return "bad-crs";
    case ErrorCode::InvalidTin:
      return "invalid-tin";
    case ErrorCode::Unsupported:
      return "unsupported";
    case ErrorCode::SizeLimit:
      return "size-limit";
    case ErrorCode::OutputExists:
      return "output-exists";
    case ErrorCode::WriteFailed:
      return "write-failed";
    case ErrorCode::OutOfMemory:
      return "out-of-memory";
    case ErrorCode::Cancelled:
      return "cancelled";
    case ErrorCode::Internal:
      return "internal";
  }
  return "internal";
}

#ifdef THALWEG_ASSERTIONS
void assertion_failed(const char* expression, const char* file, int line) {
  throw Error(ErrorCode::Internal,
              std::string("assertion failed: ") + expression + " at " + file + ":" + std::to_string(line));
}
#endif

}  // namespace thalweg
