// PLY: a header that declares elements with properties, then their records, as text or binary of either
// endianness.
//
// 1. Parse the header. A record has a least size, so a count that the rest of the file cannot hold is refused
//    before anything is allocated; the same for lists.
// 2. Read every element's records in turn; every number fits a double exactly. What is not known is skipped.
// 3. When all is read, check that faces and edges name vertices that exist (they may come first).
#include "io/file_content.hpp"
#include "io/tin_format.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

namespace thalweg {

namespace {

enum class Encoding : std::uint8_t { Text, Little, Big };
enum class Number : std::uint8_t { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };

struct Property {
  std::string name;
  Number type = Number::Float64;
  std::optional<Number> count_type;  // of a list
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  Encoding encoding = Encoding::Text;
  std::vector<Element> elements;
  std::string crs;
  std::size_t body = 0;
};

std::size_t size_of(Number type) {
  constexpr std::array<std::size_t, 8> kSizes = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

std::optional<Number> parse_type(std::string_view word) {
  constexpr std::array<std::array<std::string_view, 2>, 8> kNames = {{{"char", "int8"},
                                                                      {"uchar", "uint8"},
                                                                      {"short", "int16"},
                                                                      {"ushort", "uint16"},
                                                                      {"int", "int32"},
                                                                      {"uint", "uint32"},
                                                                      {"float", "float32"},
                                                                      {"double", "float64"}}};
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (word == kNames[i][0] || word == kNames[i][1]) return static_cast<Number>(i);
  }
  return std::nullopt;
}

class HeaderParser {
 public:
  HeaderParser(std::string_view text, const std::string& file) : scanner_(text, file) {}

  Header parse() {
    scanner_.word();
    bool has_format = false;
    while (scanner_.next_line()) {
      const std::string_view word = scanner_.word();
      if (word == "end_header") {
        if (!has_format) fail("the header has no line 'format'");
        scanner_.next_line();
        header_.body = scanner_.position();
        return std::move(header_);
      }
      if (word == "format")
        parse_format(), has_format = true;
      else if (word == "comment")
        parse_comment();
      else if (word == "element")
        parse_element();
      else if (word == "property")
        parse_property();
      else if (word != "obj_info" && !word.empty())
        fail("'" + std::string(word.substr(0, 40)) + "' is no header line");
    }
    fail("the header has no end (end_header)");
  }

 private:
  [[noreturn]] void fail(const std::string& message) { scanner_.fail(ErrorCode::BadFormat, message); }

  void parse_format() {
    const std::string_view name = scanner_.word();
    if (name == "ascii")
      header_.encoding = Encoding::Text;
    else if (name == "binary_little_endian")
      header_.encoding = Encoding::Little;
    else if (name == "binary_big_endian")
      header_.encoding = Encoding::Big;
    else
      fail("'" + std::string(name.substr(0, 40)) + "' is no PLY format");
  }

  void parse_comment() {
    const std::string_view comment = scanner_.rest_of_line();
    constexpr std::string_view kCrs = "crs:";
    if (comment.substr(0, kCrs.size()) != kCrs) return;
    header_.crs = comment.substr(std::min(comment.find_first_not_of(' ', kCrs.size()), comment.size()));
  }

  void parse_element() {
    Element element;
    element.name = scanner_.word();
    const std::int64_t count = scanner_.integer("the element's count");
    if (element.name.empty() || count < 0) fail("an element has a name and a count that is not negative");
    for (const Element& other : header_.elements) {
      if (other.name == element.name) fail("the element '" + element.name + "' is declared twice");
    }
    element.count = static_cast<std::uint64_t>(count);
    header_.elements.push_back(std::move(element));
  }

  void parse_property() {
    if (header_.elements.empty()) fail("a property stands before any element");
    Property property;
    std::string_view word = scanner_.word();
    if (word == "list") {
      property.count_type = parse_type(scanner_.word());
      if (!property.count_type || *property.count_type >= Number::Float32)
        fail("the type of a list's count is no integer type");
      word = scanner_.word();
    }
    const std::optional<Number> type = parse_type(word);
    if (!type) fail("'" + std::string(word.substr(0, 40)) + "' is no PLY type");
    property.type = *type;
    property.name = scanner_.word();
    header_.elements.back().properties.push_back(std::move(property));
  }

  TextScanner scanner_;
  Header header_;
};

// Reads the numbers of the body, in the file's encoding.
class Body {
 public:
  Body(std::string_view bytes, const Header& header, const std::string& file)
      : bytes_(bytes),
        encoding_(header.encoding),
        position_(header.body),
        scanner_(bytes, file),
        file_(file) {
    if (encoding_ == Encoding::Text) {
      while (scanner_.position() < header.body) scanner_.next_line();
    }
  }

  [[nodiscard]] Encoding encoding() const { return encoding_; }
  [[nodiscard]] std::size_t left() const { return bytes_.size() - position(); }
  [[nodiscard]] double fraction() const {
    return static_cast<double>(position()) / static_cast<double>(bytes_.size());
  }

  double number(Number type) { return encoding_ == Encoding::Text ? text_number() : binary_number(type); }

  [[noreturn]] void fail(ErrorCode code, const std::string& message) const {
    if (encoding_ == Encoding::Text) scanner_.fail(code, message);
    throw Error(code, file_ + " byte " + std::to_string(position_) + ": " + message);
  }

 private:
  [[nodiscard]] std::size_t position() const {
    return encoding_ == Encoding::Text ? scanner_.position() : position_;
  }

  double text_number() {
    const std::string_view word = scanner_.word_anywhere();
    const std::optional<double> value = parse_number(word);
    if (!value) {
      fail(ErrorCode::BadFormat, word.empty() ? "the file ends before all elements of its header"
                                              : "'" + std::string(word.substr(0, 40)) + "' is no number");
    }
    return *value;
  }

  template <class Value>
  double binary_value() {
    std::array<char, sizeof(Value)> raw;
    if (left() < raw.size()) fail(ErrorCode::BadFormat, "the file ends before all elements of its header");
    std::memcpy(raw.data(), bytes_.data() + position_, raw.size());
    position_ += raw.size();
    if ((encoding_ == Encoding::Little) != (std::endian::native == std::endian::little))
      std::reverse(raw.begin(), raw.end());
    Value value;
    std::memcpy(&value, raw.data(), sizeof(Value));
    return static_cast<double>(value);
  }

  double binary_number(Number type) {
    switch (type) {
      case Number::Int8:
        return binary_value<std::int8_t>();
      case Number::Uint8:
        return binary_value<std::uint8_t>();
      case Number::Int16:
        return binary_value<std::int16_t>();
      case Number::Uint16:
        return binary_value<std::uint16_t>();
      case Number::Int32:
        return binary_value<std::int32_t>();
      case Number::Uint32:
        return binary_value<std::uint32_t>();
      case Number::Float32:
        return binary_value<float>();
      case Number::Float64:
        return binary_value<double>();
    }
    return 0;
  }

  std::string_view bytes_;
  Encoding encoding_;
  std::size_t position_;
  TextScanner scanner_;
  const std::string& file_;
};

// What a property is to us; everything else is skipped.
enum class Role : std::uint8_t { None, X, Y, Z, Corners, Order, First, Second, Kind };

Role role_of(const Element& element, const Property& property) {
  const std::string& name = property.name;
  if (element.name == "vertex" && !property.count_type) {
    if (name == "x" || name == "X") return Role::X;
    if (name == "y" || name == "Y") return Role::Y;
    if (name == "z" || name == "Z") return Role::Z;
  }
  if (element.name == "face") {
    if (property.count_type && (name == "vertex_indices" || name == "vertex_index")) return Role::Corners;
    if (!property.count_type && name == "order") return Role::Order;
  }
  if (element.name == "edge" && !property.count_type) {
    if (name == "vertex1") return Role::First;
    if (name == "vertex2") return Role::Second;
    if (name == "kind") return Role::Kind;
  }
  return Role::None;
}

class PlyReader {
 public:
  PlyReader(std::string_view bytes, const std::string& file, Progress& progress)
      : header_(HeaderParser(bytes, file).parse()),
        body_(bytes, header_, file),
        file_(file),
        progress_(progress) {}

  TinFile read() {
    for (const Element& element : header_.elements) read_element(element);
    check_ids();
    tin_.crs = header_.crs;
    return std::move(tin_);
  }

 private:
  // One record, as far as it concerns us.
  struct Record {
    double x = 0, y = 0, z = 0, order = 0, first = 0, second = 0;
    double kind = static_cast<double>(EdgeKind::Breakline);
    Triangle corners;
  };

  void check_size(const Element& element) const {
    std::uint64_t least = 0;
    for (const Property& property : element.properties) {
      const std::size_t binary = size_of(property.count_type.value_or(property.type));
      least += body_.encoding() == Encoding::Text ? 1 : binary;
    }
    const std::uint64_t most = least == 0 ? 0 : body_.left() / least;
    if (element.count > most) {
      body_.fail(ErrorCode::BadFormat, "the header promises " + std::to_string(element.count) +
                                           " elements '" + element.name +
                                           "', but the file can hold no more than " + std::to_string(most) +
                                           "; it is cut off or damaged");
    }
    if (element.count >= Id<void>::kInvalid) {
      body_.fail(ErrorCode::SizeLimit, "more than 4294967294 elements '" + element.name + "'");
    }
  }

  static bool has_role(const Element& element, Role role) {
    return std::any_of(element.properties.begin(), element.properties.end(),
                       [&](const Property& property) { return role_of(element, property) == role; });
  }

  void require(const Element& element, Role role, const char* name) const {
    if (has_role(element, role)) return;
    throw Error(ErrorCode::BadFormat,
                file_ + ": the element '" + element.name + "' has no property '" + name + "'");
  }

  void prepare(const Element& element) {
    if (element.name == "vertex") {
      require(element, Role::X, "x");
      require(element, Role::Y, "y");
      require(element, Role::Z, "z");
      tin_.points.reserve(element.count);
      tin_.heights.reserve(element.count);
    } else if (element.name == "face") {
      require(element, Role::Corners, "vertex_indices");
      tin_.triangles.reserve(element.count);
      has_orders_ = has_role(element, Role::Order);
    } else if (element.name == "edge") {
      has_edges_ = has_role(element, Role::First) && has_role(element, Role::Second);
    }
  }

  void read_element(const Element& element) {
    constexpr std::uint64_t kProgressStep = 1U << 12U;
    check_size(element);
    prepare(element);
    std::vector<Role> roles;
    for (const Property& property : element.properties) roles.push_back(role_of(element, property));
    for (std::uint64_t i = 0; i < element.count; ++i) {
      if (i % kProgressStep == 0) progress_.advance(body_.fraction());
      Record record;
      for (std::size_t p = 0; p < roles.size(); ++p)
        read_property(element.properties[p], roles[p], i, record);
      keep(element, i, record);
    }
  }

  void read_property(const Property& property, Role role, std::uint64_t row, Record& record) {
    if (property.count_type) {
      read_list(property, role, row, record);
      return;
    }
    const double value = body_.number(property.type);
    switch (role) {
      case Role::X:
        record.x = value;
        break;
      case Role::Y:
        record.y = value;
        break;
      case Role::Z:
        record.z = value;
        break;
      case Role::Order:
        record.order = value;
        break;
      case Role::First:
        record.first = value;
        break;
      case Role::Second:
        record.second = value;
        break;
      case Role::Kind:
        record.kind = value;
        break;
      case Role::None:
      case Role::Corners:
        break;
    }
  }

  void read_list(const Property& property, Role role, std::uint64_t row, Record& record) {
    const double count = body_.number(*property.count_type);
    if (!(count >= 0) || count != std::floor(count) || count > static_cast<double>(body_.left())) {
      body_.fail(ErrorCode::BadFormat,
                 "element " + std::to_string(row) + " has a list of an impossible length");
    }
    if (role == Role::Corners && count != 3) {
      body_.fail(ErrorCode::WrongGeometry,
                 "face " + std::to_string(row) + " has " + std::to_string(static_cast<std::uint64_t>(count)) +
                     " corners; a TIN has triangles only: triangulate the mesh first");
    }
    for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(count); ++i) {
      const double value = body_.number(property.type);
      if (role == Role::Corners) record.corners[i] = to_id(value, "face", row);
    }
  }

  VertexId to_id(double value, const char* what, std::uint64_t row) const {
    if (value >= 0 && value < Id<void>::kInvalid && value == std::floor(value)) {
      return VertexId{static_cast<std::size_t>(value)};
    }
    body_.fail(ErrorCode::BadFormat, std::string(what) + " " + std::to_string(row) + " names vertex " +
                                         std::to_string(value) + ", which is no vertex number");
  }

  double to_count(double value, double most, const char* what, std::uint64_t row) const {
    if (value >= 0 && value <= most && value == std::floor(value)) return value;
    body_.fail(ErrorCode::BadFormat, std::string(what) + " " + std::to_string(row) + " is " +
                                         std::to_string(value) + "; it has to be an integer from 0 to " +
                                         std::to_string(std::lround(most)));
  }

  void keep(const Element& element, std::uint64_t row, const Record& record) {
    if (element.name == "vertex") {
      if (!std::isfinite(record.x) || !std::isfinite(record.y) || !std::isfinite(record.z)) {
        body_.fail(ErrorCode::BadCoordinate, "vertex " + std::to_string(row) + " is not finite");
      }
      tin_.points.push_back({record.x, record.y});
      tin_.heights.push_back(record.z);
    } else if (element.name == "face") {
      tin_.triangles.push_back(record.corners);
      if (!has_orders_) return;
      constexpr double kMost = std::numeric_limits<std::uint16_t>::max();
      tin_.triangle_orders.push_back(
          static_cast<std::uint16_t>(to_count(record.order, kMost, "the order of face", row)));
    } else if (element.name == "edge" && has_edges_) {
      constexpr double kAllKinds = 63;
      const auto kind = static_cast<EdgeKind>(to_count(record.kind, kAllKinds, "the kind of edge", row));
      if (!is_constraint(kind)) return;
      tin_.constraints.push_back({to_id(record.first, "edge", row), to_id(record.second, "edge", row), kind});
    }
  }

  void check_ids() const {
    const std::size_t count = tin_.points.size();
    const auto check = [&](VertexId v, const char* what, std::size_t row) {
      if (v.index() < count) return;
      throw Error(ErrorCode::BadFormat, file_ + ": " + what + " " + std::to_string(row) + " names vertex " +
                                            std::to_string(v.value()) + ", but there are only " +
                                            std::to_string(count));
    };
    for (std::size_t t = 0; t < tin_.triangles.size(); ++t) {
      for (const VertexId v : tin_.triangles[t]) check(v, "face", t);
    }
    for (std::size_t e = 0; e < tin_.constraints.size(); ++e) {
      check(tin_.constraints[e].a, "edge", e);
      check(tin_.constraints[e].b, "edge", e);
    }
  }

  Header header_;
  Body body_;
  const std::string& file_;
  Progress& progress_;
  TinFile tin_;
  bool has_orders_ = false;
  bool has_edges_ = false;
};

}  // namespace

TinFile read_ply(const std::string& path, Progress& progress) {
  const FileContent content(path);
  return PlyReader(content.bytes(), path, progress).read();
}

}  // namespace thalweg
