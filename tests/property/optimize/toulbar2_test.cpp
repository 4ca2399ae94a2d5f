// An independent solver on the problems that dump_problem writes. Needs toulbar2 on the PATH; skipped without
// it.
#include "support/random.hpp"

#include <thalweg/delaunay/triangulate.hpp>
#include <thalweg/optimize/optimize.hpp>
#include <thalweg/order/quadrilaterals.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <string>

namespace thalweg::test {
namespace {

std::string output_of(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string output;
  std::array<char, 4096> buffer{};
  while (pipe && fgets(buffer.data(), buffer.size(), pipe.get()) != nullptr) output += buffer.data();
  return output;
}

class Toulbar2 : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_FALSE(output_of("command -v toulbar2").empty())
        << "toulbar2 is not installed: tools/dev/packages check does it";
    path_ =
        std::filesystem::temp_directory_path() /
        ("thalweg_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + ".cfn");
  }
  void TearDown() override { std::filesystem::remove(path_); }

  /// A surface with many ties; heights are whole numbers below `levels`.
  void make_surface(std::size_t side, int levels, bool lattice) {
    std::set<Point2> places;
    while (places.size() < side * side) {
      const std::size_t i = places.size();
      places.insert(lattice ? Point2{static_cast<double>(i % side), static_cast<double>(i / side)}
                            : Point2{random_.real(0, 100), random_.real(0, 100)});
    }
    std::vector<double> heights;
    for (std::size_t i = 0; i < places.size(); ++i) heights.push_back(random_.integer(0, levels - 1));
    tin_ = triangulate({places.begin(), places.end()}, heights, {}, progress_);
    quadrilaterals_ = find_quadrilaterals(tin_, {}, progress_);
  }

  /// The optimum that toulbar2 proves; -1 if it does not.
  double prove(const OptimizeOptions& options) {
    {
      std::ofstream file(path_);
      dump_problem(file, tin_, quadrilaterals_, options, progress_);
    }
    const std::string output = output_of("toulbar2 '" + path_.string() + "' 2>&1");
    const std::size_t at = output.find("Optimum: ");
    return at == std::string::npos ? -1 : std::stod(output.substr(at + 9));
  }

  void expect_same(const OptimizeOptions& options, std::size_t sum) {
    const OptimizeResult result = optimize_first_order(tin_, quadrilaterals_, options, progress_);
    EXPECT_TRUE(result.criteria[sum].optimal);
    const double sign = result.criteria[sum].direction == "max" ? -1 : 1;
    EXPECT_EQ(sign * result.criteria[sum].result * 0x1p32, prove(options));
  }

  Random random_;
  Progress progress_;
  std::filesystem::path path_;
  Tin tin_;
  std::vector<Quadrilateral> quadrilaterals_;
};

TEST_F(Toulbar2, AgreesOnSmoothness) {
  SCOPED_TRACE(random_.trace());
  for (const bool lattice : {true, false}) {
    make_surface(30, 1000, lattice);
    expect_same({.criteria = {Criterion::NormalAngleSum}}, 0);
  }
}

TEST_F(Toulbar2, AgreesOnEverySum) {
  SCOPED_TRACE(random_.trace());
  for (const bool lattice : {true, false}) {
    make_surface(15, 1000, lattice);
    for (const CriterionTraits& traits : all_criteria()) {
      const Objective objective = traits.criterion;
      if (objective.is_extreme() || objective.is_of_pits() || objective.needs_reference()) {
        continue;
      }
      SCOPED_TRACE(traits.name);
      expect_same({.criteria = {objective}}, 0);
    }
  }
}

TEST_F(Toulbar2, AgreesOnSmoothnessWithFewestPits) {
  SCOPED_TRACE(random_.trace());
  for (const bool lattice : {true, false}) {
    for (const int levels : {3, 6, 1000}) {
      make_surface(lattice ? 20 : 26, levels, lattice);
      expect_same({}, 1);
      expect_same({.criteria = {Criterion::PitDepth, Criterion::NormalAngleSum}}, 1);
    }
  }
}

TEST_F(Toulbar2, AgreesOnFlips) {
  SCOPED_TRACE(random_.trace());
  for (const int levels : {3, 6}) {
    make_surface(15, levels, true);
    const OptimizeOptions pits = {.criteria = {Criterion::LocalMinima}};
    const OptimizeResult result = optimize_first_order(tin_, quadrilaterals_, pits, progress_);
    EXPECT_EQ(static_cast<double>(std::count(result.flipped.begin(), result.flipped.end(), 1)), prove(pits));
  }
}

}  // namespace
}  // namespace thalweg::test
