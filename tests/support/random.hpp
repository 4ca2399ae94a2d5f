#pragma once

/// Random numbers of a test: the seed is made from the test's full name, or taken from THALWEG_SEED.

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <random>
#include <string>

namespace thalweg::test {

/// A generator for the running test; declare `SCOPED_TRACE(random.trace())` to print the seed on failure.
class Random {
 public:
  Random() : seed_(make_seed()), engine_(seed_) {}
  [[nodiscard]] std::string trace() const { return "THALWEG_SEED=" + std::to_string(seed_); }

  /// A whole number in [low, high].
  template <class Integer>
  Integer integer(Integer low, Integer high) {
    return low + static_cast<Integer>(engine_() % (static_cast<std::uint64_t>(high - low) + 1));
  }
  /// A number in [low, high), one of 2^53 evenly spaced.
  double real(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
  }
  std::mt19937_64& engine() { return engine_; }

 private:
  static std::uint64_t make_seed() {
    if (const char* given = std::getenv("THALWEG_SEED")) return std::strtoull(given, nullptr, 10);
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    std::uint64_t hash = 0xcbf29ce484222325U;  // FNV-1a
    for (const char c : std::string(test->test_suite_name()) + "." + test->name()) {
      hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
    }
    return hash;
  }

  std::uint64_t seed_;
  std::mt19937_64 engine_;
};

}  // namespace thalweg::test
