// Dead ends, contraction, bridges.
//
// 1. Let D(q) = cost with label 1 less that with label 0; it depends on the neighbours' labels. Over all
//    labels that they may still have, D lies between lo(q) and hi(q). If lo >= 0, label 0 is never worse; if
//    hi <= 0, label 1. Such a label may be fixed, at once if it is the helpful one of its link or there is no
//    link: a link more never disconnects. The unhelpful label may be fixed if fixed links connect the ends of
//    its link already: whatever the others are, the link is not needed. Desmet et al., The dead-end
//    elimination theorem, 1992, in an ordered group.
// 2. Fixing narrows the intervals of the neighbours, which go on a work list.
// 3. Links that are fixed to be there are contracted; those that became loops are free. Among the rest, a
//    bridge of the graph of links that may still be there has to be there. Its label is fixed, and so on
//    until nothing moves.
// Every condition, once true, stays true while labels are fixed, so the final set is the same in any order.
//
// Blocks of variables are first reduced by themselves, each by one thread, as if all labels outside were
// open: what is true of those holds whatever they are. Labels that would need links wait for all blocks, and
// so do neighbours outside. Costs may tie at all levels, so borders of blocks do not depend on the thread
// count.
#include "optimize/reduction.hpp"

#include "base/id_range.hpp"
#include "base/ordered_blocks.hpp"
#include "optimize/blocks.hpp"

#include <thalweg/base/assert.hpp>

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

namespace thalweg {

namespace {

constexpr std::size_t kSteps = 8192;       // between looks at the progress
constexpr std::size_t kBlock = 1U << 15U;  // variables

/// Tables may reach anywhere: with them, all is one block.
template <std::size_t Criteria>
std::size_t block_size(const Labelling<Criteria>& problem) {
  return problem.tables.empty() ? kBlock : std::max(problem.size(), kBlock);
}

template <std::size_t Criteria>
class Reducer {
 public:
  Reducer(const Labelling<Criteria>& problem, const Progress& progress)
      : problem_(problem), progress_(progress), queued_(problem.size(), 0) {
    out_.label.assign(problem.size(), Label::Open);
    out_.nodes = UnionFind(problem.node_count);
  }

  Reduction run() {
    reduce_blocks();
    drain_work_list();
    while (connect()) drain_work_list();
    return std::move(out_);
  }

 private:
  /// The label that is never worse, if there is one; `label_of` says what is known of the others. Pre: no
  /// term is a table, or all labels are known.
  template <class LabelOf>
  [[nodiscard]] Label verdict(std::uint32_t q, const LabelOf& label_of) const {
    Weight<Criteria> lo = problem_.unary.levels()[q];
    Weight<Criteria> hi = lo;
    // Signs and labels are as good as random: without branches.
    for (std::size_t i = problem_.first[q]; i < problem_.first[q + 1]; ++i) {
      const Weight<Criteria>& weight = problem_.weight[i];
      const Label label = label_of(problem_.neighbour[i]);
      const bool negative = is_negative<Criteria>(weight), one = label == Label::One,
                 open = label == Label::Open;
      add_if<Criteria>(lo, weight, one | (open & negative));
      add_if<Criteria>(hi, weight, one | (open & !negative));
    }
    for (const std::uint32_t i : problem_.tables.of(q)) {
      const auto [least, most] = spread<Criteria>(problem_.tables, i, q, out_.label);
      add_if<Criteria>(lo, least, true);
      add_if<Criteria>(hi, most, true);
    }
    // One flip and its tie decide last: they are positive, or there are none.
    const Weight<Criteria> zero{};
    if (lo >= zero) return Label::Zero;
    if (hi < zero || (hi == zero && problem_.unary.ties()[q] == 0)) return Label::One;
    return Label::Open;
  }

  /// What a block leaves to do.
  struct Rest {
    std::vector<std::uint32_t> again;   ///< variables to look at once more
    std::vector<std::uint32_t> linked;  ///< variables with links
    std::vector<std::uint32_t> work;
  };

  void reduce_blocks() {
    for_each_block_in_order<Rest>(
        problem_.size(), block_size(problem_), progress_,
        [&](std::size_t begin, std::size_t end, Rest& rest) {
          rest.again.clear();
          rest.linked.clear();
          reduce_block({static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)}, rest);
        },
        [&](std::size_t, std::size_t, const Rest& rest) {
          again_.insert(again_.end(), rest.again.begin(), rest.again.end());
          linked_.insert(linked_.end(), rest.linked.begin(), rest.linked.end());
        });
    for (const std::uint32_t q : linked_) {
      if (out_.label[q] == problem_.link[q].helpful()) unite_ends(q);
    }
    for (const std::uint32_t q : again_) enqueue(q);
    again_ = {};
  }

  void reduce_block(IdRange ours, Rest& rest) {
    const auto label_of = [&](std::uint32_t q) { return ours.contains(q) ? out_.label[q] : Label::Open; };
    std::uint32_t next = ours.begin;  // not yet looked at for the first time
    const auto wake = [&](std::uint32_t q) {
      if (!ours.contains(q)) return rest.again.push_back(q);
      if (q >= next || queued_[q] != 0 || out_.label[q] != Label::Open) return;
      queued_[q] = 1;
      rest.work.push_back(q);
    };
    const auto look_at = [&](std::uint32_t q) {
      const Label label = verdict(q, label_of);
      if (label == Label::Open) return;
      if (problem_.has_link(q) && label != problem_.link[q].helpful()) return rest.again.push_back(q);
      out_.label[q] = label;
      for_each_neighbour(q, wake);
    };
    while (next < ours.end) {
      if (next % kSteps == 0) progress_.check();
      const std::uint32_t q = next++;
      if (problem_.has_link(q)) rest.linked.push_back(q);
      look_at(q);
      while (!rest.work.empty()) {
        const std::uint32_t p = rest.work.back();
        rest.work.pop_back();
        queued_[p] = 0;
        look_at(p);
      }
    }
  }

  [[nodiscard]] bool needs_link(std::uint32_t q) {
    return problem_.has_link(q) && out_.nodes.find(problem_.link[q].a) != out_.nodes.find(problem_.link[q].b);
  }

  void unite_ends(std::uint32_t q) { out_.nodes.unite(problem_.link[q].a, problem_.link[q].b); }

  template <class Visit>
  void for_each_neighbour(std::uint32_t q, const Visit& visit) const {
    for (std::size_t i = problem_.first[q]; i < problem_.first[q + 1]; ++i) visit(problem_.neighbour[i]);
    for (const std::uint32_t i : problem_.tables.of(q)) {
      for (const std::uint32_t p : problem_.tables.scope(i)) visit(p);
    }
  }

  void enqueue(std::uint32_t q) {
    if (queued_[q] != 0 || out_.label[q] != Label::Open) return;
    queued_[q] = 1;
    work_.push_back(q);
  }

  void drain_work_list() {
    const auto label_of = [this](std::uint32_t q) { return out_.label[q]; };
    for (std::size_t i = 0; i < work_.size(); ++i) {
      if (i % kSteps == 0) progress_.check();
      const std::uint32_t q = work_[i];
      queued_[q] = 0;
      if (out_.label[q] != Label::Open) continue;
      const Label label = verdict(q, label_of);
      if (label == Label::Open) continue;
      if (needs_link(q) && label != problem_.link[q].helpful()) continue;
      fix(q, label);
    }
    work_.clear();
  }

  void fix(std::uint32_t q, Label label) {
    out_.label[q] = label;
    if (problem_.has_link(q) && label == problem_.link[q].helpful()) unite_ends(q);
    for_each_neighbour(q, [this](std::uint32_t p) { enqueue(p); });
  }

  /// Frees loops, fixes bridges, numbers the other blocks. Returns whether anything changed.
  bool connect() {
    progress_.check();
    const auto gone = [&](std::uint32_t q) {
      if (out_.label[q] == Label::Open && needs_link(q)) return false;
      enqueue(q);
      return true;
    };
    std::erase_if(linked_, gone);
    const std::vector<NodePair> edges = contracted();
    Blocks blocks = find_blocks(edges, contracted_nodes_);
    out_.block_count = static_cast<std::uint32_t>(blocks.size.size());
    bool changed = !work_.empty();
    for (std::size_t i = 0; i < linked_.size(); ++i) {
      const std::uint32_t q = linked_[i];
      if (blocks.size[blocks.block[i]] > 1) continue;
      fix(q, problem_.link[q].helpful());
      changed = true;
    }
    if (!changed) out_.links = LinkBlocks(problem_.size(), std::move(linked_), std::move(blocks.block));
    return changed;
  }

  /// The undecided links between contracted nodes, these numbered by first appearance.
  std::vector<NodePair> contracted() {
    number_.resize(problem_.node_count, kNone);
    contracted_nodes_ = 0;
    std::vector<std::uint32_t> numbered;
    const auto number_of = [&](std::uint32_t node) {
      const std::uint32_t root = out_.nodes.find(node);
      if (number_[root] == kNone) {
        number_[root] = contracted_nodes_++;
        numbered.push_back(root);
      }
      return number_[root];
    };
    std::vector<NodePair> edges;
    edges.reserve(linked_.size());
    for (const std::uint32_t q : linked_) {
      const std::uint32_t a = number_of(problem_.link[q].a), b = number_of(problem_.link[q].b);
      edges.emplace_back(a, b);
    }
    for (const std::uint32_t root : numbered) number_[root] = kNone;
    return edges;
  }

  const Labelling<Criteria>& problem_;
  const Progress& progress_;
  Reduction out_;
  std::vector<std::uint8_t> queued_;  ///< by variable: whether it is on a work list
  std::vector<std::uint32_t> work_, again_;
  std::vector<std::uint32_t> linked_;  ///< open variables whose link is no loop
  std::vector<std::uint32_t> number_;  ///< by node, while it is numbered
  std::uint32_t contracted_nodes_ = 0;
};

}  // namespace

template <std::size_t Criteria>
Reduction reduce(const Labelling<Criteria>& problem, const Progress& progress) {
  return Reducer<Criteria>(problem, progress).run();
}

namespace {

/// Components: those within a block of variables are found by one thread, the others when all blocks are
/// done.
template <std::size_t Criteria>
class Splitter {
 public:
  Splitter(const Labelling<Criteria>& problem, const Reduction& reduction)
      : problem_(problem),
        reduction_(reduction),
        first_of_link_block_(reduction.block_count + 1, 0),
        reached_(problem.size(), 0),
        link_block_reached_(reduction.block_count, 0),
        table_reached_(problem.tables.size(), 0) {
    const std::span<const std::uint32_t> linked = reduction.links.variables();
    const std::span<const std::uint32_t> block = reduction.links.blocks();
    for (const std::uint32_t b : block) ++first_of_link_block_[b + 1];
    std::partial_sum(first_of_link_block_.begin(), first_of_link_block_.end(), first_of_link_block_.begin());
    in_link_blocks_.resize(first_of_link_block_.back());
    std::vector<std::uint32_t> fill(first_of_link_block_.begin(), first_of_link_block_.end() - 1);
    for (std::size_t i = 0; i < linked.size(); ++i) in_link_blocks_[fill[block[i]]++] = linked[i];
  }

  Partition run(const Progress& progress) {
    struct Found {
      Partition parts;
      std::vector<std::uint32_t> outside;  // variables of components that go beyond the block
    };
    std::vector<std::uint32_t> outside;
    for_each_block_in_order<Found>(
        problem_.size(), block_size(problem_), progress,
        [&](std::size_t begin, std::size_t end, Found& found) {
          found = {};
          const IdRange ours{static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)};
          for (std::uint32_t seed = ours.begin; seed < ours.end; ++seed) {
            take_component(seed, ours, found.parts, found.outside);
          }
        },
        [&](std::size_t, std::size_t, const Found& found) {
          const auto before = static_cast<std::uint32_t>(parts_.variable.size());
          for (std::size_t i = 1; i < found.parts.first.size(); ++i) {
            parts_.first.push_back(before + found.parts.first[i]);
          }
          parts_.variable.insert(parts_.variable.end(), found.parts.variable.begin(),
                                 found.parts.variable.end());
          outside.insert(outside.end(), found.outside.begin(), found.outside.end());
        });
    for (const std::uint32_t q : outside) {
      reached_[q] = 0;
      const std::uint32_t block = reduction_.links.of(q);
      if (block != kNone) link_block_reached_[block] = 0;
    }
    std::vector<std::uint32_t> none;
    for (const std::uint32_t seed : outside) {
      take_component(seed, {0, static_cast<std::uint32_t>(problem_.size())}, parts_, none);
    }
    return std::move(parts_);
  }

 private:
  /// Appends the component of a variable as a part, if it is new and lies within the range; what of it does
  /// is outside, if not all does.
  void take_component(std::uint32_t seed, IdRange ours, Partition& parts,
                      std::vector<std::uint32_t>& outside) {
    const std::size_t first = parts.first.back();
    bool whole = true;
    const auto reach = [&](std::uint32_t q) {
      if (reduction_.label[q] != Label::Open) return;
      if (!ours.contains(q)) {
        whole = false;
      } else if (std::exchange(reached_[q], 1) == 0) {
        parts.variable.push_back(q);
      }
    };
    reach(seed);
    for (std::size_t i = first; i < parts.variable.size(); ++i) reach_from(parts.variable[i], ours, reach);
    if (!whole) {
      outside.insert(outside.end(), parts.variable.begin() + static_cast<std::ptrdiff_t>(first),
                     parts.variable.end());
      parts.variable.resize(first);
    } else if (parts.variable.size() > first) {
      parts.first.push_back(static_cast<std::uint32_t>(parts.variable.size()));
    }
  }

  template <class Reach>
  void reach_from(std::uint32_t q, IdRange ours, const Reach& reach) {
    for (std::size_t j = problem_.first[q]; j < problem_.first[q + 1]; ++j) {
      if (!is_zero<Criteria>(problem_.weight[j])) reach(problem_.neighbour[j]);
    }
    for (const std::uint32_t t : problem_.tables.of(q)) {
      if (std::exchange(table_reached_[t], 1) != 0) continue;
      const std::vector<std::uint32_t> scope =
          condition<Criteria>(problem_.tables, t, reduction_.label).scope;
      // Seen from a variable on which it depends no more, a table joins nothing yet.
      if (std::find(scope.begin(), scope.end(), q) == scope.end())
        table_reached_[t] = 0;
      else
        std::for_each(scope.begin(), scope.end(), reach);
    }
    const std::uint32_t block = reduction_.links.of(q);
    if (block == kNone) return;
    const std::span<const std::uint32_t> linked = link_block(block);
    if (!ours.contains(linked.front()) || !ours.contains(linked.back())) {
      reach(ours.contains(linked.front()) ? linked.back() : linked.front());  // which ends it
    } else if (std::exchange(link_block_reached_[block], 1) == 0) {
      std::for_each(linked.begin(), linked.end(), reach);
    }
  }

  /// Ascending.
  [[nodiscard]] std::span<const std::uint32_t> link_block(std::uint32_t block) const {
    return std::span(in_link_blocks_)
        .subspan(first_of_link_block_[block], first_of_link_block_[block + 1] - first_of_link_block_[block]);
  }

  const Labelling<Criteria>& problem_;
  const Reduction& reduction_;
  std::vector<std::uint32_t> first_of_link_block_, in_link_blocks_;
  std::vector<std::uint8_t> reached_, link_block_reached_, table_reached_;
  Partition parts_;
};

}  // namespace

template <std::size_t Criteria>
Partition split(const Labelling<Criteria>& problem, const Reduction& reduction, const Progress& progress) {
  return Splitter<Criteria>(problem, reduction).run(progress);
}

template Reduction reduce(const Labelling<1>&, const Progress&);
template Reduction reduce(const Labelling<2>&, const Progress&);
template Reduction reduce(const Labelling<4>&, const Progress&);
template Partition split(const Labelling<1>&, const Reduction&, const Progress&);
template Partition split(const Labelling<2>&, const Reduction&, const Progress&);
template Partition split(const Labelling<4>&, const Reduction&, const Progress&);

}  // namespace thalweg
