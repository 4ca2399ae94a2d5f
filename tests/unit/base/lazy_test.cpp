#include <thalweg/base/lazy.hpp>

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <stdexcept>

namespace thalweg {
namespace {

TEST(Lazy, IsMadeOnceWhicheverThreadsAskAndCopiesShareIt) {
  const Lazy<int> value;
  const Lazy<int> copy = value;
  std::atomic<int> made{0};
  const auto make = [&] { return ++made; };
  tbb::parallel_for(0, 1000, [&](int i) { EXPECT_EQ((i % 2 == 0 ? value : copy).get(make), 1); });
  EXPECT_EQ(made, 1);
  EXPECT_EQ(&value.get(make), &copy.get(make));
}

TEST(Lazy, IsTriedAgainIfMakingFails) {
  const Lazy<int> value;
  EXPECT_THROW(value.get([]() -> int { throw std::runtime_error("no"); }), std::runtime_error);
  EXPECT_EQ(value.get([] { return 7; }), 7);
}

}  // namespace
}  // namespace thalweg
