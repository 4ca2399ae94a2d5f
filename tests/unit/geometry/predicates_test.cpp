// Predicates and boxes on cases whose answer is plain, and on those that floating point gets wrong.
#include <thalweg/geometry/point.hpp>
#include <thalweg/geometry/predicates.hpp>
#include <thalweg/geometry/slope.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace thalweg {
namespace {

TEST(Box2, HoldsWhatWasAdded) {
  EXPECT_TRUE(Box2().empty());
  EXPECT_EQ(Box2().width(), 0);
  const std::vector<Point2> points{{1, 5}, {-2, 7}};
  const Box2 box = bounding_box(points);
  EXPECT_EQ(box.width(), 3);
  EXPECT_EQ(box.height(), 2);
  EXPECT_TRUE(box.contains({1, 7}));
  EXPECT_FALSE(box.contains({1.1, 7}));
}

TEST(Point2, IsOrderedByXThenY) {
  EXPECT_LT((Point2{1, 9}), (Point2{2, 0}));
  EXPECT_LT((Point2{1, 8}), (Point2{1, 9}));
}

TEST(Orientation, SeesTheLastBit) {
  const Point2 a{0.5, 0.5}, b{12, 12};
  EXPECT_EQ(orientation(a, b, {24, 24}), 0);
  EXPECT_EQ(orientation(a, b, {24, std::nextafter(24.0, 25)}), 1);
  EXPECT_EQ(orientation(a, b, {std::nextafter(24.0, 25), 24}), -1);
  const double tiny = 0x1p-1060;
  EXPECT_EQ(orientation({0, 0}, {tiny, 0}, {0, tiny}), 1);
  EXPECT_EQ(orientation({0, 0}, {tiny, tiny}, {2 * tiny, 2 * tiny}), 0);
  EXPECT_EQ(orientation({-9e99, -9e99}, {9e99, 9e99}, {0, 1e-300}), 1);
}

TEST(Orientation, SeesWhatIsLostWhenScaled) {
  EXPECT_EQ(orientation({0x1p100, 0}, {0x1p99, 0x1p-1060}, {0, 0}), 1);
}

// Products of differences are too small for doubles, but the heights are not.
TEST(FallAcross, SeesWhatUnderflows) {
  const Point2 a{0, 0}, b{1.6e-162, 0}, c{0.96e-162, 1e-162};
  EXPECT_EQ(fall_across(a, 0, b, 2e99, c, 1e99), -1);
}

TEST(InCircle, SeesTheLastBit) {
  const Point2 a{0, 0}, b{1, 0}, c{1, 1};
  EXPECT_EQ(in_circle(a, b, c, {0, 1}), 0);
  EXPECT_EQ(in_circle(a, b, c, {0, std::nextafter(1.0, 0)}), 1);
  EXPECT_EQ(in_circle(a, b, c, {0, std::nextafter(1.0, 2)}), -1);
  EXPECT_EQ(in_circle(a, b, c, {0.5, 0.5}), 1);
  EXPECT_EQ(in_circle(a, b, c, {1, 0}), 0);
  const double x = 500'000, y = 5'000'000, step = 1.0 / 1024;
  EXPECT_EQ(in_circle({x, y}, {x + step, y}, {x + step, y + step}, {x, y + step}), 0);
  EXPECT_EQ(in_circle({-9e99, -9e99}, {9e99, -9e99}, {9e99, 9e99}, {-9e99, 9e99}), 0);
}

TEST(InCirclePerturbed, TheLargestOfFourCocircularPointsIsOutside) {
  const Point2 sw{0, 0}, se{1, 0}, ne{1, 1}, nw{0, 1};  // ne is the largest
  EXPECT_FALSE(in_circle_perturbed(sw, se, nw, ne));
  EXPECT_FALSE(in_circle_perturbed(nw, sw, se, ne));
  EXPECT_FALSE(in_circle_perturbed(se, ne, nw, sw)) << "both triangles of diagonal se-nw are empty";
  EXPECT_TRUE(in_circle_perturbed(sw, se, ne, nw)) << "those of diagonal sw-ne are not";
  EXPECT_TRUE(in_circle_perturbed(sw, ne, nw, se));
}

TEST(SegmentMeetsOpenDisc, TouchingIsNotMeeting) {
  const Point2 a{1, 0}, b{0, 1}, c{-1, 0};  // the unit circle
  EXPECT_TRUE(segment_meets_open_disc(a, b, c, {-2, 0}, {2, 0}));
  EXPECT_TRUE(segment_meets_open_disc(a, b, c, {0, 0}, {0.1, 0.1}));
  EXPECT_TRUE(segment_meets_open_disc(a, b, c, {0, 0}, {0, 0}));
  EXPECT_TRUE(segment_meets_open_disc(a, b, c, {0, 0}, {9, 9})) << "one end inside";
  EXPECT_TRUE(segment_meets_open_disc(a, b, c, a, b)) << "a chord";
  EXPECT_FALSE(segment_meets_open_disc(a, b, c, {-2, 1}, {2, 1})) << "a tangent";
  EXPECT_TRUE(segment_meets_open_disc(a, b, c, {-2, std::nextafter(1.0, 0)}, {2, std::nextafter(1.0, 0)}));
  EXPECT_FALSE(segment_meets_open_disc(a, b, c, {-2, std::nextafter(1.0, 2)}, {2, std::nextafter(1.0, 2)}));
  EXPECT_FALSE(segment_meets_open_disc(a, b, c, {1, 0}, {2, 0})) << "starts on the circle, leads away";
  EXPECT_FALSE(segment_meets_open_disc(a, b, c, {1, 0}, {1, 5})) << "starts on the circle, along the tangent";
  EXPECT_TRUE(segment_meets_open_disc(a, b, c, {1, 0}, {0.9, 5})) << "starts on the circle, leads inside";
  EXPECT_FALSE(segment_meets_open_disc(a, b, c, {2, 0}, {3, 0})) << "on a line that meets it, beyond";
  EXPECT_FALSE(segment_meets_open_disc(a, b, c, {2, 2}, {2, 2})) << "a point outside";
  EXPECT_FALSE(segment_meets_open_disc(a, b, c, b, b)) << "a point on the circle";
}

TEST(OnSegment, EndsBelong) {
  EXPECT_TRUE(on_segment({0, 0}, {4, 2}, {2, 1}));
  EXPECT_TRUE(on_segment({4, 2}, {0, 0}, {0, 0}));
  EXPECT_FALSE(on_segment({0, 0}, {4, 2}, {6, 3}));
  EXPECT_FALSE(on_segment({0, 0}, {4, 2}, {2, std::nextafter(1.0, 2)}));
  EXPECT_TRUE(on_segment({1, 0}, {1, 3}, {1, 2}));
}

TEST(CrossProperly, EndsDoNotCount) {
  EXPECT_TRUE(cross_properly({0, 0}, {2, 2}, {0, 2}, {2, 0}));
  EXPECT_FALSE(cross_properly({0, 0}, {2, 2}, {1, 1}, {2, 0}));
  EXPECT_FALSE(cross_properly({0, 0}, {2, 2}, {1, 1}, {3, 3}));
  EXPECT_FALSE(cross_properly({0, 0}, {2, 2}, {2, 2}, {3, 0}));
  EXPECT_FALSE(cross_properly({0, 0}, {1, 1}, {0, 3}, {3, 0}));
}

}  // namespace
}  // namespace thalweg
