// The text formats 2DM and OBJ.
//
// Numbers are the shortest text that reads back as the same double. 2DM (SMS; QGIS by MDAL): node ids ascend
// from 1; constraint edges are node strings, ten nodes a line, the last one negative, then the string's id
// and its kind. OBJ: z is up, constraint edges are line elements; an element in two groups ("g ridge
// boundary") is both.
#include "io/edge_chains.hpp"
#include "io/file_writer.hpp"
#include "io/tin_format.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace thalweg {

namespace {

constexpr std::size_t kProgressStep = 1U << 14U;

std::vector<EdgeChain> chains_to_write(const TinWriteJob& job) {
  if (!job.options.enabled("EDGES")) return {};
  const std::vector<ConstraintEdge> edges = job.view.tin.constraint_edges();
  return chain_edges(edges);
}

void write_position(FileWriter& file, const TinWriteJob& job, std::size_t v) {
  file.number(job.xy()[v].x);
  file.character(' ');
  file.number(job.xy()[v].y);
  file.character(' ');
  file.number(job.view.tin.heights()[v]);
}

void write_corners(FileWriter& file, const Triangle& triangle) {
  for (const VertexId v : triangle) {
    file.character(' ');
    file.number(v.value() + 1);
  }
}

// Calls `write` for 0 .. count - 1 and reports the phase's progress from `start` on.
template <class Write>
void write_each(const TinWriteJob& job, std::size_t start, std::size_t count, const Write& write) {
  const double total = static_cast<double>(job.view.tin.vertex_count() + job.view.tin.triangle_count() + 1);
  for (std::size_t i = 0; i < count; ++i) {
    if (i % kProgressStep == 0) job.progress.advance(static_cast<double>(start + i) / total);
    write(i);
  }
}

void write_node_string(FileWriter& file, const EdgeChain& chain, std::size_t id) {
  constexpr std::size_t kNodesALine = 10;
  const std::size_t last = chain.vertices.size() - 1;
  for (std::size_t i = 0; i <= last; ++i) {
    if (i % kNodesALine == 0) file.text(i == 0 ? "NS" : "\nNS");
    file.text(i == last ? " -" : " ");
    file.number(chain.vertices[i].value() + 1);
  }
  file.character(' ');
  file.number(id);
  file.text(" " + kind_words(chain.kind) + "\n");
}

}  // namespace

void write_2dm(const TinWriteJob& job) {
  const Tin& tin = job.view.tin;
  FileWriter file(job.path, job.target);
  file.text("MESH2D\nNUM_MATERIALS_PER_ELEM 1\n");
  write_each(job, 0, tin.triangle_count(), [&](std::size_t t) {
    file.text("E3T ");
    file.number(t + 1);
    write_corners(file, tin.triangles()[t]);
    file.text(" 1\n");
  });
  write_each(job, tin.triangle_count(), tin.vertex_count(), [&](std::size_t v) {
    file.text("ND ");
    file.number(v + 1);
    file.character(' ');
    write_position(file, job, v);
    file.character('\n');
  });
  std::size_t id = 0;
  for (const EdgeChain& chain : chains_to_write(job)) write_node_string(file, chain, ++id);
  file.close();
}

void write_obj(const TinWriteJob& job) {
  const Tin& tin = job.view.tin;
  FileWriter file(job.path, job.target);
  write_each(job, 0, tin.vertex_count(), [&](std::size_t v) {
    file.text("v ");
    write_position(file, job, v);
    file.character('\n');
  });
  file.text("g surface\n");
  write_each(job, tin.vertex_count(), tin.triangle_count(), [&](std::size_t t) {
    file.character('f');
    write_corners(file, tin.triangles()[t]);
    file.character('\n');
  });
  EdgeKind kind = EdgeKind::None;
  for (const EdgeChain& chain : chains_to_write(job)) {
    if (chain.kind != kind) {
      kind = chain.kind;
      std::string groups = kind_words(kind);
      std::replace(groups.begin(), groups.end(), '+', ' ');
      file.text("g " + groups + "\n");
    }
    file.character('l');
    for (const VertexId v : chain.vertices) {
      file.character(' ');
      file.number(v.value() + 1);
    }
    file.character('\n');
  }
  file.close();
}

}  // namespace thalweg
