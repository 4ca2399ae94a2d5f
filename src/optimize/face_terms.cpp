// Costs of the triangulations of one face.
//
// Terms of triangles and of pairs of triangles at an edge are computed once each; a triangulation adds up
// those that it has. A fixed edge beyond which lies a triangle that every triangulation has, or the same face
// once more, counts here; one between two faces couples them.
#include "optimize/face_terms.hpp"

#include "base/parallel.hpp"
#include "optimize/ties.hpp"

#include <thalweg/base/assert.hpp>

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace thalweg {

std::int64_t TermLevel::measure(double value) const {
  const std::int64_t steps = to_steps(value);
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

TermLevel level_of(const Objective& objective, std::optional<std::int64_t> limit,
                   const Reference* reference) {
  TermLevel level{.parts = {}, .limit = limit, .reference = reference};
  if (objective.is_of_pits()) return level;
  const double sign = objective.direction() == Direction::Maximise ? -1 : 1;
  for (const Objective::Part& part : objective.parts) {
    level.parts.push_back({&declaration_of(part.criterion), sign * part.weight});
  }
  return level;
}

FaceSides find_sides(const Tin& tin, const FixedFaces& faces, const Progress& progress) {
  FaceSides sides;
  const std::size_t count = 2 * faces.edges.size();
  sides.owner.assign(count, FaceSides::kNoFace);
  sides.fixed.assign(count, FaceSides::kNoTriangle);
  std::vector<std::uint32_t> face_of_triangle(faces.triangles.size(), FaceSides::kNoFace);
  for (std::uint32_t f = 0; f < faces.faces.size(); ++f) {
    for (const std::uint32_t t : faces.faces.row(f)) face_of_triangle[t] = f;
  }
  sides.triangles.first.assign(count + 1, 0);
  for (std::uint32_t t = 0; t < faces.triangles.size(); ++t) {
    for (const std::uint32_t side : faces.sides[t]) {
      ++sides.triangles.first[side + 1];
      if (face_of_triangle[t] == FaceSides::kNoFace) {
        sides.fixed[side] = t;
      } else {
        sides.owner[side] = face_of_triangle[t];
      }
    }
  }
  std::partial_sum(sides.triangles.first.begin(), sides.triangles.first.end(), sides.triangles.first.begin());
  sides.triangles.items.resize(sides.triangles.first.back());
  std::vector<std::uint32_t> fill(sides.triangles.first.begin(), sides.triangles.first.end() - 1);
  for (std::uint32_t t = 0; t < faces.triangles.size(); ++t) {
    for (const std::uint32_t side : faces.sides[t]) sides.triangles.items[fill[side]++] = t;
  }
  std::vector<std::uint32_t> fresh;  // edges that the Delaunay triangulation does not have
  for (std::uint32_t e = 0; e < faces.edges.size(); ++e) {
    if (!faces.edges[e].ground.valid()) fresh.push_back(e);
  }
  tbb::parallel_sort(fresh.begin(), fresh.end(), [&](std::uint32_t e, std::uint32_t f) {
    const auto ends = [&](std::uint32_t edge) {
      return std::minmax(tin.point(faces.edges[edge].a), tin.point(faces.edges[edge].b));
    };
    const std::pair<Point2, Point2> of_e = ends(e), of_f = ends(f);
    return of_e < of_f;
  });
  sides.tie.assign(faces.edges.size(), 0);
  for (std::size_t rank = 0; rank < fresh.size(); ++rank) sides.tie[fresh[rank]] = tie_of(rank, fresh.size());
  progress.check();
  return sides;
}

namespace {

constexpr std::size_t kFrontLimit = 2'000'000;
constexpr std::uint32_t kNowhere = 0xffffffffU;

template <std::size_t Criteria>
class FaceLabeller {
 public:
  FaceLabeller(const FaceTerms<Criteria>& terms, std::span<const PlateauLink> links, std::size_t face,
               const FaceTriangulations& list)
      : terms_(terms), list_(list), triangles_(terms.faces.faces.row(face)), face_(face) {
    for (const std::uint32_t t : triangles_) {
      corners_.push_back(face_of(terms.tin, terms.faces, t, terms.scale));
      own_.push_back(terms.of(corners_.back()));
      if (terms.order_level) own_.back()[*terms.order_level] += terms.faces.triangles[t].order;
    }
    number_sides();
    for (const Group& group : groups_) prepare(group);
    if (!links.empty()) note_links(links);
  }

  /// The one label that bounds all; `size`: triangles of a triangulation.
  FaceLabels<Criteria> relax(std::uint32_t size) {
    FaceLabels<Criteria> labels;
    labels.triangulation = {0};
    Cost<Criteria> cost;
    for (std::size_t level = 0; level < Criteria; ++level) cost.level[level] = least_cost(level, size);
    labels.unary = {cost};
    for (const std::uint32_t g : coupled_) {
      labels.side.push_back(groups_[g].side);
      labels.at_side.push_back({static_cast<std::uint16_t>(members(groups_[g]).size())});
    }
    labels.link = links_;
    labels.joins.assign(links_.size(), std::vector<std::uint8_t>{1});
    return labels;
  }

  FaceLabels<Criteria> run() {
    const std::size_t count = list_.count();
    std::vector<Cost<Criteria>> cost(count);
    at_.assign(count * coupled_.size(), 0);
    joined_.assign(count * links_.size(), 0);
    for (std::size_t i = 0; i < count; ++i) cost[i] = add_up(i);
    return gather(cost);
  }

 private:
  /// Candidates of the face left of a side.
  struct Group {
    std::uint32_t side = 0;
    std::uint32_t opposite = kNowhere;  ///< the group on the other side of the edge, if it is of this face
    std::uint32_t link = kNowhere;
    std::size_t first_pair = 0;  ///< lower of the two groups: terms, [place here * size there + place there]
    std::uint32_t size_across = 0;
  };

  void number_sides() {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> entries;  // side, triangle and corner
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
      for (std::uint32_t corner = 0; corner < 3; ++corner) {
        entries.emplace_back(terms_.faces.sides[triangles_[i]][corner], 3 * i + corner);
      }
    }
    std::sort(entries.begin(), entries.end());
    group_.resize(3 * triangles_.size());
    place_.resize(3 * triangles_.size());
    std::uint32_t place = 0;
    for (const auto& [side, entry] : entries) {
      if (groups_.empty() || groups_.back().side != side) {
        groups_.push_back({.side = side});
        place = 0;
        const std::size_t last = groups_.size() - 1;
        if (last > 0 && groups_[last - 1].side == (side ^ 1U) && side % 2 == 1) {
          groups_[last].opposite = static_cast<std::uint32_t>(last - 1);
          groups_[last - 1].opposite = static_cast<std::uint32_t>(last);
        }
      }
      group_[entry] = static_cast<std::uint32_t>(groups_.size() - 1);
      place_[entry] = place++;
    }
    chosen_.assign(groups_.size(), kNowhere);
  }

  [[nodiscard]] std::span<const std::uint32_t> members(const Group& group) const {
    return terms_.sides.triangles.row(group.side);
  }
  [[nodiscard]] const Face& corners(std::uint32_t triangle) const {
    return corners_[static_cast<std::size_t>(
        std::lower_bound(triangles_.begin(), triangles_.end(), triangle) - triangles_.begin())];
  }

  void prepare(const Group& group) {
    const auto index = static_cast<std::uint32_t>(&group - groups_.data());
    const std::uint32_t across = group.side ^ 1U;
    if (group.opposite != kNowhere) {
      if (group.opposite < index) return;
      Group& lower = groups_[index];
      lower.first_pair = pairs_.size();
      const auto there = members(groups_[group.opposite]);
      lower.size_across = static_cast<std::uint32_t>(there.size());
      for (const std::uint32_t left : members(group)) {
        for (const std::uint32_t right : there) pairs_.push_back(terms_.of(corners(left), corners(right)));
      }
    } else if (terms_.sides.owner[across] != FaceSides::kNoFace) {
      coupled_.push_back(index);
    } else if (const std::uint32_t fixed = terms_.sides.fixed[across]; fixed != FaceSides::kNoTriangle) {
      const Face outside = face_of(terms_.tin, terms_.faces, fixed, terms_.scale);
      for (const std::uint32_t t : members(group)) {
        const auto i = std::lower_bound(triangles_.begin(), triangles_.end(), t) - triangles_.begin();
        Weight<Criteria>& own = own_[static_cast<std::size_t>(i)];
        const Weight<Criteria> more = terms_.of(corners_[static_cast<std::size_t>(i)], outside);
        for (std::size_t level = 0; level < Criteria; ++level) own[level] += more[level];
      }
    }
  }

  /// Own terms, and of each pair at an edge half its least, rounded down, at either side: a sum of these is
  /// no more than that of the terms.
  std::int64_t least_cost(std::size_t level, std::uint32_t size) const {
    std::vector<std::int64_t> weights;
    for (const Weight<Criteria>& own : own_) weights.push_back(own[level]);
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      const Group& here = groups_[g];
      if (here.opposite == kNowhere || here.opposite < g) continue;
      const std::size_t count = members(here).size();
      std::vector<std::int64_t> least(count + here.size_across, std::numeric_limits<std::int64_t>::max());
      for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t j = 0; j < here.size_across; ++j) {
          const std::int64_t weight = pairs_[here.first_pair + i * here.size_across + j][level];
          least[i] = std::min(least[i], weight);
          least[count + j] = std::min(least[count + j], weight);
        }
      }
      const auto spread = [&](const Group& group, std::size_t first) {
        const auto triangles = members(group);
        for (std::size_t i = 0; i < triangles.size(); ++i)
          weights[index_of(triangles[i])] += least[first + i] >> 1;
      };
      spread(here, 0);
      spread(groups_[here.opposite], count);
    }
    const auto sum = find_least_sum(terms_.faces, face_, weights, kFrontLimit);
    THALWEG_ASSERT(!sum || least_by_area(weights, size) <= *sum);
    return sum ? *sum : least_by_area(weights, size);
  }

  /// Spreads the weight of each triangle over its area: a triangulation covers each ground triangle once, at
  /// no less than the least weight by area of those that overlap it. Two triangles on the same vertices
  /// overlap exactly if they are the same or some of their sides cross.
  [[nodiscard]] std::int64_t least_by_area(std::span<const std::int64_t> weights, std::uint32_t size) const {
    std::vector<std::size_t> ground;
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      if (is_ground(triangles_[i])) ground.push_back(i);
    }
    if (ground.size() != size) {
      return std::int64_t{size} * *std::min_element(weights.begin(), weights.end());
    }
    constexpr long double kRounding = 1e-12L;  // far above that of all operations here
    long double sum = 0, rounding = 0;
    for (const std::size_t i : ground) {
      long double least = by_area(weights, i);
      for (const std::uint32_t side : terms_.faces.sides[triangles_[i]]) {
        for (const std::uint32_t crossing : terms_.faces.crossings.row(side / 2)) {
          for (const std::uint32_t other : {2 * crossing, 2 * crossing + 1}) {
            for (const std::uint32_t t : terms_.sides.triangles.row(other)) {
              least = std::min(least, by_area(weights, index_of(t)));
            }
          }
        }
      }
      sum += least * corners_[i].normal.z;
      rounding += std::abs(least * corners_[i].normal.z) * kRounding;
    }
    return static_cast<std::int64_t>(std::floor(sum - rounding));
  }

  [[nodiscard]] long double by_area(std::span<const std::int64_t> weights, std::size_t i) const {
    return static_cast<long double>(weights[i]) / corners_[i].normal.z;
  }

  [[nodiscard]] bool is_ground(std::uint32_t triangle) const {
    const auto& [a, b, c] = terms_.faces.triangles[triangle].corners;
    const HalfedgeId ab = terms_.tin.find_halfedge(a, b);
    return ab.valid() && terms_.tin.apex(ab) == c;
  }

  [[nodiscard]] std::size_t index_of(std::uint32_t triangle) const {
    return static_cast<std::size_t>(std::lower_bound(triangles_.begin(), triangles_.end(), triangle) -
                                    triangles_.begin());
  }

  void note_links(std::span<const PlateauLink> links) {
    for (const Group& group : groups_) {
      const PlateauLink& link = links[group.side / 2];
      if (link.first != link.second && terms_.faces.edges[group.side / 2].free) links_.push_back(link);
    }
    std::sort(links_.begin(), links_.end());
    links_.erase(std::unique(links_.begin(), links_.end()), links_.end());
    for (Group& group : groups_) {
      const PlateauLink& link = links[group.side / 2];
      if (link.first == link.second || !terms_.faces.edges[group.side / 2].free) continue;
      group.link =
          static_cast<std::uint32_t>(std::lower_bound(links_.begin(), links_.end(), link) - links_.begin());
    }
  }

  Cost<Criteria> add_up(std::size_t label) {
    Cost<Criteria> cost;
    for (const std::uint32_t t : list_[label]) {
      const auto i = static_cast<std::size_t>(std::lower_bound(triangles_.begin(), triangles_.end(), t) -
                                              triangles_.begin());
      add(cost, own_[i]);
      for (std::size_t entry = 3 * i; entry < 3 * i + 3; ++entry) chosen_[group_[entry]] = place_[entry];
    }
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      const Group& group = groups_[g];
      if (chosen_[g] == kNowhere || group.opposite == kNowhere || group.opposite < g) continue;
      add(cost,
          pairs_[group.first_pair + std::size_t{chosen_[g]} * group.size_across + chosen_[group.opposite]]);
      const std::uint32_t edge = group.side / 2;
      cost.level[Criteria] += terms_.faces.edges[edge].ground.valid() ? 0 : 1;
      cost.level[Criteria + 1] += terms_.sides.tie[edge];
      if (group.link != kNowhere) joined_[label * links_.size() + group.link] = 1;
    }
    for (std::size_t c = 0; c < coupled_.size(); ++c) {
      at_[label * coupled_.size() + c] = static_cast<std::uint16_t>(chosen_[coupled_[c]]);
    }
    std::fill(chosen_.begin(), chosen_.end(), kNowhere);
    return cost;
  }

  FaceLabels<Criteria> gather(const std::vector<Cost<Criteria>>& cost) {
    const std::size_t sides = coupled_.size(), links = links_.size();
    const auto seen = [&](std::uint32_t i) {
      return std::pair(std::span(at_).subspan(i * sides, sides),
                       std::span(joined_).subspan(i * links, links));
    };
    const auto compare = [&](std::uint32_t i, std::uint32_t j) {
      const auto [at_i, joined_i] = seen(i);
      const auto [at_j, joined_j] = seen(j);
      const auto at =
          std::lexicographical_compare_three_way(at_i.begin(), at_i.end(), at_j.begin(), at_j.end());
      if (at != 0) return at;
      return std::lexicographical_compare_three_way(joined_i.begin(), joined_i.end(), joined_j.begin(),
                                                    joined_j.end());
    };
    std::vector<std::uint32_t> order(cost.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
      const auto seen_alike = compare(i, j);
      if (seen_alike != 0) return seen_alike < 0;
      return cost[i] == cost[j] ? i < j : cost[i] < cost[j];
    });
    order.erase(std::unique(order.begin(), order.end(),
                            [&](std::uint32_t i, std::uint32_t j) { return compare(i, j) == 0; }),
                order.end());
    FaceLabels<Criteria> labels;
    labels.triangulation = order;
    labels.link = links_;
    for (const std::uint32_t i : order) labels.unary.push_back(cost[i]);
    for (std::size_t c = 0; c < sides; ++c) {
      labels.side.push_back(groups_[coupled_[c]].side);
      auto& column = labels.at_side.emplace_back();
      for (const std::uint32_t i : order) column.push_back(at_[i * sides + c]);
    }
    for (std::size_t l = 0; l < links; ++l) {
      auto& column = labels.joins.emplace_back();
      for (const std::uint32_t i : order) column.push_back(joined_[i * links + l]);
    }
    return labels;
  }

  const FaceTerms<Criteria>& terms_;
  const FaceTriangulations& list_;
  std::span<const std::uint32_t> triangles_;
  std::size_t face_;
  std::vector<Face> corners_;          ///< by triangle
  std::vector<Weight<Criteria>> own_;  ///< by triangle: its terms, and those with triangles in no face
  std::vector<Group> groups_;          ///< by side
  std::vector<std::uint32_t> group_;   ///< of each corner's side
  std::vector<std::uint32_t> place_;   ///< in the group
  std::vector<Weight<Criteria>> pairs_;
  std::vector<std::uint32_t> coupled_;  ///< groups
  std::vector<PlateauLink> links_;
  std::vector<std::uint32_t> chosen_;  ///< by group: the place that the triangulation has
  std::vector<std::uint16_t> at_;      ///< by triangulation and coupled group
  std::vector<std::uint8_t> joined_;   ///< by triangulation and link
};

}  // namespace

template <std::size_t Criteria>
FaceLabels<Criteria> label_face(const FaceTerms<Criteria>& terms, std::span<const PlateauLink> links,
                                std::size_t face, const FaceTriangulations& list) {
  return FaceLabeller<Criteria>(terms, links, face, list).run();
}

template <std::size_t Criteria>
FaceLabels<Criteria> relax_face(const FaceTerms<Criteria>& terms, std::span<const PlateauLink> links,
                                std::size_t face, std::uint32_t size) {
  return FaceLabeller<Criteria>(terms, links, face, {}).relax(size);
}

template FaceLabels<1> relax_face(const FaceTerms<1>&, std::span<const PlateauLink>, std::size_t,
                                  std::uint32_t);
template FaceLabels<2> relax_face(const FaceTerms<2>&, std::span<const PlateauLink>, std::size_t,
                                  std::uint32_t);
template FaceLabels<5> relax_face(const FaceTerms<5>&, std::span<const PlateauLink>, std::size_t,
                                  std::uint32_t);

template FaceLabels<1> label_face(const FaceTerms<1>&, std::span<const PlateauLink>, std::size_t,
                                  const FaceTriangulations&);
template FaceLabels<2> label_face(const FaceTerms<2>&, std::span<const PlateauLink>, std::size_t,
                                  const FaceTriangulations&);
template FaceLabels<5> label_face(const FaceTerms<5>&, std::span<const PlateauLink>, std::size_t,
                                  const FaceTriangulations&);

}  // namespace thalweg
