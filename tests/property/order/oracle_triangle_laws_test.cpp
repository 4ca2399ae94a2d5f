// Laws that hold triangle by triangle, for the oracle itself, on random scenes.
#include <support/oracle/law_testing.hpp>
#include <support/oracle/path_by_slabs.hpp>
#include <support/oracle/triangulations.hpp>

#include <bit>
#include <map>

namespace thalweg::oracle {
namespace {

constexpr auto index(Definition d) {
  return static_cast<std::size_t>(d);
}

bool within(SiteSet inner, SiteSet outer) {
  return (inner & ~outer) == 0;
}

// Section 4's sweep through u and v, where it is sound: whether a site beyond uv counts does not depend on
// the third corner while it is in the circle, under sees-triang and empty-quad.
TEST(OracleTriangleLaws, Section4SweepHoldsForSeesTriangAndEmptyQuad) {
  for_each_scene(kStreams, 40, {}, [](const Oracle& oracle) {
    const Scene& scene = oracle.scene();
    std::map<std::pair<Edge, int>, std::array<bool, 2>> seen;  // by u, v and p
    for (const Corners& t : oracle.valid_triangles()) {
      const auto counted = oracle.counted(t);
      for (std::size_t side = 0; side < 3; ++side) {
        const Edge uv{t[side], t[(side + 1) % 3]};
        for (int p = 0; p < scene.size(); ++p) {
          if ((counted[index(Definition::Std)] >> p & 1U) == 0) continue;
          if (turn(scene.at(uv.first), scene.at(uv.second), scene.at(p)) >= 0) continue;
          const std::array<bool, 2> now{(counted[index(Definition::SeesTriang)] >> p & 1U) != 0,
                                        (counted[index(Definition::EmptyQuad)] >> p & 1U) != 0};
          const auto [at, fresh] = seen.emplace(std::pair(uv, p), now);
          ASSERT_EQ(at->second, now) << to_text(t) << " and " << p;
        }
      }
    }
  });
}

// Lemma 1: what a weaker definition counts, each stronger one counts too, along both chains.
TEST(OracleTriangleLaws, Lemma1) {
  using enum Definition;
  constexpr std::array<std::pair<Definition, Definition>, 8> kInclusions{{{Pathcon, Std},
                                                                          {SeesTriang, Pathcon},
                                                                          {SeesVtx, SeesTriang},
                                                                          {SeesOpp, SeesVtx},
                                                                          {Sees3Vtx, SeesOpp},
                                                                          {EmptyQuad, Sees3Vtx},
                                                                          {ConfEdge, SeesTriang},
                                                                          {SeesOpp, ConfEdge}}};
  for_each_scene(kStreams, 40, {}, [&](const Oracle& oracle) {
    for (const Corners& t : oracle.valid_triangles()) {
      const auto counted = oracle.counted(t);
      for (const auto& [weak, strong] : kInclusions) {
        ASSERT_TRUE(within(counted[index(weak)], counted[index(strong)]))
            << to_text(t) << ": " << name_of(weak) << " counts more than " << name_of(strong);
      }
    }
  });
}

// Lemma 2: in a simple polygon, sees-3vtx and empty-quad count the same.
TEST(OracleTriangleLaws, Lemma2InPolygons) {
  for_each_scene(std::array{Stream::Polygon}, 100, {}, [](const Oracle& oracle) {
    for (const Corners& t : oracle.valid_triangles()) {
      ASSERT_EQ(oracle.counted(t, Definition::Sees3Vtx), oracle.counted(t, Definition::EmptyQuad))
          << to_text(t);
    }
  });
}

// Lemmas 5 and 6: at order at most 1, sees-triang is sees-vtx, and conf-edge is sees-opp.
TEST(OracleTriangleLaws, Lemmas5And6) {
  for_each_scene(kStreams, 40, {}, [](const Oracle& oracle) {
    for (const Corners& t : oracle.valid_triangles()) {
      const Orders orders = oracle.orders(t);
      if (orders[index(Definition::SeesVtx)] <= 1) {
        ASSERT_EQ(orders[index(Definition::SeesTriang)], orders[index(Definition::SeesVtx)]) << to_text(t);
      }
      if (orders[index(Definition::SeesOpp)] <= 1) {
        ASSERT_EQ(orders[index(Definition::ConfEdge)], orders[index(Definition::SeesOpp)]) << to_text(t);
      }
    }
  });
}

// Property 2: without constraint edges every definition but empty-quad is the standard order.
TEST(OracleTriangleLaws, Property2) {
  for_each_scene(kPlaneStreams, 40, {.constraints = 0}, [](const Oracle& oracle) {
    for (const Corners& t : oracle.valid_triangles()) {
      const auto counted = oracle.counted(t);
      for (const Definition d : kDefinitions) {
        if (d == Definition::EmptyQuad) continue;
        ASSERT_EQ(counted[index(d)], counted[index(Definition::Std)]) << to_text(t) << " " << name_of(d);
      }
    }
  });
}

// Property 1: the triangles of order 0 are those of one triangulation, under every constrained definition.
TEST(OracleTriangleLaws, Property1) {
  for_each_scene(kStreams, 40, {}, [](const Oracle& oracle) {
    const std::vector<Corners> delaunay = delaunay_triangles(oracle);
    for (const Corners& t : oracle.valid_triangles()) {
      const bool in_delaunay = std::find(delaunay.begin(), delaunay.end(), t) != delaunay.end();
      for (const Definition d : kDefinitions) {
        if (d == Definition::Std || d == Definition::EmptyQuad || d == Definition::Sees3Vtx) continue;
        ASSERT_EQ(oracle.order(t, d) == 0, in_delaunay) << to_text(t) << " " << name_of(d);
      }
    }
  });
}

// How many triples and quadruples with site v change their sense if v moves; two if the move ends on a
// degeneracy.
int criticalities(const Scene& before, const Scene& after, int v) {
  int changes = 0;
  for (int a = 0; a < before.size(); ++a) {
    for (int b = 0; b < a; ++b) {
      if (a == v || b == v) continue;
      const auto side = [&](const Scene& s) { return sign_of(turn(s.at(a), s.at(b), s.at(v))); };
      if (side(after) == 0) return 2;
      changes += side(before) != side(after) ? 1 : 0;
      for (int c = 0; c < b; ++c) {
        if (c == v) continue;
        const Corners t = before.counter_clockwise({a, b, c});
        const auto place = [&](const Scene& s) {
          return sign_of(power(s.at(t[0]), s.at(t[1]), s.at(t[2]), s.at(v)));
        };
        if (place(after) == 0) return 2;
        changes += place(before) != place(after) ? 1 : 0;
      }
    }
  }
  return changes;
}

// Property 4: if one site passes one criticality, the order of a triangle that stays changes by one at most.
// Not so for pathcon and conf-edge (see the scenes figure-3-left and property-4-conf-edge).
TEST(OracleTriangleLaws, Property4) {
  Dice dice("Property4 moves");
  int moves = 0;
  for_each_scene(std::array{Stream::General}, 300, {.most = 10}, [&](const Oracle& before) {
    const int v = dice.between(0, before.scene().size() - 1);
    Scene moved = before.scene();
    moved.sites[static_cast<std::size_t>(v)].x += dice.between(-2, 2);
    moved.sites[static_cast<std::size_t>(v)].y += dice.between(-2, 2);
    if (criticalities(before.scene(), moved, v) != 1 || !defect(moved).empty()) return;
    ++moves;
    const Oracle after(moved);
    for (const Corners& t : before.valid_triangles()) {
      if (moved.counter_clockwise(t) != t || after.validity(t) != Validity::Valid) continue;
      for (const Definition d : kDefinitions) {
        if (d == Definition::Pathcon || d == Definition::ConfEdge) continue;
        ASSERT_LE(std::abs(after.order(t, d) - before.order(t, d)), 1)
            << to_text(t) << " " << name_of(d) << ", site " << v << " in " << to_text(moved);
      }
    }
  });
  EXPECT_GT(moves, 10);
}

// The oracle's two ways to decide paths agree.
TEST(OracleTriangleLaws, PathsByParityAndBySlabsAgree) {
  for_each_scene(kStreams, 3, {.most = 12}, [](const Oracle& oracle) {
    for (const Corners& t : oracle.valid_triangles()) {
      const SiteSet members = oracle.counted(t, Definition::Std),
                    joined = oracle.counted(t, Definition::Pathcon);
      for (int p = 0; p < oracle.scene().size(); ++p) {
        if ((members >> p & 1U) == 0) continue;
        ASSERT_EQ((joined >> p & 1U) != 0, path_joins_by_slabs(oracle.scene(), t, p))
            << to_text(t) << " point " << p;
      }
    }
  });
}

}  // namespace
}  // namespace thalweg::oracle
