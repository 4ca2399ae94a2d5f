// The table.
//
// 1. The mesh: sides, orientation, overlaps, constraint edges, digest, counts. What follows needs a sound
// mesh.
// 2. Orders of all triangles.
// 3. The constrained Delaunay triangulation by flips, its quadrilaterals, how the result differs from it.
// 4. Values and pits of both, then what is claimed to be optimal (plain_optimum.cpp).
#include "base/parallel.hpp"
#include "verify/plain_criteria.hpp"
#include "verify/plain_delaunay.hpp"
#include "verify/plain_digest.hpp"
#include "verify/plain_mesh.hpp"
#include "verify/plain_optimum.hpp"
#include "verify/plain_orders.hpp"
#include "verify/plain_proof.hpp"

#include <thalweg/verify/verify.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <span>

namespace thalweg::verify {

namespace {

class Table {
 public:
  void add(std::string claim, Verdict verdict, std::string detail = {}) {
    findings_.push_back({std::move(claim), verdict, std::move(detail)});
  }
  void add_fault(std::string claim, const std::optional<std::string>& fault) {
    add(std::move(claim), fault ? Verdict::Broken : Verdict::Holds, fault.value_or(""));
  }
  void add_count(std::string claim, std::optional<std::size_t> claimed, std::size_t found) {
    if (!claimed) return;
    const bool equal = *claimed == found;
    add(std::move(claim), equal ? Verdict::Holds : Verdict::Broken,
        equal ? fmt::format("{}", found) : fmt::format("claimed {}, found {}", *claimed, found));
  }
  [[nodiscard]] std::vector<Finding> take() { return std::move(findings_); }

 private:
  std::vector<Finding> findings_;
};

PlainMesh plain_mesh_of(const Subject& subject) {
  PlainMesh mesh;
  mesh.xy.assign(subject.points.begin(), subject.points.end());
  mesh.written.assign(subject.continuous.begin(), subject.continuous.end());
  mesh.z.assign(subject.heights.begin(), subject.heights.end());
  for (const Triangle& t : subject.triangles)
    mesh.triangles.push_back({t[0].value(), t[1].value(), t[2].value()});
  for (const ConstraintEdge& edge : subject.constraints) {
    EdgeKind& kind = mesh.constraints[std::minmax(edge.a.value(), edge.b.value())];
    kind = kind | edge.kind;
  }
  mesh.on_valley.assign(mesh.xy.size(), false);
  for (const auto& [edge, kind] : mesh.constraints) {
    if (has(kind, EdgeKind::Valley)) mesh.on_valley[edge.first] = mesh.on_valley[edge.second] = true;
  }
  return mesh;
}

std::set<std::pair<Index, Index>> edges_of(const PlainMesh& mesh) {
  std::vector<std::pair<Index, Index>> edges;
  for (const Corners& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) edges.emplace_back(std::minmax(t[i], t[(i + 1) % 3]));
  }
  std::sort(edges.begin(), edges.end());
  return {edges.begin(), edges.end()};
}

std::optional<std::string> find_missing_constraint(const PlainMesh& mesh,
                                                   const std::set<std::pair<Index, Index>>& edges) {
  for (const auto& [edge, kind] : mesh.constraints) {
    if (!edges.contains(edge)) {
      return fmt::format("constraint edge {}-{} is no edge of a triangle", edge.first, edge.second);
    }
  }
  return std::nullopt;
}

std::optional<std::string> find_height_fault(const Subject& subject) {
  for (std::size_t v = 0; v < subject.heights.size(); ++v) {
    if (!std::isfinite(subject.heights[v]) || !std::isfinite(subject.points[v].x) ||
        !std::isfinite(subject.points[v].y)) {
      return fmt::format("vertex {} is not finite", v);
    }
  }
  return std::nullopt;
}

class Checker {
 public:
  Checker(const Subject& subject, const Claims& claims, Progress& progress)
      : subject_(subject), claims_(claims), progress_(progress), mesh_(plain_mesh_of(subject)) {
    if (!subject.reference_points.empty())
      reference_.emplace(subject.reference_points, subject.reference_heights);
  }

  std::vector<Finding> run() {
    if (check_mesh()) {
      check_orders();
      check_structure();
      check_values();
      check_optima();
    }
    return table_.take();
  }

 private:
  bool check_mesh() {
    progress_.start_phase("mesh");
    auto fault = find_height_fault(subject_);
    if (!fault && mesh_.triangles.empty()) fault = "there is no triangle";
    if (!fault) fault = link_sides(mesh_);
    if (!fault) fault = find_unsoundness(mesh_);
    table_.add_fault("the mesh is a triangulation of its points", fault);
    edges_ = edges_of(mesh_);
    const auto missing = find_missing_constraint(mesh_, edges_);
    table_.add_fault("every constraint edge is an edge of the mesh", missing);
    table_.add_count("vertices", claims_.vertices, mesh_.xy.size());
    table_.add_count("triangles", claims_.triangles, mesh_.triangles.size());
    table_.add_count("edges", claims_.edges, edges_.size());
    table_.add_count("constraint edges", claims_.constraint_edges, mesh_.constraints.size());
    if (claims_.digest) {
      const std::string digest = plain_digest(mesh_, written());
      const bool equal = digest == *claims_.digest;
      table_.add(
          "digest", equal ? Verdict::Holds : Verdict::Broken,
          equal ? digest : "vertices, heights or constraint edges are not those of the report: " + digest);
    }
    if (fault || missing) {
      table_.add("orders, structure, criteria", Verdict::NotChecked, "the mesh is not sound");
    }
    return !fault && !missing;
  }

  [[nodiscard]] bool polygon() const {
    return std::any_of(mesh_.constraints.begin(), mesh_.constraints.end(), [](const auto& edge) {
      return has(edge.second, EdgeKind::Boundary) || has(edge.second, EdgeKind::Hole);
    });
  }

  void check_orders() {
    constexpr std::size_t kBlock = 512;
    progress_.start_phase("orders");
    const std::string claim = fmt::format("every triangle has order at most {} under {}", subject_.order,
                                          definition_name(subject_.definition));
    const PlainOrders orders(mesh_, subject_.definition, polygon());
    orders_known_ = orders.known();
    if (!orders_known_) {
      table_.add(claim, Verdict::NotChecked,
                 "pathcon is counted only where the TIN is a polygon or has one rim");
      return;
    }
    std::vector<unsigned> found(mesh_.triangles.size());  // beyond what is allowed: one more
    for_each_block(found.size(), kBlock, progress_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) {
        while (found[t] <= subject_.order && !orders.at_most(mesh_.triangles[t], found[t])) ++found[t];
      }
    });
    const auto high = std::ranges::find_if(found, [&](unsigned order) { return order > subject_.order; });
    std::optional<std::string> fault;
    if (high != found.end()) {
      const Corners& t = mesh_.triangles[static_cast<std::size_t>(high - found.begin())];
      fault =
          fmt::format("triangle {}-{}-{} has order {}", t[0], t[1], t[2], orders.count(t, mesh_.xy.size()));
    }
    table_.add_fault(claim, fault);
    if (!fault) check_told_orders(found);
  }

  /// What the mesh and the report say of the orders of single triangles.
  void check_told_orders(std::span<const unsigned> found) {
    table_.add_count("largest order", claims_.max_order, std::ranges::max(found));
    if (!claims_.orders.empty()) {
      std::optional<std::string> fault;
      for (std::size_t t = found.size(); t-- > 0;) {
        const Corners& c = mesh_.triangles[t];
        if (claims_.orders[t] == found[t]) continue;
        fault = fmt::format("triangle {}-{}-{} has order {}, the mesh says {}", c[0], c[1], c[2], found[t],
                            claims_.orders[t]);
      }
      table_.add_fault("the orders that the mesh gives its triangles", fault);
    }
    if (!claims_.order_histogram.empty()) {
      std::vector<std::size_t> histogram(claims_.order_histogram.size());
      for (const unsigned order : found) {
        histogram.resize(std::max<std::size_t>(histogram.size(), order + 1));
        ++histogram[order];
      }
      const bool equal = histogram == claims_.order_histogram;
      table_.add("triangles by order", equal ? Verdict::Holds : Verdict::Broken,
                 fmt::format("{}{}", equal ? "" : "found ", fmt::join(histogram, " ")));
    }
  }

  void check_structure() {
    progress_.start_phase("structure");
    delaunay_ = flip_to_delaunay(mesh_, progress_);
    if (subject_.order == 1 && orders_known_) {
      const PlainOrders orders(delaunay_, subject_.definition, polygon());
      quadrilaterals_ = find_quadrilaterals(delaunay_, orders, progress_);
      table_.add_count(
          "first-order quadrilaterals, barred ones included",
          claims_.quadrilaterals ? std::optional(*claims_.quadrilaterals + claims_.barred) : std::nullopt,
          quadrilaterals_.size());
    } else if (claims_.quadrilaterals && subject_.order > 0) {
      table_.add("first-order quadrilaterals", Verdict::NotChecked);
    }
    if (claims_.proof) check_proof(*claims_.proof);
    const std::set<std::pair<Index, Index>> before = edges_of(delaunay_);
    std::size_t flipped = 0;
    for (const auto& edge : edges_) flipped += before.contains(edge) ? 0 : 1;
    if (subject_.order <= 1) table_.add_count("flipped diagonals", claims_.flipped, flipped);
    if (subject_.order == 0) {
      table_.add("the mesh is the constrained Delaunay triangulation",
                 flipped == 0 ? Verdict::Holds : Verdict::Broken,
                 flipped == 0 ? "" : fmt::format("{} of its edges are not Delaunay", flipped));
    }
  }

  /// Whose proof it is; if it is this terrain's, the quadrilaterals take its order.
  void check_proof(const Proof& proof) {
    std::string criteria;
    for (const CriterionClaim& claim : claims_.criteria)
      criteria += (criteria.empty() ? "" : ",") + claim.name;
    auto ordered = in_order_of(proof, quadrilaterals_);
    std::string fault;
    if (!proof.complete || proof.quadrilateral_count != proof.quadrilaterals.size()) {
      fault = "it is cut off";
    } else if (proof.digest != plain_digest(mesh_, written())) {
      fault = "it is of another terrain, with digest " + proof.digest;
    } else if (proof.definition != definition_name(subject_.definition)) {
      fault = "it is for definition " + proof.definition;
    } else if (proof.criteria != criteria) {
      fault = "it is for criteria " + proof.criteria;
    } else if (!ordered && claims_.barred == 0) {
      fault = "its quadrilaterals are not those of the terrain";
    }
    proof_fits_ = fault.empty();
    table_.add("the proof is of this terrain and these criteria",
               proof_fits_ ? Verdict::Holds : Verdict::Broken, fault);
    if (ordered) quadrilaterals_ = std::move(*ordered);
  }

  [[nodiscard]] std::span<const Point2> written() const {
    return subject_.written.empty() ? subject_.points : subject_.written;
  }

  [[nodiscard]] PlainScale scale() const {
    return {subject_.horizontal_metres_per_unit, subject_.vertical_metres_per_unit};
  }

  void check_value(const std::string& claim, double claimed, const PlainMesh& mesh,
                   const PlainCriterion& criterion) {
    const PlainValue found = value_of(mesh, scale(), criterion);
    const bool equal = std::abs(static_cast<long double>(claimed) - found.value) <= found.tolerance;
    table_.add(
        claim, equal ? Verdict::Holds : Verdict::Broken,
        equal ? fmt::format("{:.10g}", claimed)
              : fmt::format("claimed {:.17g}, found {:.17g}", claimed, static_cast<double>(found.value)));
  }

  void check_values() {
    progress_.start_phase("values");
    for (const CriterionClaim& claim : claims_.criteria) {
      const auto criterion = plain_criterion(claim.name, reference());
      if (!criterion) {
        table_.add(claim.name, Verdict::NotChecked, "the verifier has no formula for it, or no reference");
        continue;
      }
      check_value(claim.name + ", Delaunay", claim.delaunay, delaunay_, *criterion);
      check_value(claim.name + ", result", claim.result, mesh_, *criterion);
    }
    const auto pits = [&](const std::string& name, const std::optional<PitsClaim>& claimed,
                          const PlainMesh& mesh) {
      if (!claimed) return;
      const PlainPits found = count_pits(mesh);
      table_.add_count("pits inside, " + name, claimed->interior, found.interior);
      table_.add_count("pits on the boundary, " + name, claimed->boundary, found.boundary);
      table_.add_count("lakes, " + name, claimed->lake, found.lake);
    };
    pits("Delaunay", claims_.pits_delaunay, delaunay_);
    pits("result", claims_.pits_result, mesh_);
  }

  [[nodiscard]] std::vector<bool> flipped_quadrilaterals() const {
    std::vector<bool> flipped;
    for (const PlainQuadrilateral& q : quadrilaterals_)
      flipped.push_back(edges_.contains(std::minmax(q.s, q.t)));
    return flipped;
  }

  void check_optima() {
    progress_.start_phase("optima");
    if (claims_.barred > 0) {
      table_.add("bounds, optimality", Verdict::NotChecked,
                 fmt::format("{} diagonals are barred by source points that the simplified TIN left out",
                             claims_.barred));
      return;
    }
    for (Finding& finding :
         check_bounds({.delaunay = delaunay_,
         .quadrilaterals = quadrilaterals_,
         .scale = scale(),
         .reference = reference(),
         .order = subject_.order,
         .structure_known = subject_.order == 0 ||
                            (subject_.order == 1 && orders_known_ && quadrilaterals_tell_all()),
         .flipped = flipped_quadrilaterals()},
                      claims_.criteria, proof_fits_ ? &*claims_.proof : nullptr, progress_)) {
      table_.add(std::move(finding.claim), finding.verdict, std::move(finding.detail));
    }
  }

  /// Not where they may overlap: then further edges can be free.
  [[nodiscard]] bool quadrilaterals_tell_all() const {
    return subject_.definition != OrderDefinition::Sees3vtx &&
           subject_.definition != OrderDefinition::EmptyQuad;
  }

  [[nodiscard]] const PlainReference* reference() const { return reference_ ? &*reference_ : nullptr; }

  const Subject& subject_;
  const Claims& claims_;
  Progress& progress_;
  std::optional<PlainReference> reference_;
  PlainMesh mesh_;
  std::set<std::pair<Index, Index>> edges_;  ///< of the mesh
  PlainMesh delaunay_;
  std::vector<PlainQuadrilateral> quadrilaterals_;
  bool orders_known_ = false;
  bool proof_fits_ = false;
  Table table_;
};

}  // namespace

std::vector<Finding> check(const Subject& subject, const Claims& claims, Progress& progress) {
  return Checker(subject, claims, progress).run();
}

}  // namespace thalweg::verify
