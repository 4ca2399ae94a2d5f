// A segment with both ends outside meets the open disc if the centre projects into the open segment and is
// nearer to its line than the radius. Both are signs of polynomials in the coordinates relative to a (see
// geometry/predicates.cpp, which decides exactly); here they are estimated in doubles first.
//
// Error bound: a value that is built by at most n roundings along any path of its expression, from exact
// inputs, differs from the exact one by at most n eps / (1 - n eps) times the same expression of magnitudes
// (Higham, Accuracy and Stability of Numerical Algorithms, 2002, section 3.1), eps = 2^-53. The longest path,
// to the clearance, has 24 roundings, and the magnitudes are themselves low by as many: 64 eps is safe.
#include "order/circumdisc.hpp"

namespace thalweg::detail {

namespace {

Estimate operator+(Estimate a, Estimate b) {
  return {a.value + b.value, a.magnitude + b.magnitude};
}
Estimate operator-(Estimate a, Estimate b) {
  return {a.value - b.value, a.magnitude + b.magnitude};
}
Estimate operator*(Estimate a, Estimate b) {
  return {a.value * b.value, a.magnitude * b.magnitude};
}

Estimate difference(double a, double b) {
  return {a - b, std::abs(a - b)};
}

double error(Estimate e) {
  constexpr double kRelativeError = 64 * 0x1p-53;
  return kRelativeError * e.magnitude;
}

// 0 means undecided, also where products underflow or overflow.
int sign(Estimate e) {
  constexpr double kNoUnderflow = 1e-200;
  if (e.magnitude > kNoUnderflow) {
    if (e.value > error(e)) return 1;
    if (-e.value > error(e)) return -1;
  }
  return 0;
}

}  // namespace

Circumdisc::Circumdisc(Point2 a, Point2 b, Point2 c) : a_(a), b_(b), c_(c) {
  const Estimate bx = difference(b.x, a.x), by = difference(b.y, a.y);
  const Estimate cx = difference(c.x, a.x), cy = difference(c.y, a.y);
  const Estimate b_lift = bx * bx + by * by;
  const Estimate c_lift = cx * cx + cy * cy;
  twice_area_ = Estimate{2, 2} * (bx * cy - by * cx);
  u_ = cy * b_lift - by * c_lift;
  v_ = bx * c_lift - cx * b_lift;
  radius_ = u_ * u_ + v_ * v_;
}

bool Circumdisc::passes(Point2 p, Point2 q) const {
  const Estimate px = difference(p.x, a_.x), py = difference(p.y, a_.y);
  const Estimate dx = difference(q.x, p.x), dy = difference(q.y, p.y);
  const Estimate to_centre_x = u_ - twice_area_ * px, to_centre_y = v_ - twice_area_ * py;
  const Estimate along = to_centre_x * dx + to_centre_y * dy;
  const int starts_before = sign(along);
  if (starts_before < 0) return false;
  const Estimate length_squared = dx * dx + dy * dy;
  const int ends_behind = sign(twice_area_ * length_squared - along);
  if (ends_behind < 0) return false;
  const Estimate across = dx * to_centre_y - dy * to_centre_x;
  const int near = sign(radius_ * length_squared - across * across);
  if (near < 0) return false;
  if (starts_before > 0 && ends_behind > 0 && near > 0) return true;
  return segment_meets_open_disc(a_, b_, c_, p, q);
}

// The divisions and the root add roundings that doubled errors cover.
Box2 Circumdisc::box() const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double denominator = twice_area_.value - 2 * error(twice_area_);
  const double reach_x = std::abs(u_.value) + 2 * error(u_);
  const double reach_y = std::abs(v_.value) + 2 * error(v_);
  if (!(denominator > twice_area_.value / 2) || sign(twice_area_) <= 0 || !std::isfinite(radius_.magnitude)) {
    return {-kInfinity, -kInfinity, kInfinity, kInfinity};
  }
  const double slack = 2 * (2 * error(twice_area_) / denominator + 64 * 0x1p-53);
  const double x = a_.x + u_.value / twice_area_.value;
  const double y = a_.y + v_.value / twice_area_.value;
  const double radius = std::sqrt(radius_.value + 2 * error(radius_)) / denominator;
  const double margin_x = radius + (reach_x * slack + 4 * error(u_)) / denominator + std::abs(x) * 0x1p-50;
  const double margin_y = radius + (reach_y * slack + 4 * error(v_)) / denominator + std::abs(y) * 0x1p-50;
  return {x - margin_x, y - margin_y, x + margin_x, y + margin_y};
}

}  // namespace thalweg::detail
