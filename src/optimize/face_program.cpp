// Labels of a face by dynamic programming over its fronts.
//
// 1. A partial triangulation covers what is left behind a front. What can follow depends on the front alone;
//    what that costs depends also on the triangles behind the front's edges, and on those at sides beyond
//    which there is another face: these are *open*, for the triangle across is not known yet. So partial
//    triangulations with the same front are compared as labels are in label_reduction.cpp: one goes if
//    another is no worse whatever lies across each open side, of all that may.
// 2. Pits: what only the one that goes joins may save a pit for each plateau that is joined, no more, for
//    each names one outlet (face_network.cpp).
// 3. Fronts are taken in the order of their numbers, so each has all that leads to it; each partial
//    triangulation that stays goes on along each arc. What stays at the empty front are the labels.
// Exact for sums of terms of triangles and of neighbouring triangles, as the program over the edges of a
// polygon in: Silveira, van Kreveld, Optimal higher order Delaunay triangulations of polygons, 2009; fronts
// take the place of edges so that vertices may lie inside, and open sides that of known neighbours.
#include "optimize/face_labels.hpp"

#include <thalweg/base/assert.hpp>

#include <algorithm>
#include <deque>
#include <numeric>
#include <utility>

namespace thalweg {

template <std::size_t Criteria>
class FaceLabeller<Criteria>::Program {
 public:
  FaceLabels<Criteria> run(const FaceModel<Criteria>& model, const FrontGraph& graph,
                           const LabelLimits& limits) {
    start(model, graph, limits);
    const std::uint32_t empty = *graph.empty_front;
    Front& first = front(0);
    first.partials.resize(1);
    first.joined.assign(words_, 0);
    auto arc = graph.arcs.begin();
    for (std::uint32_t f = 0; f < graph.front_count; ++f) {
      const bool reached = ends_[f] != 0 && at_[f] != kNone;
      if (reached) thin_out(front(f));
      for (; arc != graph.arcs.end() && arc->from == f; ++arc) {
        if (reached && ends_[arc->to] != 0) extend(front(f), arc->triangle, front(arc->to));
      }
      if (reached && f != empty) free_.push_back(at_[f]);
    }
    return gather(front(empty));
  }

 private:
  static constexpr std::uint32_t kNone = FaceGroup::kNone;
  static constexpr std::size_t kSamples = 8;
  static constexpr std::size_t kFew = 4;             // fewer are compared sooner than sampled
  static constexpr std::size_t kMostBuffers = 1024;  // kept from face to face

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
    void clear() {
      open.clear();
      partials.clear();
      places.clear();
      joined.clear();
    }
  };
  /// What a partial triangulation costs for some choices of what lies across open sides, and of plateaus that
  /// have an outlet elsewhere.
  using Samples = std::array<Cost<Criteria>, kSamples>;

  void start(const FaceModel<Criteria>& model, const FrontGraph& graph, const LabelLimits& limits) {
    model_ = &model;
    limits_ = limits;
    comparisons_ = 0;
    complete_ = true;
    words_ = (model.links.size() + 63) / 64;
    none_.assign(words_, 0);
    first_least_.assign(model.groups.size(), kNone);
    least_.clear();
    kept_.clear();
    find_nodes();
    ends_.assign(graph.front_count, 0);
    ends_[*graph.empty_front] = 1;
    std::for_each(graph.arcs.rbegin(), graph.arcs.rend(),
                  [&](const auto& arc) { ends_[arc.from] |= ends_[arc.to]; });
    THALWEG_ASSERT(ends_[0] != 0);
    at_.assign(graph.front_count, kNone);
    if (buffers_.size() > kMostBuffers) buffers_.clear();
    free_.resize(buffers_.size());
    std::iota(free_.begin(), free_.end(), 0U);
  }

  /// Of a front that is not done with.
  Front& front(std::uint32_t f) {
    if (at_[f] == kNone) {
      if (free_.empty()) {
        free_.push_back(static_cast<std::uint32_t>(buffers_.size()));
        buffers_.emplace_back();
      }
      at_[f] = free_.back();
      free_.pop_back();
      buffers_[at_[f]].clear();
    }
    return buffers_[at_[f]];
  }

  void find_nodes() {
    node_links_.clear();
    ends_of_links_.clear();
    for (std::size_t l = 0; l < model_->links.size(); ++l) {
      ends_of_links_.emplace_back(model_->links[l].first, l);
      if (model_->links[l].second != 0) ends_of_links_.emplace_back(model_->links[l].second, l);
    }
    std::sort(ends_of_links_.begin(), ends_of_links_.end());
    for (std::size_t i = 0; i < ends_of_links_.size(); ++i) {
      const auto& [node, link] = ends_of_links_[i];
      if (i == 0 || node != ends_of_links_[i - 1].first) node_links_.resize(node_links_.size() + words_, 0);
      node_links_[node_links_.size() - words_ + link / 64] |= std::uint64_t{1} << (link % 64);
    }
  }

  /// Over all that may be across the group, the least of what candidate p costs more than q.
  const Weight<Criteria>& least_excess(std::uint32_t g, std::size_t p, std::size_t q) {
    const FaceGroup& group = model_->groups[g];
    if (first_least_[g] == kNone) {
      first_least_[g] = static_cast<std::uint32_t>(least_.size());
      least_.resize(least_.size() + std::size_t{group.size} * group.size);
      for (std::size_t one = 0; one < group.size; ++one) {
        for (std::size_t other = 0; other < group.size; ++other) {
          if (one != other) least_[first_least_[g] + one * group.size + other] = excess(group, one, other);
        }
      }
    }
    return least_[first_least_[g] + p * group.size + q];
  }

  [[nodiscard]] Weight<Criteria> excess(const FaceGroup& group, std::size_t p, std::size_t q) const {
    Weight<Criteria> least{};
    for (std::size_t x = 0; x < group.size_across; ++x) {
      Weight<Criteria> difference = model_->weight(group, p, x);
      const Weight<Criteria>& other = model_->weight(group, q, x);
      for (std::size_t level = 0; level < Criteria; ++level) difference[level] -= other[level];
      least = x == 0 ? difference : std::min(least, difference);
    }
    return least;
  }

  /// Whether the first is no worse than the second, whatever follows and whatever is chosen in other faces.
  [[nodiscard]] bool replaces(const Front& front, std::size_t better, std::size_t worse) {
    const std::size_t sides = front.open.size();
    Cost<Criteria> excess = front.partials[worse].cost - front.partials[better].cost;
    for (std::size_t i = 0; i < sides; ++i) {
      const std::size_t p = front.places[worse * sides + i], q = front.places[better * sides + i];
      if (p != q) add(excess, least_excess(front.open[i], p, q));
    }
    if (words_ > 0) {
      excess.level[*model_->terms->pit_level] -=
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

  [[nodiscard]] Cost<Criteria> sample(const Front& front, std::size_t i, std::size_t c) const {
    Cost<Criteria> cost = front.partials[i].cost;
    const std::size_t sides = front.open.size();
    for (std::size_t s = 0; s < sides; ++s) {
      const FaceGroup& group = model_->groups[front.open[s]];
      add(cost, model_->weight(group, front.places[i * sides + s], (c + c * s) % group.size_across));
    }
    if (words_ > 0 && c % 2 == 0)
      cost.level[*model_->terms->pit_level] -= count_lost(&front.joined[i * words_], none_.data());
    return cost;
  }

  /// Drops what others replace; those that stay are ranked by what they cost in one sample.
  void thin_out(Front& front) {
    stays_.clear();
    if (front.partials.size() == 1) {
      stays_.push_back(0);
    } else {
      rank(front);
      for (const std::uint32_t i : ranked_) {
        comparisons_ += stays_.size();
        if (std::any_of(stays_.begin(), stays_.end(),
                        [&](std::uint32_t j) { return is_replaced(front, i, j); })) {
          continue;
        }
        if (comparisons_ > limits_.most_comparisons && stays_.size() >= limits_.few_labels) {
          complete_ = false;
          break;
        }
        stays_.push_back(i);
      }
      keep(front);
    }
    for (Partial& partial : front.partials) {
      kept_.push_back({partial.before, partial.triangle});
      partial.before = static_cast<std::uint32_t>(kept_.size() - 1);
    }
  }

  void rank(const Front& front) {
    const std::size_t count = front.partials.size();
    samples_.resize(count);
    ranked_.resize(count);
    for (std::uint32_t i = 0; i < count; ++i) {
      ranked_[i] = i;
      for (std::size_t c = 0; c < (count <= kFew ? 1 : kSamples); ++c) samples_[i][c] = sample(front, i, c);
    }
    std::sort(ranked_.begin(), ranked_.end(), [&](std::uint32_t i, std::uint32_t j) {
      return samples_[i][0] == samples_[j][0] ? i < j : samples_[i][0] < samples_[j][0];
    });
  }

  [[nodiscard]] bool is_replaced(const Front& front, std::uint32_t worse, std::uint32_t better) {
    for (std::size_t c = 1; c < kSamples && front.partials.size() > kFew; ++c) {
      if (samples_[worse][c] < samples_[better][c]) return false;
    }
    return replaces(front, better, worse);
  }

  /// Those that stay, in their order.
  void keep(Front& front) {
    const std::size_t sides = front.open.size();
    thinned_.clear();
    thinned_.open.swap(front.open);
    for (const std::uint32_t i : stays_) {
      const auto first = front.places.begin() + static_cast<std::ptrdiff_t>(i * sides);
      thinned_.places.insert(thinned_.places.end(), first, first + static_cast<std::ptrdiff_t>(sides));
      const auto bits = front.joined.begin() + static_cast<std::ptrdiff_t>(i * words_);
      thinned_.joined.insert(thinned_.joined.end(), bits, bits + static_cast<std::ptrdiff_t>(words_));
      thinned_.partials.push_back(front.partials[i]);
    }
    std::swap(front, thinned_);
  }

  struct Closing {
    const FaceGroup* group;
    std::size_t here, at;  ///< the candidate; where the open group across is
  };
  /// What an open side has: of the front that is extended, or of the new triangle.
  struct Source {
    bool fresh = false;
    std::uint16_t at = 0;  ///< where it is open there, or the triangle's place
  };

  /// What a triangle closes and opens; returns its cost.
  Cost<Criteria> place(const Front& from, std::uint32_t triangle) {
    Cost<Criteria> cost;
    add(cost, model_->own[triangle]);
    closing_.clear();
    joining_.assign(words_, 0);
    open_.clear();
    source_.clear();
    for (std::size_t i = 0; i < from.open.size(); ++i) {
      open_.push_back(from.open[i]);
      source_.push_back({false, static_cast<std::uint16_t>(i)});
    }
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t g = model_->group[triangle][corner];
      const FaceGroup& group = model_->groups[g];
      if (group.size_across == 0) continue;
      const std::uint16_t here = model_->place[triangle][corner];
      const auto across = group.opposite == kNone
                              ? from.open.end()
                              : std::lower_bound(from.open.begin(), from.open.end(), group.opposite);
      if (across != from.open.end() && *across == group.opposite) {
        closing_.push_back({&group, here, static_cast<std::size_t>(across - from.open.begin())});
        const auto at = std::find(open_.begin(), open_.end(), group.opposite);
        source_.erase(source_.begin() + (at - open_.begin()));
        open_.erase(at);
        continue;
      }
      const auto at = std::lower_bound(open_.begin(), open_.end(), g);
      source_.insert(source_.begin() + (at - open_.begin()), {true, here});
      open_.insert(at, g);
      if (group.opposite == kNone) continue;
      const std::uint32_t edge = group.side / 2;
      cost.level[Criteria] += model_->terms->faces.edges[edge].ground.valid() ? 0 : 1;
      cost.level[Criteria + 1] += model_->terms->sides.tie(edge);
      if (group.link != kNone) joining_[group.link / 64] |= std::uint64_t{1} << (group.link % 64);
    }
    return cost;
  }

  void extend(const Front& front, std::uint32_t triangle, Front& to) {
    const Cost<Criteria> cost = place(front, triangle);
    THALWEG_ASSERT(to.partials.empty() || to.open == open_);
    to.open.assign(open_.begin(), open_.end());
    const std::size_t sides = front.open.size();
    for (std::size_t i = 0; i < front.partials.size(); ++i) {
      to.partials.push_back({front.partials[i].cost, front.partials[i].before, triangle});
      Partial& next = to.partials.back();
      next.cost += cost;
      for (const Closing& c : closing_)
        add(next.cost, model_->weight(*c.group, c.here, front.places[i * sides + c.at]));
      for (const auto& [fresh, at] : source_) to.places.push_back(fresh ? at : front.places[i * sides + at]);
      for (std::size_t w = 0; w < words_; ++w)
        to.joined.push_back(front.joined[i * words_ + w] | joining_[w]);
    }
  }

  FaceLabels<Criteria> gather(const Front& last) {
    FaceLabels<Criteria> labels;
    labels.complete = complete_;
    const std::size_t sides = last.open.size(), count = last.partials.size();
    THALWEG_ASSERT(last.open == model_->coupled);
    labels.link = model_->links;
    labels.at_side.resize(sides * count);
    labels.joins.resize(model_->links.size() * count);
    labels.unary.reserve(count);
    labels.side.reserve(sides);
    for (const std::uint32_t g : last.open) labels.side.push_back(model_->groups[g].side);
    for (std::size_t i = 0; i < count; ++i) {
      labels.unary.push_back(last.partials[i].cost);
      row_.clear();
      for (std::uint32_t at = last.partials[i].before; kept_[at].triangle != kNone; at = kept_[at].before) {
        row_.push_back(model_->triangles[kept_[at].triangle]);
      }
      std::sort(row_.begin(), row_.end());
      FaceTriangulations& all = labels.triangulations;
      all.size = static_cast<std::uint32_t>(row_.size());
      if (i == 0) all.triangles.reserve(count * row_.size());
      all.triangles.insert(all.triangles.end(), row_.begin(), row_.end());
      for (std::size_t s = 0; s < sides; ++s) labels.at_side[s * count + i] = last.places[i * sides + s];
      for (std::size_t l = 0; l < labels.link.size(); ++l) {
        labels.joins[l * count + i] = last.joined[i * words_ + l / 64] >> (l % 64) & 1U;
      }
    }
    return labels;
  }

  struct Kept {
    std::uint32_t before, triangle;
  };

  const FaceModel<Criteria>* model_ = nullptr;
  LabelLimits limits_;
  std::size_t words_ = 0;                  ///< of the bits of links
  std::vector<std::uint64_t> none_;        ///< bits of no link
  std::vector<std::uint64_t> node_links_;  ///< by plateau: bits of its links
  std::vector<std::pair<std::uint32_t, std::size_t>> ends_of_links_;
  std::vector<std::uint32_t>
      first_least_;                      ///< by group: where its part of least_ starts, once it is asked for
  std::vector<Weight<Criteria>> least_;  ///< [p * size + q], as least_excess
  std::vector<std::uint8_t> ends_;       ///< by front: 1 if the empty one can follow
  std::vector<std::uint32_t> at_;        ///< by front: its buffer
  std::deque<Front> buffers_;
  std::vector<std::uint32_t> free_;  ///< buffers
  std::vector<Kept> kept_;
  std::size_t comparisons_ = 0;
  bool complete_ = true;
  // Of one step.
  std::vector<Samples> samples_;
  std::vector<std::uint32_t> ranked_, stays_, open_, row_;
  Front thinned_;
  std::vector<Closing> closing_;
  std::vector<Source> source_;
  std::vector<std::uint64_t> joining_;
};

template <std::size_t Criteria>
FaceLabeller<Criteria>::FaceLabeller() : program_(std::make_unique<Program>()) {}
template <std::size_t Criteria>
FaceLabeller<Criteria>::~FaceLabeller() = default;

template <std::size_t Criteria>
FaceLabels<Criteria> FaceLabeller<Criteria>::label(const FaceModel<Criteria>& model, const FrontGraph& graph,
                                                   const LabelLimits& limits) {
  return program_->run(model, graph, limits);
}

/// Rows of one list and of another, each with its own length, joined row by row.
template <class T>
static std::vector<T> rows_joined(const std::vector<T>& one, const std::vector<T>& other, std::size_t rows) {
  std::vector<T> joined;
  joined.reserve(one.size() + other.size());
  for (std::size_t row = 0; row < rows; ++row) {
    for (const std::vector<T>* part : {&one, &other}) {
      const auto length = static_cast<std::ptrdiff_t>(part->size() / rows);
      const auto first = part->begin() + static_cast<std::ptrdiff_t>(row) * length;
      joined.insert(joined.end(), first, first + length);
    }
  }
  return joined;
}

template <std::size_t Criteria>
void add_labels(const FaceLabels<Criteria>& more, FaceLabels<Criteria>& labels) {
  const auto append = [](const auto& from, auto& to) { to.insert(to.end(), from.begin(), from.end()); };
  append(more.triangulations.triangles, labels.triangulations.triangles);
  append(more.unary, labels.unary);
  labels.at_side = rows_joined(labels.at_side, more.at_side, labels.side.size());
  labels.joins = rows_joined(labels.joins, more.joins, labels.link.size());
}

template <std::size_t Criteria>
void note_possible(const FaceSides& sides, const std::vector<FaceLabels<Criteria>>& faces,
                   SideWeights<Criteria>& weights) {
  for (const FaceLabels<Criteria>& labels : faces) {
    if (!labels.complete) continue;
    for (std::size_t s = 0; s < labels.side.size(); ++s) {
      const std::uint32_t first = sides.triangles.first[labels.side[s]];
      std::fill_n(weights.possible.begin() + first, sides.triangles.row(labels.side[s]).size(), 0);
      for (const std::uint16_t place : labels.places(s)) weights.possible[first + place] = 1;
    }
  }
}

template void add_labels(const FaceLabels<1>&, FaceLabels<1>&);
template void add_labels(const FaceLabels<2>&, FaceLabels<2>&);
template void add_labels(const FaceLabels<5>&, FaceLabels<5>&);
template void note_possible(const FaceSides&, const std::vector<FaceLabels<1>>&, SideWeights<1>&);
template void note_possible(const FaceSides&, const std::vector<FaceLabels<2>>&, SideWeights<2>&);
template void note_possible(const FaceSides&, const std::vector<FaceLabels<5>>&, SideWeights<5>&);
template class FaceLabeller<1>;
template class FaceLabeller<2>;
template class FaceLabeller<5>;

}  // namespace thalweg
