#pragma once

/// Things that arbitrary bytes are thrown at. libFuzzer runs one of them a program; a test runs all of them
/// on the corpus and on a fixed number of mutants.

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace thalweg::fuzz {

/// A law that was broken. An Error of the library is an answer, unless its code is Internal.
class Finding : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

struct Target {
  std::string_view name;
  /// Throws: Finding; whatever else escapes is one as well.
  void (*run)(std::string_view bytes);
  /// Inputs to start with.
  std::vector<std::string> (*seeds)();
};

/// terrain: noding, both triangulations, orders, optimisation of a small survey; mesh: a TIN file, optimised
/// again; points, lines: sources in files; report, proof: what `verify` reads.
std::span<const Target> targets();
/// Throws: std::invalid_argument if there is none of that name.
const Target& find_target(std::string_view name);

}  // namespace thalweg::fuzz
