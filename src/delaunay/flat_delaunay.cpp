// Delaunay triangulation in strips, one a thread, and the seams between them.
//
// 1. Vertices fall into strips of about equal size by their x. Each strip is triangulated for itself
//    (incremental.cpp), in rounds: the last one holds 15 of 16 vertices, the one before 15 of 16 of the rest,
//    and so on, each in order of ids (Amenta, Choi, Rote, Incremental constructions con BRIO, 2003).
// 2. A cell of a strip is safe if the closed box of its disc (of a ghost: the closed half-plane) meets no
//    other strip's box of vertices, with room for rounding: then it belongs to the whole triangulation.
// 3. Let S be the vertices of unsafe cells. A cell of the whole triangulation that is no safe one has all its
//    vertices in S: if all cells around one of them were safe, these would be all cells of the whole
//    triangulation around it. Its circle is empty of S too, so it is a cell of the triangulation of S. The
//    sides between safe and unsafe cells are sides there as well. So: triangulate S, and from the far side of
//    each such side on flood the cells of S, across all sides but these: they are what is missing.
// 4. Unsafe cells lie along the seams: about the square root of all, for points spread evenly. If there are
//    many, as on one common circle, all vertices are triangulated in one strip; a sample tells so before.
#include "flat_delaunay.hpp"

#include "incremental.hpp"
#include "spatial_order.hpp"

#include <thalweg/base/assert.hpp>

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <unordered_map>

namespace thalweg::detail {

namespace {

// Fewer vertices are not worth a thread of their own.
constexpr std::size_t kLeastStrip = 1 << 15;
constexpr std::size_t kSamplesAStrip = 1 << 10;

struct Strip {
  std::vector<std::uint32_t> vertices;
  std::uint32_t first_cell = 0;
  Box2 box;
  [[nodiscard]] std::uint32_t end_cell() const {
    return first_cell + static_cast<std::uint32_t>(cell_count(vertices.size()));
  }
};

class Strips {
 public:
  Strips(const Positions& at, const Progress& progress)
      : at_(at), count_(at.infinity()), cells_(cell_count(count_)), progress_(progress) {}

  /// False if some strip has no triangle.
  bool triangulate(std::size_t strips);
  /// Whether few cells are unsafe. Pre: triangulated.
  bool are_apart() { return are_few(mark_unsafe()); }
  /// False if many are.
  bool join();
  [[nodiscard]] RawVector<Cell> take_cells() { return std::move(cells_); }

 private:
  void cut(std::size_t strips);
  [[nodiscard]] bool safe(const Cell& cell, std::size_t strip) const;
  std::vector<std::uint32_t> mark_unsafe();
  [[nodiscard]] bool are_few(std::span<const std::uint32_t> unsafe) const {
    return unsafe.size() <= count_ / 2;
  }
  void fill_seams(const RawVector<Cell>& seam, std::span<const std::uint32_t> vertices,
                  std::span<const std::uint32_t> unsafe);

  Positions at_;
  std::uint32_t count_;
  RawVector<Cell> cells_;
  std::vector<Strip> strips_;
  const Progress& progress_;
};

void Strips::cut(std::size_t strips) {
  std::vector<double> sample;
  const std::size_t step = std::max<std::size_t>(1, count_ / (strips * kSamplesAStrip));
  for (std::size_t v = 0; v < count_; v += step) sample.push_back(at_[static_cast<std::uint32_t>(v)].x);
  std::sort(sample.begin(), sample.end());
  std::vector<double> limit;
  for (std::size_t i = 1; i < strips; ++i) limit.push_back(sample[i * sample.size() / strips]);
  strips_.resize(strips);
  tbb::parallel_for(std::size_t{0}, strips, [&](std::size_t i) {
    Strip& strip = strips_[i];
    strip.vertices = in_rounds(count_, [&](std::uint32_t v) {
      const double x = at_[v].x;
      return (i == 0 || x >= limit[i - 1]) && (i + 1 == strips || x < limit[i]);
    });
    for (const std::uint32_t v : strip.vertices) strip.box.add(at_[v]);
  });
}

bool Strips::triangulate(std::size_t strips) {
  cut(strips);
  std::size_t next = 0;
  for (Strip& strip : strips_) {
    if (strip.vertices.size() < 3) return false;
    strip.first_cell = static_cast<std::uint32_t>(next);
    next += cell_count(strip.vertices.size());
  }
  std::atomic<bool> proper{true};
  tbb::parallel_for(std::size_t{0}, strips, [&](std::size_t i) {
    if (!insert_all(at_, strips_[i].vertices, cells_, strips_[i].first_cell, progress_)) proper = false;
  });
  return proper;
}

// Rounding errors of the centre and the radius are below a millionth of the radius for triangles that are not
// needles; needles are not safe.
bool Strips::safe(const Cell& cell, std::size_t strip) const {
  constexpr double kMargin = 1e-6;
  constexpr double kLeastHeight = 1e-4;  // of a triangle, over the square of its longest side
  const std::uint32_t infinity = at_.infinity();
  for (std::uint32_t i = 0; i < 3; ++i) {
    if (cell.vertex[i] != infinity) continue;
    const Point2 from = at_[cell.vertex[after(i)]];
    const Point2 to = at_[cell.vertex[before(i)]];
    for (std::size_t other = 0; other < strips_.size(); ++other) {
      if (other == strip) continue;
      const Box2& box = strips_[other].box;
      for (const Point2 corner : {Point2{box.x_min, box.y_min}, Point2{box.x_min, box.y_max},
                                  Point2{box.x_max, box.y_min}, Point2{box.x_max, box.y_max}}) {
        if (orientation(from, to, corner) >= 0) return false;
      }
    }
    return true;
  }
  const Point2 a = at_[cell.vertex[0]];
  const double bx = at_[cell.vertex[1]].x - a.x, by = at_[cell.vertex[1]].y - a.y;
  const double cx = at_[cell.vertex[2]].x - a.x, cy = at_[cell.vertex[2]].y - a.y;
  const double b_lift = bx * bx + by * by, c_lift = cx * cx + cy * cy;
  const double area = bx * cy - by * cx;
  if (!(area > kLeastHeight * std::max(b_lift, c_lift))) return false;
  const double x = (cy * b_lift - by * c_lift) / (2 * area);
  const double y = (bx * c_lift - cx * b_lift) / (2 * area);
  const double reach = (1 + kMargin) * std::sqrt(x * x + y * y) + 0x1p-50 * std::abs(a.x);
  const bool clear_left = strip == 0 || a.x + x - reach > strips_[strip - 1].box.x_max;
  const bool clear_right = strip + 1 == strips_.size() || a.x + x + reach < strips_[strip + 1].box.x_min;
  return clear_left && clear_right;
}

std::vector<std::uint32_t> Strips::mark_unsafe() {
  std::vector<std::vector<std::uint32_t>> found(strips_.size());
  tbb::parallel_for(std::size_t{0}, strips_.size(), [&](std::size_t i) {
    for (std::uint32_t c = strips_[i].first_cell; c < strips_[i].end_cell(); ++c) {
      if (safe(cells_[c], i)) continue;
      cells_[c].mark = 1;
      found[i].push_back(c);
    }
  });
  std::vector<std::uint32_t> all;
  for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
  return all;
}

bool Strips::join() {
  const std::vector<std::uint32_t> unsafe = mark_unsafe();
  if (!are_few(unsafe)) return false;
  std::vector<std::uint32_t> vertices;
  for (const std::uint32_t c : unsafe) {
    for (const std::uint32_t v : cells_[c].vertex) {
      if (v != at_.infinity()) vertices.push_back(v);
    }
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  std::vector<Point2> positions;
  positions.reserve(vertices.size() + 1);
  for (const std::uint32_t v : vertices) positions.push_back(at_[v]);
  positions.push_back(at_[at_.infinity()]);
  const auto count = static_cast<std::uint32_t>(vertices.size());
  RawVector<Cell> seam(cell_count(count));
  const std::vector<std::uint32_t> order = in_rounds(count, [](std::uint32_t) { return true; });
  if (!insert_all({positions}, order, seam, 0, progress_)) return false;
  vertices.push_back(at_.infinity());
  fill_seams(seam, vertices, unsafe);
  return true;
}

void Strips::fill_seams(const RawVector<Cell>& seam, std::span<const std::uint32_t> vertices,
                        std::span<const std::uint32_t> unsafe) {
  // Sides between safe and unsafe cells, by their directed ends as the unsafe one has them.
  std::unordered_map<std::uint64_t, std::uint32_t> border;
  const auto key = [](std::uint32_t from, std::uint32_t to) { return std::uint64_t{from} << 32U | to; };
  for (const std::uint32_t c : unsafe) {
    for (std::uint32_t i = 0; i < 3; ++i) {
      const std::uint32_t side = cells_[c].neighbour[i];
      if (cells_[cell_of(side)].mark != 0) continue;
      border.emplace(key(cells_[c].vertex[after(i)], cells_[c].vertex[before(i)]), side);
    }
  }
  constexpr std::uint32_t kNone = 0xffffffffU;
  std::vector<std::uint32_t> place(seam.size(), kNone);
  std::vector<std::uint32_t> pending;
  std::size_t used = 0;
  const auto safe_side = [&](std::uint32_t c, std::uint32_t i) {
    const auto found =
        border.find(key(vertices[seam[c].vertex[after(i)]], vertices[seam[c].vertex[before(i)]]));
    return found == border.end() ? kNone : found->second;
  };
  std::uint32_t spare = strips_.back().end_cell();
  const auto enter = [&](std::uint32_t c) {
    if (place[c] != kNone) return;
    place[c] = used < unsafe.size() ? unsafe[used] : spare++;
    ++used;
    pending.push_back(c);
  };
  for (std::uint32_t c = 0; c < seam.size(); ++c) {
    for (std::uint32_t i = 0; i < 3; ++i) {
      if (safe_side(c, i) != kNone) enter(c);
    }
  }
  std::vector<std::uint32_t> entered;
  while (!pending.empty()) {
    const std::uint32_t c = pending.back();
    pending.pop_back();
    entered.push_back(c);
    for (std::uint32_t i = 0; i < 3; ++i) {
      if (safe_side(c, i) == kNone) enter(cell_of(seam[c].neighbour[i]));
    }
  }
  THALWEG_ASSERT(spare == cells_.size());
  for (const std::uint32_t c : entered) {
    Cell& cell = cells_[place[c]];
    cell = {};
    for (std::uint32_t i = 0; i < 3; ++i) {
      cell.vertex[i] = vertices[seam[c].vertex[i]];
      const std::uint32_t across = safe_side(c, i);
      if (across != kNone) {
        link(cells_, side_of(place[c], i), across);
      } else {
        const std::uint32_t inner = seam[c].neighbour[i];
        cell.neighbour[i] = side_of(place[cell_of(inner)], corner_of(inner));
      }
    }
  }
}

// Whether strips of some of the vertices can be joined; then those of all can, as a rule.
bool sample_is_apart(const Positions& at, std::size_t strips, const Progress& progress) {
  constexpr std::uint32_t kSample = 1 << 12;
  std::vector<Point2> sample;
  const std::uint32_t step = std::max(1U, at.infinity() / kSample);
  for (std::uint32_t v = 0; v < at.infinity(); v += step) sample.push_back(at[v]);
  sample.push_back(at[at.infinity()]);
  Strips trial({sample}, progress);
  return trial.triangulate(strips) && trial.are_apart();
}

}  // namespace

RawVector<Cell> delaunay_cells(const Positions& at, const Progress& progress) {
  const std::uint32_t count = at.infinity();
  const std::size_t threads = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  const std::size_t strips = std::min<std::size_t>(threads, count / kLeastStrip);
  if (strips > 1 && sample_is_apart(at, strips, progress)) {
    Strips parallel(at, progress);
    if (parallel.triangulate(strips) && parallel.join()) return parallel.take_cells();
  }
  RawVector<Cell> cells(count < 3 ? 0 : cell_count(count));
  const std::vector<std::uint32_t> order = in_rounds(count, [](std::uint32_t) { return true; });
  if (count < 3 || !insert_all(at, order, cells, 0, progress)) cells.clear();
  return cells;
}

}  // namespace thalweg::detail
