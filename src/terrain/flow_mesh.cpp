// Numbers along a curve.
//
// 1. Vertices along a Hilbert curve; triangles by their smallest vertex, bucket by bucket.
// 2. What is next to what does not change, so twins are looked up, not searched.
#include "terrain/flow_mesh.hpp"

#include "base/parallel.hpp"
#include "base/prefetch.hpp"
#include "delaunay/spatial_order.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace thalweg {

namespace {

constexpr std::size_t kBlock = 8192;
constexpr std::size_t kAhead = 16;  // numbers by which memory is asked for before it is needed

// Measured on points in random order: at 10 000 numbers along a curve save what they cost, at 30 000 (10 000
// apart) a fifth of all time, at 200 000 half.
constexpr std::size_t kFarApart = 1U << 13U;
constexpr std::size_t kSampledTriangles = 4096;

/// How far apart the numbers of vertices of one edge are, on average over a sample.
bool is_scattered(const Tin& tin) {
  const std::size_t step = tin.triangle_count() / kSampledTriangles + 1;
  std::size_t sum = 0, count = 0;
  for (std::size_t t = 0; t < tin.triangle_count(); t += step, ++count) {
    const Triangle& c = tin.triangle(TriangleId{t});
    const auto [low, high] = std::minmax({c[0], c[1], c[2]});
    sum += high.index() - low.index();
  }
  return sum > kFarApart * count;
}

}  // namespace

FlowMesh::FlowMesh(const Tin& tin, const Progress& progress)
    : tin_(tin),
      points_(tin.points()),
      heights_(tin.heights()),
      triangles_(tin.triangles()),
      twins_(tin.arrays().twins) {
  if (is_scattered(tin)) {
    number_vertices(progress);
    number_triangles(progress);
    link_triangles(progress);
    points_ = moved_points_;
    heights_ = moved_heights_;
    triangles_ = moved_triangles_;
    twins_ = moved_twins_;
  }
}

void FlowMesh::link_fans(std::span<const HalfedgeId> rim) {
  more_fans_.assign(rim.begin(), rim.end());
  std::ranges::sort(more_fans_, {}, [this](HalfedgeId h) { return std::pair(origin(h), h); });
  const auto stands_alone = [&](std::size_t i) {
    const VertexId v = origin(more_fans_[i]);
    const bool before = i > 0 && origin(more_fans_[i - 1]) == v;
    return !before && !(i + 1 < more_fans_.size() && origin(more_fans_[i + 1]) == v);
  };
  std::vector<HalfedgeId> several;
  for (std::size_t i = 0; i < more_fans_.size(); ++i) {
    if (!stands_alone(i)) several.push_back(more_fans_[i]);
  }
  more_fans_ = std::move(several);
}

void FlowMesh::number_vertices(const Progress& progress) {
  const std::size_t n = tin_.vertex_count();
  const std::vector<std::uint32_t> order = coarse_hilbert_order(tin_.points(), progress);
  given_vertex_.resize(n);
  own_vertex_.resize(n);
  moved_points_.resize(n);
  moved_heights_.resize(n);
  for_each_block(n, kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      if (v + kAhead < end) {
        prefetch(&tin_.points()[order[v + kAhead]]);
        prefetch(&tin_.heights()[order[v + kAhead]]);
      }
      const VertexId given{order[v]};
      given_vertex_[v] = given;
      own_vertex_[given.index()] = VertexId{v};
      moved_points_[v] = tin_.point(given);
      moved_heights_[v] = tin_.height(given);
    }
  });
}

void FlowMesh::number_triangles(const Progress& progress) {
  const std::size_t count = tin_.triangle_count();
  RawVector<std::uint32_t> smallest(count);
  for_each_block(count, kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const Triangle& c = tin_.triangle(TriangleId{t});
      smallest[t] = std::min({own(c[0]), own(c[1]), own(c[2])}).value();
    }
  });
  std::vector<std::uint32_t> next(tin_.vertex_count() + 1, 0);
  const auto for_each_in_ranges = [&](const auto& body) {
    for_each_range(tin_.vertex_count(), progress, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = 0; t < count; ++t) {
        if (smallest[t] >= begin && smallest[t] < end) body(t);
      }
    });
  };
  for_each_in_ranges([&](std::size_t t) { ++next[smallest[t] + 1]; });
  for (std::size_t v = 0; v < tin_.vertex_count(); ++v) next[v + 1] += next[v];
  given_triangle_.resize(count);
  own_triangle_.resize(count);
  for_each_in_ranges([&](std::size_t t) {
    const TriangleId place{next[smallest[t]]++};
    own_triangle_[t] = place;
    given_triangle_[place.index()] = TriangleId{t};
  });
}

void FlowMesh::link_triangles(const Progress& progress) {
  const std::size_t count = tin_.triangle_count();
  moved_triangles_.resize(count);
  moved_twins_.resize(3 * count);
  const std::span<const HalfedgeId> given_twins = tin_.arrays().twins;
  for_each_block(count, kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      if (t + 2 * kAhead < end) {
        const TriangleId later = given_triangle_[t + 2 * kAhead];
        prefetch(&tin_.triangle(later));
        prefetch(&given_twins[3 * later.index()]);
      }
      if (t + kAhead < end) {
        const TriangleId next = given_triangle_[t + kAhead];
        for (std::size_t side = 0; side < 3; ++side) {
          prefetch(&own_vertex_[tin_.triangle(next)[side].index()]);
          const HalfedgeId twin = given_twins[3 * next.index() + side];
          if (twin.valid()) prefetch(&own_triangle_[twin.index() / 3]);
        }
      }
      const TriangleId given = given_triangle_[t];
      const Triangle& c = tin_.triangle(given);
      moved_triangles_[t] = {own(c[0]), own(c[1]), own(c[2])};
      for (std::size_t side = 0; side < 3; ++side) {
        const HalfedgeId twin = given_twins[3 * given.index() + side];
        moved_twins_[3 * t + side] = twin.valid() ? own(twin) : twin;
      }
    }
  });
}

}  // namespace thalweg
