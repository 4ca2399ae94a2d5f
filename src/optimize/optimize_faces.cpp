// From faces to a network, and back.
//
// 1. The fronts of each face are found, and by them its labels: the triangulations that may be best for
//    something that is chosen in other faces (face_program.cpp). A face with too many fronts or labels has as
//    labels some of those, and if pits are counted what the heuristics for them choose there; then a second
//    network, in which one label stands for all that the face has, gives the bound.
// 2. Each criterion is a level of costs, local minima included (face_network.cpp). The network is solved
//    (label_solver.cpp).
// 3. Pits: if the choice leaves more than its costs tell, there are sets of plateaus whose outlets lead to
//    each other. Each of these is to have an outlet or to count, and the network is solved again. What is
//    left then is a bound.
// 4. An objective that is the worst of its terms: as in optimize_first_order.cpp, by bisection over limits.
#include "base/parallel.hpp"
#include "optimize/face_network.hpp"
#include "optimize/first_order_problem.hpp"
#include "optimize/label_solver.hpp"
#include "optimize/objective_value.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/optimize/optimize_faces.hpp>
#include <thalweg/optimize/pit_heuristics.hpp>

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

namespace thalweg {

namespace {

constexpr std::size_t kFaces = 64;
/// Faces that need more than this share of the comparisons are looked at once more, when what their
/// neighbours may have is known: of 37,830 faces of random points at order 4 these are 11.
constexpr std::size_t kFirstShare = 100;
/// Of all of these together.
constexpr std::size_t kMostComparisons = 2'000'000'000;
constexpr int kRounds = 30;
/// A larger set of plateaus is not asked to have an outlet; what it hides stays a gap.
constexpr std::size_t kLargestSet = 200;

std::string method_name(const SolverFigures& figures) {
  std::string name = "elimination";
  if (figures.used_tables) name += " + dynamic programming";
  if (figures.used_relaxation) name += " + mini-buckets and local search";
  return name;
}

template <std::size_t Criteria>
class FaceRun {
 public:
  /// The first `reported` criteria are those that were asked for.
  FaceRun(const Tin& delaunay, const FixedFaces& faces, const FaceOptimizeOptions& options,
          std::size_t reported, Progress& progress)
      : delaunay_(delaunay),
        faces_(faces),
        levels_(levels_of(options)),
        reported_(reported),
        scale_{options.common.horizontal_metres_per_unit, options.common.vertical_metres_per_unit},
        reference_(options.common.reference),
        limits_{options.common.width_limit, options.common.effort},
        progress_(progress),
        label_limits_{options.most_comparisons, options.few_labels},
        bounds_alone_(options.bounds_alone) {
    progress_.start_phase("search faces");
    search_faces(options.work_limit);
    sides_ = find_sides(delaunay, faces, progress);
    for (std::size_t level = 0; level < levels_.size(); ++level) {
      if (!counts_pits(level)) continue;
      pit_level_ = level;
      pits_ = find_plateau_nodes(delaunay, faces);
      join_always(faces, searched_, *pits_, progress);
    }
    progress_.advance(1);
  }

  FaceOptimizeResult run() {
    progress_.start_phase("choose triangulations");
    for (std::size_t level = 0; level < levels_.size(); ++level) {
      if (is_extreme(level)) settle(level);
    }
    const Choice choice = solve_up_to(levels_.size());
    progress_.advance(1);
    return report(choice);
  }

 private:
  using Values = std::array<WideSteps, Criteria>;  ///< by level, in steps
  struct Choice {
    std::vector<std::uint32_t> triangles;  ///< candidates, ascending
    Values value{};
    Values bound{};                         ///< of all levels, one after the other
    std::vector<std::uint32_t> face_sizes;  ///< triangles, by face
    std::size_t new_edges = 0;
    SolverFigures figures;
    std::size_t labels = 0, most_labels = 0, partial_faces = 0, largest_face = 0;
  };
  /// An extreme, in steps as in sums.hpp.
  struct Settled {
    std::int64_t limit = 0, bound = 0;
    std::int64_t least = 0;  ///< of all triangulations
  };

  [[nodiscard]] bool is_extreme(std::size_t level) const {
    return levels_[level] && levels_[level]->is_extreme();
  }
  [[nodiscard]] bool counts_pits(std::size_t level) const {
    return levels_[level] && levels_[level]->is(Criterion::LocalMinima);
  }

  void search_faces(std::size_t work_limit) {
    searched_.resize(faces_.faces.size());
    for_each_block(faces_.faces.size(), kFaces, progress_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t f = begin; f < end; ++f)
        searched_[f] = search_fronts(delaunay_, faces_, f, work_limit);
    });
  }

  /// Solves the levels before `count`; those from it on cost nothing.
  Choice solve_up_to(std::size_t count) {
    FaceTerms<Criteria> terms{delaunay_, faces_, sides_, scale_, {}, std::nullopt};
    for (std::size_t level = 0; level < count; ++level) {
      if (!levels_[level]) {
        terms.order_level = level;
        continue;
      }
      const auto limit = is_extreme(level) ? std::optional(settled_[level].limit) : std::nullopt;
      terms.levels[level] = level_of(*levels_[level], limit, reference_);
    }
    if (pits_ && pit_level_ < count) terms.pit_level = pit_level_;
    SideWeights<Criteria> sides = weigh_sides(terms, progress_);
    std::vector<FaceLabels<Criteria>> labels = label_faces(terms, sides);
    offer_heuristics(terms, sides, labels);
    Choice choice = solve_for(terms, sides, labels);
    if (choice.partial_faces > 0) {
      relax_partial(terms, sides, labels);
      choice.bound = solve_for(terms, sides, labels).bound;
    }
    return choice;
  }

  /// Plateau links of candidate edges if pits are counted.
  [[nodiscard]] std::span<const PlateauLink> links_for(const FaceTerms<Criteria>& terms) const {
    return terms.pit_level ? std::span<const PlateauLink>(pits_->link) : std::span<const PlateauLink>();
  }

  /// All faces with few labels; then, knowing what these leave across, the others.
  std::vector<FaceLabels<Criteria>> label_faces(const FaceTerms<Criteria>& terms,
                                                SideWeights<Criteria>& sides) {
    const std::span<const PlateauLink> links = links_for(terms);
    std::vector<FaceLabels<Criteria>> labels(faces_.faces.size());
    std::vector<std::uint32_t> turn(labels.size());
    std::iota(turn.begin(), turn.end(), 0U);
    const auto label = [&](std::size_t block, const LabelLimits& limits) {
      for_each_block(turn.size(), block, progress_, [&](std::size_t begin, std::size_t end) {
        FaceModeller<Criteria> modeller(terms, sides, links);
        FaceLabeller<Criteria>& labeller = labellers_.local();
        for (std::size_t i = begin; i < end; ++i) {
          const std::uint32_t f = turn[i];
          labels[f] = labeller.label(modeller.model(f), graph_of(faces_, searched_, f), limits);
          labels[f].complete = labels[f].complete && searched_[f].whole;
        }
      });
      std::erase_if(turn, [&](std::uint32_t f) { return labels[f].complete || !searched_[f].whole; });
    };
    label(kFaces, {label_limits_.most_comparisons / kFirstShare, label_limits_.few_labels});
    note_possible(sides_, labels, sides);
    const std::size_t share = kMostComparisons / std::max<std::size_t>(turn.size(), 1);
    label(1, {std::min(label_limits_.most_comparisons, share), label_limits_.few_labels});
    return labels;
  }

  /// What the heuristics choose in faces that are not complete becomes labels there.
  void offer_heuristics(const FaceTerms<Criteria>& terms, const SideWeights<Criteria>& sides,
                        std::vector<FaceLabels<Criteria>>& labels) {
    const bool whole = std::all_of(labels.begin(), labels.end(), [](const auto& l) { return l.complete; });
    if (whole || !terms.pit_level || !can_remove_pits(delaunay_, faces_)) return;
    if (offered_.empty()) {
      for (const PitHeuristic heuristic : {PitHeuristic::Flip, PitHeuristic::Hull})
        offered_.push_back(remove_pits(delaunay_, faces_, heuristic, progress_));
    }
    const std::span<const PlateauLink> links = links_for(terms);
    FaceModeller<Criteria> modeller(terms, sides, links);
    for (std::size_t f = 0; f < labels.size(); ++f) {
      if (labels[f].complete) continue;
      const FaceModel<Criteria>& model = modeller.model(f);
      for (const std::vector<OrderTriangle>& offer : offered_) {
        std::vector<std::uint8_t> chosen;
        for (const std::uint32_t t : model.triangles)
          chosen.push_back(std::binary_search(offer.begin(), offer.end(), faces_.triangles[t]) ? 1 : 0);
        if (const auto path = path_of(faces_, f, chosen))
          add_labels(labellers_.local().label(model, *path, LabelLimits{}), labels[f]);
      }
    }
  }

  void relax_partial(const FaceTerms<Criteria>& terms, const SideWeights<Criteria>& sides,
                     std::vector<FaceLabels<Criteria>>& labels) {
    const std::span<const PlateauLink> links = links_for(terms);
    for_each_block(labels.size(), kFaces, progress_, [&](std::size_t begin, std::size_t end) {
      FaceModeller<Criteria> modeller(terms, sides, links);
      for (std::size_t f = begin; f < end; ++f) {
        if (labels[f].complete) continue;
        labels[f] = relax_face(modeller.model(f), labels[f].triangulations.size);
      }
    });
  }

  Choice solve_for(const FaceTerms<Criteria>& terms, const SideWeights<Criteria>& sides,
                   const std::vector<FaceLabels<Criteria>>& labels) {
    PlateauNodes* const pits = terms.pit_level ? &*pits_ : nullptr;
    std::vector<PlateauSet> closed;
    for (int round = 0;; ++round) {
      const FaceNetwork<Criteria> network = build_network(terms, sides, labels, pits, closed);
      const NetworkSolution<Criteria> solution = solve(network.network, limits_, progress_);
      const WideSteps counted = network.base[pit_level_] + solution.value.level[pit_level_];
      if (pits != nullptr && round < kRounds && find_closed(labels, solution.chosen, counted, closed))
        continue;
      Choice choice = choice_of(labels, solution);
      for (std::size_t level = 0; level < Criteria; ++level) {
        choice.value[level] += network.base[level];
        choice.bound[level] += network.base[level];
      }
      return choice;
    }
  }

  /// Adds the sets of plateaus that the choice joins to each other only, and that count as no pit; false if
  /// there is none that is new. `counted`: the pits that its costs tell of.
  bool find_closed(const std::vector<FaceLabels<Criteria>>& labels, const std::vector<std::uint32_t>& chosen,
                   WideSteps counted, std::vector<PlateauSet>& closed) {
    UnionFind joined(pits_->node_count);
    for (std::size_t f = 0; f < labels.size(); ++f) {
      const FaceLabels<Criteria>& face = labels[f];
      for (std::size_t l = 0; l < face.link.size(); ++l) {
        if (face.has_link(l, chosen[f])) joined.unite(face.link[l].first, face.link[l].second);
      }
    }
    std::map<std::uint32_t, PlateauSet> sets;
    for (std::uint32_t n = 1; n < pits_->node_count; ++n) {
      if (pits_->sets.find(n) == n && joined.find(n) != 0) sets[joined.find(n)].push_back(n);
    }
    if (static_cast<WideSteps>(sets.size()) == counted) return false;
    bool found = false;
    for (auto& [first, set] : sets) {
      if (set.size() < 3 || set.size() > kLargestSet) continue;
      if (std::find(closed.begin(), closed.end(), set) != closed.end()) continue;
      closed.push_back(std::move(set));
      found = true;
    }
    return found;
  }

  Choice choice_of(const std::vector<FaceLabels<Criteria>>& labels,
                   const NetworkSolution<Criteria>& solution) const {
    Choice choice;
    std::copy_n(solution.value.level.begin(), Criteria, choice.value.begin());
    std::copy_n(solution.bound.level.begin(), Criteria, choice.bound.begin());
    choice.new_edges = static_cast<std::size_t>(solution.value.level[Criteria]);
    choice.figures = solution.figures;
    for (std::uint32_t t = 0; t < faces_.triangles.size(); ++t) {
      const auto& sides = faces_.sides[t];
      if (std::none_of(sides.begin(), sides.end(),
                       [&](std::uint32_t s) { return faces_.edges[s / 2].free; })) {
        choice.triangles.push_back(t);
      }
    }
    for (std::size_t f = 0; f < labels.size(); ++f) {
      const FaceLabels<Criteria>& face = labels[f];
      choice.labels += face.unary.size();
      choice.most_labels = std::max(choice.most_labels, face.unary.size());
      choice.partial_faces += face.complete ? 0 : 1;
      choice.largest_face = std::max<std::size_t>(choice.largest_face, face.triangulations.size);
      choice.face_sizes.push_back(face.triangulations.size);
      if (face.relaxed) continue;
      const auto triangles = face.triangulations[solution.chosen[f]];
      choice.triangles.insert(choice.triangles.end(), triangles.begin(), triangles.end());
    }
    std::sort(choice.triangles.begin(), choice.triangles.end());
    return choice;
  }

  [[nodiscard]] Tin tin_of(const Choice& choice) const {
    std::vector<Triangle> triangles;
    for (const std::uint32_t t : choice.triangles) triangles.push_back(faces_.triangles[t].corners);
    return {{delaunay_.points().begin(), delaunay_.points().end()},
            {delaunay_.heights().begin(), delaunay_.heights().end()},
            std::move(triangles),
            delaunay_.constraint_edges()};
  }

  static std::vector<std::optional<Objective>> levels_of(const FaceOptimizeOptions& options) {
    std::vector<std::optional<Objective>> levels(options.common.criteria.begin(),
                                                 options.common.criteria.end());
    if (options.order_sum_after) {
      levels.insert(levels.begin() + static_cast<std::ptrdiff_t>(*options.order_sum_after), std::nullopt);
    }
    return levels;
  }

  static bool same_before(const Values& a, const Values& b, std::size_t level) {
    return std::equal(a.begin(), a.begin() + level, b.begin());
  }

  /// Finds the least limit of an extreme that leaves the levels before it at their best.
  void settle(std::size_t level) {
    const Objective& objective = *levels_[level];
    const std::vector<std::int64_t> values = term_values(
        delaunay_, faces_, sides_, level_of(objective, std::nullopt, reference_), scale_, progress_);
    Settled& settled = settled_[level];
    if (values.empty()) return;
    const Choice before = solve_up_to(level);
    const auto worst = [&](const Choice& choice) {
      return static_cast<std::int64_t>(value_on(tin_of(choice), objective, scale_, reference_, progress_));
    };
    std::int64_t reached = worst(before);
    settled.bound = settled.least = values.front();
    auto low = values.begin();
    auto high = std::lower_bound(low, values.end(), reached);
    while (low < high) {
      const auto middle = low + (high - low) / 2;
      settled.limit = *middle;
      const Choice trial = solve_up_to(level + 1);
      if (same_before(trial.value, before.value, level) && trial.value[level] == 0) {
        reached = worst(trial);
        high = std::lower_bound(values.begin(), middle, reached);
        continue;
      }
      const bool excluded = same_before(trial.bound, before.value, level) && trial.bound[level] > 0;
      low = middle + 1;
      if (excluded && low != values.end()) settled.bound = *low;
    }
    settled.limit = reached;
  }

  /// What each level costs at least, on the scale of a choice's values: one after the other says nothing of
  /// a level where one before it is not proved. Not of extremes and pits.
  Values least_by_level(std::span<const std::uint32_t> face_sizes) {
    FaceTerms<Criteria> terms{delaunay_, faces_, sides_, scale_, {}, std::nullopt};
    for (std::size_t level = 0; level < levels_.size(); ++level) {
      if (!levels_[level]) {
        terms.order_level = level;
      } else if (!is_extreme(level)) {
        terms.levels[level] = level_of(*levels_[level], std::nullopt, reference_);
      }
    }
    const SideWeights<Criteria> sides = weigh_sides(terms, progress_);
    std::vector<FaceLabels<Criteria>> labels(faces_.faces.size());
    for_each_block(labels.size(), kFaces, progress_, [&](std::size_t begin, std::size_t end) {
      FaceModeller<Criteria> modeller(terms, sides, {});
      for (std::size_t f = begin; f < end; ++f) labels[f] = relax_face(modeller.model(f), face_sizes[f]);
    });
    return build_network(terms, sides, labels, nullptr, {}).base;  // of one label a face, all that it costs
  }

  [[nodiscard]] FaceOptimizeResult report(const Choice& choice) {
    FaceOptimizeResult result;
    result.faces = faces_.faces.size();
    result.partial_faces = choice.partial_faces;
    result.largest_face = choice.largest_face;
    result.labels = choice.labels;
    result.most_labels = choice.most_labels;
    result.new_edges = choice.new_edges;
    result.fixed_by_elimination = choice.figures.fixed_by_elimination;
    result.pieces = choice.figures.pieces;
    result.largest_piece = choice.figures.largest_piece;
    result.width = choice.figures.width;
    for (const std::uint32_t t : choice.triangles) result.triangles.push_back(faces_.triangles[t]);
    result.tin = tin_of(choice);
    bool proved = true;
    std::optional<Values> least;
    for (std::size_t level = 0; level < reported_; ++level) {
      if (!least && level > 0 && (bounds_alone_ || !proved)) least = least_by_level(choice.face_sizes);
      result.criteria.push_back(describe(level, choice, result.tin, proved ? nullptr : &*least));
      const CriterionResult& line = result.criteria.back();
      if (bounds_alone_)
        result.bounds_alone.push_back(level == 0 ? line.bound
                                                 : describe(level, choice, result.tin, &*least).bound);
      proved = line.optimal;
    }
    return result;
  }

  /// As in optimize_first_order: the bound of a level holds if all levels before have reached theirs; else
  /// that of the level by itself does, by `least`.
  [[nodiscard]] CriterionResult describe(std::size_t level, const Choice& choice, const Tin& tin,
                                         const Values* least) const {
    const bool proved_before = least == nullptr;
    CriterionResult line{.name = "order-sum", .unit = "count", .direction = "min"};
    if (levels_[level]) {
      line.name = levels_[level]->name();
      line.unit = levels_[level]->unit();
      line.direction = levels_[level]->direction() == Direction::Minimise ? "min" : "max";
    }
    const auto value = [&](const Tin& of) {
      return levels_[level] ? value_on(of, *levels_[level], scale_, reference_, progress_)
                            : order_sum_on(of, faces_);
    };
    const WideSteps delaunay = value(delaunay_), result = value(tin);
    WideSteps bound = result - (choice.value[level] - (proved_before ? choice.bound : *least)[level]);
    if (counts_pits(level)) bound = proved_before ? choice.bound[level] : 0;
    if (is_extreme(level)) bound = proved_before ? settled_[level].bound : settled_[level].least;
    const auto as_reported = [&](WideSteps steps) {
      return levels_[level] ? in_units(steps, *levels_[level]) : static_cast<double>(steps);
    };
    line.delaunay = as_reported(delaunay);
    line.result = as_reported(result);
    line.bound = as_reported(bound);
    line.optimal = proved_before && result == bound;
    line.method = method_name(choice.figures);
    if (is_extreme(level)) line.method = "bisection over limits by " + line.method;
    if (counts_pits(level)) line.method = "outlets by " + line.method;
    return line;
  }

  const Tin& delaunay_;
  const FixedFaces& faces_;
  std::vector<std::optional<Objective>> levels_;  ///< none: the sum of orders
  std::size_t reported_;
  Scale scale_;
  const Reference* reference_;
  SolverLimits limits_;
  Progress& progress_;
  LabelLimits label_limits_;
  bool bounds_alone_;
  tbb::enumerable_thread_specific<FaceLabeller<Criteria>> labellers_;
  std::vector<SearchedFace> searched_;
  std::vector<std::vector<OrderTriangle>> offered_;  ///< triangulations of the heuristics, once asked for
  FaceSides sides_;
  std::optional<PlateauNodes> pits_;
  std::size_t pit_level_ = 0;
  std::array<Settled, Criteria> settled_{};
};

}  // namespace

void require_face_criteria(const std::vector<Objective>& criteria) {
  for (const Objective& objective : criteria) {
    for (const Objective::Part& part : objective.parts) {
      const Declaration& declaration = declaration_of(part.criterion);
      if (declaration.vertex == nullptr && part.criterion != Criterion::PitDepth) continue;
      throw Error(ErrorCode::Unsupported, "criterion " + std::string(declaration.traits.name) +
                                              " cannot be optimised at orders above 1, under sees-3vtx and "
                                              "empty-quad, nor with --method flip and hull; take --order 1, "
                                              "--definition sees-opp and --method exact");
    }
  }
}

void take_bounds(std::span<const CriterionResult> of, std::span<const double> alone,
                 std::span<CriterionResult> lines) {
  bool reached = true;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    CriterionResult& line = lines[i];
    line.bound = reached ? of[i].bound : alone[i];
    reached = reached && line.result == line.bound;
    line.optimal = reached;
    line.method += "; bound: " + of[i].method;
  }
}

FaceOptimizeResult optimize_faces(const Tin& delaunay, const FixedFaces& faces,
                                  const FaceOptimizeOptions& options, Progress& progress) {
  check_options(delaunay, options.common);
  require_face_criteria(options.common.criteria);
  FaceOptimizeOptions completed = options;
  std::vector<Objective>& criteria = completed.common.criteria;
  const std::size_t reported = criteria.size();
  const bool open = !criteria.empty() && criteria.back().is_extreme() &&
                    std::none_of(criteria.begin(), criteria.end(),
                                 [](const Objective& o) { return o.is(Criterion::NormalAngleSum); });
  if (open) criteria.emplace_back(Criterion::NormalAngleSum);
  count_levels(criteria);
  const std::size_t extra = options.order_sum_after ? 1 : 0, levels = criteria.size() + extra;
  constexpr std::size_t kMost = 5;
  if (levels > kMost) {
    throw Error(ErrorCode::Usage,
                "there are " + std::to_string(levels) +
                    " values in order of priority, the sum of orders and what follows a largest "
                    "value included; at most 5 can be");
  }
  if (levels <= 1) return FaceRun<1>(delaunay, faces, completed, reported + extra, progress).run();
  if (levels == 2) return FaceRun<2>(delaunay, faces, completed, reported + extra, progress).run();
  return FaceRun<5>(delaunay, faces, completed, reported + extra, progress).run();
}

}  // namespace thalweg
