#pragma once

/// Lakes as they were drawn: what is in them, looked up ring by ring.

#include <thalweg/verify/sources.hpp>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace thalweg::verify {

class PlainLakes {
 public:
  /// Positions at most `reach` from a ring are in the lake, too.
  PlainLakes(std::span<const SourceLine> lines, double reach);
  [[nodiscard]] bool any() const { return !lakes_.empty(); }
  [[nodiscard]] bool hold(Point2 p) const;
  /// Whether all vertices in each lake have one height.
  [[nodiscard]] Finding check_flat(const Subject& subject) const;

 private:
  struct Lake {
    std::string name;
    Box2 box;
    std::vector<const SourceLine*> rings;
  };
  [[nodiscard]] bool holds(const Lake& lake, Point2 p) const;

  double reach_;
  std::vector<Lake> lakes_;
};

}  // namespace thalweg::verify
