// Our triangulation against CGAL's on many points of seven kinds, with no, some and many constraint edges:
// the same triangles. THALWEG_ENGINE_POINTS (default 4000) sets the number of points; edges are none, a
// thousandth and a tenth of it. Prints rows of a markdown table: points, edges after noding, triangles,
// processor seconds of both.
#include "noded.hpp"

#include <thalweg/delaunay/triangulate.hpp>

#include <support/random.hpp>

#include <cstdlib>
#include <ctime>
#include <numbers>
#include <string>

namespace thalweg {
namespace {

using test::Random;

std::size_t wanted_points() {
  const char* const given = std::getenv("THALWEG_ENGINE_POINTS");
  return given == nullptr ? 4000 : std::strtoull(given, nullptr, 10);
}

enum class Kind { Random, Grid, Clustered, Spiral, Comb, Circle, NearlyCollinear };
constexpr std::array<std::string_view, 7> kNames{"random", "grid",   "clustered", "spiral",
                                                 "comb",   "circle", "collinear"};

/// Point `i` of `count`; those of a spiral and a comb are in order along a line.
Point2 place(Kind kind, std::size_t i, std::size_t count, Random& random) {
  const auto t = static_cast<double>(i);
  switch (kind) {
    case Kind::Random:
      return {random.real(0, 1e4), random.real(0, 1e4)};
    case Kind::Grid: {
      const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count))));
      return {500000 + 30 * static_cast<double>(i % side), 5200000 + 30 * static_cast<double>(i / side)};
    }
    case Kind::Clustered: {
      const double scale = std::ldexp(1.0, -random.integer(0, 20));
      return {500000 + scale * random.real(0, 1000), 4000000 + scale * random.real(0, 1000)};
    }
    case Kind::Spiral:
      return {std::sqrt(t) * std::cos(std::sqrt(t)), std::sqrt(t) * std::sin(std::sqrt(t))};
    case Kind::Comb: {
      static constexpr std::array<double, 4> kTooth{0, 1000, 1000, 0};
      return {t * 1e-3, kTooth[i % 4]};
    }
    case Kind::Circle: {
      const double angle = 2 * std::numbers::pi * t / static_cast<double>(count);
      return {1e4 * std::cos(angle), 1e4 * std::sin(angle)};
    }
    case Kind::NearlyCollinear:
      break;
  }
  return {t, 0.3 * t + std::ldexp(random.integer(-3, 3), -30)};
}

std::vector<Point2> make_points(Kind kind, std::size_t count, Random& random) {
  std::vector<Point2> points;
  for (std::size_t i = 0; i < count; ++i) points.push_back(place(kind, i, count, random));
  std::vector<Point2> distinct = points;
  std::sort(distinct.begin(), distinct.end());
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  return distinct.size() == points.size() ? points : distinct;
}

/// Segments from a point to one a few places on in the order of the points: of a spiral and a comb its own
/// line, of the others in order of (x, y) within columns of a hundred points.
std::vector<SegmentEnds> make_segments(Kind kind, std::vector<Point2>& points, std::size_t count,
                                       Random& random) {
  if (count == 0) return {};
  const bool line = kind == Kind::Spiral || kind == Kind::Comb;
  if (kind == Kind::Random || kind == Kind::Clustered) {
    std::sort(points.begin(), points.end());
    for (std::size_t i = 0; i < points.size(); i += 100) {
      const auto end = points.begin() + static_cast<std::ptrdiff_t>(std::min(points.size(), i + 100));
      std::sort(points.begin() + static_cast<std::ptrdiff_t>(i), end,
                [](Point2 a, Point2 b) { return a.y < b.y || (a.y == b.y && a.x < b.x); });
    }
  }
  std::vector<SegmentEnds> segments;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = k * points.size() / count;
    const std::size_t j = line ? i + 1 : i + random.integer<std::size_t>(1, 5);
    if (j < points.size()) segments.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j)});
  }
  return segments;
}

struct Measured {
  Tin tin;
  double seconds = 0;
};

Measured measure(std::vector<Point2> points, const std::vector<ConstraintEdge>& edges,
                 TriangulationEngine engine) {
  Progress progress;
  std::vector<double> heights(points.size(), 0.0);
  const std::clock_t start = std::clock();
  Measured measured{triangulate(std::move(points), std::move(heights), edges, progress, engine), 0};
  measured.seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  return measured;
}

class EnginesAtSize : public testing::TestWithParam<std::tuple<std::size_t, std::size_t>> {};

TEST_P(EnginesAtSize, Agree) {
  const auto kind = static_cast<Kind>(std::get<0>(GetParam()));
  const std::size_t share = std::get<1>(GetParam());
  Random random;
  SCOPED_TRACE(random.trace());
  std::vector<Point2> points = make_points(kind, wanted_points(), random);
  const auto segments = make_segments(kind, points, share == 0 ? 0 : points.size() / share, random);
  Progress progress;
  const Noding noding = node_segments(points, segments, progress);
  ASSERT_FALSE(noding.failure.has_value());
  points.insert(points.end(), noding.crossings.begin(), noding.crossings.end());
  std::vector<ConstraintEdge> edges;
  for (const auto& [a, b] : test::all_links(noding))
    edges.push_back({VertexId{a}, VertexId{b}, EdgeKind::Breakline});
  const Measured ours = measure(points, edges, TriangulationEngine::Flat);
  const Measured theirs = measure(points, edges, TriangulationEngine::Cgal);
  EXPECT_TRUE(std::ranges::equal(ours.tin.triangles(), theirs.tin.triangles()));
  std::printf("| %s | %zu | %zu | %zu | %.2f | %.2f |\n", kNames[static_cast<std::size_t>(kind)].data(),
              points.size(), edges.size(), ours.tin.triangle_count(), ours.seconds, theirs.seconds);
}

INSTANTIATE_TEST_SUITE_P(All, EnginesAtSize,
                         testing::Combine(testing::Range<std::size_t>(0, kNames.size()),
                                          testing::Values(0, 1000, 10)),
                         [](const auto& each) {
                           return std::string(kNames[std::get<0>(each.param)]) + "_" +
                                  std::to_string(std::get<1>(each.param));
                         });

}  // namespace
}  // namespace thalweg
