// Dead-end elimination with many labels.
//
// 1. Label i of a variable goes if there is a label j with
//        unary(i) - unary(j) + sum over its terms of min over what stays across (w(i, x) - w(j, x)) >= 0.
//    The minimum depends on the classes of i and j alone. Costs are compared lexicographically; the minimum
//    of a sum of vectors is no less than the sum of minima in any ordered group. Based on: Goldstein,
//    Efficient rotamer elimination applied to protein side-chains, 1994.
// 2. In a round all variables whose neighbours lost labels are examined, each against the labels that stay
//    when the round starts. What is lost in a round may be lost together: take an optimum, and replace the
//    lost label of one variable after the other; no step makes it worse, whatever the labels of the others
//    are.
// 3. With many labels not all pairs are tried: j is one of those that are best if each term took its least.
// 4. Then a term over a pair of variables is written as a function of one label, one of the other and a rest;
//    where the rest is zero the pair is not coupled.
#include "optimize/label_reduction.hpp"

#include "base/parallel.hpp"
#include "base/union_find.hpp"

#include <algorithm>
#include <atomic>
#include <numeric>

namespace thalweg {

namespace {

constexpr std::size_t kBlock = 256;
constexpr std::size_t kAllPairs = 40;
constexpr std::size_t kFavourites = 16;
constexpr int kRounds = 100;

template <std::size_t Criteria>
Weight<Criteria> minus(const Weight<Criteria>& a, const Weight<Criteria>& b) {
  Weight<Criteria> difference;
  for (std::size_t i = 0; i < Criteria; ++i) difference[i] = a[i] - b[i];
  return difference;
}

template <std::size_t Criteria>
class Reducer {
 public:
  Reducer(const LabelNetwork<Criteria>& network, const Progress& progress)
      : network_(network), progress_(progress), rows_(pair_terms_by_variable(network)) {}

  std::vector<std::uint8_t> run() {
    const std::size_t count = network_.size();
    stays_.assign(network_.unary.size(), 1);
    first_class_.assign(network_.pairs.size() + 1, 0);
    for (std::size_t c = 0; c < network_.pairs.size(); ++c) {
      const PairTerm& pair = network_.pairs[c];
      first_class_[c + 1] = first_class_[c] + pair.classes_a + pair.classes_b;
    }
    class_stays_.assign(first_class_.back(), 0);
    for_each_block(count, kBlock, progress_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) mark_classes(v);
    });
    std::vector<std::uint32_t> turn(count);
    std::iota(turn.begin(), turn.end(), 0U);
    for (int round = 0; round < kRounds && !turn.empty(); ++round) turn = run_round(turn);
    return std::move(stays_);
  }

 private:
  /// Examines the variables; returns those beside a variable that lost labels.
  std::vector<std::uint32_t> run_round(const std::vector<std::uint32_t>& turn) {
    std::vector<std::vector<std::uint32_t>> lost(turn.size());
    for_each_block(turn.size(), kBlock, progress_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) lost[i] = examine(turn[i]);
    });
    std::vector<std::uint32_t> changed;
    for (std::size_t i = 0; i < turn.size(); ++i) {
      for (const std::uint32_t label : lost[i]) stays_[label] = 0;
      if (!lost[i].empty()) changed.push_back(turn[i]);
    }
    for_each_block(changed.size(), kBlock, progress_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) mark_classes(changed[i]);
    });
    std::vector<std::uint32_t> next;
    for (const std::uint32_t v : changed) {
      for (const std::uint32_t c : row(v)) {
        next.push_back(network_.pairs[c].a == v ? network_.pairs[c].b : network_.pairs[c].a);
      }
    }
    std::sort(next.begin(), next.end());
    next.erase(std::unique(next.begin(), next.end()), next.end());
    return next;
  }

  [[nodiscard]] std::span<const std::uint32_t> row(std::size_t v) const {
    return std::span(rows_.item).subspan(rows_.first[v], rows_.first[v + 1] - rows_.first[v]);
  }

  void mark_classes(std::size_t v) {
    for (const std::uint32_t c : row(v)) {
      const PairTerm& pair = network_.pairs[c];
      const bool is_a = pair.a == v;
      const std::size_t from = first_class_[c] + (is_a ? 0 : pair.classes_a);
      const std::size_t classes = is_a ? pair.class_a : pair.class_b;
      std::fill_n(class_stays_.begin() + static_cast<std::ptrdiff_t>(from),
                  is_a ? pair.classes_a : pair.classes_b, 0);
      for (std::size_t i = 0; i < network_.label_count(v); ++i) {
        if (stays_[network_.first_label[v] + i] != 0) class_stays_[from + network_.classes[classes + i]] = 1;
      }
    }
  }

  /// A term as one of its variables sees it.
  struct View {
    std::size_t classes = 0;               ///< of the variable's labels
    std::size_t count = 0;                 ///< classes of the variable
    std::vector<Weight<Criteria>> least;   ///< [p * count + q]: min over what stays of w(p, x) - w(q, x)
    std::vector<Weight<Criteria>> lowest;  ///< min over what stays of w(p, x)
  };

  [[nodiscard]] View view(std::size_t v, std::uint32_t c) const {
    const PairTerm& pair = network_.pairs[c];
    const bool is_a = pair.a == v;
    View view;
    view.classes = is_a ? pair.class_a : pair.class_b;
    view.count = is_a ? pair.classes_a : pair.classes_b;
    const std::size_t across = is_a ? pair.classes_b : pair.classes_a;
    const std::size_t mine = first_class_[c] + (is_a ? 0 : pair.classes_a);
    const std::size_t theirs = first_class_[c] + (is_a ? pair.classes_a : 0);
    const auto weight = [&](std::size_t p, std::size_t x) -> const Weight<Criteria>& {
      return network_.weights[pair.weight + (is_a ? p * across + x : x * view.count + p)];
    };
    view.least.resize(view.count * view.count);
    view.lowest.resize(view.count);
    for (std::size_t p = 0; p < view.count; ++p) {
      if (class_stays_[mine + p] == 0) continue;
      bool first = true;
      for (std::size_t x = 0; x < across; ++x) {
        if (class_stays_[theirs + x] == 0) continue;
        view.lowest[p] = first ? weight(p, x) : std::min(view.lowest[p], weight(p, x));
        for (std::size_t q = 0; q < view.count; ++q) {
          if (class_stays_[mine + q] == 0) continue;
          Weight<Criteria>& least = view.least[p * view.count + q];
          const Weight<Criteria> difference = minus<Criteria>(weight(p, x), weight(q, x));
          least = first ? difference : std::min(least, difference);
        }
        first = false;
      }
    }
    return view;
  }

  /// Labels that v loses.
  [[nodiscard]] std::vector<std::uint32_t> examine(std::size_t v) const {
    std::vector<std::uint32_t> open, lost;
    const std::uint32_t begin = network_.first_label[v];
    for (std::uint32_t i = 0; i < network_.label_count(v); ++i) {
      if (stays_[begin + i] != 0) open.push_back(i);
    }
    if (open.size() < 2) return lost;
    std::vector<View> views;
    for (const std::uint32_t c : row(v)) views.push_back(view(v, c));
    const std::vector<std::uint32_t> rivals = favourites(open, begin, views);
    std::vector<std::uint8_t> gone(network_.label_count(v), 0);
    for (const std::uint32_t j : rivals) {
      if (gone[j] != 0) continue;
      for (const std::uint32_t i : open) {
        if (i == j || gone[i] != 0) continue;
        Cost<Criteria> excess = network_.unary[begin + i] - network_.unary[begin + j];
        for (const View& view : views) {
          const std::size_t p = network_.classes[view.classes + i], q = network_.classes[view.classes + j];
          if (p != q) add(excess, view.least[p * view.count + q]);
        }
        if (excess < Cost<Criteria>{}) continue;
        gone[i] = 1;
        lost.push_back(begin + i);
      }
    }
    return lost;
  }

  [[nodiscard]] std::vector<std::uint32_t> favourites(const std::vector<std::uint32_t>& open,
                                                      std::uint32_t begin,
                                                      const std::vector<View>& views) const {
    if (open.size() <= kAllPairs) return open;
    std::vector<std::pair<Cost<Criteria>, std::uint32_t>> ranked;
    for (const std::uint32_t i : open) {
      Cost<Criteria> least = network_.unary[begin + i];
      for (const View& view : views) add(least, view.lowest[network_.classes[view.classes + i]]);
      ranked.emplace_back(least, i);
    }
    std::partial_sort(ranked.begin(), ranked.begin() + kFavourites, ranked.end(),
                      [](const auto& a, const auto& b) {
                        return a.first == b.first ? a.second < b.second : a.first < b.first;
                      });
    std::vector<std::uint32_t> best;
    for (std::size_t i = 0; i < kFavourites; ++i) best.push_back(ranked[i].second);
    return best;
  }

  const LabelNetwork<Criteria>& network_;
  const Progress& progress_;
  PairTermRows rows_;
  std::vector<std::uint8_t> stays_;       ///< by label
  std::vector<std::size_t> first_class_;  ///< by pair: where its classes are in class_stays_, a's first
  std::vector<std::uint8_t> class_stays_;
};

/// A term over the labels that stay, without what one label alone decides.
template <std::size_t Criteria>
class Rest {
 public:
  Rest(const LabelNetwork<Criteria>& network, const PairTerm& pair, std::span<const std::uint32_t> of_a,
       std::span<const std::uint32_t> of_b)
      : base_(network.weight(pair, of_a[0], of_b[0])) {
    for (const std::uint32_t i : of_a)
      by_a_.push_back(minus<Criteria>(network.weight(pair, i, of_b[0]), base_));
    for (const std::uint32_t j : of_b) by_b_.push_back(network.weight(pair, of_a[0], j));
    for (std::size_t i = 0; i < of_a.size() && !couples_; ++i) {
      for (std::size_t j = 0; j < of_b.size() && !couples_; ++j) {
        const Weight<Criteria> rest =
            minus<Criteria>(minus<Criteria>(network.weight(pair, of_a[i], of_b[j]), by_a_[i]), by_b_[j]);
        couples_ = rest != Weight<Criteria>{};
      }
    }
  }
  [[nodiscard]] bool couples() const { return couples_; }
  [[nodiscard]] const Weight<Criteria>& of_a(std::size_t i) const { return by_a_[i]; }
  [[nodiscard]] const Weight<Criteria>& of_b(std::size_t j) const { return by_b_[j]; }

 private:
  Weight<Criteria> base_;
  std::vector<Weight<Criteria>> by_a_, by_b_;
  bool couples_ = false;
};

template <std::size_t Criteria>
class Splitter {
 public:
  Splitter(const LabelNetwork<Criteria>& network, std::span<const std::uint8_t> stays) : network_(network) {
    first_open_.reserve(network.size() + 1);
    for (std::size_t v = 0; v < network.size(); ++v) {
      for (std::uint32_t i = 0; i < network.label_count(v); ++i) {
        if (stays[network.first_label[v] + i] == 0) continue;
        open_.push_back(i);
        unary_.push_back(network.unary[network.first_label[v] + i]);
      }
      first_open_.push_back(static_cast<std::uint32_t>(open_.size()));
    }
  }

  std::vector<LabelPiece<Criteria>> run() {
    UnionFind parts(network_.size());
    std::vector<std::uint32_t> coupled;
    for (std::uint32_t c = 0; c < network_.pairs.size(); ++c) {
      const PairTerm& pair = network_.pairs[c];
      const std::span<const std::uint32_t> of_a = open(pair.a), of_b = open(pair.b);
      if (of_a.size() < 2 && of_b.size() < 2) continue;
      const Rest<Criteria> rest(network_, pair, of_a, of_b);
      if (rest.couples()) {
        coupled.push_back(c);
        parts.unite(pair.a, pair.b);
        continue;
      }
      for (std::size_t i = 0; i < of_a.size(); ++i) add(unary_[first_open_[pair.a] + i], rest.of_a(i));
      for (std::size_t j = 0; j < of_b.size(); ++j) add(unary_[first_open_[pair.b] + j], rest.of_b(j));
    }
    number_pieces(parts);
    for (const std::uint32_t c : coupled) take(network_.pairs[c]);
    return std::move(pieces_);
  }

 private:
  void number_pieces(UnionFind& parts) {
    constexpr std::uint32_t kNoPiece = 0xffffffffU;
    std::vector<std::uint32_t> number(network_.size(), kNoPiece);
    piece_.assign(network_.size(), 0);
    index_.assign(network_.size(), 0);
    for (std::uint32_t v = 0; v < network_.size(); ++v) {
      const std::span<const std::uint32_t> labels = open(v);
      if (labels.size() < 2) continue;
      std::uint32_t& piece = number[parts.find(v)];
      if (piece == kNoPiece) {
        piece = static_cast<std::uint32_t>(pieces_.size());
        pieces_.emplace_back();
      }
      piece_[v] = piece;
      LabelPiece<Criteria>& to = pieces_[piece];
      index_[v] = static_cast<std::uint32_t>(to.variable.size());
      to.variable.push_back(v);
      to.label.insert(to.label.end(), labels.begin(), labels.end());
      const auto first = unary_.begin() + first_open_[v];
      to.network.unary.insert(to.network.unary.end(), first,
                              first + static_cast<std::ptrdiff_t>(labels.size()));
      to.network.first_label.push_back(static_cast<std::uint32_t>(to.label.size()));
    }
  }

  [[nodiscard]] std::span<const std::uint32_t> open(std::uint32_t v) const {
    return std::span(open_).subspan(first_open_[v], first_open_[v + 1] - first_open_[v]);
  }

  /// Classes that stay, in a new numbering, for the labels of one end.
  std::size_t take_classes(LabelNetwork<Criteria>& to, std::size_t classes,
                           std::span<const std::uint32_t> open, std::vector<std::uint16_t>& kept) const {
    const std::size_t first = to.classes.size();
    for (const std::uint32_t i : open) {
      const std::uint16_t old = network_.classes[classes + i];
      const auto at = std::find(kept.begin(), kept.end(), old);
      to.classes.push_back(static_cast<std::uint16_t>(at - kept.begin()));
      if (at == kept.end()) kept.push_back(old);
    }
    return first;
  }

  void take(const PairTerm& pair) {
    LabelNetwork<Criteria>& to = pieces_[piece_[pair.a]].network;
    std::vector<std::uint16_t> of_a, of_b;
    PairTerm moved{.a = index_[pair.a], .b = index_[pair.b]};
    moved.class_a = take_classes(to, pair.class_a, open(pair.a), of_a);
    moved.class_b = take_classes(to, pair.class_b, open(pair.b), of_b);
    moved.classes_a = static_cast<std::uint16_t>(of_a.size());
    moved.classes_b = static_cast<std::uint16_t>(of_b.size());
    moved.weight = to.weights.size();
    for (const std::size_t p : of_a) {
      for (const std::size_t q : of_b) {
        to.weights.push_back(network_.weights[pair.weight + p * pair.classes_b + q]);
      }
    }
    to.pairs.push_back(moved);
  }

  const LabelNetwork<Criteria>& network_;
  std::vector<std::uint32_t> first_open_ = {0};  ///< by variable: where its labels that stay are in open_
  std::vector<std::uint32_t> open_;
  std::vector<Cost<Criteria>> unary_;         ///< of these
  std::vector<std::uint32_t> piece_, index_;  ///< by variable
  std::vector<LabelPiece<Criteria>> pieces_;
};

}  // namespace

template <std::size_t Criteria>
std::vector<std::uint8_t> find_useful_labels(const LabelNetwork<Criteria>& network,
                                             const Progress& progress) {
  return Reducer<Criteria>(network, progress).run();
}

template <std::size_t Criteria>
std::vector<LabelPiece<Criteria>> split(const LabelNetwork<Criteria>& network,
                                        std::span<const std::uint8_t> stays) {
  return Splitter<Criteria>(network, stays).run();
}

template std::vector<std::uint8_t> find_useful_labels(const LabelNetwork<1>&, const Progress&);
template std::vector<std::uint8_t> find_useful_labels(const LabelNetwork<2>&, const Progress&);
template std::vector<std::uint8_t> find_useful_labels(const LabelNetwork<5>&, const Progress&);
template std::vector<LabelPiece<1>> split(const LabelNetwork<1>&, std::span<const std::uint8_t>);
template std::vector<LabelPiece<2>> split(const LabelNetwork<2>&, std::span<const std::uint8_t>);
template std::vector<LabelPiece<5>> split(const LabelNetwork<5>&, std::span<const std::uint8_t>);

}  // namespace thalweg
