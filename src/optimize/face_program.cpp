// Labels of a face by dynamic programming over its fronts.
//
// 1. A partial triangulation covers what is left behind a front. What can follow depends on the front alone;
//    what that costs depends also on the triangles behind the front's edges, and on those at sides beyond
//    which there is another face: these are *open*, for the triangle across is not known yet. So partial
//    triangulations with the same front are compared as labels are in label_reduction.cpp: one goes if
//    another is no worse whatever lies across each open side, of all that may.
// 2. Pits: what only the one that goes joins may save a pit for each plateau that is joined, no more, for
// each
//    names one outlet (face_network.cpp).
// 3. Fronts are taken in the order of their numbers, so each has all that leads to it; each partial
//    triangulation that stays goes on along each arc. What stays at the empty front are the labels.
// Exact for sums of terms of triangles and of neighbouring triangles, as the program over the edges of a
// polygon in: Silveira, van Kreveld, Optimal higher order Delaunay triangulations of polygons, 2009; fronts
// take the place of edges so that vertices may lie inside, and open sides that of known neighbours.
#include "optimize/face_labels.hpp"

#include <thalweg/base/assert.hpp>

#include <algorithm>
#include <numeric>
#include <utility>

namespace thalweg {

namespace {

template <std::size_t Criteria>
class FaceProgram {
 public:
  FaceProgram(const FaceModel<Criteria>& model, const FrontGraph& graph, const LabelLimits& limits)
      : model_(model),
        graph_(graph),
        limits_(limits),
        words_((model.links.size() + 63) / 64),
        none_(words_, 0),
        least_(model.groups.size()),
        fronts_(graph.front_count) {
    find_nodes();
    ends_.assign(graph.front_count, 0);
    ends_[*graph.empty_front] = 1;
    std::for_each(graph.arcs.rbegin(), graph.arcs.rend(),
                  [&](const auto& arc) { ends_[arc.from] |= ends_[arc.to]; });
  }

  FaceLabels<Criteria> run() {
    THALWEG_ASSERT(ends_[0] != 0);
    fronts_[0].partials.resize(1);
    fronts_[0].joined.assign(words_, 0);
    auto arc = graph_.arcs.begin();
    for (std::uint32_t f = 0; f < graph_.front_count; ++f) {
      if (ends_[f] != 0 && !fronts_[f].partials.empty()) thin_out(fronts_[f]);
      for (; arc != graph_.arcs.end() && arc->from == f; ++arc) {
        if (ends_[arc->to] != 0) extend(fronts_[f], arc->triangle, fronts_[arc->to]);
      }
      if (f != *graph_.empty_front) fronts_[f] = {};
    }
    return gather(fronts_[*graph_.empty_front]);
  }

 private:
  static constexpr std::uint32_t kNone = FaceGroup::kNone;
  static constexpr std::size_t kSamples = 8;

  struct Partial {
    Cost<Criteria> cost;
    std::uint32_t before = kNone;    ///< of kept_; at the front itself: the one that it comes from
    std::uint32_t triangle = kNone;  ///< the last one
  };
  struct Front {
    std::vector<std::uint32_t> open;  ///< groups, ascending
    std::vector<Partial> partials;
    std::vector<std::uint16_t> places;  ///< by partial: of each open group the candidate that it has
    std::vector<std::uint64_t> joined;  ///< by partial: bits of links
  };

  void find_nodes() {
    std::vector<std::pair<std::uint32_t, std::size_t>> ends;
    for (std::size_t l = 0; l < model_.links.size(); ++l) {
      ends.emplace_back(model_.links[l].first, l);
      if (model_.links[l].second != 0) ends.emplace_back(model_.links[l].second, l);
    }
    std::sort(ends.begin(), ends.end());
    for (std::size_t i = 0; i < ends.size(); ++i) {
      if (i == 0 || ends[i].first != ends[i - 1].first) node_links_.resize(node_links_.size() + words_, 0);
      node_links_[node_links_.size() - words_ + ends[i].second / 64] |= std::uint64_t{1}
                                                                        << (ends[i].second % 64);
    }
  }

  void compare_candidates(std::uint32_t g) {
    if (!least_[g].empty()) return;
    const FaceGroup& group = model_.groups[g];
    least_[g].resize(std::size_t{group.size} * group.size);
    for (std::size_t p = 0; p < group.size; ++p) {
      for (std::size_t x = 0; x < group.size_across; ++x) {
        const Weight<Criteria>& weight = model_.weight(group, p, x);
        for (std::size_t q = 0; q < group.size; ++q) {
          Weight<Criteria> difference = weight;
          const Weight<Criteria>& other = model_.weight(group, q, x);
          for (std::size_t level = 0; level < Criteria; ++level) difference[level] -= other[level];
          Weight<Criteria>& least = least_[g][p * group.size + q];
          least = x == 0 ? difference : std::min(least, difference);
        }
      }
    }
  }

  /// Whether the first is no worse than the second, whatever follows and whatever is chosen in other faces.
  [[nodiscard]] bool replaces(const Front& front, std::size_t better, std::size_t worse) const {
    const std::size_t sides = front.open.size();
    Cost<Criteria> excess = front.partials[worse].cost - front.partials[better].cost;
    for (std::size_t i = 0; i < sides; ++i) {
      const std::size_t p = front.places[worse * sides + i], q = front.places[better * sides + i];
      if (p == q) continue;
      const std::uint32_t g = front.open[i];
      add(excess, least_[g][p * model_.groups[g].size + q]);
    }
    if (words_ > 0) {
      excess.level[*model_.terms->pit_level] -=
          count_lost(&front.joined[worse * words_], &front.joined[better * words_]);
    }
    return !(excess < Cost<Criteria>{});
  }

  /// Plateaus that one joins by a link that the other does not have.
  [[nodiscard]] std::int64_t count_lost(const std::uint64_t* has, const std::uint64_t* lacks) const {
    std::uint64_t any = 0;
    for (std::size_t w = 0; w < words_; ++w) any |= has[w] & ~lacks[w];
    if (any == 0) return 0;
    std::int64_t count = 0;
    for (std::size_t n = 0; n < node_links_.size(); n += words_) {
      std::uint64_t lost = 0;
      for (std::size_t w = 0; w < words_; ++w) lost |= has[w] & ~lacks[w] & node_links_[n + w];
      count += lost != 0 ? 1 : 0;
    }
    return count;
  }

  /// What a partial triangulation costs for some choices of what lies across open sides, and of plateaus that
  /// have an outlet elsewhere.
  using Samples = std::array<Cost<Criteria>, kSamples>;

  [[nodiscard]] Samples samples_of(const Front& front, std::size_t i) const {
    Samples samples;
    const std::size_t sides = front.open.size();
    for (std::size_t c = 0; c < kSamples; ++c) {
      samples[c] = front.partials[i].cost;
      for (std::size_t s = 0; s < sides; ++s) {
        const FaceGroup& group = model_.groups[front.open[s]];
        add(samples[c], model_.weight(group, front.places[i * sides + s], (c + c * s) % group.size_across));
      }
      if (words_ > 0 && c % 2 == 0)
        samples[c].level[*model_.terms->pit_level] -= count_lost(&front.joined[i * words_], none_.data());
    }
    return samples;
  }

  /// Drops what others replace; those that stay are ranked by what they cost in one sample.
  void thin_out(Front& front) {
    const std::size_t count = front.partials.size(), sides = front.open.size();
    for (const std::uint32_t g : front.open) compare_candidates(g);
    std::vector<Samples> samples;
    std::vector<std::uint32_t> ranked(count), stays;
    for (std::uint32_t i = 0; i < count; ++i) {
      ranked[i] = i;
      samples.push_back(samples_of(front, i));
    }
    std::sort(ranked.begin(), ranked.end(), [&](std::uint32_t i, std::uint32_t j) {
      return samples[i][0] == samples[j][0] ? i < j : samples[i][0] < samples[j][0];
    });
    for (const std::uint32_t i : ranked) {
      const auto is_replaced_by = [&](std::uint32_t j) {
        for (std::size_t c = 1; c < kSamples; ++c) {
          if (samples[i][c] < samples[j][c]) return false;
        }
        return replaces(front, j, i);
      };
      comparisons_ += stays.size();
      if (std::any_of(stays.begin(), stays.end(), is_replaced_by)) continue;
      if (comparisons_ > limits_.most_comparisons && stays.size() >= limits_.few_labels) {
        complete_ = false;
        break;
      }
      stays.push_back(i);
    }
    Front thinned{.open = std::move(front.open), .partials = {}, .places = {}, .joined = {}};
    for (const std::uint32_t i : stays) {
      const auto first = front.places.begin() + static_cast<std::ptrdiff_t>(i * sides);
      thinned.places.insert(thinned.places.end(), first, first + static_cast<std::ptrdiff_t>(sides));
      const auto bits = front.joined.begin() + static_cast<std::ptrdiff_t>(i * words_);
      thinned.joined.insert(thinned.joined.end(), bits, bits + static_cast<std::ptrdiff_t>(words_));
      thinned.partials.push_back(front.partials[i]);
      kept_.push_back({front.partials[i].before, front.partials[i].triangle});
      thinned.partials.back().before = static_cast<std::uint32_t>(kept_.size() - 1);
    }
    front = std::move(thinned);
  }

  void extend(const Front& front, std::uint32_t triangle, Front& to) {
    Cost<Criteria> cost;
    add(cost, model_.own[triangle]);
    std::vector<std::uint32_t> open = front.open;
    std::vector<std::uint64_t> joined(words_, 0);
    struct Closing {
      const FaceGroup* group;
      std::size_t here, at;  ///< the candidate; where the open group across is
    };
    std::vector<Closing> closing;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t g = model_.group[triangle][corner];
      const FaceGroup& group = model_.groups[g];
      if (group.size_across == 0) continue;
      const auto across = std::lower_bound(front.open.begin(), front.open.end(), group.opposite);
      if (group.opposite != kNone && across != front.open.end() && *across == group.opposite) {
        closing.push_back(
            {&group, model_.place[triangle][corner], static_cast<std::size_t>(across - front.open.begin())});
        open.erase(std::find(open.begin(), open.end(), group.opposite));
        continue;
      }
      open.insert(std::lower_bound(open.begin(), open.end(), g), g);
      if (group.opposite == kNone) continue;
      const std::uint32_t edge = group.side / 2;
      cost.level[Criteria] += model_.terms->faces.edges[edge].ground.valid() ? 0 : 1;
      cost.level[Criteria + 1] += model_.terms->sides.tie[edge];
      if (group.link != kNone) joined[group.link / 64] |= std::uint64_t{1} << (group.link % 64);
    }
    // For each open side where it was, or the new triangle's candidate.
    std::vector<std::pair<std::size_t, std::uint16_t>> source;
    for (const std::uint32_t g : open) {
      const auto at = std::lower_bound(front.open.begin(), front.open.end(), g);
      if (at != front.open.end() && *at == g) {
        source.emplace_back(at - front.open.begin(), 0);
        continue;
      }
      const auto corner = std::find(model_.group[triangle].begin(), model_.group[triangle].end(), g) -
                          model_.group[triangle].begin();
      source.emplace_back(front.open.size(), model_.place[triangle][static_cast<std::size_t>(corner)]);
    }
    THALWEG_ASSERT(to.partials.empty() || to.open == open);
    const std::size_t sides = front.open.size();
    for (std::size_t i = 0; i < front.partials.size(); ++i) {
      Partial next{front.partials[i].cost, front.partials[i].before, triangle};
      next.cost += cost;
      for (const Closing& c : closing)
        add(next.cost, model_.weight(*c.group, c.here, front.places[i * sides + c.at]));
      to.partials.push_back(next);
      for (const auto& [at, place] : source)
        to.places.push_back(at < sides ? front.places[i * sides + at] : place);
      for (std::size_t w = 0; w < words_; ++w) to.joined.push_back(front.joined[i * words_ + w] | joined[w]);
    }
    to.open = std::move(open);
  }

  FaceLabels<Criteria> gather(const Front& last) const {
    FaceLabels<Criteria> labels;
    labels.complete = complete_;
    const std::size_t sides = last.open.size();
    THALWEG_ASSERT(last.open == model_.coupled);
    labels.link = model_.links;
    labels.at_side.resize(sides);
    labels.joins.resize(model_.links.size());
    for (const std::uint32_t g : last.open) labels.side.push_back(model_.groups[g].side);
    for (std::size_t i = 0; i < last.partials.size(); ++i) {
      labels.unary.push_back(last.partials[i].cost);
      std::vector<std::uint32_t> row;
      for (std::uint32_t at = last.partials[i].before; kept_[at].triangle != kNone; at = kept_[at].before) {
        row.push_back(model_.triangles[kept_[at].triangle]);
      }
      std::sort(row.begin(), row.end());
      labels.triangulations.size = static_cast<std::uint32_t>(row.size());
      labels.triangulations.triangles.insert(labels.triangulations.triangles.end(), row.begin(), row.end());
      for (std::size_t s = 0; s < sides; ++s) labels.at_side[s].push_back(last.places[i * sides + s]);
      for (std::size_t l = 0; l < labels.joins.size(); ++l) {
        labels.joins[l].push_back(last.joined[i * words_ + l / 64] >> (l % 64) & 1U);
      }
    }
    return labels;
  }

  struct Kept {
    std::uint32_t before, triangle;
  };

  const FaceModel<Criteria>& model_;
  const FrontGraph& graph_;
  LabelLimits limits_;
  std::size_t words_;                                 ///< of the bits of links
  std::vector<std::uint64_t> none_;                   ///< bits of no link
  std::vector<std::uint64_t> node_links_;             ///< by plateau: bits of its links
  std::vector<std::vector<Weight<Criteria>>> least_;  ///< by group: [p * size + q], min over what is across
                                                      ///< of what p costs more than q
  std::vector<std::uint8_t> ends_;                    ///< by front: 1 if the empty one can follow
  std::vector<Front> fronts_;
  std::vector<Kept> kept_;
  std::size_t comparisons_ = 0;
  bool complete_ = true;
};

}  // namespace

template <std::size_t Criteria>
FaceLabels<Criteria> label_face(const FaceModel<Criteria>& model, const FrontGraph& graph,
                                const LabelLimits& limits) {
  return FaceProgram<Criteria>(model, graph, limits).run();
}

template <std::size_t Criteria>
void add_labels(const FaceLabels<Criteria>& more, FaceLabels<Criteria>& labels) {
  const auto append = [](const auto& from, auto& to) { to.insert(to.end(), from.begin(), from.end()); };
  append(more.triangulations.triangles, labels.triangulations.triangles);
  append(more.unary, labels.unary);
  for (std::size_t s = 0; s < labels.side.size(); ++s) append(more.at_side[s], labels.at_side[s]);
  for (std::size_t l = 0; l < labels.link.size(); ++l) append(more.joins[l], labels.joins[l]);
}

template <std::size_t Criteria>
void note_possible(const FaceSides& sides, const std::vector<FaceLabels<Criteria>>& faces,
                   SideWeights<Criteria>& weights) {
  for (const FaceLabels<Criteria>& labels : faces) {
    if (!labels.complete) continue;
    for (std::size_t s = 0; s < labels.side.size(); ++s) {
      const std::uint32_t first = sides.triangles.first[labels.side[s]];
      std::fill_n(weights.possible.begin() + first, sides.triangles.row(labels.side[s]).size(), 0);
      for (const std::uint16_t place : labels.at_side[s]) weights.possible[first + place] = 1;
    }
  }
}

template void add_labels(const FaceLabels<1>&, FaceLabels<1>&);
template void add_labels(const FaceLabels<2>&, FaceLabels<2>&);
template void add_labels(const FaceLabels<5>&, FaceLabels<5>&);
template void note_possible(const FaceSides&, const std::vector<FaceLabels<1>>&, SideWeights<1>&);
template void note_possible(const FaceSides&, const std::vector<FaceLabels<2>>&, SideWeights<2>&);
template void note_possible(const FaceSides&, const std::vector<FaceLabels<5>>&, SideWeights<5>&);
template FaceLabels<1> label_face(const FaceModel<1>&, const FrontGraph&, const LabelLimits&);
template FaceLabels<2> label_face(const FaceModel<2>&, const FrontGraph&, const LabelLimits&);
template FaceLabels<5> label_face(const FaceModel<5>&, const FrontGraph&, const LabelLimits&);

}  // namespace thalweg
