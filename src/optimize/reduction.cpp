// Dead ends, contraction, bridges.
//
// 1. Let D(q) = cost with label 1 less that with label 0; it depends on the neighbours' labels. Over all
// labels that
//    they may still have, D lies between lo(q) and hi(q). If lo >= 0, label 0 is never worse; if hi <= 0,
//    label 1. Such a label may be fixed, at once if it is the helpful one of its link or there is no link: a
//    link more never disconnects. The unhelpful label may be fixed if fixed links connect the ends of its
//    link already: whatever the others are, the link is not needed. Desmet et al., The dead-end elimination
//    theorem, 1992, in an ordered group.
// 2. Fixing narrows the intervals of the neighbours, which go on a work list.
// 3. Links that are fixed to be there are contracted; those that became loops are free. Among the rest, a
// bridge of
//    the graph of links that may still be there has to be there. Its label is fixed, and so on until nothing
//    moves.
// Every condition, once true, stays true while labels are fixed, so the final set is the same in any order.
#include "optimize/reduction.hpp"

#include "base/parallel.hpp"
#include "optimize/blocks.hpp"

#include <thalweg/base/assert.hpp>

#include <algorithm>
#include <utility>

namespace thalweg {

namespace {

constexpr std::size_t kBlock = 8192;

template <std::size_t Criteria>
class Reducer {
 public:
  Reducer(const Labelling<Criteria>& problem, const Progress& progress)
      : problem_(problem), progress_(progress), queued_(problem.size(), Queued::No) {
    out_.label.assign(problem.size(), Label::Open);
    out_.block.assign(problem.size(), kNone);
    out_.nodes = UnionFind(problem.node_count);
  }

  /// Whether a variable is on the work list, and if so, with which verdict.
  enum class Queued : std::uint8_t { No, Unjudged, ForZero, ForOne };

  Reduction run() {
    fill_work_list();
    for (std::uint32_t q = 0; q < problem_.link.size(); ++q) {
      if (problem_.link[q].exists()) linked_.push_back(q);
    }
    drain_work_list();
    while (connect()) drain_work_list();
    return std::move(out_);
  }

 private:
  /// The label that is never worse, if there is one.
  [[nodiscard]] Label verdict(std::uint32_t q) const {
    Cost<Criteria> lo = problem_.unary[q];
    Cost<Criteria> hi = lo;
    for (std::size_t i = problem_.first[q]; i < problem_.first[q + 1]; ++i) {
      const Weight<Criteria>& weight = problem_.weight[i];
      const Label label = out_.label[problem_.neighbour[i]];
      if (label == Label::Zero) continue;
      const bool negative = is_negative<Criteria>(weight);
      if (label == Label::One || negative) add(lo, weight);
      if (label == Label::One || !negative) add(hi, weight);
    }
    for (const std::uint32_t i : problem_.tables.of(q)) {
      const auto [least, most] = spread<Criteria>(problem_.tables, i, q, out_.label);
      add(lo, least);
      add(hi, most);
    }
    const Cost<Criteria> zero{};
    if (!(lo < zero)) return Label::Zero;
    if (!(zero < hi)) return Label::One;
    return Label::Open;
  }

  [[nodiscard]] bool needs_link(std::uint32_t q) {
    return problem_.has_link(q) && out_.nodes.find(problem_.link[q].a) != out_.nodes.find(problem_.link[q].b);
  }

  /// While all labels are open, a verdict reads nothing that others write. It stays true.
  void fill_work_list() {
    for_each_block(problem_.size(), kBlock, progress_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t q = begin; q < end; ++q) {
        const Label label = verdict(static_cast<std::uint32_t>(q));
        queued_[q] = label == Label::Zero  ? Queued::ForZero
                     : label == Label::One ? Queued::ForOne
                                           : Queued::No;
      }
    });
    for (std::uint32_t q = 0; q < queued_.size(); ++q) {
      if (queued_[q] != Queued::No) work_.push_back(q);
    }
  }

  void enqueue(std::uint32_t q) {
    if (queued_[q] != Queued::No || out_.label[q] != Label::Open) return;
    queued_[q] = Queued::Unjudged;
    work_.push_back(q);
  }

  void drain_work_list() {
    for (std::size_t i = 0; i < work_.size(); ++i) {
      if (i % kBlock == 0) progress_.check();
      const std::uint32_t q = work_[i];
      const Queued queued = std::exchange(queued_[q], Queued::No);
      if (out_.label[q] != Label::Open) continue;
      const Label label = queued == Queued::ForZero  ? Label::Zero
                          : queued == Queued::ForOne ? Label::One
                                                     : verdict(q);
      if (label == Label::Open) continue;
      if (needs_link(q) && label != problem_.link[q].helpful) continue;
      fix(q, label);
    }
    work_.clear();
  }

  void fix(std::uint32_t q, Label label) {
    out_.label[q] = label;
    if (problem_.has_link(q) && label == problem_.link[q].helpful) {
      out_.nodes.unite(problem_.link[q].a, problem_.link[q].b);
    }
    for (std::size_t i = problem_.first[q]; i < problem_.first[q + 1]; ++i) enqueue(problem_.neighbour[i]);
    for (const std::uint32_t i : problem_.tables.of(q)) {
      for (const std::uint32_t p : problem_.tables.scope(i)) enqueue(p);
    }
  }

  /// Frees loops, fixes bridges, numbers the other blocks. Returns whether anything changed.
  bool connect() {
    progress_.check();
    const auto gone = [&](std::uint32_t q) {
      if (out_.label[q] == Label::Open && needs_link(q)) return false;
      enqueue(q);
      out_.block[q] = kNone;
      return true;
    };
    std::erase_if(linked_, gone);
    const std::vector<NodePair> edges = contracted();
    const Blocks blocks = find_blocks(edges, contracted_nodes_);
    out_.block_count = static_cast<std::uint32_t>(blocks.size.size());
    bool changed = !work_.empty();
    for (std::size_t i = 0; i < linked_.size(); ++i) {
      const std::uint32_t q = linked_[i];
      out_.block[q] = blocks.block[i];
      if (blocks.size[blocks.block[i]] > 1) continue;
      out_.block[q] = kNone;
      fix(q, problem_.link[q].helpful);
      changed = true;
    }
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
  std::vector<Queued> queued_;  ///< by variable
  std::vector<std::uint32_t> work_;
  std::vector<std::uint32_t> linked_;  ///< open variables whose link is no loop
  std::vector<std::uint32_t> number_;  ///< by node, while it is numbered
  std::uint32_t contracted_nodes_ = 0;
};

}  // namespace

template <std::size_t Criteria>
Reduction reduce(const Labelling<Criteria>& problem, const Progress& progress) {
  return Reducer<Criteria>(problem, progress).run();
}

template <std::size_t Criteria>
Partition split(const Labelling<Criteria>& problem, const Reduction& reduction) {
  std::vector<std::uint32_t> first_of_block(reduction.block_count + 1, 0), in_blocks;
  for (const std::uint32_t block : reduction.block) {
    if (block != kNone) ++first_of_block[block + 1];
  }
  for (std::size_t i = 0; i < reduction.block_count; ++i) first_of_block[i + 1] += first_of_block[i];
  in_blocks.resize(first_of_block.back());
  std::vector<std::uint32_t> fill(first_of_block.begin(), first_of_block.end() - 1);
  for (std::uint32_t q = 0; q < problem.size(); ++q) {
    if (reduction.block[q] != kNone) in_blocks[fill[reduction.block[q]]++] = q;
  }

  Partition parts;
  std::vector<std::uint8_t> reached(problem.size(), 0), block_reached(reduction.block_count, 0),
      table_reached(problem.tables.size(), 0);
  const auto reach = [&](std::uint32_t q) {
    if (reached[q] != 0 || reduction.label[q] != Label::Open) return;
    reached[q] = 1;
    parts.variable.push_back(q);
  };
  for (std::uint32_t seed = 0; seed < problem.size(); ++seed) {
    reach(seed);
    for (std::size_t i = parts.first.back(); i < parts.variable.size(); ++i) {
      const std::uint32_t q = parts.variable[i];
      for (std::size_t j = problem.first[q]; j < problem.first[q + 1]; ++j) {
        if (!is_zero<Criteria>(problem.weight[j])) reach(problem.neighbour[j]);
      }
      for (const std::uint32_t t : problem.tables.of(q)) {
        if (std::exchange(table_reached[t], 1) != 0) continue;
        const std::vector<std::uint32_t> scope =
            condition<Criteria>(problem.tables, t, reduction.label).scope;
        // Seen from a variable on which it depends no more, a table joins nothing yet.
        if (std::find(scope.begin(), scope.end(), q) == scope.end())
          table_reached[t] = 0;
        else
          std::for_each(scope.begin(), scope.end(), reach);
      }
      const std::uint32_t block = reduction.block[q];
      if (block == kNone || block_reached[block] != 0) continue;
      block_reached[block] = 1;
      for (std::size_t j = first_of_block[block]; j < first_of_block[block + 1]; ++j) reach(in_blocks[j]);
    }
    if (parts.variable.size() > parts.first.back()) {
      parts.first.push_back(static_cast<std::uint32_t>(parts.variable.size()));
    }
  }
  return parts;
}

template Reduction reduce(const Labelling<1>&, const Progress&);
template Reduction reduce(const Labelling<2>&, const Progress&);
template Reduction reduce(const Labelling<4>&, const Progress&);
template Partition split(const Labelling<1>&, const Reduction&);
template Partition split(const Labelling<2>&, const Reduction&);
template Partition split(const Labelling<4>&, const Reduction&);

}  // namespace thalweg
