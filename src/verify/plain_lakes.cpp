// Inside by the number of pieces to the right; on the shore by the distance to a piece.
#include "verify/plain_lakes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace thalweg::verify {

PlainLakes::PlainLakes(std::span<const SourceLine> lines, double reach) : reach_(reach) {
  for (const SourceLine& line : lines) {
    if (!has(line.kind, EdgeKind::Lake)) continue;
    auto lake = std::ranges::find(lakes_, line.feature, &Lake::name);
    if (lake == lakes_.end()) lake = lakes_.insert(lake, {line.feature, {}, {}});
    lake->rings.push_back(&line);
    for (const Point2 p : line.xy) {
      lake->box.add({p.x - reach, p.y - reach});
      lake->box.add({p.x + reach, p.y + reach});
    }
  }
}

bool PlainLakes::holds(const Lake& lake, Point2 p) const {
  if (!lake.box.contains(p)) return false;
  bool inside = false;
  for (const SourceLine* ring : lake.rings) {
    for (std::size_t i = 0; i + 1 < ring->xy.size(); ++i) {
      const Point2 a = ring->xy[i], b = ring->xy[i + 1];
      const double x = b.x - a.x, y = b.y - a.y;
      const double along = ((p.x - a.x) * x + (p.y - a.y) * y) / (x * x + y * y);
      const double t = x * x + y * y > 0 ? std::clamp(along, 0.0, 1.0) : 0;
      if (std::hypot(a.x + t * x - p.x, a.y + t * y - p.y) <= reach_) return true;
      if ((a.y > p.y) == (b.y > p.y)) continue;
      using Extended = long double;
      const Extended crossing = a.x + (Extended{p.y} - a.y) / (Extended{b.y} - a.y) * (Extended{b.x} - a.x);
      if (crossing > p.x) inside = !inside;
    }
  }
  return inside;
}

bool PlainLakes::hold(Point2 p) const {
  return std::ranges::any_of(lakes_, [&](const Lake& lake) { return holds(lake, p); });
}

Finding PlainLakes::check_flat(const Subject& subject) const {
  std::size_t count = 0;
  for (const Lake& lake : lakes_) {
    std::size_t first = subject.points.size();
    for (std::size_t v = 0; v < subject.points.size(); ++v) {
      if (!holds(lake, subject.points[v])) continue;
      ++count;
      if (first == subject.points.size()) first = v;
      if (subject.heights[v] == subject.heights[first]) continue;
      return {"lakes are flat", Verdict::Broken,
              fmt::format("{}: vertex {} has height {}, vertex {} has {}", lake.name, first,
                          subject.heights[first], v, subject.heights[v])};
    }
  }
  return {"lakes are flat", Verdict::Holds, fmt::format("{} lakes, {} vertices", lakes_.size(), count)};
}

}  // namespace thalweg::verify
