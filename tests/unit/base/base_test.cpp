// Error names, ids, progress and cancel, small letters, and loops in blocks.
#include "base/lower_case.hpp"
#include "base/parallel.hpp"

#include <thalweg/base/assert.hpp>
#include <thalweg/base/error.hpp>
#include <thalweg/base/id.hpp>
#include <thalweg/base/progress.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <set>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace thalweg {
namespace {

using testing::ElementsAre;
using testing::Pair;

TEST(Error, NamesAreDistinctAndStable) {
  std::set<std::string> names;
  for (int code = 0; code <= static_cast<int>(ErrorCode::Internal); ++code) {
    const std::string name(error_name(static_cast<ErrorCode>(code)));
    EXPECT_TRUE(names.insert(name).second) << name;
    EXPECT_EQ(name.find_first_not_of("abcdefghijklmnopqrstuvwxyz-"), std::string::npos) << name;
  }
  EXPECT_EQ(error_name(ErrorCode::NotFound), "not-found");
  EXPECT_EQ(error_name(ErrorCode::InvalidTin), "invalid-tin");
  EXPECT_EQ(error_name(ErrorCode::Internal), "internal");
}

TEST(Error, CarriesCodeAndMessage) {
  const Error error(ErrorCode::BadFormat, "points.csv row 3: no number");
  EXPECT_EQ(error.code(), ErrorCode::BadFormat);
  EXPECT_STREQ(error.what(), "points.csv row 3: no number");
}

TEST(Id, KindsDoNotMix) {
  static_assert(!std::is_convertible_v<VertexId, TriangleId>);
  static_assert(!std::is_convertible_v<std::size_t, VertexId>);
  static_assert(sizeof(VertexId) == 4);
  EXPECT_FALSE(VertexId{}.valid());
  EXPECT_TRUE(VertexId{0}.valid());
  EXPECT_LT(VertexId{7}, VertexId{8});
  EXPECT_EQ(VertexId{7}.index(), 7U);
}

TEST(Assert, ABrokenLawIsAnInternalError) {
#ifdef THALWEG_ASSERTIONS
  try {
    THALWEG_ASSERT(1 + 1 == 3);
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Internal);
  }
#endif
  EXPECT_NO_THROW(THALWEG_ASSERT(1 + 1 == 2));
}

TEST(Progress, ReportsPhasesInStepsOfAPerCent) {
  std::vector<std::pair<std::string, double>> seen;
  Progress progress([&](const std::string& phase, double fraction) { seen.emplace_back(phase, fraction); });
  progress.start_phase("read");
  progress.advance(0.004);
  progress.advance(0.5);
  progress.advance(0.505);
  progress.advance(1);
  progress.start_phase("write");
  EXPECT_THAT(seen, ElementsAre(Pair("read", 0), Pair("read", 0.5), Pair("read", 1), Pair("write", 0)));
}

TEST(Progress, CancelStopsTheWork) {
  Progress progress;
  EXPECT_NO_THROW(progress.check());
  progress.cancel();
  EXPECT_TRUE(progress.cancelled());
  try {
    progress.advance(0.1);
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Cancelled);
  }
  EXPECT_THROW(progress.start_phase("more"), Error);
}

TEST(Progress, CancelInTheLastReportStopsTheWork) {
  Progress progress([&](const std::string&, double fraction) {
    if (fraction == 1) progress.cancel();
  });
  progress.start_phase("write");
  EXPECT_NO_THROW(progress.advance(0.5));
  EXPECT_THROW(progress.advance(1), Error);
}

TEST(LowerCase, MakesAsciiSmallAlone) {
  EXPECT_EQ(lower("AZaz[@`{09 \xc3\x84"), "azaz[@`{09 \xc3\x84");
  EXPECT_EQ(extension_of("A.B/c.d.PLY"), ".ply");
  EXPECT_EQ(extension_of("a.b/c"), "");
}

TEST(ForEachBlock, TilesTheRange) {
  for (const std::size_t count : {0U, 1U, 99U, 100U, 101U, 1234U}) {
    std::vector<std::atomic<int>> visits(count);
    for_each_block(count, 100, Progress(), [&](std::size_t begin, std::size_t end) {
      EXPECT_EQ(begin % 100, 0U);
      EXPECT_TRUE(end == count || end == begin + 100);
      for (std::size_t i = begin; i < end; ++i) ++visits[i];
    });
    for (const auto& v : visits) EXPECT_EQ(v, 1);
  }
}

TEST(ForEachBlock, StopsOnCancelAndPassesExceptionsOn) {
  Progress cancelled;
  cancelled.cancel();
  const auto nothing = [](std::size_t, std::size_t) {};
  EXPECT_THROW(for_each_block(10, 1, cancelled, nothing), Error);
  const auto fail = [](std::size_t, std::size_t) { throw std::runtime_error("body"); };
  EXPECT_THROW(for_each_block(10, 1, Progress(), fail), std::runtime_error);
}

}  // namespace
}  // namespace thalweg
