#include "optimize/face.hpp"
#include "support/meshes.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace thalweg::test {
namespace {

TEST(NormalAngle, AgreesWithTheMathematicalLibrary) {
  Random random;
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < 200000; ++i) {
    const double x = random.real(-1, 1), y = random.real(0, 1) * std::pow(10, random.real(-12, 0));
    ASSERT_NEAR(angle_of(x, y), std::atan2(y, x), 5e-16) << x << " " << y;
  }
}

TEST(NormalAngle, HasExactEnds) {
  EXPECT_EQ(angle_of(1, 0), 0);
  EXPECT_EQ(angle_of(0, 1), std::numbers::pi / 2);
  EXPECT_EQ(angle_of(-1, 0), std::numbers::pi);
  EXPECT_EQ(angle_of(2, 2), std::numbers::pi / 4);
}

TEST(NormalAngle, IsSymmetricAndSurvivesExtremes) {
  Random random;
  SCOPED_TRACE(random.trace());
  for (int i = 0; i < 2000; ++i) {
    const auto vector = [&] {
      const double size = std::pow(10, random.real(-150, 150));
      return Vector3{size * random.real(-1, 1), size * random.real(-1, 1), size * random.real(0.1, 1)};
    };
    const Vector3 m = vector(), n = vector();
    ASSERT_EQ(angle_between(m, n), angle_between(n, m));
    ASSERT_NEAR(angle_between(m, n), angle_between(scaled_to_unit(m), scaled_to_unit(n)), 1e-15);
    ASSERT_EQ(angle_between(m, m), 0);
  }
}

TEST(NormalAngle, NormalDependsOnTheTriangleAlone) {
  const Corner a{{0.1, 0.7}, 0.3}, b{{3.3, -1.9}, 1.7}, c{{2.7, 4.1}, -2.2};
  const Vector3 n = make_face(a, b, c, {2, 0.5}).normal;
  for (const Face& face : {make_face(b, c, a, {2, 0.5}), make_face(c, a, b, {2, 0.5})}) {
    EXPECT_TRUE(face.normal.x == n.x && face.normal.y == n.y && face.normal.z == n.z);
    EXPECT_EQ(face.corner[0], a);
  }
  EXPECT_GT(n.z, 0);
}

}  // namespace
}  // namespace thalweg::test
