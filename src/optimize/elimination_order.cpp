// Minimum fill on sorted rows of neighbours. A queue holds each variable under its last known (fill, degree);
// entries that are no longer current are dropped when they come up. Only the rows of the eliminated
// variable's neighbours are evaluated anew: elsewhere fill can only have shrunk, and a key that is too large
// delays, but harms nothing. Based on: Kjaerulff, Triangulation of graphs, 1990; Dechter, Bucket elimination,
// 1999.
#include "optimize/elimination_order.hpp"

#include <algorithm>
#include <queue>
#include <tuple>

namespace thalweg {

namespace {

class Planner {
 public:
  Planner(std::size_t count, std::span<const NodePair> edges) : rows_(count), keys_(count) {
    for (const auto& [a, b] : edges) {
      rows_[a].push_back(b);
      rows_[b].push_back(a);
    }
    for (Row& row : rows_) {
      std::sort(row.begin(), row.end());
      row.erase(std::unique(row.begin(), row.end()), row.end());
    }
  }

  EliminationOrder run(std::uint32_t width_limit) {
    start();
    for (std::uint32_t v = next(); v != kNoVariable; v = next()) {
      if (rows_[v].size() > width_limit) return std::move(out_);
      eliminate(v);
    }
    for (std::size_t i = 0; i < out_.order.size(); ++i) {
      std::sort(out_.scope.begin() + out_.first[i], out_.scope.begin() + out_.first[i + 1],
                [&](std::uint32_t a, std::uint32_t b) { return out_.position[a] < out_.position[b]; });
    }
    out_.complete = true;
    return std::move(out_);
  }

  std::vector<std::uint32_t> cut(std::uint32_t width_limit, std::span<const std::uint32_t> times) {
    std::vector<std::uint32_t> removed;
    start();
    for (std::uint32_t v = next(); v != kNoVariable; v = next()) {
      if (rows_[v].size() <= width_limit) {
        eliminate(v);
        continue;
      }
      const auto later = [&](std::uint32_t a, std::uint32_t b) {
        return std::tuple(times[a], rows_[b].size(), a) < std::tuple(times[b], rows_[a].size(), b);
      };
      const std::uint32_t best =
          std::min(v, *std::min_element(rows_[v].begin(), rows_[v].end(), later), later);
      remove(best);
      removed.push_back(best);
      if (best != v) update(v);
    }
    return removed;
  }

 private:
  using Row = std::vector<std::uint32_t>;
  using Key = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>;  ///< fill, degree, variable
  static constexpr std::uint32_t kNoVariable = 0xffffffffU;
  static constexpr Key kDone{kNoVariable, kNoVariable, kNoVariable};

  void start() {
    out_.position.assign(rows_.size(), 0);
    out_.first.push_back(0);
    for (std::uint32_t v = 0; v < rows_.size(); ++v) update(v);
  }

  /// The variable whose turn it is; its entry leaves the queue.
  std::uint32_t next() {
    while (!queue_.empty()) {
      const Key key = queue_.top();
      queue_.pop();
      const std::uint32_t v = std::get<2>(key);
      if (key == keys_[v]) return v;
    }
    return kNoVariable;
  }

  [[nodiscard]] bool adjacent(std::uint32_t a, std::uint32_t b) const {
    return std::binary_search(rows_[a].begin(), rows_[a].end(), b);
  }

  void update(std::uint32_t v) {
    const Row& row = rows_[v];
    std::uint32_t fill = 0;
    for (std::size_t i = 0; i < row.size(); ++i) {
      for (std::size_t j = i + 1; j < row.size(); ++j) fill += adjacent(row[i], row[j]) ? 0 : 1;
    }
    keys_[v] = {fill, static_cast<std::uint32_t>(row.size()), v};
    queue_.push(keys_[v]);
  }

  void eliminate(std::uint32_t v) {
    const Row row = std::move(rows_[v]);
    keys_[v] = kDone;
    out_.position[v] = static_cast<std::uint32_t>(out_.order.size());
    out_.order.push_back(v);
    out_.scope.insert(out_.scope.end(), row.begin(), row.end());
    out_.first.push_back(static_cast<std::uint32_t>(out_.scope.size()));
    out_.width = std::max(out_.width, static_cast<std::uint32_t>(row.size()));
    for (const std::uint32_t a : row) {
      Row merged;
      merged.reserve(rows_[a].size() + row.size());
      std::set_union(rows_[a].begin(), rows_[a].end(), row.begin(), row.end(), std::back_inserter(merged));
      std::erase_if(merged, [&](std::uint32_t b) { return b == a || b == v; });
      rows_[a] = std::move(merged);
    }
    for (const std::uint32_t a : row) update(a);
  }

  void remove(std::uint32_t v) {
    const Row row = std::move(rows_[v]);
    keys_[v] = kDone;
    for (const std::uint32_t a : row) std::erase(rows_[a], v);
    for (const std::uint32_t a : row) update(a);
  }

  std::vector<Row> rows_;
  std::vector<Key> keys_;
  std::priority_queue<Key, std::vector<Key>, std::greater<>> queue_;
  EliminationOrder out_;
};

}  // namespace

EliminationOrder find_elimination_order(std::size_t count, std::span<const NodePair> edges,
                                        std::uint32_t width_limit) {
  return Planner(count, edges).run(width_limit);
}

std::uint64_t table_entries(const EliminationOrder& order) {
  std::uint64_t entries = 0;
  for (std::size_t i = 0; i < order.order.size(); ++i)
    entries += std::uint64_t{2} << order.scope_at(i).size();
  return entries;
}

std::vector<std::uint32_t> find_cutset(std::size_t count, std::span<const NodePair> edges,
                                       std::uint32_t width_limit, std::span<const std::uint32_t> times) {
  return Planner(count, edges).cut(width_limit, times);
}

std::vector<std::uint32_t> tree_numbers(const EliminationOrder& order) {
  // Parents stand later in the order than children. Counted from the back, a variable's subtree ends at its
  // own number, and the subtrees of its children follow each other before it.
  const std::size_t count = order.order.size();
  std::vector<std::uint32_t> subtree(count, 1), end(count, 0), number(count, 0);
  for (std::size_t i = 0; i < count; ++i) {
    if (!order.scope_at(i).empty()) subtree[order.position[order.scope_at(i)[0]]] += subtree[i];
  }
  std::uint32_t roots_end = static_cast<std::uint32_t>(count);
  for (std::size_t i = count; i-- > 0;) {
    const bool is_root = order.scope_at(i).empty();
    std::uint32_t& place = is_root ? roots_end : end[order.position[order.scope_at(i)[0]]];
    number[order.order[i]] = place - 1;
    end[i] = place - 1;
    place -= subtree[i];
  }
  return number;
}

}  // namespace thalweg
