// The mesh formats OFF and STL.
//
// An STL repeats the corners of every triangle: equal positions are one vertex, in order of first appearance.
// It is read in binary and as text; the size of a binary file follows from its number of triangles.
#include "io/file_content.hpp"
#include "io/tin_format.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>
#include <string>
#include <string_view>

namespace thalweg {

namespace {

constexpr std::size_t kProgressStep = 1U << 12U;

/// Comments go from # to the end of a line.
std::string_view next_word(TextScanner& scanner, const char* what) {
  std::string_view word = scanner.word_anywhere();
  while (word.starts_with('#')) {
    scanner.next_line();
    word = scanner.word_anywhere();
  }
  if (word.empty()) scanner.fail(ErrorCode::BadFormat, std::string("the file ends before ") + what);
  return word;
}

double next_number(TextScanner& scanner, const char* what) {
  const std::string_view word = next_word(scanner, what);
  const std::optional<double> value = parse_number(word);
  if (!value) scanner.fail(ErrorCode::BadFormat, "'" + std::string(word.substr(0, 40)) + "' is no number");
  if (!std::isfinite(*value)) scanner.fail(ErrorCode::BadCoordinate, std::string(what) + " is not finite");
  return *value;
}

std::size_t next_count(TextScanner& scanner, const char* what) {
  const std::string_view word = next_word(scanner, what);
  const std::int64_t value = parse_integer(word).value_or(-1);
  if (value < 0 || value >= Id<void>::kInvalid) {
    scanner.fail(ErrorCode::BadFormat, std::string("'").append(word.substr(0, 40)) + "' is no " + what);
  }
  return static_cast<std::size_t>(value);
}

class StlReader {
 public:
  StlReader(const std::string& path, Progress& progress)
      : path_(path), progress_(progress), origin_(read_origin(path)) {}

  TinFile read() {
    const FileContent content(path_);
    const std::string_view bytes = content.bytes();
    if (bytes.size() >= kHeader && bytes.size() == kHeader + kFacet * std::size_t{number_at(bytes, kTitle)}) {
      read_binary(bytes);
    } else {
      read_text(bytes);
    }
    return std::move(tin_);
  }

 private:
  static constexpr std::size_t kTitle = 80, kHeader = 84, kFacet = 50;

  static std::uint32_t number_at(std::string_view bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;) value = value << 8U | static_cast<unsigned char>(bytes[at + i]);
    return value;
  }

  void read_binary(std::string_view bytes) {
    const std::size_t count = number_at(bytes, kTitle);
    for (std::size_t t = 0; t < count; ++t) {
      if (t % kProgressStep == 0) progress_.advance(static_cast<double>(t) / static_cast<double>(count));
      std::array<VertexId, 3> corners;
      for (std::size_t i = 0; i < 3; ++i) {
        std::array<double, 3> p{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
          constexpr std::size_t kNormal = 12;
          const std::size_t at = kHeader + kFacet * t + kNormal + 12 * i + 4 * axis;
          p[axis] = static_cast<double>(std::bit_cast<float>(number_at(bytes, at)));
          if (!std::isfinite(p[axis])) {
            throw Error(ErrorCode::BadCoordinate,
                        path_ + ": triangle " + std::to_string(t) + " has a coordinate that is not finite");
          }
        }
        corners[i] = vertex(p);
      }
      tin_.triangles.push_back(corners);
    }
  }

  void read_text(std::string_view bytes) {
    TextScanner scanner(bytes, path_);
    if (scanner.word_anywhere() != "solid") {
      scanner.fail(ErrorCode::BadFormat,
                   "is neither a whole binary STL nor one in text, which begins with solid");
    }
    scanner.next_line();
    std::vector<VertexId> corners;
    std::size_t words = 0;
    bool solid_ends = false;
    for (std::string_view word = scanner.word_anywhere(); !word.empty(); word = scanner.word_anywhere()) {
      if (words++ % kProgressStep == 0) progress_.advance(scanner.fraction());
      if (word == "vertex") {
        const double x = next_number(scanner, "x"), y = next_number(scanner, "y");
        corners.push_back(vertex({x, y, next_number(scanner, "z")}));
      } else if (word == "endloop") {
        if (corners.size() != 3) scanner.fail(ErrorCode::WrongGeometry, "the facet is no triangle");
        tin_.triangles.push_back({corners[0], corners[1], corners[2]});
        corners.clear();
      } else if (word == "solid" || word == "endsolid") {
        solid_ends = word == "endsolid";
        scanner.rest_of_line();  // a name, of any words
      }
    }
    if (!corners.empty()) scanner.fail(ErrorCode::BadFormat, "the last facet has no end");
    if (!solid_ends) scanner.fail(ErrorCode::BadFormat, "the file ends before endsolid; is it cut off?");
  }

  VertexId vertex(const std::array<double, 3>& p) {
    const auto [known, is_new] = ids_.emplace(p, VertexId{tin_.points.size()});
    if (is_new) {
      tin_.points.push_back({p[0] + origin_.x, p[1] + origin_.y});
      tin_.heights.push_back(p[2] + origin_.z);
    }
    return known->second;
  }

  const std::string& path_;
  Progress& progress_;
  LocalOrigin origin_;
  std::map<std::array<double, 3>, VertexId> ids_;
  TinFile tin_;
};

}  // namespace

TinFile read_off(const std::string& path, Progress& progress) {
  const FileContent content(path);
  TextScanner scanner(content.bytes(), path);
  TinFile tin;
  scanner.word_anywhere();
  const std::size_t vertices = next_count(scanner, "number of vertices");
  const std::size_t faces = next_count(scanner, "number of faces");
  next_count(scanner, "number of edges");
  for (std::size_t v = 0; v < vertices; ++v) {
    if (v % kProgressStep == 0) progress.advance(scanner.fraction());
    const double x = next_number(scanner, "x"), y = next_number(scanner, "y");
    tin.points.push_back({x, y});
    tin.heights.push_back(next_number(scanner, "z"));
  }
  for (std::size_t f = 0; f < faces; ++f) {
    if (f % kProgressStep == 0) progress.advance(scanner.fraction());
    if (next_count(scanner, "number of corners") != 3) {
      scanner.fail(ErrorCode::WrongGeometry, "the face is no triangle; triangulate the mesh first");
    }
    Triangle triangle;
    for (VertexId& v : triangle) {
      v = VertexId{next_count(scanner, "vertex number")};
      if (v.index() < vertices) continue;
      scanner.fail(ErrorCode::BadFormat, "the face names vertex " + std::to_string(v.index()) +
                                             ", but there are only " + std::to_string(vertices));
    }
    tin.triangles.push_back(triangle);
    scanner.next_line();  // colours may follow
  }
  return tin;
}

TinFile read_stl(const std::string& path, Progress& progress) {
  return StlReader(path, progress).read();
}

}  // namespace thalweg
