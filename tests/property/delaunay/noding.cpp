// Laws of noding on line soups at map coordinates.
#include "noded.hpp"

#include <support/random.hpp>

#include <functional>

namespace thalweg {
namespace {

using test::Random;
using test::Soup;

constexpr Point2 kUtm{500000, 4000000};

double to_millimetres(double value) {
  return std::round(value * 1000) / 1000;
}

using Place = std::function<Point2(Random&)>;

Point2 anywhere(Random& random) {
  return {kUtm.x + random.real(0, 1000), kUtm.y + random.real(0, 1000)};
}

Point2 on_millimetres(Random& random) {
  const Point2 p = anywhere(random);
  return {to_millimetres(p.x), to_millimetres(p.y)};
}

// Clusters of positions a few units in the last place apart.
Point2 in_tight_clusters(Random& random) {
  const Point2 centre{kUtm.x + random.integer(0, 4) * 100.3, kUtm.y + random.integer(0, 4) * 100.7};
  const double step = std::ldexp(1.0, -random.integer(18, 31));
  return {centre.x + random.integer(-3, 3) * step, centre.y + random.integer(-3, 3) * step};
}

Point2 on_small_lattice(Random& random) {
  return {kUtm.x + random.integer(0, 12), kUtm.y + random.integer(0, 12)};
}

std::vector<std::vector<Point2>> random_lines(Random& random, int lines, int vertices, const Place& place) {
  std::vector<std::vector<Point2>> soup(lines);
  for (auto& line : soup) {
    for (int i = 0; i < vertices; ++i) line.push_back(place(random));
  }
  return soup;
}

void expect_soups_noded(const Place& place, int scenes, int lines, int vertices) {
  Random random;
  SCOPED_TRACE(random.trace());
  Progress progress;
  for (int scene = 0; scene < scenes; ++scene) {
    SCOPED_TRACE("scene " + std::to_string(scene));
    const Soup soup = test::make_soup(random_lines(random, lines, vertices, place));
    test::expect_noded(soup, node_segments(soup.vertices, soup.segments, progress));
    if (testing::Test::HasFailure()) return;
  }
}

TEST(Noding, FullPrecisionSoups) {
  expect_soups_noded(anywhere, 10, 7, 4);
}
TEST(Noding, MillimetreSoups) {
  expect_soups_noded(on_millimetres, 10, 7, 4);
}
TEST(Noding, TightClusters) {
  expect_soups_noded(in_tight_clusters, 40, 6, 4);
}
TEST(Noding, LatticeSoupsWithOverlapsAndBacktracking) {
  expect_soups_noded(on_small_lattice, 20, 6, 5);
}

// Crossings, touches and ends that are meant to lie on other lines but do not, quite.
TEST(Noding, AlmostTouchingEnds) {
  Random random;
  SCOPED_TRACE(random.trace());
  Progress progress;
  for (int scene = 0; scene < 20; ++scene) {
    auto lines = random_lines(random, 6, 2, anywhere);
    for (int i = 0; i < 12; ++i) {
      const auto& line = lines[random.integer(0, 5)];
      const double t = random.real(0, 1);
      const Point2 near{line[0].x + t * (line[1].x - line[0].x), line[0].y + t * (line[1].y - line[0].y)};
      lines.push_back({near, i % 2 == 0 ? anywhere(random) : Point2{near.x + 1e-6, near.y + 2e-6}});
    }
    const Soup soup = test::make_soup(lines);
    test::expect_noded(soup, node_segments(soup.vertices, soup.segments, progress));
    if (HasFailure()) return;
  }
}

// Bundles of nearly the same line.
TEST(Noding, NearlyCoincidentLines) {
  Random random;
  SCOPED_TRACE(random.trace());
  Progress progress;
  for (int scene = 0; scene < 20; ++scene) {
    const auto base = random_lines(random, 1, 6, anywhere).front();
    std::vector<std::vector<Point2>> lines;
    const double noise = std::ldexp(1.0, -random.integer(15, 31));
    for (int copy = 0; copy < 5; ++copy) {
      auto line = base;
      for (Point2& p : line) {
        p = {p.x + random.integer(-2, 2) * noise, p.y + random.integer(-2, 2) * noise};
      }
      lines.push_back(line);
    }
    const Soup soup = test::make_soup(lines);
    test::expect_noded(soup, node_segments(soup.vertices, soup.segments, progress));
    if (HasFailure()) return;
  }
}

std::set<std::pair<Point2, Point2>> links_by_position(const Soup& soup, const Noding& noding) {
  const std::vector<Point2> xy = test::all_vertices(soup, noding);
  std::set<std::pair<Point2, Point2>> links;
  for (const auto& [a, b] : test::all_links(noding)) links.insert(std::minmax(xy[a], xy[b]));
  return links;
}

// The same vertices in another order, segments shuffled and turned.
Soup shuffle(const Soup& soup, Random& random) {
  std::vector<std::uint32_t> place(soup.vertices.size());
  for (std::uint32_t i = 0; i < place.size(); ++i) place[i] = i;
  std::shuffle(place.begin(), place.end(), random.engine());
  Soup shuffled{.vertices = soup.vertices, .segments = soup.segments};
  for (std::size_t i = 0; i < place.size(); ++i) shuffled.vertices[place[i]] = soup.vertices[i];
  for (SegmentEnds& ends : shuffled.segments) {
    ends = {place[ends[0]], place[ends[1]]};
    if (random.integer(0, 1) == 1) std::swap(ends[0], ends[1]);
  }
  std::shuffle(shuffled.segments.begin(), shuffled.segments.end(), random.engine());
  return shuffled;
}

TEST(Noding, DoesNotDependOnOrder) {
  Random random;
  SCOPED_TRACE(random.trace());
  Progress progress;
  for (const Place& place : {Place(anywhere), Place(in_tight_clusters), Place(on_small_lattice)}) {
    for (int scene = 0; scene < 10; ++scene) {
      const Soup soup = test::make_soup(random_lines(random, 6, 4, place));
      const Soup other = shuffle(soup, random);
      EXPECT_EQ(links_by_position(soup, node_segments(soup.vertices, soup.segments, progress)),
                links_by_position(other, node_segments(other.vertices, other.segments, progress)));
    }
  }
}

TEST(Noding, LeavesNodedLinesAlone) {
  Progress progress;
  const Soup soup =
      test::make_soup({{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}}, {{1, 1}, {5, 7}}, {{3, 3}, {3, 3}}});
  const Noding noding = node_segments(soup.vertices, soup.segments, progress);
  EXPECT_TRUE(noding.crossings.empty());
  EXPECT_EQ(noding.nodes.size(), 2 * (soup.segments.size() - 1) + 1);
}

TEST(Noding, CutsACrossAtItsCentre) {
  Progress progress;
  const Soup soup = test::make_soup({{{0, 0}, {2, 2}}, {{0, 2}, {2, 0}}});
  const Noding noding = node_segments(soup.vertices, soup.segments, progress);
  ASSERT_EQ(noding.crossings.size(), 1U);
  EXPECT_EQ(noding.crossings[0], (Point2{1, 1}));
  test::expect_noded(soup, noding);
}

}  // namespace
}  // namespace thalweg
