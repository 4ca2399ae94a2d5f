// A TIN under other vertex ids.
//
// 1. Each triangle takes the new ids and is turned so that the smallest comes first; triangles are bucketed
// by
//    it, and each bucket, a part of one fan, is sorted.
// 2. What is next to what does not change, so halfedges are moved with their triangles: nothing is searched.
#include "base/parallel.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/mesh/tin.hpp>

#include <algorithm>
#include <string>

namespace thalweg {

namespace {

constexpr std::size_t kBlock = 8192;

Triangle turned(const Triangle& t, std::size_t first) {
  return {t[first], t[(first + 1) % 3], t[(first + 2) % 3]};
}

std::size_t smallest(const Triangle& t) {
  return static_cast<std::size_t>(std::min_element(t.begin(), t.end()) - t.begin());
}

void check_numbers(std::span<const VertexId> number, std::size_t vertex_count) {
  std::vector<bool> seen(vertex_count, false);
  bool sound = number.size() == vertex_count;
  for (std::size_t v = 0; v < number.size() && sound; ++v) {
    sound = number[v].index() < vertex_count && !seen[number[v].index()];
    if (sound) seen[number[v].index()] = true;
  }
  if (!sound) throw Error(ErrorCode::InvalidTin, "new vertex ids must be a permutation of the old ones");
}

}  // namespace

Tin Tin::renumbered(std::span<const VertexId> number, const Progress& progress) const {
  check_numbers(number, vertex_count());
  Tin result;
  result.points_.resize(vertex_count());
  result.heights_.resize(vertex_count());
  for_each_block(vertex_count(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      result.points_[number[v].index()] = points_[v];
      result.heights_[number[v].index()] = heights_[v];
    }
  });
  const std::vector<HalfedgeId> moved = result.take_triangles(*this, number, progress);
  result.take_halfedges(*this, number, moved, progress);
  return result;
}

/// Takes the triangles under new ids; returns, for each old halfedge that starts a triangle's list of
/// corners, the new halfedge of the same edge.
std::vector<HalfedgeId> Tin::take_triangles(const Tin& from, std::span<const VertexId> number,
                                            const Progress& progress) {
  const std::size_t count = from.triangle_count();
  const auto renamed = [&](std::size_t t) {
    const Triangle& c = from.triangles_[t];
    return Triangle{number[c[0].index()], number[c[1].index()], number[c[2].index()]};
  };
  std::vector<Triangle> canonical(count);
  std::vector<std::uint32_t> end_of(vertex_count() + 1, 0), source(count);
  for_each_block(count, kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const Triangle mapped = renamed(t);
      canonical[t] = turned(mapped, smallest(mapped));
    }
  });
  for (const Triangle& t : canonical) ++end_of[t[0].index() + 1];
  for (std::size_t v = 0; v < vertex_count(); ++v) end_of[v + 1] += end_of[v];
  for (std::size_t t = 0; t < count; ++t) {  // starts move on and become ends
    source[end_of[canonical[t][0].index()]++] = static_cast<std::uint32_t>(t);
  }
  triangles_.resize(count);
  std::vector<HalfedgeId> moved(count);
  for_each_block(vertex_count(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const std::size_t first = v == 0 ? 0 : end_of[v - 1];
      std::sort(source.begin() + static_cast<std::ptrdiff_t>(first), source.begin() + end_of[v],
                [&](std::uint32_t a, std::uint32_t b) { return canonical[a] < canonical[b]; });
      for (std::size_t i = first; i < end_of[v]; ++i) {
        const std::uint32_t t = source[i];
        triangles_[i] = canonical[t];
        moved[t] = HalfedgeId{3 * i + (3 - smallest(renamed(t))) % 3};
      }
    }
  });
  return moved;
}

void Tin::take_halfedges(const Tin& from, std::span<const VertexId> number, std::span<const HalfedgeId> moved,
                         const Progress& progress) {
  const auto now = [&](HalfedgeId h) {
    const HalfedgeId first = moved[h.index() / 3];
    const std::size_t side = first.index() % 3 + h.index() % 3;
    return HalfedgeId{first.index() / 3 * 3 + (side < 3 ? side : side - 3)};
  };
  twins_.resize(from.halfedge_count());
  kinds_.resize(from.halfedge_count());
  for_each_block(from.halfedge_count(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const HalfedgeId h{i}, twin = from.twins_[i];
      twins_[now(h).index()] = twin.valid() ? now(twin) : HalfedgeId{};
      kinds_[now(h).index()] = from.kinds_[i];
    }
  });
  edge_count_ = from.edge_count_;

  first_outgoing_.assign(vertex_count() + 1, 0);
  for (std::size_t v = 0; v < vertex_count(); ++v) {
    first_outgoing_[number[v].index() + 1] = from.first_outgoing_[v + 1] - from.first_outgoing_[v];
  }
  for (std::size_t v = 0; v < vertex_count(); ++v) first_outgoing_[v + 1] += first_outgoing_[v];
  outgoing_.resize(from.outgoing_.size());
  for_each_block(vertex_count(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const std::span<const HalfedgeId> fan = from.outgoing(VertexId{v});
      const auto to = outgoing_.begin() + first_outgoing_[number[v].index()];
      std::transform(fan.begin(), fan.end(), to, now);
      sort_large_fan({to, fan.size()});
    }
  });
}

}  // namespace thalweg
