// Points on lines become vertices of them.
#include <thalweg/delaunay/split_lines.hpp>

#include <gtest/gtest.h>

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
  EXPECT_EQ(split_lines_at_points(survey, progress), 7U);
  EXPECT_EQ(survey.lines[0].xy,
            (std::vector<Point2>{{0, 0}, {1, 1}, {2, 2}, {3, 3}, {4, 4}, {4, 3}, {4, 0}}));
  EXPECT_EQ(survey.lines[0].z, (std::vector<double>{0, 2, 4, 6, 8, 8, 8}));
  EXPECT_EQ(survey.lines[1].xy, (std::vector<Point2>{{4, 4}, {3, 3}, {2, 2}, {1, 1}, {0, 0}}));
  EXPECT_TRUE(survey.lines[1].z.empty());
  EXPECT_EQ(split_lines_at_points(survey, progress), 0U);
}

TEST(SplitLines, VerticesOfOtherLinesCount) {
  Progress progress;
  Survey survey;
  survey.lines = {line_of({{0, 0}, {4, 0}}), line_of({{2, 0}, {2, 5}}), line_of({{1, 1}, {1, 1}})};
  EXPECT_EQ(split_lines_at_points(survey, progress), 1U);
  EXPECT_EQ(survey.lines[0].xy, (std::vector<Point2>{{0, 0}, {2, 0}, {4, 0}}));
}

TEST(SplitLines, NothingToDo) {
  Progress progress;
  Survey survey;
  EXPECT_EQ(split_lines_at_points(survey, progress), 0U);
  survey.lines = {line_of({}), line_of({{1, 1}})};
  EXPECT_EQ(split_lines_at_points(survey, progress), 0U);
}

}  // namespace
}  // namespace thalweg
