#pragma once

/// Changed copies of inputs, by a generator that is the same everywhere.

#include <cstdint>
#include <random>
#include <span>
#include <string>

namespace thalweg::fuzz {

class Mutants {
 public:
  Mutants(std::span<const std::string> inputs, std::uint64_t seed) : inputs_(inputs), engine_(seed) {}

  /// One of the inputs after a few changes: bytes and bits, pieces left out, doubled, or taken from another
  /// input, numbers in text that hurt.
  std::string next();

 private:
  std::size_t below(std::size_t bound) { return bound == 0 ? 0 : engine_() % bound; }
  void change(std::string& bytes);

  std::span<const std::string> inputs_;
  std::mt19937_64 engine_;
};

}  // namespace thalweg::fuzz
