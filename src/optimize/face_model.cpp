// Terms of triangles and of pairs of triangles at an edge, of one face.
//
// A fixed edge beyond which lies a triangle that every triangulation has counts as a term of the triangle at
// it; one beyond which lies the same face once more, as any free edge; one between two faces couples them.
#include "optimize/face_model.hpp"

#include "base/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace thalweg {

namespace {

constexpr std::size_t kSides = 4096;

}  // namespace

template <std::size_t Criteria>
const FaceModel<Criteria>& FaceModeller<Criteria>::model(std::size_t face) {
  model_.start(terms_, face);
  for (const std::uint32_t t : model_.triangles) {
    model_.corners.push_back(face_of(terms_.tin, terms_.faces, t, terms_.scale));
    model_.own.push_back(terms_.of(model_.corners.back()));
    if (terms_.order_level) model_.own.back()[*terms_.order_level] += terms_.faces.triangles[t].order;
  }
  group_sides();
  for (std::uint32_t g = 0; g < model_.groups.size(); ++g) weigh(g);
  if (!links_.empty()) note_links();
  refuse_overflow();
  return model_;
}

template <std::size_t Criteria>
void FaceModeller<Criteria>::group_sides() {
  entries_.clear();
  for (std::uint32_t i = 0; i < model_.triangles.size(); ++i) {
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      const std::uint64_t side = terms_.faces.sides[model_.triangles[i]][corner];
      entries_.push_back(side << 32U | (3 * i + corner));
    }
  }
  std::sort(entries_.begin(), entries_.end());
  std::vector<FaceGroup>& groups = model_.groups;
  for (const std::uint64_t key : entries_) {
    const auto side = static_cast<std::uint32_t>(key >> 32U), entry = static_cast<std::uint32_t>(key);
    if (groups.empty() || groups.back().side != side) {
      const auto last = static_cast<std::uint32_t>(groups.size());
      groups.push_back({.side = side});
      if (last > 0 && side % 2 == 1 && groups[last - 1].side == side - 1) {
        groups[last].opposite = last - 1;
        groups[last - 1].opposite = last;
      }
    }
    model_.group[entry / 3][entry % 3] = static_cast<std::uint32_t>(groups.size() - 1);
    model_.place[entry / 3][entry % 3] = static_cast<std::uint16_t>(groups.back().size++);
  }
}

template <std::size_t Criteria>
void FaceModeller<Criteria>::weigh(std::uint32_t index) {
  FaceGroup& group = model_.groups[index];
  const std::uint32_t across = group.side ^ 1U;
  if (group.opposite != FaceGroup::kNone) {
    if (group.opposite > index) weigh_pairs(group, model_.groups[group.opposite]);
  } else if (const std::uint32_t between = sides_.index[group.side / 2];
             between != SideWeights<Criteria>::kNone) {
    model_.coupled.push_back(index);
    weigh_coupled(group, sides_.first[between]);
  } else if (const std::uint32_t fixed = terms_.sides.fixed(across); fixed != FaceSides::kNoTriangle) {
    const Face outside = face_of(terms_.tin, terms_.faces, fixed, terms_.scale);
    for (const std::uint32_t t : model_.members(group)) {
      const std::size_t i = model_.index_of(t);
      const Weight<Criteria> more = terms_.of(model_.corners[i], outside);
      for (std::size_t level = 0; level < Criteria; ++level) {
        if (__builtin_add_overflow(model_.own[i][level], more[level], &model_.own[i][level]))
          refuse_sums(level);
      }
    }
  }
}

template <std::size_t Criteria>
void FaceModeller<Criteria>::weigh_coupled(FaceGroup& group, std::size_t first) {
  const std::uint32_t across = group.side ^ 1U;
  const std::size_t there = terms_.sides.triangles.row(across).size();
  const auto possible = sides_.possible.begin() + terms_.sides.triangles.first[across];
  const bool is_left = group.side % 2 == 0;
  group.first_weight = model_.weights.size();
  for (std::size_t i = 0; i < group.size; ++i) {
    for (std::size_t j = 0; j < there; ++j) {
      if (possible[static_cast<std::ptrdiff_t>(j)] == 0) continue;
      model_.weights.push_back(sides_.weights[first + (is_left ? i * there + j : j * group.size + i)]);
    }
  }
  group.size_across = static_cast<std::uint32_t>((model_.weights.size() - group.first_weight) / group.size);
  group.stride = group.size_across;
  group.stride_across = 1;
}

template <std::size_t Criteria>
void FaceModeller<Criteria>::weigh_pairs(FaceGroup& here, FaceGroup& there) {
  here.first_weight = there.first_weight = model_.weights.size();
  here.size_across = there.size;
  here.stride = there.stride_across = there.size;
  there.size_across = here.size;
  here.stride_across = there.stride = 1;
  for (const std::uint32_t left : model_.members(here)) {
    const Face& of_left = model_.corners[model_.index_of(left)];
    for (const std::uint32_t right : model_.members(there)) {
      model_.weights.push_back(terms_.of(of_left, model_.corners[model_.index_of(right)]));
    }
  }
}

// A triangulation of the face has fewer than twice as many triangles as vertices, and three sides a triangle.
template <std::size_t Criteria>
void FaceModeller<Criteria>::refuse_overflow() {
  for (std::size_t level = 0; level < Criteria; ++level) {
    const auto most = [level](const std::vector<Weight<Criteria>>& weights) {
      double largest = 0;
      for (const auto& weight : weights)
        largest = std::max(largest, std::abs(static_cast<double>(weight[level])));
      return largest;
    };
    const double of_one = most(model_.own) + 3 * most(model_.weights);
    // Candidates are three vertices each: most often that is enough.
    if (of_one * 6 * static_cast<double>(model_.triangles.size()) < kMostSteps) continue;
    vertices_.clear();
    for (const std::uint32_t t : model_.triangles) {
      const Triangle& corners = terms_.faces.triangles[t].corners;
      vertices_.insert(vertices_.end(), corners.begin(), corners.end());
    }
    std::sort(vertices_.begin(), vertices_.end());
    const auto end = std::unique(vertices_.begin(), vertices_.end());
    if (of_one * 2 * static_cast<double>(end - vertices_.begin()) >= kMostSteps) refuse_sums(level);
  }
}

template <std::size_t Criteria>
bool FaceModeller<Criteria>::joins(const FaceGroup& group) const {
  const PlateauLink& link = links_[group.side / 2];
  return link.first != link.second && terms_.faces.edges[group.side / 2].free;
}

template <std::size_t Criteria>
void FaceModeller<Criteria>::note_links() {
  for (const FaceGroup& group : model_.groups) {
    if (joins(group)) model_.links.push_back(links_[group.side / 2]);
  }
  std::sort(model_.links.begin(), model_.links.end());
  model_.links.erase(std::unique(model_.links.begin(), model_.links.end()), model_.links.end());
  for (FaceGroup& group : model_.groups) {
    if (!joins(group)) continue;
    const auto at = std::lower_bound(model_.links.begin(), model_.links.end(), links_[group.side / 2]);
    group.link = static_cast<std::uint32_t>(at - model_.links.begin());
  }
}

template <std::size_t Criteria>
SideWeights<Criteria> weigh_sides(const FaceTerms<Criteria>& terms, const Progress& progress) {
  SideWeights<Criteria> sides;
  sides.index.assign(terms.faces.edges.size(), SideWeights<Criteria>::kNone);
  std::size_t count = 0;
  for (std::uint32_t e = 0; e < terms.faces.edges.size(); ++e) {
    const std::uint32_t left = terms.sides.owner(2 * e), right = terms.sides.owner(2 * e + 1);
    if (left == right || left == FaceSides::kNoFace || right == FaceSides::kNoFace) continue;
    sides.index[e] = static_cast<std::uint32_t>(sides.edges.size());
    sides.edges.push_back(e);
    sides.first.push_back(count);
    count += terms.sides.triangles.row(2 * e).size() * terms.sides.triangles.row(2 * e + 1).size();
  }
  sides.weights.resize(count);
  sides.possible.assign(terms.sides.triangles.items.size(), 1);
  for_each_block(sides.edges.size(), kSides, progress, [&](std::size_t begin, std::size_t end) {
    std::vector<Face> right;
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t e = sides.edges[i];
      right.clear();
      for (const std::uint32_t t : terms.sides.triangles.row(2 * e + 1)) {
        right.push_back(face_of(terms.tin, terms.faces, t, terms.scale));
      }
      std::size_t to = sides.first[i];
      for (const std::uint32_t t : terms.sides.triangles.row(2 * e)) {
        const Face left = face_of(terms.tin, terms.faces, t, terms.scale);
        for (const Face& other : right) sides.weights[to++] = terms.of(left, other);
      }
    }
  });
  return sides;
}

template SideWeights<1> weigh_sides(const FaceTerms<1>&, const Progress&);
template SideWeights<2> weigh_sides(const FaceTerms<2>&, const Progress&);
template SideWeights<5> weigh_sides(const FaceTerms<5>&, const Progress&);
template class FaceModeller<1>;
template class FaceModeller<2>;
template class FaceModeller<5>;

}  // namespace thalweg
