// Every triangle, edge and vertex once, under each label of the quadrilaterals that it touches.
#include "verify/plain_terms.hpp"

#include <algorithm>
#include <array>
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
    if (std::any_of(components_.begin(), components_.end(),
                    [](const Component& c) { return has_vertex_part(c.criterion); })) {
      add_vertices();
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
      return apex_of(quadrilateral, label, a, b, delaunay_apex);
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

  /// An edge at a vertex, there while a quadrilateral has the label, or always; how it bends depends on the
  /// labels of at most two.
  struct Spoke {
    Index quadrilateral = kNone;
    bool label = false;
    Index left = kNone, right = kNone;  ///< quadrilaterals beside it
    std::array<int, 4> bend{};          ///< bit 0: label of `left`, bit 1: of `right`
  };

  /// The apex of the triangle beside a side ab, if its quadrilateral, which may be none, has the label.
  [[nodiscard]] Index apex_of(Index quadrilateral, bool label, Index a, Index b, Index delaunay_apex) const {
    if (quadrilateral == kNone || !label) return delaunay_apex;
    const PlainQuadrilateral& which = problem_.quadrilaterals[quadrilateral];
    return which.s == a || which.s == b ? which.t : which.s;  // the end of st that is not on the side
  }

  void add_vertices() {
    const PlainMesh& mesh = problem_.delaunay;
    std::vector<std::vector<Spoke>> spokes(mesh.xy.size());
    std::vector<std::vector<Index>> scopes(mesh.xy.size());
    const auto add_spoke = [&](Index a, Index b, const Spoke& spoke) {
      spokes[a].push_back(spoke);
      spokes[b].push_back(spoke);
    };
    for (Index q = 0; q < problem_.quadrilaterals.size(); ++q) {
      const auto& [s, u, t, v, left, right] = problem_.quadrilaterals[q];
      const int kept = bend(mesh, u, v, s, t), flipped = bend(mesh, s, t, v, u);
      add_spoke(u, v, {q, false, kNone, kNone, {kept, kept, kept, kept}});
      add_spoke(s, t, {q, true, kNone, kNone, {flipped, flipped, flipped, flipped}});
      for (const Index corner : {s, u, t, v}) scopes[corner].push_back(q);
    }
    for (Index t = 0; t < mesh.triangles.size(); ++t) {
      for (Index i = 0; i < 3; ++i) {
        const Index other = mesh.across[t][i], a = mesh.triangles[t][i], b = mesh.triangles[t][(i + 1) % 3],
                    l = mesh.triangles[t][(i + 2) % 3];
        if (other == kNone) add_spoke(a, b, {});
        if (other == kNone || other < t) continue;
        const Index p = quadrilateral_of_[t], q = quadrilateral_of_[other];
        if (p == q && p != kNone) continue;  // a diagonal
        Index r = kNone;
        for (const Index v : mesh.triangles[other]) {
          if (v != a && v != b) r = v;
        }
        Spoke spoke{kNone, false, p, q, {}};
        for (std::size_t labels = 0; labels < spoke.bend.size(); ++labels) {
          spoke.bend[labels] = bend(mesh, a, b, apex_of(p, (labels & 1U) != 0, a, b, l),
                                    apex_of(q, (labels & 2U) != 0, a, b, r));
        }
        add_spoke(a, b, spoke);
      }
    }
    const std::vector<bool> rim = rim_of(mesh);
    for (Index v = 0; v < spokes.size(); ++v) {
      if (!spokes[v].empty()) add_vertex(scopes[v], spokes[v], rim[v]);
    }
  }

  void add_vertex(const std::vector<Index>& scope, const std::vector<Spoke>& spokes, bool on_rim) {
    std::vector<Cost> table(std::size_t{1} << scope.size());
    for (std::size_t labels = 0; labels < table.size(); ++labels) {
      const auto label_of = [&](Index q) {
        const auto place = std::find(scope.begin(), scope.end(), q) - scope.begin();
        return q != kNone && (labels >> static_cast<std::size_t>(place) & 1U) != 0;
      };
      PlainRing ring{.on_rim = on_rim};
      for (const Spoke& spoke : spokes) {
        if (spoke.quadrilateral != kNone && label_of(spoke.quadrilateral) != spoke.label) continue;
        const int side = spoke.bend[(label_of(spoke.left) ? 1U : 0U) + (label_of(spoke.right) ? 2U : 0U)];
        ++ring.edges;
        ring.convex += side > 0 ? 1 : 0;
        ring.reflex += side < 0 ? 1 : 0;
      }
      for (const Component& component : components_) {
        if (!has_vertex_part(component.criterion)) continue;
        table[labels][component.place] += counted(component, vertex_term(component.criterion, ring));
      }
    }
    add(scope, table);
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
      const bool alone = component.criterion.parts.size() == 1;
      if (alone && component.criterion.depends != Depends::OnTriangle) continue;
      cost[component.place] +=
          counted(component, triangle_term(problem_.delaunay, problem_.scale, component.criterion, a, b, c));
    }
    return cost;
  }
  [[nodiscard]] Cost edge(Index a, Index b, Index l, Index r) const {
    Cost cost{};
    for (const Component& component : components_) {
      const bool alone = component.criterion.parts.size() == 1;
      if (alone && component.criterion.depends != Depends::OnEdge) continue;
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

std::size_t most_at_vertex(const PlainProblem& problem) {
  std::vector<std::size_t> count(problem.delaunay.xy.size(), 0);
  for (const PlainQuadrilateral& q : problem.quadrilaterals) {
    for (const Index corner : {q.s, q.u, q.t, q.v}) ++count[corner];
  }
  return count.empty() ? 0 : *std::max_element(count.begin(), count.end());
}

std::vector<Factor> terms_of(const PlainProblem& problem, const std::vector<Component>& components) {
  return Terms(problem, components).factors();
}

}  // namespace thalweg::verify
