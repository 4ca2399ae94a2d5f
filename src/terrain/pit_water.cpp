// Water in pits.
//
// 1. Under water is what is lower than the level and connected to the bottom. A triangle is counted at its
//    submerged corner of least id. Which vertices are wet, and were reached before, cannot be foreseen, so
//    lists grow without jumps: what is not wanted is overwritten.
// 2. A triangle counts as far as it is submerged, cut along its shore: in batches, in loops over columns
//    without branches.
#include "terrain/pit_water.hpp"

#include "terrain/flow_graph.hpp"

#include <algorithm>

namespace thalweg {

namespace {

constexpr std::size_t kBatch = 128;
using Column = std::array<double, kBatch>;

struct Batch {
  std::array<Column, 3> over;  ///< height of the water over each corner
  Column whole;                ///< area of the triangle
  Column top, middle, bottom;  ///< the same, sorted
  Column area, volume;         ///< of the water
};

// The choice is made before sanitizers are ready.
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__) && \
    !defined(__SANITIZE_ADDRESS__)
[[gnu::target_clones("default", "avx2", "avx512f")]]
#endif
void fill(Batch& batch) {
  for (std::size_t i = 0; i < kBatch; ++i) {
    const double p = batch.over[0][i], q = batch.over[1][i], r = batch.over[2][i];
    const double most = std::max(p, q), least = std::min(p, q);
    batch.top[i] = std::max(most, r);
    batch.middle[i] = std::max(least, std::min(most, r));
    batch.bottom[i] = std::min(least, r);
  }
  for (std::size_t i = 0; i < kBatch; ++i) {
    const double a = batch.top[i], b = batch.middle[i], c = batch.bottom[i], whole = batch.whole[i];
    const double share = a / (a - b) * (a / (a - c)), dry = c / (c - a) * (c / (c - b));
    const double mean = (a + b + c) / 3;
    const double area_of_one = whole * share, area_of_two = whole * (1 - dry);
    const double volume_of_one = whole * share * a / 3, volume_of_two = whole * (mean - dry * c / 3);
    const bool one = b <= 0, all = c >= 0;  // submerged corners
    const double area = one ? area_of_one : area_of_two, volume = one ? volume_of_one : volume_of_two;
    batch.area[i] = all ? whole : area;
    batch.volume[i] = all ? whole * (a + b + c) / 3 : volume;
  }
}

}  // namespace

void WaterGauge::reach(VertexId v, HalfedgeId out, bool wet) {
  std::uint32_t& known = reached_[wet ? 1 : 0][v.index() & -static_cast<std::size_t>(wet)];
  lake_[lake_count_] = out;
  lake_count_ += known != mark_ ? 1 : 0;
  known = mark_;
}

void WaterGauge::flood(VertexId bottom, double level, std::uint32_t mark) {
  constexpr std::size_t kRoom = 1024;
  const auto pit = static_cast<std::uint32_t>(levels_.size());
  levels_.push_back(level);
  mark_ = elsewhere_ = mark;
  lake_.resize(std::max(lake_.size(), kRoom));
  lake_count_ = 1;
  lake_[0] = mesh_.some_out(bottom);
  reached_[1][bottom.index()] = mark;
  for (std::size_t next = 0; next < lake_count_; ++next) {
    const HalfedgeId out = lake_[next];
    const VertexId o = mesh_.origin(out);
    mesh_.for_each_out_around(out, [&](HalfedgeId h) {
      if (lake_count_ + 2 > lake_.size()) lake_.resize(2 * lake_.size());
      if (triangle_count_ == triangles_.size()) triangles_.resize(2 * triangles_.size() + kRoom);
      const std::size_t t = h.index() / 3, side = h.index() - 3 * t;
      const Triangle& corner = mesh_.triangle(TriangleId{t});
      const VertexId p = corner[kNextSide[side]], q = corner[kPreviousSide[side]];
      const bool wet_p = mesh_.height(p) < level, wet_q = mesh_.height(q) < level;
      reach(p, HalfedgeId{3 * t + kNextSide[side]}, wet_p);
      reach(q, HalfedgeId{3 * t + kPreviousSide[side]}, wet_q);
      triangles_[triangle_count_] = {o, p, q, pit};
      triangle_count_ += (wet_p & (p < o)) | (wet_q & (q < o)) ? 0 : 1;
    });
  }
}

std::vector<Water> WaterGauge::measure() {
  std::vector<Water> water(levels_.size());
  Batch batch{};
  for (std::size_t begin = 0; begin < triangle_count_; begin += kBatch) {
    const std::size_t count = std::min(kBatch, triangle_count_ - begin);
    for (std::size_t i = 0; i < count; ++i) {
      const Submerged& t = triangles_[begin + i];
      const double level = levels_[t.pit];
      const Point2 o = mesh_.point(t.o), p = mesh_.point(t.p), q = mesh_.point(t.q);
      batch.over[0][i] = level - mesh_.height(t.o);
      batch.over[1][i] = level - mesh_.height(t.p);
      batch.over[2][i] = level - mesh_.height(t.q);
      batch.whole[i] = ((p.x - o.x) * (q.y - o.y) - (p.y - o.y) * (q.x - o.x)) / 2;
    }
    fill(batch);
    for (std::size_t i = 0; i < count; ++i) {
      Water& of_pit = water[triangles_[begin + i].pit];
      of_pit.area += batch.area[i];
      of_pit.volume += batch.volume[i];
    }
  }
  triangle_count_ = 0;
  levels_.clear();
  return water;
}

}  // namespace thalweg
