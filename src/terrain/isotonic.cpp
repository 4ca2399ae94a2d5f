// Isotonic regression by splitting blocks, exact on any directed graph.
//
// 1. A block that may take one value from a range: ask which vertices want to be above the range's middle.
//    Squares: the middle is the block's mean, the weight of a vertex is its value less the mean. Sum: the
//    range is a run of the sorted values, the middle lies between two of them, the weight is 1 above, -1
//    below.
// 2. The heaviest set that holds with each vertex all that is above it (a closure) goes up, the rest goes
//    down; a block without such a set keeps its mean. Each closure is a minimum cut (Dinic).
// 3. Means of blocks that were split by rounding alone may cross by an ulp: what is below is lowered.
//
// Based on: Maxwell, Muckstadt, "Establishing consistent and realistic reorder intervals", 1985 (splitting at
// the mean); Stout, "Isotonic regression via partitioning", 2013, section 3 (splitting between two values);
// Picard, "Maximal closure of a graph", 1976.
#include "terrain/isotonic.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace thalweg {

namespace {

constexpr std::uint32_t kNone = 0xffffffffU;
// Of the largest weight: what is less is rounding. A sum of n weights errs by at most n 2^-53 of it.
constexpr double kRounding = 1e-13;

/// Dinic on a graph whose last two nodes are source and sink.
class Cut {
 public:
  explicit Cut(std::size_t nodes) : head_(nodes, kNone), source_(nodes - 2), sink_(nodes - 1) {}

  void add(std::size_t from, std::size_t to, double capacity) {
    edges_.push_back({static_cast<std::uint32_t>(to), head_[from], capacity});
    head_[from] = static_cast<std::uint32_t>(edges_.size() - 1);
    edges_.push_back({static_cast<std::uint32_t>(from), head_[to], 0});
    head_[to] = static_cast<std::uint32_t>(edges_.size() - 1);
  }

  /// True for what is on the source's side; capacities up to `least` count as none.
  std::vector<bool> source_side(double least) {
    least_ = least;
    while (rank()) {
      current_ = head_;
      while (push()) {
      }
    }
    std::vector<bool> side(head_.size());
    for (std::size_t i = 0; i < side.size(); ++i) side[i] = rank_[i] != kNone;
    return side;
  }

 private:
  struct Edge {
    std::uint32_t to, next;
    double capacity;
  };

  bool rank() {
    rank_.assign(head_.size(), kNone);
    rank_[source_] = 0;
    queue_.assign(1, static_cast<std::uint32_t>(source_));
    for (std::size_t i = 0; i < queue_.size(); ++i) {
      for (std::uint32_t e = head_[queue_[i]]; e != kNone; e = edges_[e].next) {
        if (edges_[e].capacity <= least_ || rank_[edges_[e].to] != kNone) continue;
        rank_[edges_[e].to] = rank_[queue_[i]] + 1;
        queue_.push_back(edges_[e].to);
      }
    }
    return rank_[sink_] != kNone;
  }

  /// Sends flow along one way of the ranks; false: there is none left.
  bool push() {
    way_.clear();
    std::size_t at = source_;
    while (at != sink_) {
      std::uint32_t& e = current_[at];
      while (e != kNone && (edges_[e].capacity <= least_ || rank_[edges_[e].to] != rank_[at] + 1)) {
        e = edges_[e].next;
      }
      if (e != kNone) {
        way_.push_back(e);
        at = edges_[e].to;
        continue;
      }
      if (way_.empty()) return false;
      rank_[at] = kNone;
      at = edges_[way_.back() ^ 1U].to;
      way_.pop_back();
    }
    double flow = std::numeric_limits<double>::infinity();
    for (const std::uint32_t e : way_) flow = std::min(flow, edges_[e].capacity);
    for (const std::uint32_t e : way_) {
      edges_[e].capacity -= flow;
      edges_[e ^ 1U].capacity += flow;
    }
    return true;
  }

  std::vector<Edge> edges_;
  std::vector<std::uint32_t> head_, current_, rank_, queue_, way_;
  std::size_t source_, sink_;
  double least_ = 0;
};

struct Block {
  std::vector<std::uint32_t> members;
  std::vector<DownArc> arcs;  // of vertices, not of places in `members`
  std::size_t low = 0;        // the range of sorted values that is left: [low, high]
  std::size_t high = 0;
};

class Regression {
 public:
  Regression(std::span<const double> values, ChangeNorm norm)
      : values_(values), norm_(norm), result_(values.begin(), values.end()), place_(values.size()) {
    if (norm == ChangeNorm::Squares) return;
    sorted_.assign(values.begin(), values.end());
    std::sort(sorted_.begin(), sorted_.end());
    sorted_.erase(std::unique(sorted_.begin(), sorted_.end()), sorted_.end());
  }

  std::vector<double> run(std::span<const DownArc> arcs) {
    Block all{.members = {}, .arcs = {arcs.begin(), arcs.end()}, .low = 0, .high = 0};
    if (!sorted_.empty()) all.high = sorted_.size() - 1;
    for (std::size_t i = 0; i < values_.size(); ++i) all.members.push_back(static_cast<std::uint32_t>(i));
    blocks_.push_back(std::move(all));
    while (!blocks_.empty()) {
      Block block = std::move(blocks_.back());
      blocks_.pop_back();
      norm_ == ChangeNorm::Squares ? split_at_mean(std::move(block)) : split_range(block);
    }
    return std::move(result_);
  }

 private:
  void split_at_mean(Block block) {
    if (block.members.empty()) return;
    long double sum = 0;
    double least = values_[block.members.front()], most = least;
    for (const std::uint32_t v : block.members) {
      sum += values_[v];
      least = std::min(least, values_[v]);
      most = std::max(most, values_[v]);
    }
    const auto size = static_cast<long double>(block.members.size());
    const double mean = std::clamp(static_cast<double>(sum / size), least, most);
    for (const std::uint32_t v : block.members) result_[v] = mean;
    if (least == most) return;
    std::vector<double> weights;
    for (const std::uint32_t v : block.members) weights.push_back(values_[v] - mean);
    auto [upper, lower] = split(block, weights);
    if (upper.members.empty() || lower.members.empty()) return;
    blocks_.push_back(std::move(upper));
    blocks_.push_back(std::move(lower));
  }

  void split_range(const Block& block) {
    if (block.members.empty()) return;
    if (block.low == block.high) {
      for (const std::uint32_t v : block.members) result_[v] = sorted_[block.low];
      return;
    }
    const std::size_t middle = (block.low + block.high) / 2;
    std::vector<double> weights;
    for (const std::uint32_t v : block.members) weights.push_back(values_[v] > sorted_[middle] ? 1 : -1);
    auto [upper, lower] = split(block, weights);
    upper.low = middle + 1;
    upper.high = block.high;
    lower.low = block.low;
    lower.high = middle;
    blocks_.push_back(std::move(upper));
    blocks_.push_back(std::move(lower));
  }

  std::pair<Block, Block> split(const Block& block, std::span<const double> weights) {
    const std::size_t n = block.members.size();
    Cut cut(n + 2);
    double largest = 0;
    for (std::size_t i = 0; i < n; ++i) {
      place_[block.members[i]] = static_cast<std::uint32_t>(i);
      largest = std::max(largest, std::abs(weights[i]));
      if (weights[i] > 0) cut.add(n, i, weights[i]);
      if (weights[i] < 0) cut.add(i, n + 1, -weights[i]);
    }
    for (const DownArc& arc : block.arcs) {
      cut.add(place_[arc.below], place_[arc.above], std::numeric_limits<double>::infinity());
    }
    const std::vector<bool> up = cut.source_side(kRounding * largest);
    double gain = 0;
    Block upper, lower;
    for (std::size_t i = 0; i < n; ++i) {
      (up[i] ? upper : lower).members.push_back(block.members[i]);
      if (up[i]) gain += weights[i];
    }
    if (norm_ == ChangeNorm::Squares && gain <= kRounding * largest * static_cast<double>(n)) return {};
    for (const DownArc& arc : block.arcs) {
      const bool above = up[place_[arc.above]], below = up[place_[arc.below]];
      if (above == below) (above ? upper : lower).arcs.push_back(arc);
    }
    return {std::move(upper), std::move(lower)};
  }

  std::span<const double> values_;
  ChangeNorm norm_;
  std::vector<double> result_;
  std::vector<std::uint32_t> place_;
  std::vector<double> sorted_;
  std::vector<Block> blocks_;
};

void run_downstream(std::span<double> values, std::span<const DownArc> arcs) {
  std::vector<std::vector<std::uint32_t>> below(values.size());
  std::vector<std::uint32_t> lowered;
  const auto lower = [&](std::uint32_t above, std::uint32_t v) {
    if (!(values[above] < values[v])) return;
    values[v] = values[above];
    lowered.push_back(v);
  };
  for (const DownArc& arc : arcs) below[arc.above].push_back(arc.below);
  for (const DownArc& arc : arcs) lower(arc.above, arc.below);
  while (!lowered.empty()) {
    const std::uint32_t v = lowered.back();
    lowered.pop_back();
    for (const std::uint32_t next : below[v]) lower(v, next);
  }
}

}  // namespace

std::vector<double> regress_isotonic(std::span<const double> values, std::span<const DownArc> arcs,
                                     ChangeNorm norm) {
  std::vector<double> result = Regression(values, norm).run(arcs);
  run_downstream(result, arcs);
  return result;
}

}  // namespace thalweg
