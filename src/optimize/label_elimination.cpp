// Bucket elimination and mini-buckets.
//
// 1. Each term goes to the bucket of its variable that is eliminated first. In order, the terms of a bucket
//    are added in a table over all their variables; the least entry for each choice of the others is a new
//    term, a message, which goes to the bucket of its first variable.
// 2. If the table would be too large, the terms are divided among several tables, and each has its own least
//    entry: the sum of minima is no more than the minimum of the sum, so what comes out is a bound. Based on:
//    Dechter, Rish, Mini-buckets: a general scheme for bounded inference, 2003.
// 3. Backwards: each variable takes the label that is best in its bucket under the labels of those after it.
#include "optimize/label_elimination.hpp"

#include "optimize/elimination_order.hpp"

#include <algorithm>
#include <span>

namespace thalweg {

namespace {

constexpr std::uint32_t kWidestPlanned = 32;

template <std::size_t Criteria>
class NetworkEliminator {
 public:
  NetworkEliminator(const LabelNetwork<Criteria>& network, std::uint64_t most_entries,
                    const Progress& progress)
      : network_(network), most_entries_(most_entries), progress_(progress), buckets_(network.size()) {
    plan();
    for (std::uint32_t c = 0; c < network.pairs.size(); ++c) {
      const PairTerm& pair = network.pairs[c];
      buckets_[std::min(position_[pair.a], position_[pair.b])].pairs.push_back(c);
    }
  }

  Eliminated<Criteria> run() {
    for (std::uint32_t i = 0; i < order_.size(); ++i) {
      if (i % 64 == 0) progress_.check();
      empty_bucket(i);
    }
    result_.chosen.assign(network_.size(), 0);
    for (std::size_t i = order_.size(); i-- > 0;) choose(i);
    return std::move(result_);
  }

 private:
  /// A function of the labels of its scope; the index counts labels of scope[0] fastest.
  struct Message {
    std::vector<std::uint32_t> scope;  ///< by position
    std::vector<Cost<Criteria>> table;
  };
  struct Bucket {
    std::vector<std::uint32_t> pairs;
    std::vector<std::uint32_t> messages;
  };
  /// Terms of one bucket that are added in one table.
  struct Share {
    std::vector<std::uint32_t> scope;  ///< without the bucket's own variable
    std::uint64_t entries = 1;         ///< of the scope
    std::vector<std::uint32_t> pairs, messages;
  };

  void plan() {
    std::vector<NodePair> edges;
    for (const PairTerm& c : network_.pairs) edges.emplace_back(c.a, c.b);
    order_ = find_elimination_order(network_.size(), edges, kWidestPlanned).order;
    std::vector<bool> placed(network_.size(), false);
    for (const std::uint32_t v : order_) placed[v] = true;
    for (std::uint32_t v = 0; v < network_.size(); ++v) {
      if (!placed[v]) order_.push_back(v);
    }
    position_.resize(network_.size());
    for (std::uint32_t i = 0; i < order_.size(); ++i) position_[order_[i]] = i;
  }

  [[nodiscard]] std::uint32_t other_end(std::uint32_t c, std::uint32_t v) const {
    return network_.pairs[c].a == v ? network_.pairs[c].b : network_.pairs[c].a;
  }
  [[nodiscard]] const Weight<Criteria>& weight(std::uint32_t c, std::uint32_t v, std::uint32_t label,
                                               std::uint32_t other) const {
    const PairTerm& pair = network_.pairs[c];
    return pair.a == v ? network_.weight(pair, label, other) : network_.weight(pair, other, label);
  }

  /// The scope with more variables, and what a table over it has.
  void widen(Share& share, std::span<const std::uint32_t> variables) const {
    for (const std::uint32_t u : variables) {
      if (std::find(share.scope.begin(), share.scope.end(), u) != share.scope.end()) continue;
      share.scope.push_back(u);
      share.entries *= network_.label_count(u);
    }
  }

  [[nodiscard]] Share& share_for(std::vector<Share>& shares, std::uint32_t v,
                                 std::span<const std::uint32_t> variables) const {
    for (Share& share : shares) {
      Share wider{share.scope, share.entries, {}, {}};
      widen(wider, variables);
      if (wider.entries * network_.label_count(v) > most_entries_ && !share.scope.empty()) continue;
      share.scope = std::move(wider.scope);
      share.entries = wider.entries;
      return share;
    }
    shares.emplace_back();
    widen(shares.back(), variables);
    return shares.back();
  }

  void empty_bucket(std::uint32_t i) {
    const std::uint32_t v = order_[i];
    Bucket& bucket = buckets_[i];
    std::stable_sort(bucket.messages.begin(), bucket.messages.end(), [&](std::uint32_t m, std::uint32_t n) {
      return messages_[m].scope.size() > messages_[n].scope.size();
    });
    std::vector<Share> shares(1);
    for (const std::uint32_t m : bucket.messages) {
      share_for(shares, v, std::span(messages_[m].scope).subspan(1)).messages.push_back(m);
    }
    for (const std::uint32_t c : bucket.pairs) {
      const std::uint32_t u = other_end(c, v);
      share_for(shares, v, std::span(&u, 1)).pairs.push_back(c);
    }
    result_.exact = result_.exact && shares.size() == 1;
    for (std::size_t s = 0; s < shares.size(); ++s) send(v, shares[s], s == 0);
  }

  /// Minimises over the labels of v, and sends the message on.
  void send(std::uint32_t v, Share& share, bool with_unary) {
    std::sort(share.scope.begin(), share.scope.end(),
              [&](std::uint32_t a, std::uint32_t b) { return position_[a] < position_[b]; });
    const std::uint32_t labels = network_.label_count(v);
    result_.largest_table = std::max(result_.largest_table, share.entries * labels);
    result_.table_entries += share.entries * labels;
    Message message{share.scope, {}};
    message.table.reserve(share.entries);
    std::vector<std::uint32_t> digit(share.scope.size(), 0);
    std::vector<std::size_t> place;  // of each pair's other end in the scope
    for (const std::uint32_t c : share.pairs) {
      place.push_back(static_cast<std::size_t>(
          std::find(share.scope.begin(), share.scope.end(), other_end(c, v)) - share.scope.begin()));
    }
    std::vector<std::vector<std::size_t>> step;  // of each message, by the scope's digits
    for (const std::uint32_t m : share.messages) step.push_back(strides(messages_[m], share.scope));
    std::vector<std::size_t> at(share.messages.size(), 0);
    for (std::uint64_t entry = 0; entry < share.entries; ++entry) {
      Cost<Criteria> best;
      for (std::uint32_t label = 0; label < labels; ++label) {
        Cost<Criteria> cost = with_unary ? network_.unary[network_.first_label[v] + label] : Cost<Criteria>{};
        // The bucket's own variable is first in the scope of each of its messages.
        for (std::size_t m = 0; m < at.size(); ++m) cost += messages_[share.messages[m]].table[at[m] + label];
        for (std::size_t c = 0; c < place.size(); ++c) {
          add(cost, weight(share.pairs[c], v, label, digit[place[c]]));
        }
        if (label == 0 || cost < best) best = cost;
      }
      message.table.push_back(best);
      for (std::size_t d = 0; d < digit.size(); ++d) {
        const bool carries = ++digit[d] == network_.label_count(share.scope[d]);
        for (std::size_t m = 0; m < at.size(); ++m) {
          at[m] += carries ? step[m][d] - step[m][d] * digit[d] : step[m][d];
        }
        if (!carries) break;
        digit[d] = 0;
      }
    }
    if (message.scope.empty()) {
      result_.bound += message.table[0];
      return;
    }
    buckets_[position_[message.scope[0]]].messages.push_back(static_cast<std::uint32_t>(messages_.size()));
    messages_.push_back(std::move(message));
  }

  /// How far one label more of each variable in `scope` goes in the message's table; 0 where it is not in it.
  [[nodiscard]] std::vector<std::size_t> strides(const Message& message,
                                                 std::span<const std::uint32_t> scope) const {
    std::vector<std::size_t> steps(scope.size(), 0);
    std::size_t stride = 1;
    for (const std::uint32_t u : message.scope) {
      const auto at = std::find(scope.begin(), scope.end(), u);
      if (at != scope.end()) steps[static_cast<std::size_t>(at - scope.begin())] = stride;
      stride *= network_.label_count(u);
    }
    return steps;
  }

  void choose(std::size_t i) {
    const std::uint32_t v = order_[i];
    Cost<Criteria> best;
    for (std::uint32_t label = 0; label < network_.label_count(v); ++label) {
      Cost<Criteria> cost = network_.unary[network_.first_label[v] + label];
      for (const std::uint32_t c : buckets_[i].pairs) {
        add(cost, weight(c, v, label, result_.chosen[other_end(c, v)]));
      }
      for (const std::uint32_t m : buckets_[i].messages) {
        std::size_t at = label, stride = 1;
        for (const std::uint32_t u : messages_[m].scope) {
          if (u != v) at += stride * result_.chosen[u];
          stride *= network_.label_count(u);
        }
        cost += messages_[m].table[at];
      }
      if (label > 0 && !(cost < best)) continue;
      best = cost;
      result_.chosen[v] = label;
    }
  }

  const LabelNetwork<Criteria>& network_;
  std::uint64_t most_entries_;
  const Progress& progress_;
  std::vector<std::uint32_t> order_, position_;
  std::vector<Bucket> buckets_;
  std::vector<Message> messages_;
  Eliminated<Criteria> result_;
};

}  // namespace

template <std::size_t Criteria>
Eliminated<Criteria> eliminate(const LabelNetwork<Criteria>& network, std::uint64_t most_entries,
                               const Progress& progress) {
  return NetworkEliminator<Criteria>(network, most_entries, progress).run();
}

template Eliminated<1> eliminate(const LabelNetwork<1>&, std::uint64_t, const Progress&);
template Eliminated<2> eliminate(const LabelNetwork<2>&, std::uint64_t, const Progress&);
template Eliminated<5> eliminate(const LabelNetwork<5>&, std::uint64_t, const Progress&);

}  // namespace thalweg
