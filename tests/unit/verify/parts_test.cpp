// The verifier's own arithmetic and solver, against each other and against enumeration.
#include "support/random.hpp"
#include "verify/exact.hpp"
#include "verify/plain_delaunay.hpp"
#include "verify/plain_solver.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/verify/proof.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

namespace thalweg::verify {
namespace {

TEST(Exact, TheSmallestNumbersTurnToo) {
  const double least = std::numeric_limits<double>::denorm_min();
  EXPECT_EQ(turn({0, 0}, {least, 0}, {least, least}), 1);
  EXPECT_EQ(turn({0, 0}, {least, least}, {least, 0}), -1);
  EXPECT_EQ(turn({0, 0}, {least, least}, {2 * least, 2 * least}), 0);
  EXPECT_EQ(turn({0, 0}, {3 * least, least}, {2 * least, 5 * least}), 1);
}

TEST(Exact, NearlyCollinearPointsAreToldApart) {
  const double ulp = std::numeric_limits<double>::epsilon();
  EXPECT_EQ(turn({0, 0}, {12, 12}, {24, 24}), 0);
  EXPECT_EQ(turn({0.5, 0.5}, {12, 12}, {24, 24 * (1 + ulp)}), 1);
  EXPECT_EQ(turn({0.5, 0.5 + ulp}, {12, 12}, {24, 24}), 1);
  EXPECT_EQ(turn({0.5 + ulp, 0.5}, {12, 12}, {24, 24}), -1);
  EXPECT_EQ(turn({1e7 + 0.1, 0.1}, {1e7 + 0.2, 0.2}, {1e7 + 0.3, 0.3}),
            -turn({1e7 + 0.2, 0.2}, {1e7 + 0.1, 0.1}, {1e7 + 0.3, 0.3}));
}

TEST(Exact, OfFourPointsOnACircleTheLargestIsOutside) {
  const Point2 a{0, 0}, b{1, 0}, c{1, 1}, d{0, 1};  // so the diagonal is bd
  EXPECT_EQ(circle_side(a, b, c, d), 0);
  EXPECT_FALSE(counts_as_inside(a, b, d, c));
  EXPECT_FALSE(counts_as_inside(b, c, d, a));
  EXPECT_TRUE(counts_as_inside(a, b, c, d));
  EXPECT_EQ(circle_side(a, b, c, {0, 1 + 0x1p-52}), -1);
  EXPECT_EQ(circle_side(a, b, c, {0x1p-60, 1 - 0x1p-53}), 1);
}

TEST(ReadProof, RefusesStepsWithoutAWordThatIsKnown) {
  for (const std::string step : {" 0+ 1-", "", "cuts 0+"}) {
    std::istringstream text("thalweg-proof 1\nstage 0\ncut 0+ 1-\n" + step + "\nend\n");
    try {
      verify::read_proof(text, "p.proof");
      ADD_FAILURE() << "'" << step << "' was taken";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::BadFormat);
      EXPECT_NE(std::string(error.what()).find("p.proof line 4"), std::string::npos) << error.what();
    }
  }
}

// The least of all labellings.
Cost enumerated(std::size_t variables, const std::vector<Factor>& factors) {
  Cost least{};
  for (std::size_t labels = 0; labels < std::size_t{1} << variables; ++labels) {
    Cost sum{};
    for (const Factor& factor : factors) {
      std::size_t index = 0;
      for (std::size_t i = 0; i < factor.scope.size(); ++i) index |= (labels >> factor.scope[i] & 1U) << i;
      for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += factor.table[index][k];
    }
    if (labels == 0 || sum < least) least = sum;
  }
  return least;
}

TEST(Minimise, IsTheLeastOfAllLabellings) {
  test::Random random;
  SCOPED_TRACE(random.trace());
  for (int run = 0; run < 300; ++run) {
    const std::size_t variables = random.integer<std::size_t>(1, 10);
    std::vector<Factor> factors;
    for (int f = random.integer(1, 20); f > 0; --f) {
      Factor factor;
      for (Index q = 0; q < variables; ++q) {
        if (factor.scope.size() < 4 && random.integer(0, 3) == 0) factor.scope.push_back(q);
      }
      factor.table.resize(std::size_t{1} << factor.scope.size());
      for (Cost& cost : factor.table) {
        for (std::int64_t& component : cost) component = random.integer<std::int64_t>(-2, 2);
      }
      factors.push_back(factor);
    }
    Progress progress;
    const auto optimum = minimise(variables, factors, 10, progress);
    ASSERT_TRUE(optimum);
    EXPECT_EQ(optimum->cost, enumerated(variables, factors)) << "run " << run;
    Cost reached{};
    for (const Factor& factor : factors) {
      std::size_t index = 0;
      for (std::size_t i = 0; i < factor.scope.size(); ++i) {
        index |= static_cast<std::size_t>(optimum->labels[factor.scope[i]]) << i;
      }
      for (std::size_t k = 0; k < reached.size(); ++k) reached[k] += factor.table[index][k];
    }
    EXPECT_EQ(reached, optimum->cost) << "run " << run;
  }
}

TEST(Minimise, SaysWhenATableWouldBeTooWide) {
  std::vector<Factor> factors;
  for (Index a = 0; a < 5; ++a) {
    for (Index b = a + 1; b < 5; ++b) {
      factors.push_back({{a, b}, {Cost{0, 0}, Cost{0, 3}, Cost{0, 3}, Cost{0, 1}}});
    }
  }
  Progress progress;
  EXPECT_FALSE(minimise(5, factors, 2, progress));
}

}  // namespace
}  // namespace thalweg::verify
