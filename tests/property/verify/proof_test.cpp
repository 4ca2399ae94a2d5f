// Proofs of what the optimiser finds: they hold, and whatever is changed in them, they never prove more.
#include "support/first_order_scene.hpp"
#include "support/plain_surface.hpp"
#include "verify/plain_digest.hpp"

#include <thalweg/optimize/optimize.hpp>
#include <thalweg/verify/verify.hpp>

#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

namespace thalweg::test {
namespace {

using verify::Finding;
using verify::Verdict;

/// A terrain, what was made of it, and the proof.
struct Proved {
  Tin tin;
  OptimizeResult result;
  std::string text;
};

std::string digest_of(const Tin& tin) {
  verify::PlainMesh mesh;
  mesh.xy.assign(tin.points().begin(), tin.points().end());
  mesh.z.assign(tin.heights().begin(), tin.heights().end());
  for (const ConstraintEdge& edge : tin.constraint_edges()) {
    mesh.constraints[std::minmax(edge.a.value(), edge.b.value())] = edge.kind;
  }
  return verify::plain_digest(mesh, tin.points());
}

Proved prove(const Scene& scene, const std::vector<Objective>& criteria) {
  std::ostringstream text;
  text << "thalweg-proof 1\ndigest " << digest_of(scene.tin) << "\ndefinition sees-opp\ncriteria ";
  for (std::size_t i = 0; i < criteria.size(); ++i) text << (i == 0 ? "" : ",") << criteria[i].name();
  text << "\nquadrilaterals " << scene.quadrilaterals.size() << '\n';
  for (const Quadrilateral& q : scene.quadrilaterals) {
    text << "q " << q.s.value() << ' ' << q.u.value() << ' ' << q.t.value() << ' ' << q.v.value() << '\n';
  }
  Progress progress;
  OptimizeResult result =
      optimize_first_order(scene.tin, scene.quadrilaterals, {.criteria = criteria, .proof = &text}, progress);
  text << "end\n";
  Tin tin = with_diagonals(scene.tin, scene.quadrilaterals, result.flipped);
  return {std::move(tin), std::move(result), text.str()};
}

/// The findings on bounds. `beyond`: how much better than the optimum the bounds are said to be.
std::vector<Finding> check(const Proved& proved, const std::string& text, double beyond) {
  verify::Claims claims;
  for (const CriterionResult& line : proved.result.criteria) {
    const double worse = line.direction == "min" ? 1 : -1;
    claims.criteria.push_back({.name = line.name,
                               .delaunay = line.delaunay,
                               .result = line.result,
                               .bound = line.bound + worse * beyond,
                               .optimal = line.optimal && beyond == 0});
  }
  std::istringstream lines(text);
  claims.proof = verify::read_proof(lines, "proof");
  const std::vector<ConstraintEdge> constraints = proved.tin.constraint_edges();
  Progress progress;
  const std::vector<Finding> all = verify::check({.points = proved.tin.points(),
                                                  .heights = proved.tin.heights(),
                                                  .triangles = proved.tin.triangles(),
                                                  .constraints = constraints},
                                                 claims, progress);
  std::vector<Finding> bounds;
  for (const Finding& finding : all) {
    if (beyond == 0 || finding.claim.ends_with(", bound")) bounds.push_back(finding);
  }
  return bounds;
}

std::vector<std::vector<Objective>> priorities() {
  return {{Criterion::NormalAngleSum},
          {Criterion::LocalMinima, Criterion::NormalAngleSum},
          {Criterion::LocalMinima, Criterion::ConvexEdges, Criterion::AreaRatioSum},
          {Criterion::PitDepth, Criterion::NormalAngleSum},
          {Criterion::LocalMinima, Criterion::PitDepth, Criterion::ValleyTriangles, Criterion::EdgeLength},
          {Criterion::PitDepth, Criterion::LocalMinima, Criterion::DrainingValleys, Criterion::MaxAngle},
          {Criterion::NormalAngleMax},
          {Criterion::AreaRatioMax, Criterion::NormalAngleSum},
          {Criterion::NormalAngleSum, Criterion::MaxAngle},
          {Criterion::LocalMinima, Criterion::NormalAngleMax, Criterion::EdgeLength},
          {Criterion::MinAngle, Criterion::MaxArea},
          {Criterion::ConvexVertices},
          {Criterion::LocalMinima, Criterion::MixedVertices, Criterion::NormalAngleSum},
          {Criterion::MaxDegree, Criterion::ConvexVertices},
          {parse_objective("3*mixed-vertices+0.5*normal-angle-sum")},
          {parse_objective("2*edge-length+0.5*normal-angle-sum-convex-edges")}};
}

/// Scenes whose quadrilaterals are all there are.
Scene whole_scene(Random& random) {
  while (true) {
    Scene scene = random_scene(random, 40, random.integer(2, 6));
    if (scene.quadrilaterals.size() < 40) return scene;
  }
}

TEST(Proof, HoldsForWhatTheOptimiserFinds) {
  Random random;
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < 50 && !HasFailure(); ++i) {
    const Scene scene = whole_scene(random);
    for (const std::vector<Objective>& criteria : priorities()) {
      const Proved proved = prove(scene, criteria);
      for (const Finding& finding : check(proved, proved.text, 0)) {
        EXPECT_EQ(finding.verdict, Verdict::Holds) << finding.claim << ": " << finding.detail << "\n"
                                                   << proved.text;
        const bool is_bound =
            finding.claim.ends_with(", optimal") && !finding.claim.starts_with("local-minima") &&
            !finding.claim.starts_with("pit-depth") && !finding.claim.starts_with("max-degree");
        if (is_bound) {
          EXPECT_EQ(finding.detail, "by the proof") << finding.claim << "\n" << proved.text;
        }
      }
    }
  }
}

/// One change to the lines after the quadrilaterals.
std::string changed(const std::string& text, Random& random) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  std::size_t first = 0;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("q ") || line.starts_with("quadrilaterals")) first = lines.size() + 1;
    lines.push_back(line);
  }
  if (lines.size() < first + 3) return text;
  const auto pick = [&] { return random.integer(first + 1, lines.size() - 2); };
  const std::size_t at = pick();
  switch (random.integer(0, 4)) {
    case 0:
      lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(at));
      break;
    case 1:
      std::swap(lines[at], lines[pick()]);
      break;
    case 2:
      lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(pick()), lines[at]);
      break;
    case 3:
      for (char& sign : lines[at]) {
        if ((sign == '+' || sign == '-') && random.integer(0, 2) == 0) sign = sign == '+' ? '-' : '+';
      }
      break;
    default:
      for (char& digit : lines[at]) {
        if (digit >= '0' && digit <= '9' && random.integer(0, 3) == 0) {
          digit = static_cast<char>('0' + random.integer(0, 9));
        }
      }
  }
  std::string result;
  for (const std::string& line : lines) result += line + "\n";
  return result;
}

TEST(Proof, NoChangeProvesMore) {
  Random random;
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < 20 && !HasFailure(); ++i) {
    const Scene scene = whole_scene(random);
    for (const std::vector<Objective>& criteria : priorities()) {
      const Proved proved = prove(scene, criteria);
      for (int change = 0; change < 8; ++change) {
        std::string text = proved.text;
        for (int j = 0; j < change; ++j) text = changed(text, random);
        for (const Finding& finding : check(proved, text, 1e-3)) {
          EXPECT_NE(finding.verdict, Verdict::Holds) << finding.claim << ": " << finding.detail << "\n"
                                                     << text;
        }
      }
    }
  }
}

}  // namespace
}  // namespace thalweg::test
