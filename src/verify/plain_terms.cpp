// Every triangle and every edge once, under each label of the quadrilaterals that it touches.
#include "verify/plain_terms.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace thalweg::verify {

namespace {

class Terms {
 public:
  Terms(const PlainProblem& problem, const std::vector<Component>& components)
      : problem_(problem), components_(components) {}

  std::vector<Factor> factors() {
    const PlainMesh& mesh = problem_.delaunay;
    Cost constant{};
    for (const Component& component : components_) {
      if (component.counts_beyond) continue;
      const std::int64_t steps = constant_term(mesh, problem_.scale, component.criterion);
      constant[component.place] += component.criterion.maximised ? -steps : steps;
    }
    add({}, {constant});
    quadrilateral_of_.assign(mesh.triangles.size(), kNone);
    for (Index q = 0; q < problem_.quadrilaterals.size(); ++q) {
      const auto& [s, u, t, v, left, right] = problem_.quadrilaterals[q];
      quadrilateral_of_[left] = quadrilateral_of_[right] = q;
      add({q}, {plus(triangle(u, v, s), triangle(v, u, t)), plus(triangle(s, u, t), triangle(t, v, s))});
      add({q}, {edge(u, v, s, t), edge(s, t, v, u)});
    }
    for (Index t = 0; t < mesh.triangles.size(); ++t) {
      const Corners& c = mesh.triangles[t];
      if (quadrilateral_of_[t] == kNone) add({}, {triangle(c[0], c[1], c[2])});
      for (Index i = 0; i < 3; ++i) {
        const Index other = mesh.across[t][i];
        if (other != kNone && t < other) add_side(t, other, c[i], c[(i + 1) % 3], c[(i + 2) % 3]);
      }
    }
    std::vector<Factor> factors;
    for (auto& [scope, table] : tables_) factors.push_back({scope, std::move(table)});
    return factors;
  }

 private:
  // Between two triangles, at least one of which may be of a quadrilateral.
  void add_side(Index t, Index other, Index a, Index b, Index l) {
    const Index p = quadrilateral_of_[t], q = quadrilateral_of_[other];
    if (p == q && p != kNone) return;  // its diagonal
    Index r = kNone;
    for (const Index v : problem_.delaunay.triangles[other]) {
      if (v != a && v != b) r = v;
    }
    const auto apex = [&](Index quadrilateral, bool label, Index delaunay_apex) {
      if (quadrilateral == kNone || !label) return delaunay_apex;
      const PlainQuadrilateral& which = problem_.quadrilaterals[quadrilateral];
      return which.s == a || which.s == b ? which.t : which.s;  // the end of st that is not on the side
    };
    if (p == kNone && q == kNone) {
      add({}, {edge(a, b, l, r)});
    } else if (p == kNone || q == kNone) {
      const Index one = p == kNone ? q : p;
      add({one}, {edge(a, b, l, r), edge(a, b, apex(p, true, l), apex(q, true, r))});
    } else {
      std::vector<Cost> table;
      for (std::size_t i = 0; i < 4; ++i) {
        const bool low = (i & 1U) != 0, high = (i & 2U) != 0;
        table.push_back(edge(a, b, apex(p, p < q ? low : high, l), apex(q, p < q ? high : low, r)));
      }
      add({std::min(p, q), std::max(p, q)}, table);
    }
  }

  void add(const std::vector<Index>& scope, const std::vector<Cost>& table) {
    std::vector<Cost>& sum = tables_[scope];
    sum.resize(table.size());
    for (std::size_t i = 0; i < table.size(); ++i) sum[i] = plus(sum[i], table[i]);
  }

  [[nodiscard]] std::int64_t counted(const Component& component, std::int64_t term) const {
    const PlainCriterion& criterion = component.criterion;
    if (!component.counts_beyond) return criterion.maximised ? -term : term;
    return (criterion.combines == Combines::Largest ? term >= component.limit : term <= component.limit) ? 1
                                                                                                         : 0;
  }
  [[nodiscard]] Cost triangle(Index a, Index b, Index c) const {
    Cost cost{};
    for (const Component& component : components_) {
      if (component.criterion.depends == Depends::OnEdge && component.criterion.parts.size() == 1) continue;
      cost[component.place] +=
          counted(component, triangle_term(problem_.delaunay, problem_.scale, component.criterion, a, b, c));
    }
    return cost;
  }
  [[nodiscard]] Cost edge(Index a, Index b, Index l, Index r) const {
    Cost cost{};
    for (const Component& component : components_) {
      if (component.criterion.depends == Depends::OnTriangle) continue;
      cost[component.place] +=
          counted(component, edge_term(problem_.delaunay, problem_.scale, component.criterion, a, b, l, r));
    }
    return cost;
  }

  const PlainProblem& problem_;
  const std::vector<Component>& components_;
  std::vector<Index> quadrilateral_of_;
  std::map<std::vector<Index>, std::vector<Cost>> tables_;
};

}  // namespace

std::vector<Factor> terms_of(const PlainProblem& problem, const std::vector<Component>& components) {
  return Terms(problem, components).factors();
}

}  // namespace thalweg::verify
