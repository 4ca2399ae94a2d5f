// An R-tree, packed.
//
// 1. GDAL makes the index while the layer is empty, with all that goes with it. Its trigger for new features
//    is taken away, and put back at the end.
// 2. Features are sorted into columns of about the square root of all nodes each, and within a column from
//    south to north, by the centres of their boxes; then they fill nodes one after the other, about as many
//    each. Nodes fill those of the level above in the same way, up to one, the root.
//    Based on: Leutenegger, Lopez, Edgington, STR: a simple and efficient algorithm for R-tree packing, 1997.
// 3. Nodes go into the tables in which SQLite's module keeps them (The SQLite R*Tree Module, section 5):
//    _node (number, content), _parent (of nodes), _rowid (of features). A node: depth of the tree (in the
//    root), number of entries, entries of id and bounds, all big-endian. The root has number 1.
#include "io/spatial_index.hpp"

#include "io/gdal_session.hpp"

#include <fmt/format.h>
#include <ogrsf_frmts.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <span>
#include <utility>

namespace thalweg {

namespace {

constexpr std::size_t kHeader = 4, kEntry = 24;
constexpr std::size_t kStatement = 1U << 16U;  // characters, about

float at_most(double value) {
  const auto rounded = static_cast<float>(value);
  return rounded > value ? std::nextafter(rounded, -std::numeric_limits<float>::infinity()) : rounded;
}

/// Columns from west to east, each from south to north.
template <class Entry>
void sort_into_tiles(std::vector<Entry>& entries, std::size_t nodes) {
  const auto by_centre = [](std::size_t axis) {
    return [axis](const Entry& a, const Entry& b) {
      const double at_a = double{a.bounds[axis]} + a.bounds[axis + 1];
      const double at_b = double{b.bounds[axis]} + b.bounds[axis + 1];
      return at_a != at_b ? at_a < at_b : a.id < b.id;
    };
  };
  tbb::parallel_sort(entries.begin(), entries.end(), by_centre(0));
  const auto columns = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(nodes))));
  tbb::parallel_for(std::size_t{0}, columns, [&](std::size_t column) {
    const auto limit = [&](std::size_t i) {
      return entries.begin() + static_cast<std::ptrdiff_t>(entries.size() * i / columns);
    };
    std::sort(limit(column), limit(column + 1), by_centre(2));
  });
}

template <class Word>
void append_hex(std::string& text, Word word) {
  fmt::format_to(std::back_inserter(text), "{:0{}x}", word, 2 * sizeof(Word));
}

}  // namespace

SpatialIndex::SpatialIndex(GDALDataset& dataset, const std::string& layer, std::string target)
    : dataset_(dataset), target_(std::move(target)) {
  name_ = fmt::format("rtree_{}_{}", layer, dataset.GetLayerByName(layer.c_str())->GetGeometryColumn());
  // Asking makes GDAL create what it has put off.
  trigger_ = ask("SELECT sql FROM sqlite_master WHERE type = 'trigger' AND name = '" + name_ + "_insert'");
  node_size_ = std::stoul(ask("SELECT length(data) FROM \"" + name_ + "_node\" WHERE nodeno = 1"));
  execute("DROP TRIGGER \"" + name_ + "_insert\"");
}

void SpatialIndex::add(const Box2& box) {
  entries_.push_back({static_cast<std::int64_t>(entries_.size()) + 1,
                      {at_most(box.x_min), -at_most(-box.x_max), at_most(box.y_min), -at_most(-box.y_max)}});
}

void SpatialIndex::finish(const Progress& progress) {
  std::vector<Entry> level = std::move(entries_);
  std::int64_t next_id = 2;
  for (unsigned depth = 0; !level.empty(); ++depth) {
    std::vector<Entry> above = write_level(level, next_id, depth, progress);
    if (above.size() == 1) break;
    next_id += static_cast<std::int64_t>(above.size());
    level = std::move(above);
  }
  execute(trigger_);
}

// Writes the nodes that hold the given entries; returns their own.
std::vector<SpatialIndex::Entry> SpatialIndex::write_level(std::vector<Entry>& entries, std::int64_t first_id,
                                                           unsigned depth, const Progress& progress) {
  const std::size_t most = (node_size_ - kHeader) / kEntry, count = entries.size();
  const std::size_t nodes = (count + most - 1) / most;
  sort_into_tiles(entries, nodes);
  std::vector<Entry> level;
  std::string statement;
  std::vector<std::pair<std::int64_t, std::int64_t>> node_of;
  node_of.reserve(count);
  for (std::size_t node = 0; node < nodes; ++node) {
    if (node % 256 == 0) progress.check();
    const std::size_t begin = count * node / nodes, end = count * (node + 1) / nodes;
    const std::int64_t id = nodes == 1 ? 1 : first_id + static_cast<std::int64_t>(node);
    Bounds whole = entries[begin].bounds;
    if (statement.empty()) statement = "INSERT OR REPLACE INTO \"" + name_ + "_node\" VALUES ";
    fmt::format_to(std::back_inserter(statement), "({},x'", id);
    append_hex(statement, static_cast<std::uint16_t>(nodes == 1 ? depth : 0));
    append_hex(statement, static_cast<std::uint16_t>(end - begin));
    for (const Entry& entry : std::span(entries).subspan(begin, end - begin)) {
      append_hex(statement, static_cast<std::uint64_t>(entry.id));
      for (const float bound : entry.bounds) append_hex(statement, std::bit_cast<std::uint32_t>(bound));
      for (const std::size_t axis : {0U, 2U}) {
        whole[axis] = std::min(whole[axis], entry.bounds[axis]);
        whole[axis + 1] = std::max(whole[axis + 1], entry.bounds[axis + 1]);
      }
      node_of.emplace_back(entry.id, id);
    }
    statement.append(2 * (node_size_ - kHeader - kEntry * (end - begin)), '0');
    statement += "'),";
    level.push_back({id, whole});
    if (statement.size() < kStatement && node + 1 < nodes) continue;
    statement.pop_back();
    execute(std::exchange(statement, {}));
  }
  write_nodes_of(std::move(node_of), depth == 0 ? "_rowid" : "_parent");
  return level;
}

// Says of features, or nodes, in which node they are.
void SpatialIndex::write_nodes_of(std::vector<std::pair<std::int64_t, std::int64_t>> node_of,
                                  const char* table) {
  tbb::parallel_sort(node_of.begin(), node_of.end());  // in this order they are appended
  std::string statement;
  for (std::size_t i = 0; i < node_of.size(); ++i) {
    if (statement.empty()) statement = "INSERT INTO \"" + name_ + table + "\" VALUES ";
    fmt::format_to(std::back_inserter(statement), "({},{}),", node_of[i].first, node_of[i].second);
    if (statement.size() < kStatement && i + 1 < node_of.size()) continue;
    statement.pop_back();
    execute(std::exchange(statement, {}));
  }
}

void SpatialIndex::fail(const GdalSession& session) const {
  session.fail_to_write(target_ + ": the spatial index could not be written",
                        "free some space or choose another place; no partial file is left");
}

void SpatialIndex::execute(const std::string& statement) {
  const GdalSession session;
  OGRLayer* const result = dataset_.ExecuteSQL(statement.c_str(), nullptr, nullptr);
  if (result != nullptr) dataset_.ReleaseResultSet(result);
  if (session.failed()) fail(session);
}

std::string SpatialIndex::ask(const std::string& query) {
  const GdalSession session;
  OGRLayer* const result = dataset_.ExecuteSQL(query.c_str(), nullptr, nullptr);
  const std::unique_ptr<OGRFeature> row(result != nullptr ? result->GetNextFeature() : nullptr);
  const std::string answer = row ? row->GetFieldAsString(0) : "";
  if (result != nullptr) dataset_.ReleaseResultSet(result);
  if (answer.empty()) fail(session);
  return answer;
}

}  // namespace thalweg
