// What discs through one vertex hold.
//
// 1. Inversion about u turns the open disc through u with its centre in direction c (a unit vector) and
//    diameter 1 / h into the half-plane x* c > h. For one c, those with at most k points have h at least the
//    (k + 1)th largest of the products x* c; a position f is inside one of them exactly if f* c is larger.
// 2. Directions are kept by lanes of 1/64 turn. On a lane between unit vectors c and d, a point's product is
//    at least the smaller of those with c and d, where that is positive (concavity along the arc), and at
//    most the larger one over the cosine of half a lane. Points with smaller products are left out: negative
//    ones never lie inside.
// 3. Where the fan around u is not closed (the rim, or edges at u that block), turns do not wrap: lanes run
//    from a right angle before its first direction to one behind its last, and a point enters those within a
//    right angle of its own turn.
// 4. Rounding: products of single-precision factors are off by less than 2^-21 of the product of lengths.
#include "order/disc_depth.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace thalweg::detail {

namespace {

constexpr int kLanes = 64;  // a turn
constexpr int kQuarter = kLanes / 4;
constexpr int kSide = kQuarter + 1;  // a right angle, and one for rounding
constexpr int kAll = kLanes + 2 * kSide + 6;
constexpr double kPi = 3.14159265358979323846;
constexpr double kLane = 2 * kPi / kLanes;
constexpr float kSlack = 0x1p-20F;

struct Directions {
  std::array<float, kAll + 1> x{}, y{};
};

const Directions& directions() {
  static const Directions made = [] {
    Directions all;
    for (int i = 0; i <= kAll; ++i) {
      all.x[static_cast<std::size_t>(i)] = static_cast<float>(std::cos((i - kSide) * kLane));
      all.y[static_cast<std::size_t>(i)] = static_cast<float>(std::sin((i - kSide) * kLane));
    }
    return all;
  }();
  return made;
}

int lane_of(double turn) {
  return static_cast<int>(std::floor(turn / kLane));
}

}  // namespace

void DiscDepth::reset(std::size_t depth, bool closed, double breadth) {
  depth_ = depth;
  closed_ = closed;
  lanes_ = closed ? kLanes : std::min(kAll, lane_of(breadth) + 2 * kSide + 2);
  nearest_.assign((depth + 1) * kAll, 0.0F);
}

// Visits the ranges [begin, end) of places that hold the lanes from first to last.
template <class Visit>
void DiscDepth::for_lanes(int first, int last, const Visit& visit) const {
  first += kSide;
  last += kSide;
  if (!closed_) {
    first = std::max(first, 0);
    last = std::min(last, lanes_ - 1);
    if (first <= last) visit(first, last + 1);
    return;
  }
  const int count = std::min(kLanes, last - first + 1);
  if (count <= 0) return;
  const int begin = ((first % kLanes) + kLanes) % kLanes;
  const int end = begin + count;
  visit(begin, std::min(end, kLanes));
  if (end > kLanes) visit(0, end - kLanes);
}

void DiscDepth::insert(const Inverted& point) {
  const auto x = static_cast<float>(point.x), y = static_cast<float>(point.y);
  const float slack = kSlack * (std::abs(x) + std::abs(y));
  const Directions& along = directions();
  const int middle = lane_of(point.turn);
  for_lanes(middle - kSide, middle + kSide, [&](int begin, int end) {
    std::array<float, kAll> product;  // NOLINT(cppcoreguidelines-pro-type-member-init): written before read
    const auto first = static_cast<std::size_t>(begin), count = static_cast<std::size_t>(end - begin);
    for (std::size_t i = 0; i < count; ++i) {
      const float here = x * along.x[first + i] + y * along.y[first + i];
      const float next = x * along.x[first + i + 1] + y * along.y[first + i + 1];
      product[i] = (here < next ? here : next) - slack;
    }
    for (std::size_t row = 0; row <= depth_; ++row) {
      float* nearest = nearest_.data() + row * kAll + first;
      for (std::size_t i = 0; i < count; ++i) {
        const float old = nearest[i], fresh = product[i];
        nearest[i] = std::max(old, fresh);
        product[i] = std::min(old, fresh);
      }
    }
  });
}

bool DiscDepth::reaches(const Inverted& position, std::size_t depth, double from, double to) const {
  const double wider = 1.001 / std::cos(kLane / 2);
  const auto x = static_cast<float>(position.x * wider), y = static_cast<float>(position.y * wider);
  const float slack = kSlack * (std::abs(x) + std::abs(y));
  const Directions& along = directions();
  const int middle = lane_of(position.turn);
  bool any = false;
  for_lanes(std::max(middle, lane_of(from)) - kSide, std::min(middle, lane_of(to)) + kSide,
            [&](int begin, int end) {
              const float* nearest = nearest_.data() + depth * kAll;
              int open = 0;
              for (int i = begin; i < end; ++i) {
                const auto at = static_cast<std::size_t>(i);
                const float here = x * along.x[at] + y * along.y[at];
                const float next = x * along.x[at + 1] + y * along.y[at + 1];
                open |= (here > next ? here : next) + slack <= nearest[at] ? 0 : 1;
              }
              any = any || open != 0;
            });
  return any;
}

}  // namespace thalweg::detail
