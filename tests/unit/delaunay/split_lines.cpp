// Points on lines become vertices of them.
#include <thalweg/delaunay/split_lines.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace thalweg {
namespace {

SurveyLine line_of(std::vector<Point2> xy, std::vector<double> z = {}) {
  SurveyLine line;
  line.xy = std::move(xy);
  line.z = std::move(z);
  return line;
}

TEST(SplitLines, InsertsPointsInOrderAlongTheLine) {
  Progress progress;
  Survey survey;
  survey.points.xy = {{1, 1}, {3, 3}, {4, 3}, {2, 2}, {2, 2}, {5, 4}, {2, 2.5}};
  survey.points.z.assign(survey.points.xy.size(), 0);
  survey.lines = {line_of({{0, 0}, {4, 4}, {4, 0}}, {0, 8, 8}), line_of({{4, 4}, {0, 0}})};
  EXPECT_EQ(split_lines_at_points(survey, 0, progress), 7U);
  EXPECT_EQ(survey.lines[0].xy,
            (std::vector<Point2>{{0, 0}, {1, 1}, {2, 2}, {3, 3}, {4, 4}, {4, 3}, {4, 0}}));
  EXPECT_EQ(survey.lines[0].z, (std::vector<double>{0, 2, 4, 6, 8, 8, 8}));
  EXPECT_EQ(survey.lines[1].xy, (std::vector<Point2>{{4, 4}, {3, 3}, {2, 2}, {1, 1}, {0, 0}}));
  EXPECT_TRUE(survey.lines[1].z.empty());
  EXPECT_EQ(split_lines_at_points(survey, 0, progress), 0U);
}

TEST(SplitLines, VerticesOfOtherLinesCount) {
  Progress progress;
  Survey survey;
  survey.lines = {line_of({{0, 0}, {4, 0}}), line_of({{2, 0}, {2, 5}}), line_of({{1, 1}, {1, 1}})};
  EXPECT_EQ(split_lines_at_points(survey, 0, progress), 1U);
  EXPECT_EQ(survey.lines[0].xy, (std::vector<Point2>{{0, 0}, {2, 0}, {4, 0}}));
}

TEST(SplitLines, UlpsBesideALineAreOnItInOrderAlongIt) {
  Progress progress;
  Survey survey;
  const double right = std::nextafter(64.0, 65.0), left = std::nextafter(64.0, 63.0);
  survey.points.xy = {{right, 1}, {left, 2}, {64, 3}, {64 + 1e-9, 3.5}, {64, -1e-13}};
  survey.points.z.assign(survey.points.xy.size(), 0);
  survey.lines = {line_of({{64, 4}, {64, 0}}, {8, 0})};
  EXPECT_EQ(split_lines_at_points(survey, 0, progress), 3U);
  EXPECT_EQ(survey.lines[0].xy, (std::vector<Point2>{{64, 4}, {64, 3}, {left, 2}, {right, 1}, {64, 0}}));
  EXPECT_EQ(survey.lines[0].z, (std::vector<double>{8, 6, 4, 2, 0}));
}

TEST(SplitLines, APointThatAgreesKeepsItsHeight) {
  Progress progress;
  Survey survey;
  survey.points.xy = {{0.1, 0}, {0.3, 0}};
  survey.points.z = {0.7, 5};
  survey.lines = {line_of({{0, 0}, {1, 0}}, {0, 7}), line_of({{std::nextafter(0.1, 0), 0}, {0.1, 3}})};
  EXPECT_EQ(split_lines_at_points(survey, 0, progress), 2U);
  EXPECT_EQ(survey.lines[0].z, (std::vector<double>{0, 0.7, 0.3 * 7, 7}));
}

TEST(SplitLines, UlpsBesideAVertexOfTheLineIsThatVertex) {
  Progress progress;
  Survey survey;
  survey.points.xy = {{std::nextafter(64.0, 0.0), 4}, {std::nextafter(64.0, 65.0), std::nextafter(4.0, 0.0)}};
  survey.points.z.assign(survey.points.xy.size(), 5);
  survey.lines = {line_of({{0, 4}, {64, 4}, {32, 0}}, {0, 5, 8})};
  EXPECT_EQ(split_lines_at_points(survey, 0, progress), 0U);
}

TEST(SplitLines, ASegmentOverTheJumpDoesNotGoAroundTheWorld) {
  Progress progress;
  Survey survey;
  survey.points.xy = {{0, 10}};
  survey.points.z = {0};
  survey.lines = {line_of({{179, 10}, {-179, 10}})};
  EXPECT_EQ(split_lines_at_points(survey, 360, progress), 0U);
}

// Lines along x, which the plane bends up: the chord runs above them by 0.0625 at most.
class SplitLinesBeside : public testing::Test {
 protected:
  static Point2 to_plane(Point2 p) { return {p.x, p.y + p.x * p.x / 64}; }
  std::size_t split() {
    for (const Point2 p : written_points_) survey_.points.xy.push_back(to_plane(p));
    survey_.points.z.assign(written_points_.size(), 0);
    for (auto& written : written_lines_) {
      SurveyLine line;
      for (const Point2 p : written) line.xy.push_back(to_plane(p));
      line.z.assign(line.xy.size(), 0);
      line.z.back() = 8;
      survey_.lines.push_back(std::move(line));
    }
    Progress progress;
    return split_lines_beside_points(survey_, {written_points_, written_lines_}, to_plane, {.limit = 0.1}, 0,
                                     progress);
  }
  Survey survey_;
  std::vector<Point2> written_points_;
  std::vector<std::vector<Point2>> written_lines_;
};

TEST_F(SplitLinesBeside, APointBetweenCurveAndChordGetsItsFoot) {
  written_points_ = {{0.5, 0.03}, {0.5, 0.08}, {-1, -0.01}, {1.9, 0.02}};
  written_lines_ = {{{2, 0}, {-2, 0}}};
  ASSERT_EQ(split(), 1U);
  EXPECT_NEAR(written_lines_[0][1].x, 0.5, 1e-3);
  EXPECT_EQ(written_lines_[0][1].y, 0);
  EXPECT_EQ(survey_.lines[0].xy[1], to_plane(written_lines_[0][1]));
  EXPECT_NEAR(survey_.lines[0].z[1], 3, 1e-3);
}

TEST_F(SplitLinesBeside, APointWithinAPixelBecomesTheVertex) {
  written_points_ = {{0.5, 1e-14}, {-0.5, -1e-14}, {1, 1e-9}};
  written_lines_ = {{{-2, 0}, {2, 0}}};
  ASSERT_EQ(split(), 3U);
  EXPECT_EQ(written_lines_[0][1], written_points_[1]);
  EXPECT_EQ(written_lines_[0][2], written_points_[0]);
  EXPECT_NE(written_lines_[0][3], written_points_[2]);
}

TEST_F(SplitLinesBeside, VerticesOfOtherLinesCount) {
  written_lines_ = {{{-2, 0}, {2, 0}}, {{0, 0.05}, {0, 5}}, {{1, 1}, {0, 0.05}}};
  ASSERT_EQ(split(), 1U);
  EXPECT_EQ(written_lines_[0].size(), 3U);
}

TEST(SplitLines, NothingToDo) {
  Progress progress;
  Survey survey;
  EXPECT_EQ(split_lines_at_points(survey, 0, progress), 0U);
  survey.lines = {line_of({}), line_of({{1, 1}})};
  EXPECT_EQ(split_lines_at_points(survey, 0, progress), 0U);
}

}  // namespace
}  // namespace thalweg
