// 1. A cut: searches from both ends of one link, a link at a time in turn, through all links but those of the
//    cut. If one of them runs out, the ends are apart; if they meet, they are not.
// 2. Forests: Kruskal's rule for each set, over the nodes that all other links make one. To have "all others"
//    for every set, the sets are halved again and again; links of the one half are joined while the other
//    half is dealt with, then taken back.
#include "verify/plain_links.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace thalweg::verify {

namespace {

/// Sets of nodes whose unions can be taken back in reverse order.
class Unions {
 public:
  explicit Unions(std::size_t count) : parent_(count), size_(count, 1) {
    for (Index i = 0; i < count; ++i) parent_[i] = i;
  }
  [[nodiscard]] Index find(Index node) const {
    while (parent_[node] != node) node = parent_[node];
    return node;
  }
  bool unite(Index a, Index b) {
    a = find(a);
    b = find(b);
    if (a == b) return false;
    if (size_[a] < size_[b]) std::swap(a, b);
    parent_[b] = a;
    size_[a] += size_[b];
    done_.push_back(b);
    return true;
  }
  [[nodiscard]] std::size_t mark() const { return done_.size(); }
  void take_back(std::size_t mark) {
    while (done_.size() > mark) {
      const Index b = done_.back();
      done_.pop_back();
      size_[parent_[b]] -= size_[b];
      parent_[b] = b;
    }
  }

 private:
  std::vector<Index> parent_, size_, done_;
};

/// A search that goes one link at a time.
struct Front {
  std::vector<Index> nodes;
  std::size_t node = 0, link = 0;
};

}  // namespace

PlainLinks::PlainLinks(std::vector<PlainLink> links, std::size_t node_count)
    : links_(std::move(links)), at_(node_count) {
  for (Index i = 0; i < links_.size(); ++i) {
    const PlainLink& link = links_[i];
    if (link.quadrilateral >= by_quadrilateral_.size()) {
      by_quadrilateral_.resize(link.quadrilateral + std::size_t{1}, kNone);
    }
    by_quadrilateral_[link.quadrilateral] = i;
    at_[link.a].push_back(i);
    at_[link.b].push_back(i);
  }
}

const PlainLink* PlainLinks::link_of(Index quadrilateral) const {
  if (quadrilateral >= by_quadrilateral_.size() || by_quadrilateral_[quadrilateral] == kNone) return nullptr;
  return &links_[by_quadrilateral_[quadrilateral]];
}

bool PlainLinks::is_cut(std::span<const PlainLiteral> literals) const {
  std::vector<Index> gone;
  for (const PlainLiteral& literal : literals) {
    const PlainLink* link = link_of(literal.quadrilateral);
    if (link != nullptr && link->label == literal.label)
      gone.push_back(static_cast<Index>(link - links_.data()));
  }
  if (gone.empty()) return false;
  const PlainLink& first = links_[gone.front()];
  std::sort(gone.begin(), gone.end());
  std::vector<std::pair<Index, int>> side;  // of nodes reached, sorted
  const auto reached = [&](Index node) {
    const auto found = std::lower_bound(side.begin(), side.end(), std::pair(node, 0));
    return found != side.end() && found->first == node ? found->second : -1;
  };
  std::array<Front, 2> fronts;
  fronts[0].nodes = {first.a};
  fronts[1].nodes = {first.b};
  side = {{first.a, 0}, {first.b, 1}};
  std::sort(side.begin(), side.end());
  for (int turn = 0;; turn = 1 - turn) {
    Front& front = fronts[static_cast<std::size_t>(turn)];
    if (front.node == front.nodes.size()) return true;
    const Index node = front.nodes[front.node];
    if (front.link == at_[node].size()) {
      ++front.node;
      front.link = 0;
      continue;
    }
    const Index index = at_[node][front.link++];
    if (std::binary_search(gone.begin(), gone.end(), index)) continue;
    const Index next = links_[index].a == node ? links_[index].b : links_[index].a;
    const int there = reached(next);
    if (there == 1 - turn) return false;
    if (there == turn) continue;
    side.insert(std::lower_bound(side.begin(), side.end(), std::pair(next, 0)), {next, turn});
    front.nodes.push_back(next);
  }
}

Cost PlainLinks::least_forests(const std::vector<std::vector<Index>>& sets,
                               const std::vector<Cost>& rise) const {
  Cost total{};
  Unions unions(at_.size());
  std::vector<bool> in_set(by_quadrilateral_.size(), false);
  for (const std::vector<Index>& set : sets) {
    for (const Index q : set) {
      if (q < in_set.size()) in_set[q] = true;
    }
  }
  for (const PlainLink& link : links_) {
    if (!in_set[link.quadrilateral]) unions.unite(link.a, link.b);
  }
  const auto join = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (const Index q : sets[i]) {
        if (const PlainLink* link = link_of(q)) unions.unite(link->a, link->b);
      }
    }
  };
  const auto span = [&](const std::vector<Index>& set) {
    std::vector<std::pair<Cost, const PlainLink*>> extra;
    for (const Index q : set) {
      const PlainLink* link = link_of(q);
      if (link != nullptr) extra.emplace_back(link->label ? rise[q] : minus(Cost{}, rise[q]), link);
    }
    std::sort(extra.begin(), extra.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [cost, link] : extra) {
      if (unions.unite(link->a, link->b) && cost > Cost{}) total = plus(total, cost);
    }
  };
  const auto deal_with = [&](const auto& self, std::size_t begin, std::size_t end) -> void {
    const std::size_t mark = unions.mark();
    if (end - begin == 1) {
      span(sets[begin]);
    } else {
      const std::size_t middle = begin + (end - begin) / 2;
      join(middle, end);
      self(self, begin, middle);
      unions.take_back(mark);
      join(begin, middle);
      self(self, middle, end);
    }
    unions.take_back(mark);
  };
  if (!sets.empty()) deal_with(deal_with, 0, sets.size());
  return total;
}

}  // namespace thalweg::verify
