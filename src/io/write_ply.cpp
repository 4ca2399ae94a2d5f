// PLY, binary little-endian, as QGIS (MDAL) reads it: elements vertex, face and edge only, the face list is
// called vertex_indices, and the CRS is the comment "crs: ..." that MDAL hands on as an authority code or as
// WKT.
#include "io/file_writer.hpp"
#include "io/tin_format.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace thalweg {

namespace {

constexpr std::size_t kProgressStep = 1U << 14U;

std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return text;
}

void write_header(FileWriter& file, const TinView& view, std::size_t edge_count) {
  file.text("ply\nformat binary_little_endian 1.0\n");
  const std::string crs = view.crs_authority.empty() ? one_line(view.crs_wkt) : view.crs_authority;
  if (!crs.empty()) file.text("comment crs: " + crs + "\n");
  file.text("element vertex " + std::to_string(view.tin.vertex_count()) +
            "\nproperty double x\nproperty double y\nproperty double z\n");
  file.text("element face " + std::to_string(view.tin.triangle_count()) +
            "\nproperty list uchar int vertex_indices\n");
  if (!view.triangle_orders.empty()) file.text("property int order\n");
  if (edge_count > 0) {
    file.text("element edge " + std::to_string(edge_count) +
              "\nproperty int vertex1\nproperty int vertex2\nproperty uchar kind\n");
  }
  file.text("end_header\n");
}

std::int32_t ply_index(VertexId v) {
  return static_cast<std::int32_t>(v.value());
}

}  // namespace

void write_ply(const TinWriteJob& job) {
  const Tin& tin = job.view.tin;
  const std::vector<ConstraintEdge> edges =
      job.options.enabled("EDGES") ? tin.constraint_edges() : std::vector<ConstraintEdge>{};
  const double total = static_cast<double>(tin.vertex_count() + tin.triangle_count() + 1);
  FileWriter file(job.path, job.target);
  write_header(file, job.view, edges.size());
  for (std::size_t v = 0; v < tin.vertex_count(); ++v) {
    if (v % kProgressStep == 0) job.progress.advance(static_cast<double>(v) / total);
    file.little_endian(job.xy()[v].x);
    file.little_endian(job.xy()[v].y);
    file.little_endian(tin.heights()[v]);
  }
  for (std::size_t t = 0; t < tin.triangle_count(); ++t) {
    if (t % kProgressStep == 0) job.progress.advance(static_cast<double>(tin.vertex_count() + t) / total);
    file.little_endian(std::uint8_t{3});
    for (const VertexId v : tin.triangles()[t]) file.little_endian(ply_index(v));
    if (!job.view.triangle_orders.empty()) file.little_endian(std::int32_t{job.view.triangle_orders[t]});
  }
  for (const ConstraintEdge& edge : edges) {
    file.little_endian(ply_index(edge.a));
    file.little_endian(ply_index(edge.b));
    file.little_endian(static_cast<std::uint8_t>(edge.kind));
  }
  file.close();
}

}  // namespace thalweg
