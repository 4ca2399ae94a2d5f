// Roof duality.
//
// 1. The cost is written as a constant plus non-negative terms a l and a l m of literals l, m (x or 1 - x). A
//    term a l m becomes arcs l -> not m and m -> not l of capacity a, "if l is true, m is false or a is
//    paid"; a term a l is a l TRUE, with TRUE the source and its negation the sink. Half the maximum flow can
//    be paid in no labelling less.
// 2. With l -> m read as (not m) -> (not l), a flow has a mirror image; half of both together is a maximum
//    flow that is its own image. What its residual arcs still charge is again a sum of non-negative terms.
//    Let S be the literals that residual arcs reach from the source. They are consistent, and making all of S
//    true annuls every term that touches S: no arc leaves S. If some l in S is false, there is a first false
//    literal on a residual path from the source to l, and a positive term is paid. So every optimum has S.
// 3. A label that takes away a link may be forbidden. Let B be the literals of S that do so. Those in S that
//    reach B are given up; of the rest, those that residual arcs reach from the source without entering what
//    was given up, form a set S' that no arc leaves either. Whatever labelling is feasible, making S' true
//    only adds links or leaves them alone, so 2 holds with S' in place of S, and every optimum of the problem
//    with links has S'.
// Based on: Hammer, Hansen, Simeone, Roof duality, 1984; Boros, Hammer, Pseudo-Boolean optimization, 2002.
#include "optimize/roof_duality.hpp"

#include "optimize/max_flow.hpp"
#include "optimize/piece.hpp"

#include <algorithm>
#include <limits>

namespace thalweg {

namespace {

/// Node of the literal "variable has this label".
std::uint32_t literal(std::uint32_t variable, Label label) {
  return 2 * variable + (label == Label::One ? 1 : 0);
}
std::uint32_t negation(std::uint32_t node) {
  return node ^ 1U;
}

/// TRUE and FALSE are the literals of one variable more.
class Network {
 public:
  template <std::size_t Criteria>
  explicit Network(const Labelling<Criteria>& problem)
      : source_(literal(static_cast<std::uint32_t>(problem.size()), Label::One)),
        flow_(2 * problem.size() + 2) {
    std::vector<std::int64_t> unary;
    for (const Weight<Criteria>& levels : problem.unary.levels()) unary.push_back(levels[0]);
    for (const PairCost<Criteria>& pair : pairs_of(problem)) {
      const std::int64_t weight = pair.weight[0];
      const std::uint32_t a = literal(pair.a, Label::One), b = literal(pair.b, Label::One);
      if (weight > 0) charge(a, b, weight);
      if (weight < 0) {  // w x y = w x - w x (1 - y)
        unary[pair.a] += weight;
        charge(a, negation(b), -weight);
      }
    }
    for (std::uint32_t q = 0; q < unary.size(); ++q) {
      if (unary[q] > 0) charge(literal(q, Label::One), source_, unary[q]);
      if (unary[q] < 0) {  // u x = u - u (1 - x)
        constant_ += unary[q];
        charge(literal(q, Label::Zero), source_, -unary[q]);
      }
    }
  }

  std::int64_t bound(const Progress& progress) {
    const std::int64_t flow = flow_.maximise(source_, negation(source_), progress);
    return constant_ + (flow + 1) / 2;
  }

  /// Literals that residual arcs reach from the source, without passing through `forbidden`.
  [[nodiscard]] std::vector<bool> reach(const std::vector<bool>& forbidden) const {
    std::vector<bool> reached(forbidden.size(), false);
    std::vector<std::uint32_t> queue = {source_};
    for (std::size_t i = 0; i < queue.size(); ++i) {
      for_each_implied(queue[i], [&](std::uint32_t to) {
        if (reached[to] || forbidden[to]) return;
        reached[to] = true;
        queue.push_back(to);
      });
    }
    return reached;
  }

  /// Literals of `inside` from which residual arcs reach `targets`, these included.
  [[nodiscard]] std::vector<bool> reaching(std::vector<std::uint32_t> targets,
                                           const std::vector<bool>& inside) const {
    std::vector<std::vector<std::uint32_t>> into(inside.size());
    for (std::uint32_t from = 0; from < inside.size(); ++from) {
      if (!inside[from]) continue;
      for_each_implied(from, [&](std::uint32_t to) { into[to].push_back(from); });
    }
    std::vector<bool> found(inside.size(), false);
    for (const std::uint32_t target : targets) found[target] = true;
    for (std::size_t i = 0; i < targets.size(); ++i) {
      for (const std::uint32_t from : into[targets[i]]) {
        if (found[from]) continue;
        found[from] = true;
        targets.push_back(from);
      }
    }
    return found;
  }

 private:
  /// Literals at the end of residual arcs, those of the flow's mirror image included.
  template <class Visit>
  void for_each_implied(std::uint32_t from, const Visit& visit) const {
    flow_.for_each_arc(from, [&](std::uint32_t to, std::int64_t there, std::int64_t /*back*/) {
      if (there > 0) visit(to);
    });
    flow_.for_each_arc(negation(from), [&](std::uint32_t to, std::int64_t /*there*/, std::int64_t back) {
      if (back > 0) visit(negation(to));
    });
  }

  /// Adds a term that is paid if both literals are true.
  void charge(std::uint32_t a, std::uint32_t b, std::int64_t cost) {
    flow_.add_arc(a, negation(b), cost);
    flow_.add_arc(b, negation(a), cost);
  }

  std::uint32_t source_;
  std::int64_t constant_ = 0;
  FlowNetwork flow_;
};

}  // namespace

template <std::size_t Criteria>
RoofDual find_roof_dual(const Labelling<Criteria>& problem, const Progress& progress) {
  RoofDual dual;
  if (problem.tables.reach_level(0)) {
    dual.label.assign(problem.size(), Label::Open);
    dual.bound = std::numeric_limits<std::int64_t>::min();
    return dual;
  }
  Network network(problem);
  dual.bound = network.bound(progress);
  const std::vector<bool> none(2 * problem.size() + 2, false);
  const std::vector<bool> all = network.reach(none);
  std::vector<std::uint32_t> harmful;
  for (std::uint32_t q = 0; q < problem.size(); ++q) {
    if (!problem.has_link(q)) continue;
    const std::uint32_t unhelpful = literal(q, other(problem.link[q].helpful()));
    if (all[unhelpful]) harmful.push_back(unhelpful);
  }
  const std::vector<bool> kept =
      harmful.empty() ? all : network.reach(network.reaching(std::move(harmful), all));
  dual.label.assign(problem.size(), Label::Open);
  for (std::uint32_t q = 0; q < problem.size(); ++q) {
    for (const Label label : {Label::Zero, Label::One}) {
      if (kept[literal(q, label)]) dual.label[q] = label;
    }
  }
  return dual;
}

template RoofDual find_roof_dual(const Labelling<1>&, const Progress&);
template RoofDual find_roof_dual(const Labelling<2>&, const Progress&);
template RoofDual find_roof_dual(const Labelling<4>&, const Progress&);

}  // namespace thalweg
