// Meshes in binary: STL and glTF in single precision, VTU in double.
//
// STL and glTF hold positions as floats, 0.25 m apart at a northing of 4e6. What is written are differences
// to the job's local origin, which the sidecar (and the extras of glTF) tell. glTF is right-handed with y up:
// east, height, south. VTU is the XML form of a VTK grid with its arrays appended as raw bytes; constraint
// edges are line cells, told apart from triangles by their type, with their kind as cell data.
#include "io/file_writer.hpp"
#include "io/write_steps.hpp"

#include <thalweg/base/error.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace thalweg {

namespace {

using Vector = std::array<double, 3>;
using SingleVector = std::array<float, 3>;

Vector local_position(const TinWriteJob& job, VertexId v) {
  const Point2 p = job.xy()[v.index()];
  return {p.x - job.origin.x, p.y - job.origin.y, job.view.tin.height(v) - job.origin.z};
}

SingleVector single(const Vector& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

SingleVector unit_normal(const Vector& a, const Vector& b, const Vector& c) {
  const Vector u = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  const Vector w = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
  const Vector n = {u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]};
  const double length = std::hypot(n[0], n[1], n[2]);
  if (!(length > 0)) return {0, 0, 0};
  return single({n[0] / length, n[1] / length, n[2] / length});
}

void write_vector(FileWriter& file, const SingleVector& v) {
  for (const float value : v) file.little_endian(value);
}

void check_32_bits(double bytes, const TinWriteJob& job, const char* what) {
  if (bytes < std::numeric_limits<std::uint32_t>::max()) return;
  throw Error(ErrorCode::SizeLimit,
              job.target + ": " + what + " holds less than 4 GiB; write another format");
}

SingleVector gltf_position(const TinWriteJob& job, std::size_t v) {
  const Vector p = local_position(job, VertexId{v});
  return single({p[0], p[2], -p[1]});
}

// The description that goes before the bytes of a glTF.
std::string gltf_json(const TinWriteJob& job, std::size_t edge_count) {
  using Json = nlohmann::ordered_json;
  const Tin& tin = job.view.tin;
  SingleVector low, high;
  low.fill(std::numeric_limits<float>::infinity());
  high.fill(-std::numeric_limits<float>::infinity());
  for (std::size_t v = 0; v < tin.vertex_count(); ++v) {
    const SingleVector p = gltf_position(job, v);
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  }
  constexpr int kFloat = 5126, kUnsigned = 5125, kVertices = 34962, kIndices = 34963, kLines = 1,
                kTriangles = 4;
  const std::size_t vertex_bytes = 12 * tin.vertex_count(), triangle_bytes = 12 * tin.triangle_count();
  Json views = {
      {{"buffer", 0}, {"byteOffset", 0}, {"byteLength", vertex_bytes}, {"target", kVertices}},
      {{"buffer", 0}, {"byteOffset", vertex_bytes}, {"byteLength", triangle_bytes}, {"target", kIndices}}};
  Json accessors = {{{"bufferView", 0},
                     {"componentType", kFloat},
                     {"count", tin.vertex_count()},
                     {"type", "VEC3"},
                     {"min", low},
                     {"max", high}},
                    {{"bufferView", 1},
                     {"componentType", kUnsigned},
                     {"count", 3 * tin.triangle_count()},
                     {"type", "SCALAR"}}};
  Json surface = {{"attributes", {{"POSITION", 0}}}, {"indices", 1}, {"mode", kTriangles}, {"material", 0}};
  Json primitives = Json::array({surface});
  if (edge_count > 0) {
    views.push_back({{"buffer", 0},
                     {"byteOffset", vertex_bytes + triangle_bytes},
                     {"byteLength", 8 * edge_count},
                     {"target", kIndices}});
    accessors.push_back(
        {{"bufferView", 2}, {"componentType", kUnsigned}, {"count", 2 * edge_count}, {"type", "SCALAR"}});
    primitives.push_back(
        {{"attributes", {{"POSITION", 0}}}, {"indices", 2}, {"mode", kLines}, {"material", 0}});
  }
  const std::string& crs = job.view.crs_authority.empty() ? job.view.crs_wkt : job.view.crs_authority;
  const Json json = {
      {"asset", {{"version", "2.0"}, {"generator", "Thalweg"}}},
      {"extras", {{"origin", {job.origin.x, job.origin.y, job.origin.z}}, {"crs", crs}}},
      {"scene", 0},
      {"scenes", Json::array({{{"nodes", {0}}}})},
      {"nodes", Json::array({{{"mesh", 0}, {"name", "surface"}}})},
      {"meshes", Json::array({{{"primitives", primitives}}})},
      {"materials",
       Json::array({{{"doubleSided", true},
                     {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 1}}}}})},
      {"accessors", accessors},
      {"bufferViews", views},
      {"buffers", Json::array({{{"byteLength", vertex_bytes + triangle_bytes + 8 * edge_count}}})}};
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  while (text.size() % 4 != 0) text += ' ';
  return text;
}

// One array of a VTU: its description now, its bytes appended later.
struct VtuArray {
  const char* type;
  const char* name;
  std::size_t components;
  std::uint64_t bytes;
};

class VtuHeader {
 public:
  explicit VtuHeader(FileWriter& file) : file_(file) {}
  void array(const VtuArray& array) {
    file_.text(std::string("        <DataArray type=\"") + array.type + "\" Name=\"" + array.name +
               "\" NumberOfComponents=\"" + std::to_string(array.components) +
               "\" format=\"appended\" offset=\"" + std::to_string(offset_) + "\"/>\n");
    offset_ += sizeof(std::uint64_t) + array.bytes;
  }

 private:
  FileWriter& file_;
  std::uint64_t offset_ = 0;
};

// The arrays that go before the points.
void write_attributes(FileWriter& file, const TinWriteJob& job, std::span<const ConstraintEdge> edges) {
  const Tin& tin = job.view.tin;
  const std::uint64_t triangles = tin.triangle_count(), cells = triangles + edges.size();
  file.little_endian(std::uint64_t{8 * tin.vertex_count()});
  for (const double z : tin.heights()) file.little_endian(z);
  file.little_endian(cells);
  for (std::size_t t = 0; t < triangles; ++t) file.little_endian(std::uint8_t{0});
  for (const ConstraintEdge& edge : edges) file.little_endian(static_cast<std::uint8_t>(edge.kind));
  if (!job.view.triangle_orders.empty()) {
    file.little_endian(std::uint64_t{4 * cells});
    for (const std::uint16_t value : job.view.triangle_orders) file.little_endian(std::int32_t{value});
    for (std::size_t e = 0; e < edges.size(); ++e) file.little_endian(std::int32_t{0});
  }
}

}  // namespace

void write_stl(const TinWriteJob& job) {
  const Tin& tin = job.view.tin;
  FileWriter file(job.path, job.target);
  std::string title = "Thalweg TIN";  // must not begin with "solid", which is the other form of STL
  constexpr std::size_t kTitle = 80;
  title.resize(kTitle, ' ');
  file.text(title);
  check_32_bits(static_cast<double>(tin.triangle_count()), job, "an STL");
  file.little_endian(static_cast<std::uint32_t>(tin.triangle_count()));
  write_each(job, tin.vertex_count(), tin.triangle_count(), [&](std::size_t t) {
    std::array<Vector, 3> corners{};
    for (std::size_t i = 0; i < 3; ++i) corners[i] = local_position(job, tin.triangles()[t][i]);
    write_vector(file, unit_normal(corners[0], corners[1], corners[2]));
    for (const Vector& corner : corners) write_vector(file, single(corner));
    file.little_endian(std::uint16_t{0});
  });
  file.close();
}

void write_glb(const TinWriteJob& job) {
  const Tin& tin = job.view.tin;
  const std::vector<ConstraintEdge> edges = edges_to_write(job);
  const std::string json = gltf_json(job, edges.size());
  const std::size_t bytes = 12 * tin.vertex_count() + 12 * tin.triangle_count() + 8 * edges.size();
  constexpr std::size_t kHeader = 12, kChunkHeader = 8;
  const std::size_t total = kHeader + kChunkHeader + json.size() + kChunkHeader + bytes;
  check_32_bits(static_cast<double>(total), job, "a glTF binary");
  constexpr std::uint32_t kMagic = 0x46546C67, kVersion = 2, kJson = 0x4E4F534A, kBinary = 0x004E4942;
  FileWriter file(job.path, job.target);
  for (const std::size_t word :
       {std::size_t{kMagic}, std::size_t{kVersion}, total, json.size(), std::size_t{kJson}}) {
    file.little_endian(static_cast<std::uint32_t>(word));
  }
  file.text(json);
  file.little_endian(static_cast<std::uint32_t>(bytes));
  file.little_endian(kBinary);
  write_each(job, 0, tin.vertex_count(), [&](std::size_t v) { write_vector(file, gltf_position(job, v)); });
  write_each(job, tin.vertex_count(), tin.triangle_count(), [&](std::size_t t) {
    for (const VertexId v : tin.triangles()[t]) file.little_endian(v.value());
  });
  for (const ConstraintEdge& edge : edges) {
    file.little_endian(edge.a.value());
    file.little_endian(edge.b.value());
  }
  file.close();
}

void write_vtu(const TinWriteJob& job) {
  const Tin& tin = job.view.tin;
  const std::vector<ConstraintEdge> edges = edges_to_write(job);
  const std::uint64_t vertices = tin.vertex_count(), triangles = tin.triangle_count();
  const std::uint64_t cells = triangles + edges.size();
  const VtuArray elevation{"Float64", "elevation", 1, 8 * vertices}, kind{"UInt8", "kind", 1, cells},
      order{"Int32", "order", 1, 4 * cells}, points{"Float64", "Points", 3, 24 * vertices},
      connectivity{"Int64", "connectivity", 1, 8 * (3 * triangles + 2 * edges.size())},
      offsets{"Int64", "offsets", 1, 8 * cells}, types{"UInt8", "types", 1, cells};
  const bool has_orders = !job.view.triangle_orders.empty();

  FileWriter file(job.path, job.target);
  VtuHeader header(file);
  file.text(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
      "byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n  <UnstructuredGrid>\n    <Piece NumberOfPoints=\"" +
      std::to_string(vertices) + "\" NumberOfCells=\"" + std::to_string(cells) +
      "\">\n      <PointData Scalars=\"elevation\">\n");
  header.array(elevation);
  file.text("      </PointData>\n      <CellData>\n");
  header.array(kind);
  if (has_orders) header.array(order);
  file.text("      </CellData>\n      <Points>\n");
  header.array(points);
  file.text("      </Points>\n      <Cells>\n");
  header.array(connectivity);
  header.array(offsets);
  header.array(types);
  file.text("      </Cells>\n    </Piece>\n  </UnstructuredGrid>\n  <AppendedData encoding=\"raw\">\n_");

  write_attributes(file, job, edges);
  file.little_endian(points.bytes);
  write_each(job, 0, vertices, [&](std::size_t v) {
    file.little_endian(job.xy()[v].x);
    file.little_endian(job.xy()[v].y);
    file.little_endian(tin.heights()[v]);
  });
  file.little_endian(connectivity.bytes);
  write_each(job, vertices, triangles, [&](std::size_t t) {
    for (const VertexId v : tin.triangles()[t]) file.little_endian(std::int64_t{v.value()});
  });
  for (const ConstraintEdge& edge : edges) {
    file.little_endian(std::int64_t{edge.a.value()});
    file.little_endian(std::int64_t{edge.b.value()});
  }
  file.little_endian(offsets.bytes);
  std::int64_t offset = 0;
  for (std::size_t t = 0; t < triangles; ++t) file.little_endian(offset += 3);
  for (std::size_t e = 0; e < edges.size(); ++e) file.little_endian(offset += 2);
  file.little_endian(types.bytes);
  constexpr std::uint8_t kLineCell = 3, kTriangleCell = 5;
  for (std::size_t t = 0; t < triangles; ++t) file.little_endian(kTriangleCell);
  for (std::size_t e = 0; e < edges.size(); ++e) file.little_endian(kLineCell);
  file.text("\n  </AppendedData>\n</VTKFile>\n");
  file.close();
}

}  // namespace thalweg
