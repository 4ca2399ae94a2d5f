// Lines that follow their source's coordinates, on maps whose bend is known.
#include <thalweg/base/error.hpp>
#include <thalweg/mesh/densify.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace thalweg {
namespace {

using testing::HasSubstr;

Survey survey_of(std::vector<Point2> xy, std::vector<double> z = {}) {
  Survey survey;
  survey.sources.push_back({"rivers.gpkg", "main"});
  survey.lines.push_back({.kind = EdgeKind::Valley, .xy = std::move(xy), .z = std::move(z), .feature = 12});
  return survey;
}

// A chord of length s along x bends by s^2 / 8 * 2e-4 in the middle.
Point2 parabola(Point2 p) {
  return {p.x, p.y + 1e-4 * p.x * p.x};
}

TEST(DensifyLines, WhatStaysStraightIsLeftAlone) {
  Survey survey = survey_of({{0, 0}, {1e6, 3e5}, {1e6, 3e5}, {2e6, 0}}, {1, 2, 2, 3});
  const auto shear = [](Point2 p) { return Point2{2 * p.x + p.y, p.y}; };
  EXPECT_EQ(densify_lines(survey, shear), 0U);
  EXPECT_EQ(survey.lines[0].xy.size(), 4U);
}

TEST(DensifyLines, TheLimitIsATenthOfAUnit) {
  Survey below = survey_of({{0, 0}, {63.2, 0}});
  EXPECT_EQ(densify_lines(below, parabola), 0U);
  Survey above = survey_of({{0, 0}, {63.3, 0}});
  EXPECT_EQ(densify_lines(above, parabola), 1U);
  EXPECT_DOUBLE_EQ(above.lines[0].xy[1].x, 31.65);
  Survey wide = survey_of({{0, 0}, {63.3, 0}});
  EXPECT_EQ(densify_lines(wide, parabola, {.limit = 1}), 0U);
}

TEST(DensifyLines, PiecesAreAsFewAsTheBendAllows) {
  Survey survey = survey_of({{-500, 0}, {500, 0}}, {10, 20});
  EXPECT_EQ(densify_lines(survey, parabola), 15U);  // 1000 / 16 < 63.24 < 1000 / 15
  const SurveyLine& line = survey.lines[0];
  for (std::size_t i = 0; i <= 16; ++i) {
    EXPECT_DOUBLE_EQ(line.xy[i].x, -500 + 62.5 * static_cast<double>(i));
    EXPECT_DOUBLE_EQ(line.z[i], 10 + 0.625 * static_cast<double>(i));
  }
}

TEST(DensifyLines, APieceThatBendsBothWaysIsSeen) {
  const auto cubic = [](Point2 p) { return Point2{p.x, p.y + 1e-6 * p.x * p.x * p.x}; };
  Survey survey = survey_of(
      {{-64, 0}, {64, 0}});  // bends by 0.1009 at +-37, not at all in the middle: halves help nothing
  EXPECT_EQ(densify_lines(survey, cubic), 2U);
}

TEST(DensifyLines, BothDirectionsGetTheSameVertices) {
  Survey there = survey_of({{1.1, 2.3}, {977.7, -301.9}}, {0.1, 0.7});
  Survey back = survey_of({{977.7, -301.9}, {1.1, 2.3}}, {0.7, 0.1});
  EXPECT_GT(densify_lines(there, parabola), 10U);
  densify_lines(back, parabola);
  std::reverse(back.lines[0].xy.begin(), back.lines[0].xy.end());
  std::reverse(back.lines[0].z.begin(), back.lines[0].z.end());
  EXPECT_EQ(there.lines[0].xy, back.lines[0].xy);
  EXPECT_EQ(there.lines[0].z, back.lines[0].z);
}

TEST(DensifyLines, HeightsStayWithinTheirEnds) {
  const double z = 0.1 + 0.2;
  Survey level = survey_of({{-900, 0}, {900, 1}}, {z, z});
  densify_lines(level, parabola);
  EXPECT_THAT(level.lines[0].z, testing::Each(z));
  Survey steep = survey_of({{-900, 0}, {900, 1}}, {z, std::nextafter(z, 1)});
  densify_lines(steep, parabola);
  for (const double height : steep.lines[0].z) {
    EXPECT_GE(height, z);
    EXPECT_LE(height, std::nextafter(z, 1));
  }
}

TEST(DensifyLines, TheShortWayIsTakenAroundAPeriod) {
  const auto bowl = [](Point2 p) {
    const double x = std::remainder(p.x - 180, 360);
    return Point2{x, p.y + x * x};
  };
  Survey survey = survey_of({{179.25, 0}, {-179.25, 0}});
  EXPECT_EQ(densify_lines(survey, bowl, {.x_period = 360}),
            2U);  // 1.5 long bends by 0.5625, a third by 0.0625
  ASSERT_EQ(survey.lines[0].xy.size(), 4U);
  EXPECT_DOUBLE_EQ(survey.lines[0].xy[1].x, 179.75);
  EXPECT_DOUBLE_EQ(survey.lines[0].xy[2].x, -179.75);
}

TEST(DensifyLines, AnEndlessPieceIsAnErrorThatNamesIt) {
  Survey survey = survey_of({{0, 0}, {1e9, 0}});
  try {
    densify_lines(survey, parabola);
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::BadCoordinate);
    EXPECT_THAT(error.what(), HasSubstr("rivers.gpkg|main feature 12 part 0"));
    EXPECT_THAT(error.what(), HasSubstr("--t-crs"));
  }
}

}  // namespace
}  // namespace thalweg
