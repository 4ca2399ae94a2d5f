#pragma once

#include <cstdint>

namespace thalweg {

/// A number that looks random, another one for each argument: splitmix64. Source: Steele, Lea, Flood, Fast
/// splittable pseudorandom number generators, 2014.
constexpr std::uint64_t splitmix64(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31U);
}

}  // namespace thalweg
