// Terms of candidates, and which of them are at which side.
#include "optimize/face_terms.hpp"

#include <thalweg/base/error.hpp>

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <string>
#include <tuple>

namespace thalweg {

std::int64_t TermLevel::measure(double value) const {
  const std::int64_t steps = to_steps(value, most_units);
  if (!limit) return steps;
  return steps > *limit ? 1 : 0;
}

std::int64_t TermLevel::of(const Face& triangle, Scale scale, const Tin& tin) const {
  std::int64_t sum = 0;
  for (const Part& part : parts) {
    if (part.declaration->traits.coupling != Coupling::OneTriangle) continue;
    sum += measure(part.factor * part.declaration->of_triangle(triangle, scale, tin, reference));
  }
  return sum;
}

std::int64_t TermLevel::of(const Face& left, const Face& right, Scale scale, const Tin& tin) const {
  std::int64_t sum = 0;
  for (const Part& part : parts) {
    if (part.declaration->traits.coupling != Coupling::Edge) continue;
    sum += measure(part.factor * part.declaration->of_edge(left, right, scale, tin));
  }
  return sum;
}

void refuse_sums(std::size_t level) {
  throw Error(
      ErrorCode::SizeLimit,
      "the values of criterion " + std::to_string(level + 1) +
          " of --optimize are too large to be added exactly; are heights and units right? Split the area, or "
          "give a criterion that is a sum a small weight, such as 0.001*edge-length");
}

TermLevel level_of(const Objective& objective, std::optional<std::int64_t> limit,
                   const Reference* reference) {
  TermLevel level{.parts = {}, .limit = limit, .reference = reference};
  if (objective.is_of_pits()) return level;
  const double sign = objective.direction() == Direction::Maximise ? -1 : 1;
  for (const Objective::Part& part : objective.parts) {
    level.parts.push_back({&declaration_of(part.criterion), sign * part.weight});
  }
  level.most_units = kMostUnits / static_cast<double>(level.parts.size());
  return level;
}

FaceSides find_sides(const Tin& tin, const FixedFaces& faces, const Progress& progress) {
  FaceSides sides;
  const std::size_t count = 2 * faces.edges.size();
  sides.face.assign(faces.triangles.size(), FaceSides::kNoFace);
  for (std::uint32_t f = 0; f < faces.faces.size(); ++f) {
    for (const std::uint32_t t : faces.faces.row(f)) sides.face[t] = f;
  }
  sides.triangles.first.assign(count + 1, 0);
  for (const auto& of_triangle : faces.sides) {
    for (const std::uint32_t side : of_triangle) ++sides.triangles.first[side + 1];
  }
  std::partial_sum(sides.triangles.first.begin(), sides.triangles.first.end(), sides.triangles.first.begin());
  sides.triangles.items.resize(sides.triangles.first.back());
  std::vector<std::uint32_t> fill(sides.triangles.first.begin(), sides.triangles.first.end() - 1);
  for (std::uint32_t t = 0; t < faces.triangles.size(); ++t) {
    for (const std::uint32_t side : faces.sides[t]) sides.triangles.items[fill[side]++] = t;
  }
  struct Fresh {
    Point2 low, high;  // ends, by coordinates
    std::uint32_t edge;
  };
  std::vector<Fresh> fresh;  // edges that the Delaunay triangulation does not have
  fresh.reserve(static_cast<std::size_t>(
      std::count_if(faces.edges.begin(), faces.edges.end(),
                    [](const CandidateEdge& edge) { return !edge.ground.valid(); })));
  for (std::uint32_t e = 0; e < faces.edges.size(); ++e) {
    if (faces.edges[e].ground.valid()) continue;
    const auto ends = std::minmax({tin.point(faces.edges[e].a), tin.point(faces.edges[e].b)});
    fresh.push_back({ends.first, ends.second, e});
  }
  tbb::parallel_sort(fresh.begin(), fresh.end(), [](const Fresh& one, const Fresh& other) {
    return std::tie(one.low, one.high) < std::tie(other.low, other.high);
  });
  sides.rank.assign(faces.edges.size(), FaceSides::kNoRank);
  sides.rank_count = fresh.size();
  for (std::uint32_t rank = 0; rank < fresh.size(); ++rank) sides.rank[fresh[rank].edge] = rank;
  progress.check();
  return sides;
}

std::vector<std::int64_t> term_values(const Tin& tin, const FixedFaces& faces, const FaceSides& sides,
                                      const TermLevel& level, Scale scale, const Progress& progress) {
  const bool of_triangles = level.parts.front().declaration->triangle != nullptr;
  std::vector<std::int64_t> values;
  std::int64_t least = std::numeric_limits<std::int64_t>::min();
  const auto note = [&](std::int64_t value, bool fixed) {
    values.push_back(value);
    if (fixed) least = std::max(least, value);
  };
  std::vector<Face> corners;
  for (std::uint32_t t = 0; t < faces.triangles.size(); ++t) {
    corners.push_back(face_of(tin, faces, t, scale));
    const bool fixed = sides.face[t] == FaceSides::kNoFace;
    if (of_triangles) note(level.of(corners.back(), scale, tin), fixed);
  }
  for (std::uint32_t e = 0; e < faces.edges.size() && !of_triangles; ++e) {
    if (e % 4096 == 0) progress.check();
    const std::uint32_t one = 2 * e, other = one + 1;
    const bool fixed = sides.owner(one) == FaceSides::kNoFace && sides.owner(other) == FaceSides::kNoFace;
    for (const std::uint32_t left : sides.triangles.row(one)) {
      for (const std::uint32_t right : sides.triangles.row(other)) {
        note(level.of(corners[left], corners[right], scale, tin), fixed);
      }
    }
  }
  std::erase_if(values, [&](std::int64_t value) { return value < least; });
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

WideSteps order_sum_on(const Tin& tin, const FixedFaces& faces) {
  WideSteps sum = 0;
  auto at = faces.triangles.begin();  // both are sorted
  for (const Triangle& corners : tin.triangles()) {
    while (at != faces.triangles.end() && at->corners < corners) ++at;
    if (at == faces.triangles.end() || at->corners != corners) {
      throw Error(
          ErrorCode::Unsupported,
          "the constrained Delaunay triangulation itself has a larger order under this definition, so "
          "no sum of orders can be compared with it; take a definition that knows of lines, such as "
          "pathcon or sees-opp");
    }
    sum += at->order;
  }
  return sum;
}

}  // namespace thalweg
