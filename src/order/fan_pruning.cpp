// Whether a gap of the view from a vertex is worth following: steps 2 to 4 of fan_search.cpp.
#include "order/fan_search.hpp"

#include <algorithm>

namespace thalweg::detail {

namespace {

constexpr double kReach = 1.1548;  // above 1 / sin 60
constexpr double kPi = 3.14159265358979323846;
constexpr double kTurnSlack = 1e-9;
// What the largest angle of a triangle has at least, less what rounding may take off it.
constexpr double kLeastAngle = kPi / 3 - 1e-6;
// Near the hull only vertices far along a narrow gap tell that it is hopeless, so many count; the limit keeps
// a vertex that sees thousands from a cost that is quadratic in them.
constexpr std::size_t kMostCounted = 1024;
// From 90 degrees down to 3.
constexpr int kHalvings = 5;

}  // namespace

// Those that count for triangles with the range (2a, 2b).
void FanSearch::list_certain(const Range& range) {
  active_.clear();
  if (pruning_ == FanPruning::NearEnds) {
    list_certain_beside(range, Role::Right);
    list_certain_beside(range, Role::Left);
    return;
  }
  for (std::uint32_t i = 0; i < std::min(kMostCounted, seen_.size()); ++i) {
    const double turn = seen_[i].turn;
    if (narrow_ || (turn > range.left_turn - kPi && turn < range.right_turn + kPi)) active_.push_back(i);
  }
}

// Goes from the range, which is to the right or the left of what follows, round to what lies farther, with
// the nearest stop so far.
void FanSearch::list_certain_beside(const Range& range, Role of) {
  const bool leftwards = of == Role::Right;
  const double free = range.role == of ? kLeastAngle : -1;
  const bool point = range.right == range.left;
  const std::uint32_t start = leftwards ? range.left : range.right;
  const double least_reach = kReach * scale_;
  double nearest = FanTypes::kNoStop;
  if (point) nearest = std::min(seen_[start].stop, seen_[start].stop_behind);
  if (range.role == of) nearest = FanTypes::kNoStop;
  std::uint32_t i = start;
  bool first = !point;
  for (std::size_t steps = 0; steps < kMostCounted; ++steps) {
    double stop_between = FanTypes::kNoStop;
    if (!first) {
      if (!closed_ && (leftwards ? seen_[i].next : i) == 0) return;
      if (leftwards) stop_between = seen_[i].stop_after;
      i = leftwards ? seen_[i].next : seen_[i].previous;
      if (!leftwards) stop_between = seen_[i].stop_after;
      if (i == start) return;
    }
    first = false;
    const Seen& seen = seen_[i];
    double turn = leftwards ? seen.turn - range.right_turn : range.left_turn - seen.turn;
    if (turn < -kTurnSlack) turn += 2 * kPi;
    if (turn >= kPi - kTurnSlack) return;
    if (turn <= free) {
      active_.push_back(i);
      continue;
    }
    nearest = std::min({nearest, stop_between, seen.stop_behind});
    if (nearest <= least_reach) return;
    const double reach = kReach * seen.distance;
    if (reach < nearest && reach <= range.horizon) active_.push_back(i);
    nearest = std::min(nearest, seen.stop);
  }
}

FanSearch::Probe FanSearch::probe(const Range& range, Direction c) {
  return {c, std::max(dot(range.right_at, c), dot(range.left_at, c)) + range.slack};
}

bool FanSearch::deep_at(const Range& range, Direction c) const {
  const Probe at = probe(range, c);
  std::size_t depth = 0;
  for (const std::uint32_t i : active_) {
    if (at.covered_by(seen_[i]) && ++depth > k_) return true;
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

// Keeps those active that cover any of the range's chief directions; false if some of these are covered by k
// or fewer.
bool FanSearch::keep_covering(const std::array<Probe, 4>& chief, Direction& open) {
  std::array<std::size_t, 4> depth{};
  std::size_t kept = 0;
  for (const std::uint32_t i : active_) {
    std::array<bool, 4> covered{};
    for (std::size_t j = 0; j < 4; ++j) covered[j] = chief[j].covered_by(seen_[i]);
    if (!(covered[0] || covered[1] || covered[2] || covered[3])) continue;
    for (std::size_t j = 0; j < 4; ++j) depth[j] += covered[j] ? 1 : 0;
    active_[kept++] = i;
  }
  active_.resize(kept);
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
    if (!closed_ && breadth_ - range.right_turn < kLeastAngle) return true;
    from = turned(range.to_right, kLeastAngle - kPi / 2);
  } else if (role == Role::Left) {
    if (!closed_ && range.left_turn < kLeastAngle) return true;
    to = turned(range.to_left, kPi / 2 - kLeastAngle);
  }
  list_certain(range);
  if (active_.size() <= k_) {
    open = {};
    return false;
  }
  if (open != Direction{} && (dot(open, range.to_right) > 0 || dot(open, range.to_left) > 0) &&
      !deep_at(range, open)) {
    return false;
  }
  const Probe first = probe(range, from), last = probe(range, to);
  const Probe right = probe(range, range.to_right), left = probe(range, range.to_left);
  if (!keep_covering({first, right, left, last}, open)) return false;
  return deep_between(range, first, right, kHalvings, open) &&
         (range.right_turn == range.left_turn || deep_between(range, right, left, kHalvings, open)) &&
         deep_between(range, left, last, kHalvings, open);
}

}  // namespace thalweg::detail
