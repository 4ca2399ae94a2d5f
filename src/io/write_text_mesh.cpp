// The text formats 2DM, OBJ and OFF.
//
// Numbers are the shortest text that reads back as the same double. 2DM (SMS; QGIS by MDAL): node ids ascend
// from 1; constraint edges are node strings, ten nodes a line, the last one negative, then the string's id
// and its kind. OBJ: z is up, constraint edges are line elements; an element in two groups ("g ridge
// boundary") is both. OFF holds vertices and triangles, nothing else.
#include "io/file_writer.hpp"
#include "io/write_steps.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace thalweg {

namespace {

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

void write_off(const TinWriteJob& job) {
  const Tin& tin = job.view.tin;
  FileWriter file(job.path, job.target);
  file.text("OFF\n" + std::to_string(tin.vertex_count()) + " " + std::to_string(tin.triangle_count()) +
            " 0\n");
  write_each(job, 0, tin.vertex_count(), [&](std::size_t v) {
    write_position(file, job, v);
    file.character('\n');
  });
  write_each(job, tin.vertex_count(), tin.triangle_count(), [&](std::size_t t) {
    file.character('3');
    for (const VertexId v : tin.triangles()[t]) {
      file.character(' ');
      file.number(v.value());
    }
    file.character('\n');
  });
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
