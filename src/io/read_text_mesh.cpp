// The text formats 2DM and OBJ, line by line.
//
// Node ids of 2DM are any ascending positive numbers, elements may stand before the nodes: ids are turned
// into indices at the end. OBJ counts vertices from 1, or backwards from the last one read (-1). Constraint
// edges are the node strings or line elements, of the kind that their name is, as `write_tin` writes them.
// Those with other names are breaklines where they run along edges; elsewhere they are drawings of their own,
// and counted.
#include "io/edge_chains.hpp"
#include "io/file_content.hpp"
#include "io/line_matcher.hpp"
#include "io/tin_format.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace thalweg {

namespace {

constexpr std::size_t kProgressStep = 1U << 12U;

class MeshScanner {
 public:
  MeshScanner(std::string_view text, const std::string& file, Progress& progress)
      : scanner_(text, file), file_(file), progress_(progress) {}

 protected:
  // Calls `read_line` with the first word of every line that has one.
  template <class ReadLine>
  void for_each_line(const ReadLine& read_line) {
    std::size_t line = 0;
    do {
      if (line++ % kProgressStep == 0) progress_.advance(scanner_.fraction());
      const std::string_view word = scanner_.word();
      if (!word.empty()) read_line(word);
    } while (scanner_.next_line());
  }

  void read_position() {
    const double x = scanner_.number("x");
    const double y = scanner_.number("y");
    tin_.points.push_back({x, y});
    tin_.heights.push_back(scanner_.number("z"));
  }

  void add_line(const std::vector<VertexId>& vertices, EdgeKind kind) {
    for (std::size_t i = 0; i + 1 < vertices.size(); ++i) {
      tin_.constraints.push_back({vertices[i], vertices[i + 1], kind});
    }
  }

  /// Constraints without a kind become breaklines as far as they run along edges. Pre: ids are indices.
  void settle_foreign_lines() {
    const auto is_foreign = [](const ConstraintEdge& edge) { return edge.kind == EdgeKind::None; };
    if (std::ranges::none_of(tin_.constraints, is_foreign)) return;
    LineMatcher matcher(tin_.points, tin_.triangles);
    for (const ConstraintEdge& edge : tin_.constraints) {
      if (is_foreign(edge)) matcher.add(edge.a, edge.b, EdgeKind::Breakline);
    }
    std::erase_if(tin_.constraints, is_foreign);
    matcher.deliver(tin_, file_);
  }

  TextScanner scanner_;
  const std::string& file_;
  Progress& progress_;
  TinFile tin_;
};

class Reader2dm : MeshScanner {
 public:
  using MeshScanner::MeshScanner;

  TinFile read() {
    for_each_line([&](std::string_view card) { read_card(card); });
    if (!string_.empty()) scanner_.fail(ErrorCode::BadFormat, "the last node string (NS) has no end");
    resolve_ids();
    settle_foreign_lines();
    return std::move(tin_);
  }

 private:
  void read_card(std::string_view card) {
    constexpr std::array<std::string_view, 4> kOtherFaces = {"E4Q", "E6T", "E8Q", "E9Q"};
    if (!string_.empty() && card != "NS")
      scanner_.fail(ErrorCode::BadFormat, "the node string (NS) before has no end");
    if (card == "ND") {
      read_node();
    } else if (card == "E3T") {
      scanner_.integer("the element's id");
      Triangle triangle;
      for (VertexId& v : triangle) v = node_id(scanner_.integer("a node's id"));
      tin_.triangles.push_back(triangle);
    } else if (card == "NS") {
      read_node_string();
    } else if (std::find(kOtherFaces.begin(), kOtherFaces.end(), card) != kOtherFaces.end()) {
      scanner_.fail(ErrorCode::WrongGeometry,
                    "the element " + std::string(card) +
                        " is no triangle of three nodes (E3T): triangulate the mesh first");
    }
  }

  VertexId node_id(std::int64_t id) const {
    if (id > 0 && id < Id<void>::kInvalid) return VertexId{static_cast<std::size_t>(id)};
    scanner_.fail(ErrorCode::BadFormat, "a node's id is " + std::to_string(id) + "; ids are positive");
  }

  void read_node() {
    const VertexId id = node_id(scanner_.integer("the node's id"));
    if (!ids_.empty() && id <= ids_.back()) {
      scanner_.fail(ErrorCode::BadFormat, "node " + std::to_string(id.value()) + " follows node " +
                                              std::to_string(ids_.back().value()) + "; ids have to ascend");
    }
    ids_.push_back(id);
    read_position();
  }

  void read_node_string() {
    constexpr std::int64_t kLeast = -std::int64_t{Id<void>::kInvalid};
    while (true) {
      if (scanner_.line_ended()) return;
      const std::int64_t id = scanner_.integer("a node's id");
      string_.push_back(node_id(id < 0 ? -std::max(id, kLeast) : id));
      if (id < 0) break;
    }
    std::string_view name;
    for (std::string_view word = scanner_.word(); !word.empty(); word = scanner_.word()) name = word;
    add_line(string_, parse_kind_words(name).value_or(EdgeKind::None));
    string_.clear();
  }

  void resolve(VertexId& v, const char* what, std::size_t row) const {
    const std::size_t guess = v.index() - 1;
    if (guess < ids_.size() && ids_[guess] == v) {
      v = VertexId{guess};
      return;
    }
    const auto found = std::lower_bound(ids_.begin(), ids_.end(), v);
    if (found == ids_.end() || *found != v) {
      throw Error(ErrorCode::BadFormat, file_ + ": " + what + " number " + std::to_string(row + 1) +
                                            " names node " + std::to_string(v.value()) +
                                            ", which the file does not have");
    }
    v = VertexId{static_cast<std::size_t>(found - ids_.begin())};
  }

  void resolve_ids() {
    for (std::size_t t = 0; t < tin_.triangles.size(); ++t) {
      for (VertexId& v : tin_.triangles[t]) resolve(v, "triangle", t);
    }
    for (std::size_t e = 0; e < tin_.constraints.size(); ++e) {
      resolve(tin_.constraints[e].a, "edge of a node string", e);
      resolve(tin_.constraints[e].b, "edge of a node string", e);
    }
  }

  std::vector<VertexId> ids_;     // of the nodes, ascending
  std::vector<VertexId> string_;  // the node string that is being read
};

class ObjReader : MeshScanner {
 public:
  using MeshScanner::MeshScanner;

  TinFile read() {
    for_each_line([&](std::string_view keyword) { read_statement(keyword); });
    check_ids();
    settle_foreign_lines();
    return std::move(tin_);
  }

 private:
  void read_statement(std::string_view keyword) {
    constexpr std::array<std::string_view, 13> kIgnored = {
        "vn", "vt", "vp", "o", "s", "p", "usemtl", "mtllib", "usemap", "mg", "lod", "bevel", "shadow_obj"};
    if (keyword == "v")
      read_position();
    else if (keyword == "f")
      read_face();
    else if (keyword == "l")
      read_line();
    else if (keyword == "g")
      read_group();
    else if (keyword.front() != '#' &&
             std::find(kIgnored.begin(), kIgnored.end(), keyword) == kIgnored.end()) {
      scanner_.fail(ErrorCode::BadFormat,
                    "'" + std::string(keyword.substr(0, 40)) + "' is no statement of a polygonal OBJ");
    }
  }

  // "7", "7/1", "7/1/3", "7//3", "-1"
  VertexId corner(std::string_view word) const {
    const std::string_view number = word.substr(0, word.find('/'));
    const std::int64_t value = parse_integer(number).value_or(0);
    constexpr std::int64_t kMost = Id<void>::kInvalid;
    if (value > 0 && value <= kMost) return VertexId{static_cast<std::size_t>(value - 1)};
    const auto count = static_cast<std::int64_t>(tin_.points.size());
    if (value < 0 && value >= -count) return VertexId{static_cast<std::size_t>(count + value)};
    scanner_.fail(ErrorCode::BadFormat, "'" + std::string(word.substr(0, 40)) + "' is no vertex number");
  }

  void read_face() {
    Triangle triangle;
    std::size_t corners = 0;
    for (std::string_view word = scanner_.word(); !word.empty(); word = scanner_.word()) {
      if (corners < 3) triangle[corners] = corner(word);
      ++corners;
    }
    if (corners != 3) {
      scanner_.fail(ErrorCode::WrongGeometry,
                    "the face has " + std::to_string(corners) +
                        " corners; a TIN has triangles only: triangulate the mesh first");
    }
    tin_.triangles.push_back(triangle);
  }

  void read_group() {
    group_ = EdgeKind::None;
    for (std::string_view word = scanner_.word(); !word.empty(); word = scanner_.word()) {
      group_ = group_ | parse_kind_words(word).value_or(EdgeKind::None);
    }
  }

  void read_line() {
    std::vector<VertexId> line;
    for (std::string_view word = scanner_.word(); !word.empty(); word = scanner_.word())
      line.push_back(corner(word));
    add_line(line, group_);
  }

  void check_ids() const {
    const auto check = [&](VertexId v, const char* what, std::size_t row) {
      if (v.index() < tin_.points.size()) return;
      throw Error(ErrorCode::BadFormat, file_ + ": " + what + " number " + std::to_string(row + 1) +
                                            " names vertex " + std::to_string(v.index() + 1) +
                                            ", but there are only " + std::to_string(tin_.points.size()));
    };
    for (std::size_t t = 0; t < tin_.triangles.size(); ++t) {
      for (const VertexId v : tin_.triangles[t]) check(v, "face", t);
    }
    for (std::size_t e = 0; e < tin_.constraints.size(); ++e) {
      check(tin_.constraints[e].a, "edge of a line", e);
      check(tin_.constraints[e].b, "edge of a line", e);
    }
  }

  EdgeKind group_ = EdgeKind::None;
};

}  // namespace

TinFile read_2dm(const std::string& path, Progress& progress) {
  const FileContent content(path);
  return Reader2dm(content.bytes(), path, progress).read();
}

TinFile read_obj(const std::string& path, Progress& progress) {
  const FileContent content(path);
  return ObjReader(content.bytes(), path, progress).read();
}

}  // namespace thalweg
