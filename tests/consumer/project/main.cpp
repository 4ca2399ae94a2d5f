// Uses the installed headers and library: builds a TIN of two triangles, checks it, and tries one that breaks
// a law.
#include <thalweg/base/error.hpp>
#include <thalweg/mesh/tin.hpp>
#include <thalweg/mesh/validate.hpp>

#include <array>
#include <cstdio>

int main() {
  using thalweg::VertexId;
  const std::array valley = {thalweg::ConstraintEdge{VertexId{0}, VertexId{2}, thalweg::EdgeKind::Valley}};
  const thalweg::Tin tin({{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {1, 5, 2, 5},
                         {{VertexId{0}, VertexId{1}, VertexId{2}}, {VertexId{0}, VertexId{2}, VertexId{3}}},
                         valley);
  std::printf("%zu vertices, %zu triangles, %zu edges\n", tin.vertex_count(), tin.triangle_count(),
              tin.edge_count());
  try {
    const thalweg::Tin broken({{0, 0}}, {1}, {{VertexId{0}, VertexId{0}, VertexId{1}}}, {});
    return 1;
  } catch (const thalweg::Error& error) {
    if (error.code() != thalweg::ErrorCode::InvalidTin) return 1;
  }
  return tin.edge_count() == 5 && thalweg::validate(tin).empty() ? 0 : 1;
}
