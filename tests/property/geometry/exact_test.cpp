// The laws of predicates.hpp on random input, against rational arithmetic on the textbook determinants.
#include "support/random.hpp"

#include <thalweg/geometry/direction.hpp>
#include <thalweg/geometry/predicates.hpp>

#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

namespace thalweg {
namespace {

using boost::multiprecision::cpp_int;
using Rational = boost::multiprecision::cpp_rational;

// Coordinates times 2^1074, which makes a whole number of every double.
struct ExactPoint {
  cpp_int x, y, lift;
};

cpp_int scaled(double value) {
  int exponent = 0;
  const cpp_int mantissa(static_cast<std::int64_t>(std::ldexp(std::frexp(value, &exponent), 53)));
  const int shift = exponent - 53 + 1074;
  return shift >= 0 ? cpp_int(mantissa << shift) : cpp_int(mantissa / (cpp_int(1) << -shift));
}

ExactPoint exact(Point2 p) {
  const cpp_int x = scaled(p.x), y = scaled(p.y);
  return {x, y, x * x + y * y};
}

int exact_orientation(Point2 a, Point2 b, Point2 c) {
  const ExactPoint p = exact(a), q = exact(b), r = exact(c);
  return cpp_int((q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x)).sign();
}

// The determinant of the rows (x, y, lift, 1), with d's row taken from the others.
int lifted_determinant(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, const ExactPoint& d) {
  const auto minor = [&](const ExactPoint& p, const ExactPoint& q) {
    return cpp_int((p.x - d.x) * (q.y - d.y) - (p.y - d.y) * (q.x - d.x));
  };
  return cpp_int((a.lift - d.lift) * minor(b, c) + (b.lift - d.lift) * minor(c, a) +
                 (c.lift - d.lift) * minor(a, b))
      .sign();
}

int exact_in_circle(Point2 a, Point2 b, Point2 c, Point2 d) {
  return lifted_determinant(exact(a), exact(b), exact(c), exact(d));
}

// Squared distance of the closed segment from the centre, against the squared radius.
bool exact_meets(Point2 a, Point2 b, Point2 c, Point2 p, Point2 q) {
  const ExactPoint u = exact(a), v = exact(b), w = exact(c);
  const Rational twice(2 * ((v.x - u.x) * (w.y - u.y) - (v.y - u.y) * (w.x - u.x)));
  const Rational x = Rational((w.y - u.y) * (v.lift - u.lift) - (v.y - u.y) * (w.lift - u.lift)) / twice;
  const Rational y = Rational((v.x - u.x) * (w.lift - u.lift) - (w.x - u.x) * (v.lift - u.lift)) / twice;
  const Rational radius = (u.x - x) * (u.x - x) + (u.y - y) * (u.y - y);
  const ExactPoint from = exact(p), to = exact(q);
  const Rational dx(to.x - from.x), dy(to.y - from.y);
  const Rational length = dx * dx + dy * dy;
  Rational t = length == 0 ? Rational(0) : Rational(((x - from.x) * dx + (y - from.y) * dy) / length);
  t = std::clamp(t, Rational(0), Rational(1));
  const Rational east = from.x + t * dx - x, north = from.y + t * dy - y;
  return east * east + north * north < radius;
}

// Sources of points, from plain to nasty.
struct Source {
  const char* name;
  std::function<Point2(test::Random&)> draw;
};

const std::vector<Source>& sources() {
  static const std::vector<Source> all{
      {"lattice",
       [](test::Random& r) {
         return Point2{r.integer(0, 4) * 1.0, r.integer(0, 4) * 1.0};
       }},
      {"lattice far away",
       [](test::Random& r) {
         return Point2{4.2e6 + r.integer(0, 4) * 0x1p-10, 1.1e7 + r.integer(0, 4) * 0x1p-10};
       }},
      {"decimal lattice far away",
       [](test::Random& r) {
         return Point2{4.2e6 + r.integer(0, 9) * 0.001, 1.1e7 + r.integer(0, 9) * 0.001};
       }},
      {"uniform",
       [](test::Random& r) {
         return Point2{r.real(0, 1), r.real(0, 1)};
       }},
      {"near a line",
       [](test::Random& r) {
         const double x = r.real(0, 1);
         return Point2{x, 0.3 * x + r.integer(-1, 1) * 0x1p-53};
       }},
      {"near a circle",
       [](test::Random& r) {
         const double angle = r.real(0, 6.3);
         return Point2{1e5 + std::cos(angle), 1e5 + std::sin(angle)};
       }},
      {"on a circle, integers",
       [](test::Random& r) {
         constexpr std::array<int, 6> kX{0, 25, 7, 24, 15, 20};  // x^2 + y^2 = 625
         constexpr std::array<int, 6> kY{25, 0, 24, 7, 20, 15};
         const std::size_t i = r.integer<std::size_t>(0, 5);
         return Point2{kX[i] * (r.integer(0, 1) * 2.0 - 1), kY[i] * (r.integer(0, 1) * 2.0 - 1)};
       }},
      {"tiny",
       [](test::Random& r) {
         return Point2{r.integer(0, 6) * 0x1p-1070, r.integer(0, 6) * 0x1p-1070};
       }},
      {"huge",
       [](test::Random& r) {
         return Point2{r.integer(-9, 9) * 1e99, r.integer(-9, 9) * 1e99};
       }},
      {"mixed magnitudes",
       [](test::Random& r) {
         return Point2{std::ldexp(r.real(-1, 1), r.integer(-300, 300)),
                       std::ldexp(r.real(-1, 1), r.integer(-300, 300))};
       }},
  };
  return all;
}

// Scenes of points of one source, a share of them with two sources mixed.
template <class Check>
void on_scenes(std::size_t size, int count, const Check& check) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  std::vector<Point2> points(size);
  for (const Source& source : sources()) {
    SCOPED_TRACE(source.name);
    for (int i = 0; i < count; ++i) {
      for (Point2& p : points) p = source.draw(random);
      check(points);
      if (testing::Test::HasFailure()) return;
    }
  }
}

bool turn_left(std::vector<Point2>& points) {
  const int turn = exact_orientation(points[0], points[1], points[2]);
  if (turn < 0) std::swap(points[1], points[2]);
  return turn != 0;
}

TEST(ExactPredicates, Orientation) {
  on_scenes(3, 1000, [](const std::vector<Point2>& p) {
    const int expected = exact_orientation(p[0], p[1], p[2]);
    EXPECT_EQ(orientation(p[0], p[1], p[2]), expected);
    EXPECT_EQ(orientation(p[1], p[2], p[0]), expected);
    EXPECT_EQ(orientation(p[1], p[0], p[2]), -expected);
  });
}

TEST(ExactPredicates, Turn) {
  on_scenes(4, 1000, [](const std::vector<Point2>& p) {
    const ExactPoint a = exact(p[0]), b = exact(p[1]), c = exact(p[2]), d = exact(p[3]);
    const int expected = cpp_int((b.x - a.x) * (d.y - c.y) - (b.y - a.y) * (d.x - c.x)).sign();
    EXPECT_EQ(turn({p[0], p[1]}, {p[2], p[3]}), expected);
    EXPECT_EQ(turn({p[2], p[3]}, {p[0], p[1]}), -expected);
    EXPECT_EQ(turn({p[1], p[0]}, {p[2], p[3]}), -expected);
    EXPECT_EQ(turn({p[0], p[1]}, {p[0], p[2]}), exact_orientation(p[0], p[1], p[2]));
  });
}

TEST(ExactPredicates, InCircle) {
  on_scenes(4, 1000, [](std::vector<Point2> p) {
    if (!turn_left(p)) return;
    EXPECT_EQ(in_circle(p[0], p[1], p[2], p[3]), exact_in_circle(p[0], p[1], p[2], p[3]));
  });
}

TEST(ExactPredicates, SegmentMeetsOpenDisc) {
  on_scenes(5, 200, [](std::vector<Point2> p) {
    if (!turn_left(p)) return;
    const bool expected = exact_meets(p[0], p[1], p[2], p[3], p[4]);
    EXPECT_EQ(segment_meets_open_disc(p[0], p[1], p[2], p[3], p[4]), expected);
    EXPECT_EQ(segment_meets_open_disc(p[1], p[2], p[0], p[4], p[3]), expected);
  });
}

TEST(ExactPredicates, OnSegmentAndCrossing) {
  on_scenes(4, 1000, [](const std::vector<Point2>& p) {
    if (p[0] == p[1]) return;
    const auto [low, high] = std::minmax(p[0], p[1]);
    const bool between = !(p[2] < low) && !(high < p[2]);
    EXPECT_EQ(on_segment(p[0], p[1], p[2]), between && exact_orientation(p[0], p[1], p[2]) == 0);
    const bool split = exact_orientation(p[0], p[1], p[2]) * exact_orientation(p[0], p[1], p[3]) < 0;
    const bool splits = exact_orientation(p[2], p[3], p[0]) * exact_orientation(p[2], p[3], p[1]) < 0;
    EXPECT_EQ(cross_properly(p[0], p[1], p[2], p[3]), split && splits);
  });
}

// Law 2, for as many cocircular points as the scene has: raise the lift of the largest point by e, of the
// next one by e^2, and so on, for an e so small that no lesser term can outweigh a greater; then the plain
// determinant gives the answer.
TEST(ExactPredicates, TheTieRuleIsAPerturbation) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  constexpr unsigned kStep = 200;  // e = 2^-200, and all lifts are multiplied by 2^1400
  constexpr unsigned kMost = 7;
  for (const char* name : {"lattice", "on a circle, integers"}) {
    const Source& source = *std::find_if(sources().begin(), sources().end(),
                                         [&](const Source& s) { return s.name == std::string(name); });
    for (int scene = 0; scene < 100; ++scene) {
      std::vector<Point2> points(kMost);
      for (Point2& p : points) p = source.draw(random);
      std::sort(points.begin(), points.end(), std::greater<>());
      points.erase(std::unique(points.begin(), points.end()), points.end());
      std::vector<ExactPoint> lifted;
      for (const Point2 p : points) {
        const auto x = static_cast<std::int64_t>(p.x), y = static_cast<std::int64_t>(p.y);
        const auto rank = static_cast<unsigned>(lifted.size() + 1);
        lifted.push_back(
            {x, y, (cpp_int(x * x + y * y) << (kMost * kStep)) + (cpp_int(1) << ((kMost - rank) * kStep))});
      }
      const std::size_t n = points.size();
      for (std::size_t i = 0; i < n * n * n * n; ++i) {
        const std::size_t a = i % n, b = i / n % n, c = i / n / n % n, d = i / n / n / n;
        if (a == b || b == c || c == a || d == a || d == b || d == c) continue;
        if (orientation(points[a], points[b], points[c]) <= 0) continue;
        EXPECT_EQ(in_circle_perturbed(points[a], points[b], points[c], points[d]),
                  lifted_determinant(lifted[a], lifted[b], lifted[c], lifted[d]) > 0);
      }
      if (HasFailure()) return;
    }
  }
}

}  // namespace
}  // namespace thalweg
