// Whether a gap of the view from a vertex is worth following: steps 2 to 4 of fan_search.cpp.
#include "order/fan_search.hpp"

#include <algorithm>

namespace thalweg::detail {

namespace {

constexpr double kReach = 1.1548;  // above 1 / sin 60
constexpr double kAngleSlack = 1e-11;
constexpr double kPi = 3.14159265358979323846;
// What the largest angle of a triangle has at least, less what rounding may take off it.
constexpr double kLeastAngle = kPi / 3 - 1e-6;
// Near the hull only vertices far along a narrow gap tell that it is hopeless, so many count; the limit keeps
// a vertex that sees thousands from a cost that is quadratic in them.
constexpr std::size_t kMostCounted = 1024;
// From 90 degrees down to 3.
constexpr int kHalvings = 5;

}  // namespace

bool FanSearch::certain(const Range& range, const Seen& seen) const {
  if (pruning_ == FanPruning::Visible) {
    return narrow_ || (seen.turn > range.left_turn - kPi && seen.turn < range.right_turn + kPi);
  }
  const double from_right = turn_between(range.right, seen.angle);
  const double to_left = turn_between(seen.angle, range.left);
  const double breadth = turn_between(range.right, range.left);
  if (from_right <= breadth)
    return kReach * seen.distance <= range.horizon && clear(range.right, breadth, seen);
  if (from_right < 2) {
    const double sector = range.role == Role::Right ? turn_between(range.right, range.sector_end) : 0;
    if (range.role == Role::Right && from_right <= sector) return true;
    return kReach * seen.distance <= range.horizon &&
           clear(normal(range.right + sector), from_right - sector, seen);
  }
  if (to_left < 2) {
    const double sector = range.role == Role::Left ? turn_between(range.sector_end, range.left) : 0;
    if (range.role == Role::Left && to_left <= sector) return true;
    return kReach * seen.distance <= range.horizon && clear(seen.angle, to_left - sector, seen);
  }
  return false;
}

// Whether no stop that may hide a vertex seen lies from one direction on as far as `turn`.
bool FanSearch::clear(double from, double turn, const Seen& seen) const {
  const double reach = kReach * seen.distance;
  if (reach < nearest_stop_) return true;
  from = normal(from - kAngleSlack);
  const double breadth = turn + 2 * kAngleSlack;
  const auto first = static_cast<std::size_t>(from * kSectorsAUnit) % kSectors;
  const auto last = static_cast<std::size_t>(normal(from + breadth) * kSectorsAUnit) % kSectors;
  const bool unclear = sectors_[first] <= reach || sectors_[last] <= reach;
  if (first != last) {
    for (std::size_t i = (first + 1) % kSectors; i != last; i = (i + 1) % kSectors) {
      if (sectors_[i] <= reach) return false;
    }
  }
  if (!unclear) return true;
  return std::none_of(stops_.begin(), stops_.end(), [&](const Stop& stop) {
    return stop.distance <= reach && (!stop.vertex.valid() || stop.vertex != seen.vertex) &&
           turn_between(from, stop.angle) <= breadth;
  });
}

FanSearch::Probe FanSearch::probe(const Range& range, Direction c) {
  return {c, std::max(dot(range.right_at, c), dot(range.left_at, c)) + range.slack};
}

bool FanSearch::deep_at(const Range& range, Direction c) const {
  const Probe at = probe(range, c);
  std::size_t depth = 0;
  for (std::size_t i = 0; i < std::min(kMostCounted, seen_.size()); ++i) {
    if (at.covered_by(seen_[i]) && certain(range, seen_[i]) && ++depth > k_) return true;
  }
  return false;
}

// Whether more than k of the active vertices cover all directions between, where that is not so.
bool FanSearch::deep_between(const Range& range, const Probe& from, const Probe& to, int halvings,
                             Direction& open) const {
  const Direction sum{from.c.x + to.c.x, from.c.y + to.c.y};
  const Probe middle = probe(range, scaled(sum, 1 / length(sum)));
  std::size_t depth = 0, right_depth = 0, left_depth = 0;
  for (const std::uint32_t i : active_) {
    if (!middle.covered_by(seen_[i])) continue;
    ++depth;
    right_depth += from.covered_by(seen_[i]) ? 1 : 0;
    left_depth += to.covered_by(seen_[i]) ? 1 : 0;
    if (right_depth > k_ && left_depth > k_) return true;
  }
  if (depth <= k_ || halvings == 0) {
    open = middle.c;
    return false;
  }
  return (right_depth > k_ || deep_between(range, from, middle, halvings - 1, open)) &&
         (left_depth > k_ || deep_between(range, middle, to, halvings - 1, open));
}

// The vertices that certainly count and cover any of the range's chief directions; false if some of these
// are covered by k or fewer.
bool FanSearch::activate(const Range& range, const std::array<Probe, 4>& chief, Direction& open) {
  active_.clear();
  std::array<std::size_t, 4> depth{};
  for (std::size_t i = 0; i < std::min(kMostCounted, seen_.size()); ++i) {
    std::array<bool, 4> covered{};
    for (std::size_t j = 0; j < 4; ++j) covered[j] = chief[j].covered_by(seen_[i]);
    if (!(covered[0] || covered[1] || covered[2] || covered[3]) || !certain(range, seen_[i])) continue;
    for (std::size_t j = 0; j < 4; ++j) depth[j] += covered[j] ? 1 : 0;
    active_.push_back(static_cast<std::uint32_t>(i));
  }
  for (std::size_t j = 0; j < 4; ++j) {
    if (depth[j] > k_) continue;
    open = chief[j].c;
    return false;
  }
  return true;
}

bool FanSearch::hopeless(const Range& range, std::array<Direction, 2>& open) {
  if (pruning_ == FanPruning::None || seen_.size() <= k_) return false;
  if (pruning_ == FanPruning::Visible) return hopeless_as(Role::Any, range, open[0]);
  return hopeless_as(Role::Right, range, open[0]) && hopeless_as(Role::Left, range, open[1]);
}

bool FanSearch::hopeless_as(Role role, Range range, Direction& open) {
  range.slack = kCoverSlack * std::max(length(range.right_at), length(range.left_at));
  range.role = role;
  Direction from{range.to_right.y, -range.to_right.x};
  Direction to{-range.to_left.y, range.to_left.x};
  if (role == Role::Right) {
    if (beside_blocks_ && breadth_ - range.right_turn < kLeastAngle) return true;
    const Direction end = turned(range.to_right, kLeastAngle);
    range.sector_end = diamond_angle(end.x, end.y);
    from = turned(range.to_right, kLeastAngle - kPi / 2);
  } else if (role == Role::Left) {
    if (beside_blocks_ && range.left_turn < kLeastAngle) return true;
    const Direction end = turned(range.to_left, -kLeastAngle);
    range.sector_end = diamond_angle(end.x, end.y);
    to = turned(range.to_left, kPi / 2 - kLeastAngle);
  }
  if (open != Direction{} && (dot(open, range.to_right) > 0 || dot(open, range.to_left) > 0) &&
      !deep_at(range, open)) {
    return false;
  }
  const Probe first = probe(range, from), last = probe(range, to);
  const Probe right = probe(range, range.to_right), left = probe(range, range.to_left);
  if (!activate(range, {first, right, left, last}, open)) return false;
  return deep_between(range, first, right, kHalvings, open) &&
         (range.right_turn == range.left_turn || deep_between(range, right, left, kHalvings, open)) &&
         deep_between(range, left, last, kHalvings, open);
}

}  // namespace thalweg::detail
