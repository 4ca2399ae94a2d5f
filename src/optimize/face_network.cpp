// Faces, pairs, outlets.
//
// 1. Each face's labels and their costs: face_program.cpp. Two faces are coupled at each fixed edge between
//    them, by the term of the two triangles there.
// 2. Pits. A node is no pit if it can be followed along links to node 0: each node names one link, of a face,
//    as its outlet; a variable says which. If the face's label does not have the link, that costs a pit. So
//    the sum is least when as many nodes as can be have an outlet. For one choice of labels it is the number
//    of components without node 0, if outlets do not go in circles: two nodes that name each other cost a
//    pit; and for each larger set that turned out to be closed, a variable names one of its nodes, which
//    costs a pit if its outlet stays in the set. Without all such sets the sum is a bound.
#include "optimize/face_network.hpp"

#include "base/parallel.hpp"

#include <thalweg/base/error.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

namespace thalweg {

namespace {

constexpr std::size_t kFaces = 64;

/// A link as an outlet of one of its nodes.
struct Outlet {
  std::uint32_t node = 0;
  std::uint32_t target = 0;
  std::uint32_t face = 0;
  std::uint32_t link = 0;  ///< of the face
  auto operator<=>(const Outlet&) const = default;
};

template <std::size_t Criteria>
class Builder {
 public:
  Builder(const FaceTerms<Criteria>& terms, const SideWeights<Criteria>& sides,
          const std::vector<FaceLabels<Criteria>>& faces)
      : terms_(terms), sides_(sides), faces_(faces) {}

  FaceNetwork<Criteria> run(PlateauNodes* pits, std::span<const PlateauSet> closed) {
    LabelNetwork<Criteria>& network = out_.network;
    std::size_t labels = 0;
    for (const FaceLabels<Criteria>& face : faces_) labels += face.unary.size();
    network.unary.reserve(labels);
    network.first_label.reserve(faces_.size() + 1);
    for (const FaceLabels<Criteria>& face : faces_) {
      network.unary.insert(network.unary.end(), face.unary.begin(), face.unary.end());
      take_out_least(network.unary, network.first_label.back());
      network.first_label.push_back(static_cast<std::uint32_t>(network.unary.size()));
    }
    for (std::size_t i = 0; i < sides_.edges.size(); ++i) couple_faces(i);
    if (pits != nullptr) count_pits(*pits, closed);
    refuse_overflow();
    return std::move(out_);
  }

 private:
  static std::int64_t& part(Cost<Criteria>& cost, std::size_t level) { return cost.level[level]; }
  static std::int64_t& part(Weight<Criteria>& weight, std::size_t level) { return weight[level]; }

  // From `first` on there are costs of which each choice has one.
  template <class Costs>
  void take_out_least(std::vector<Costs>& costs, std::size_t first) {
    for (std::size_t level = 0; level < Criteria; ++level) {
      std::int64_t least = std::numeric_limits<std::int64_t>::max();
      for (std::size_t i = first; i < costs.size(); ++i) least = std::min(least, part(costs[i], level));
      for (std::size_t i = first; i < costs.size(); ++i) part(costs[i], level) -= least;
      out_.base[level] += least;
    }
  }

  /// Labels of one variable by their class; `kept`: the classes that there are.
  struct Column {
    std::vector<std::uint16_t> place;  ///< by label, in `kept`
    std::vector<std::uint16_t> kept;
    void take(std::span<const std::uint16_t> classes) {
      place.clear();
      kept.clear();
      for (const std::uint16_t known : classes) {
        const auto at = std::find(kept.begin(), kept.end(), known);
        place.push_back(static_cast<std::uint16_t>(at - kept.begin()));
        if (at == kept.end()) kept.push_back(known);
      }
    }
  };

  // Adds a term of two variables, given the class of each of their labels: where all labels of one have the
  // same class, it is a term of the other alone.
  template <class WeightOf>
  void couple(std::uint32_t a, std::span<const std::uint16_t> class_a, std::uint32_t b,
              std::span<const std::uint16_t> class_b, const WeightOf& weight) {
    LabelNetwork<Criteria>& network = out_.network;
    of_a_.take(class_a);
    of_b_.take(class_b);
    const std::size_t first = network.weights.size();
    for (const std::uint16_t p : of_a_.kept) {
      for (const std::uint16_t q : of_b_.kept) network.weights.push_back(weight(p, q));
    }
    take_out_least(network.weights, first);
    if (of_a_.kept.size() > 1 && of_b_.kept.size() > 1) {
      network.pairs.push_back({.a = a,
                               .b = b,
                               .class_a = add_classes(of_a_.place),
                               .class_b = add_classes(of_b_.place),
                               .weight = first,
                               .classes_a = static_cast<std::uint16_t>(of_a_.kept.size()),
                               .classes_b = static_cast<std::uint16_t>(of_b_.kept.size())});
      return;
    }
    const bool of_b = of_a_.kept.size() == 1;
    const std::vector<std::uint16_t>& place = of_b ? of_b_.place : of_a_.place;
    const std::uint32_t to = network.first_label[of_b ? b : a];
    for (std::size_t i = 0; i < place.size(); ++i)
      add(network.unary[to + i], network.weights[first + place[i]]);
    network.weights.resize(first);
  }

  std::size_t add_classes(const std::vector<std::uint16_t>& classes) {
    const std::size_t first = out_.network.classes.size();
    out_.network.classes.insert(out_.network.classes.end(), classes.begin(), classes.end());
    return first;
  }

  [[nodiscard]] std::span<const std::uint16_t> column(std::uint32_t face, std::uint32_t side) const {
    const FaceLabels<Criteria>& labels = faces_[face];
    const auto at = std::lower_bound(labels.side.begin(), labels.side.end(), side);
    return labels.places(static_cast<std::size_t>(at - labels.side.begin()));
  }

  // At an edge between two faces; the class of a relaxed face, one more than there are candidates, costs the
  // least of these.
  void couple_faces(std::size_t i) {
    const std::uint32_t e = sides_.edges[i];
    const std::uint32_t a = terms_.sides.owner(2 * e), b = terms_.sides.owner(2 * e + 1);
    const std::size_t of_left = terms_.sides.triangles.row(2 * e).size();
    const std::size_t of_right = terms_.sides.triangles.row(2 * e + 1).size();
    couple(a, column(a, 2 * e), b, column(b, 2 * e + 1), [&](std::size_t p, std::size_t q) {
      if (p < of_left && q < of_right) return sides_.weights[sides_.first[i] + p * of_right + q];
      Weight<Criteria> least;
      least.fill(std::numeric_limits<std::int64_t>::max());
      for (std::size_t x = p < of_left ? p : 0; x < (p < of_left ? p + 1 : of_left); ++x) {
        for (std::size_t y = q < of_right ? q : 0; y < (q < of_right ? q + 1 : of_right); ++y) {
          const Weight<Criteria>& other = sides_.weights[sides_.first[i] + x * of_right + y];
          for (std::size_t level = 0; level < Criteria; ++level)
            least[level] = std::min(least[level], other[level]);
        }
      }
      return least;
    });
  }

  // Outlets of each node, and a variable for each node that has any.
  void count_pits(PlateauNodes& pits, std::span<const PlateauSet> closed) {
    for (std::uint32_t f = 0; f < faces_.size(); ++f) {
      for (std::uint32_t l = 0; l < faces_[f].link.size(); ++l) {
        const auto& [a, b] = faces_[f].link[l];
        outlets_.push_back({a, b, f, l});
        if (b != 0) outlets_.push_back({b, a, f, l});
      }
    }
    std::sort(outlets_.begin(), outlets_.end(), [](const Outlet& x, const Outlet& y) {
      return std::tuple(x.node, x.face, x.link, x.target) < std::tuple(y.node, y.face, y.link, y.target);
    });
    const std::uint32_t nodes = pits.node_count;
    variable_.assign(nodes, kNoVariable);
    first_outlet_.assign(nodes + 1, 0);
    for (const Outlet& outlet : outlets_) ++first_outlet_[outlet.node + 1];
    for (std::uint32_t n = 0; n < nodes; ++n) first_outlet_[n + 1] += first_outlet_[n];
    for (std::uint32_t n = 1; n < nodes; ++n) {
      if (pits.sets.find(n) != n) continue;
      if (first_outlet_[n] == first_outlet_[n + 1]) {
        ++out_.base[*terms_.pit_level];
      } else {
        add_outlets(n);
      }
    }
    for (std::uint32_t n = 1; n < nodes; ++n) forbid_mutual(n);
    for (const PlateauSet& set : closed) open_set(set);
  }

  [[nodiscard]] std::span<const Outlet> outlets(std::uint32_t node) const {
    return std::span(outlets_).subspan(first_outlet_[node], first_outlet_[node + 1] - first_outlet_[node]);
  }

  std::uint32_t add_variable(std::size_t labels) {
    out_.network.unary.resize(out_.network.unary.size() + labels);
    out_.network.first_label.push_back(static_cast<std::uint32_t>(out_.network.unary.size()));
    return static_cast<std::uint32_t>(out_.network.size() - 1);
  }

  // Labels: the outlets, in order; then, where two nodes may name each other, none, at the cost of a pit.
  void add_outlets(std::uint32_t node) {
    const auto list = outlets(node);
    const bool level = std::any_of(list.begin(), list.end(), [](const Outlet& o) { return o.target != 0; });
    const std::size_t labels = list.size() + (level ? 1 : 0);
    variable_[node] = add_variable(labels);
    if (level) out_.network.unary.back().level[*terms_.pit_level] = 1;
    for (std::size_t begin = 0; begin < list.size();) {
      std::size_t end = begin;
      while (end < list.size() && list[end].face == list[begin].face) ++end;
      couple_outlets(variable_[node], labels, list, begin, end);
      begin = end;
    }
  }

  // The outlets begin to end of a node are of one face.
  void couple_outlets(std::uint32_t variable, std::size_t labels, std::span<const Outlet> list,
                      std::size_t begin, std::size_t end) {
    const FaceLabels<Criteria>& face = faces_[list[begin].face];
    std::vector<std::uint16_t> named(labels, 0), joined;
    for (std::size_t i = begin; i < end; ++i) named[i] = static_cast<std::uint16_t>(i - begin + 1);
    std::vector<std::vector<std::uint8_t>> pattern;  // by class
    for (std::size_t label = 0; label < face.unary.size(); ++label) {
      std::vector<std::uint8_t> joins;
      for (std::size_t i = begin; i < end; ++i) joins.push_back(face.has_link(list[i].link, label) ? 1 : 0);
      const auto known = std::find(pattern.begin(), pattern.end(), joins);
      joined.push_back(static_cast<std::uint16_t>(known - pattern.begin()));
      if (known == pattern.end()) pattern.push_back(std::move(joins));
    }
    couple(variable, named, list[begin].face, joined, [&](std::size_t outlet, std::size_t joins) {
      return pits(outlet > 0 && pattern[joins][outlet - 1] == 0);
    });
  }

  [[nodiscard]] Weight<Criteria> pits(bool one) const {
    Weight<Criteria> weight{};
    weight[*terms_.pit_level] = one ? 1 : 0;
    return weight;
  }

  // By label of the node's variable: 1 if its outlet leads to one of the targets.
  template <class IsTarget>
  [[nodiscard]] std::vector<std::uint16_t> leading_to(std::uint32_t node, const IsTarget& is_target) const {
    std::vector<std::uint16_t> leads(out_.network.label_count(variable_[node]), 0);
    const auto list = outlets(node);
    for (std::size_t i = 0; i < list.size(); ++i) leads[i] = is_target(list[i].target) ? 1 : 0;
    return leads;
  }

  // A pit if both are true.
  void forbid(std::uint32_t a, std::span<const std::uint16_t> of_a, std::uint32_t b,
              std::span<const std::uint16_t> of_b) {
    couple(a, of_a, b, of_b, [&](std::size_t p, std::size_t q) { return pits(p == 1 && q == 1); });
  }

  void forbid_mutual(std::uint32_t node) {
    std::vector<std::uint32_t> targets;
    for (const Outlet& outlet : outlets(node)) {
      if (outlet.target > node) targets.push_back(outlet.target);
    }
    std::sort(targets.begin(), targets.end());
    targets.erase(std::unique(targets.begin(), targets.end()), targets.end());
    for (const std::uint32_t other : targets) {
      forbid(variable_[node], leading_to(node, [&](std::uint32_t t) { return t == other; }), variable_[other],
             leading_to(other, [&](std::uint32_t t) { return t == node; }));
    }
  }

  void open_set(const PlateauSet& set) {
    const std::uint32_t variable = add_variable(set.size());
    for (std::size_t i = 0; i < set.size(); ++i) {
      std::vector<std::uint16_t> named(set.size(), 0);
      named[i] = 1;
      forbid(variable, named, variable_[set[i]], leading_to(set[i], [&](std::uint32_t target) {
               return std::binary_search(set.begin(), set.end(), target);
             }));
    }
  }

  /// What a choice costs at most, by what each variable and each pair can.
  [[nodiscard]] double most_at(std::size_t level) const {
    const LabelNetwork<Criteria>& network = out_.network;
    double sum = 0;
    for (std::size_t v = 0; v < network.size(); ++v) {
      double most = 0;
      for (std::size_t i = network.first_label[v]; i < network.first_label[v + 1]; ++i)
        most = std::max(most, std::abs(static_cast<double>(network.unary[i].level[level])));
      sum += most;
    }
    for (const PairTerm& pair : network.pairs) {
      double most = 0;
      for (std::size_t i = 0; i < std::size_t{pair.classes_a} * pair.classes_b; ++i)
        most = std::max(most, std::abs(static_cast<double>(network.weights[pair.weight + i][level])));
      sum += most;
    }
    return sum;
  }

  void refuse_overflow() const {
    for (std::size_t level = 0; level < Criteria; ++level) {
      if (most_at(level) >= kMostSteps) refuse_sums(level);
    }
  }

  static constexpr std::uint32_t kNoVariable = 0xffffffffU;

  const FaceTerms<Criteria>& terms_;
  const SideWeights<Criteria>& sides_;
  const std::vector<FaceLabels<Criteria>>& faces_;
  FaceNetwork<Criteria> out_;
  Column of_a_, of_b_;                     ///< of the term that is added
  std::vector<Outlet> outlets_;            ///< by node and face
  std::vector<std::size_t> first_outlet_;  ///< by node
  std::vector<std::uint32_t> variable_;    ///< by node
};

/// The path of the Delaunay triangulation; none if it has other triangles than candidates in the face.
std::optional<FrontGraph> delaunay_path(const Tin& delaunay, const FixedFaces& faces, std::size_t face) {
  std::vector<std::uint8_t> chosen;
  for (const std::uint32_t t : faces.faces.row(face)) {
    const Triangle& corners = faces.triangles[t].corners;
    const HalfedgeId ab = delaunay.find_halfedge(corners[0], corners[1]);
    chosen.push_back(ab.valid() && delaunay.apex(ab) == corners[2] ? 1 : 0);
  }
  return path_of(faces, face, chosen);
}

/// Of the fronts, those of the largest order that the limit allows; none if no triangulation is at hand.
std::optional<FrontGraph> search_part(const Tin& delaunay, const FixedFaces& faces, std::size_t face,
                                      std::size_t work_limit) {
  const auto triangles = faces.faces.row(face);
  std::uint32_t order = 0;
  for (const std::uint32_t t : triangles) order = std::max(order, faces.triangles[t].order);
  while (order > 0) {
    --order;
    std::vector<std::uint8_t> usable;
    for (const std::uint32_t t : triangles) usable.push_back(faces.triangles[t].order <= order ? 1 : 0);
    auto graph = find_fronts(faces, face, {.work_limit = work_limit, .usable = usable});
    if (graph && graph->empty_front) return graph;
  }
  return delaunay_path(delaunay, faces, face);
}

/// What every triangulation of a face joins; `link`: by candidate edge.
std::vector<PlateauLink> links_of_all(const FixedFaces& faces, std::size_t face, const FrontGraph& graph,
                                      std::span<const PlateauLink> link) {
  const std::span<const std::uint32_t> triangles = faces.faces.row(face);
  std::vector<PlateauLink> links;
  for (const std::uint32_t t : triangles) {
    for (const std::uint32_t side : faces.sides[t]) {
      if (link[side / 2].first != link[side / 2].second) links.push_back(link[side / 2]);
    }
  }
  if (links.empty()) return links;
  std::sort(links.begin(), links.end());
  links.erase(std::unique(links.begin(), links.end()), links.end());
  // Rows of bits: by triangle what it joins; by front what all ways on join, once one is known.
  const std::size_t words = (links.size() + 63) / 64;
  std::vector<std::uint64_t> joined(triangles.size() * words, 0), behind(graph.front_count * words, 0);
  std::vector<std::uint8_t> known(graph.front_count, 0);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (const std::uint32_t side : faces.sides[triangles[i]]) {
      const auto at = std::lower_bound(links.begin(), links.end(), link[side / 2]);
      if (at == links.end() || *at != link[side / 2]) continue;
      const auto l = static_cast<std::size_t>(at - links.begin());
      joined[i * words + l / 64] |= std::uint64_t{1} << (l % 64);
    }
  }
  known[*graph.empty_front] = 1;
  std::for_each(graph.arcs.rbegin(), graph.arcs.rend(), [&](const FrontGraph::Arc& arc) {
    if (known[arc.to] == 0) return;
    for (std::size_t w = 0; w < words; ++w) {
      const std::uint64_t here = behind[arc.to * words + w] | joined[arc.triangle * words + w];
      std::uint64_t& all = behind[arc.from * words + w];
      all = known[arc.from] == 0 ? here : all & here;
    }
    known[arc.from] = 1;
  });
  std::size_t next = 0;
  for (std::size_t l = 0; l < links.size(); ++l) {
    if ((behind[l / 64] >> (l % 64) & 1U) != 0) links[next++] = links[l];
  }
  links.resize(next);
  return links;
}

}  // namespace

template <std::size_t Criteria>
FaceNetwork<Criteria> build_network(const FaceTerms<Criteria>& terms, const SideWeights<Criteria>& sides,
                                    const std::vector<FaceLabels<Criteria>>& faces, PlateauNodes* pits,
                                    std::span<const PlateauSet> closed) {
  return Builder<Criteria>(terms, sides, faces).run(pits, closed);
}

std::optional<FrontGraph> path_of(const FixedFaces& faces, std::size_t face,
                                  std::span<const std::uint8_t> chosen) {
  const auto triangles = faces.faces.row(face);
  FrontGraph graph;
  std::vector<std::uint32_t> all, covered;
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const auto& sides = faces.sides[triangles[i]];
    std::copy_if(sides.begin(), sides.end(), std::back_inserter(all),
                 [&](std::uint32_t side) { return !faces.edges[side / 2].free; });
    if (chosen[i] == 0) continue;
    covered.insert(covered.end(), sides.begin(), sides.end());
    graph.arcs.push_back({graph.front_count, graph.front_count + 1, i});
    ++graph.front_count;
  }
  graph.empty_front = graph.front_count++;
  std::sort(all.begin(), all.end());
  std::sort(covered.begin(), covered.end());
  const auto is_covered = [&](std::uint32_t side) {
    return std::binary_search(covered.begin(), covered.end(), side);
  };
  const bool inside = std::all_of(covered.begin(), covered.end(), [&](std::uint32_t side) {
    return !faces.edges[side / 2].free || is_covered(side ^ 1U);
  });
  if (!inside || !std::all_of(all.begin(), all.end(), is_covered)) return std::nullopt;
  return graph;
}

SearchedFace search_fronts(const Tin& delaunay, const FixedFaces& faces, std::size_t face,
                           std::size_t work_limit) {
  if (faces.fronts[face].front_count > 0 && faces.fronts[face].work <= work_limit) return {};
  auto graph = find_fronts(faces, face, {.work_limit = work_limit});
  const bool whole = graph.has_value();
  if (!whole) graph = search_part(delaunay, faces, face, work_limit);
  if (graph) return {std::make_unique<const FrontGraph>(std::move(*graph)), whole};
  const Point2 at = delaunay.point(faces.triangles[faces.faces.row(face)[0]].corners[0]);
  throw Error(ErrorCode::SizeLimit,
              "the face between fixed edges at (" + std::to_string(at.x) + ", " + std::to_string(at.y) +
                  ") has too many triangulations of that order, and none of a smaller one that could be "
                  "found; take a smaller --order");
}

void join_always(const FixedFaces& faces, std::span<const SearchedFace> searched, PlateauNodes& pits,
                 const Progress& progress) {
  // Sets only grow, and what all triangulations join with larger sets only grows, too: so the order in which
  // faces are looked at does not matter in the end.
  for (bool again = true; again;) {
    again = false;
    pits.follow_sets();
    std::vector<std::vector<PlateauLink>> found((searched.size() + kFaces - 1) / kFaces);
    for_each_block(searched.size(), kFaces, progress, [&](std::size_t begin, std::size_t end) {
      for (std::size_t f = begin; f < end; ++f) {
        if (!searched[f].whole) continue;
        const auto always = links_of_all(faces, f, graph_of(faces, searched, f), pits.link);
        found[begin / kFaces].insert(found[begin / kFaces].end(), always.begin(), always.end());
      }
    });
    for (const std::vector<PlateauLink>& part : found) {
      for (const auto& [a, b] : part) again = pits.sets.unite(a, b) || again;
    }
  }
}

template FaceNetwork<1> build_network(const FaceTerms<1>&, const SideWeights<1>&,
                                      const std::vector<FaceLabels<1>>&, PlateauNodes*,
                                      std::span<const PlateauSet>);
template FaceNetwork<2> build_network(const FaceTerms<2>&, const SideWeights<2>&,
                                      const std::vector<FaceLabels<2>>&, PlateauNodes*,
                                      std::span<const PlateauSet>);
template FaceNetwork<5> build_network(const FaceTerms<5>&, const SideWeights<5>&,
                                      const std::vector<FaceLabels<5>>&, PlateauNodes*,
                                      std::span<const PlateauSet>);

}  // namespace thalweg
