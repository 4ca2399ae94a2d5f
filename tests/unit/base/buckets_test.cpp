#include "base/buckets.hpp"

#include <gtest/gtest.h>

namespace thalweg {
namespace {

TEST(BucketOfCoordinate, Ascends) {
  const BucketOfCoordinate bucket_of(-1, 3, 5);
  EXPECT_EQ(bucket_of(-1), 0U);
  EXPECT_EQ(bucket_of(0.5), 1U);
  EXPECT_EQ(bucket_of(3), 4U);
}

TEST(BucketOfCoordinate, IsTheFirstWithoutAScale) {
  EXPECT_EQ(BucketOfCoordinate(2, 2, 5)(2), 0U);
  const BucketOfCoordinate denormal(0, 5e-324, 5);
  EXPECT_EQ(denormal(0), 0U);
  EXPECT_EQ(denormal(5e-324), 0U);
}

}  // namespace
}  // namespace thalweg
