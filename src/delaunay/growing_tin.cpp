// Greedy insertion.
//
// Based on: Garland, Heckbert, Fast polygonal approximation of terrains and height fields, 1995, for the
// queue of triangles by their worst points; the constrained cavity is as in incremental.cpp.
//
// 1. Each cell has the list of vertices that wait in it, and knows the worst. A heap holds the worst of each
//    cell; an entry whose cell has changed since is skipped when it comes up.
// 2. The cavity of a vertex: the cells whose circles hold it, reached without crossing a constraint edge or
//    the outline. It is star-shaped about the vertex: across a side that the vertex sees lies a cell whose
//    circle holds the vertex, so the vertex sees its third corner through that side. A vertex on the outline
//    opens the fan of its new cells.
// 3. The waiting vertices of the cavity are dealt to the new cells by a walk around the fan: neighbours in
// the
//    list are neighbours in the plane, so the walk is short.
// 4. Errors are those of rounded planes. Only those near the limit are compared exactly at once; when none is
//    left beyond it, all are compared exactly, so the bound holds without rounding (needles can round badly).
#include "growing_tin.hpp"

#include <thalweg/base/assert.hpp>
#include <thalweg/geometry/vertical_distance.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace thalweg::detail {

GrowingTin::GrowingTin(std::span<const Point2> xy, std::span<const double> z, double limit)
    : xy_(xy), z_(z), limit_(limit), next_(xy.size(), kNoSide), cell_(xy.size(), kNoSide) {
  double highest = 0;
  for (const double height : z) highest = std::max(highest, std::abs(height));
  slack_ = 1e-6 * limit + 1e-9 * highest;
}

void GrowingTin::start(const Tin& tin, std::span<const std::uint32_t> ids) {
  // Side i of a cell lies opposite to corner i: it is the halfedge from the corner after.
  const auto side_at = [](HalfedgeId h) {
    return side_of(static_cast<std::uint32_t>(h.index() / 3),
                   before(static_cast<std::uint32_t>(h.index() % 3)));
  };
  cells_.resize(tin.triangle_count());
  for (std::size_t i = 0; i < tin.halfedge_count(); ++i) {
    const HalfedgeId h{i};
    Cell& cell = cells_[i / 3];
    cell.vertex[i % 3] = ids[tin.origin(h).index()];
    const std::uint32_t corner = corner_of(side_at(h));
    cell.neighbour[corner] = tin.on_rim(h) ? kNoSide : side_at(tin.twin(h));
    if (tin.constrained(h)) cell.constrained |= 1U << corner;
  }
  first_.assign(cells_.size(), kNoSide);
  worst_error_.assign(cells_.size(), 0);
  worst_vertex_.assign(cells_.size(), kNoSide);
}

GrowingTin::Plane GrowingTin::plane_of(const Cell& cell) const {
  std::uint32_t first = 0;
  for (std::uint32_t i = 1; i < 3; ++i) {
    if (xy_[cell.vertex[i]] < xy_[cell.vertex[first]]) first = i;
  }
  const std::uint32_t a = cell.vertex[first];
  const std::uint32_t b = cell.vertex[after(first)];
  const std::uint32_t c = cell.vertex[before(first)];
  const double bx = xy_[b].x - xy_[a].x, by = xy_[b].y - xy_[a].y, bz = z_[b] - z_[a];
  const double cx = xy_[c].x - xy_[a].x, cy = xy_[c].y - xy_[a].y, cz = z_[c] - z_[a];
  const double area = bx * cy - by * cx;
  return {xy_[a], z_[a], (bz * cy - by * cz) / area, (bx * cz - bz * cx) / area};
}

bool GrowingTin::within_limit(std::uint32_t v, const Cell& cell) const {
  const auto [a, b, c] = cell.vertex;
  return within_of_plane(xy_[a], xy_[b], xy_[c], xy_[v], {z_[a], z_[b], z_[c], z_[v]}, limit_);
}

double GrowingTin::error_of(std::uint32_t v, const Plane& plane, const Cell& cell) const {
  const double error = std::abs(z_[v] - plane.height(xy_[v]));
  if (std::abs(error - limit_) > slack_) return error;
  if (within_limit(v, cell)) return std::min(error, limit_);
  return std::max(error, std::nextafter(limit_, std::numeric_limits<double>::infinity()));
}

void GrowingTin::add_waiting(std::uint32_t v, std::uint32_t cell, double error) {
  next_[v] = first_[cell];
  first_[cell] = v;
  cell_[v] = cell;
  if (worst_vertex_[cell] == kNoSide || higher(error, v, worst_error_[cell], worst_vertex_[cell])) {
    worst_error_[cell] = error;
    worst_vertex_[cell] = v;
  }
}

void GrowingTin::forget_waiting(std::uint32_t cell) {
  first_[cell] = kNoSide;
  worst_error_[cell] = 0;
  worst_vertex_[cell] = kNoSide;
}

void GrowingTin::wait(std::uint32_t v, std::uint32_t cell) {
  next_[v] = first_[cell];
  first_[cell] = v;
  cell_[v] = cell;
}

void GrowingTin::push_peak(std::uint32_t cell) {
  if (!(worst_error_[cell] > limit_)) return;
  peaks_.push_back({worst_error_[cell], xy_[worst_vertex_[cell]], worst_vertex_[cell], cell});
  std::push_heap(peaks_.begin(), peaks_.end());
}

void GrowingTin::rank_all() {
  for (std::uint32_t c = 0; c < cells_.size(); ++c) {
    const Plane plane = plane_of(cells_[c]);
    for (std::uint32_t v = first_[c]; v != kNoSide; v = next_[v]) {
      const double error = error_of(v, plane, cells_[c]);
      if (worst_vertex_[c] != kNoSide && !higher(error, v, worst_error_[c], worst_vertex_[c])) continue;
      worst_error_[c] = error;
      worst_vertex_[c] = v;
    }
    push_peak(c);
  }
}

std::optional<std::uint32_t> GrowingTin::worst() {
  while (!peaks_.empty()) {
    const Peak peak = peaks_.front();
    if (worst_vertex_[peak.cell] == peak.vertex && worst_error_[peak.cell] == peak.error) return peak.vertex;
    std::pop_heap(peaks_.begin(), peaks_.end());
    peaks_.pop_back();
  }
  return std::nullopt;
}

bool GrowingTin::find_missed(const Progress& progress) {
  constexpr std::uint32_t kCellsBetweenChecks = 4096;
  bool found = false;
  for (std::uint32_t c = 0; c < cells_.size(); ++c) {
    if (c % kCellsBetweenChecks == 0) progress.check();
    std::uint32_t missed = kNoSide;
    for (std::uint32_t v = first_[c]; v != kNoSide; v = next_[v]) {
      if (within_limit(v, cells_[c])) continue;
      if (missed == kNoSide || xy_[v] < xy_[missed]) missed = v;
    }
    if (missed == kNoSide) continue;
    worst_vertex_[c] = missed;
    worst_error_[c] = std::nextafter(limit_, std::numeric_limits<double>::infinity());
    push_peak(c);
    found = true;
  }
  return found;
}

double GrowingTin::largest_error() const {
  return worst_error_.empty() ? 0 : *std::max_element(worst_error_.begin(), worst_error_.end());
}

bool GrowingTin::conflicts(std::uint32_t cell, Point2 p) const {
  const auto [a, b, c] = cells_[cell].vertex;
  return in_circle_perturbed(xy_[a], xy_[b], xy_[c], p);
}

// The cavity of v and its rim, step 2.
void GrowingTin::dig(std::uint32_t v) {
  const std::uint32_t start = cell_[v];
  cavity_.assign(1, start);
  rim_.clear();
  pending_.clear();
  for (std::uint32_t i = 3; i-- > 0;) pending_.push_back(side_of(start, i));
  while (!pending_.empty()) {
    const std::uint32_t side = pending_.back();
    pending_.pop_back();
    const Cell& cell = cells_[cell_of(side)];
    const std::uint32_t corner = corner_of(side);
    const std::uint32_t outer = cell.neighbour[corner];
    const bool constrained = (cell.constrained >> corner & 1U) != 0;
    if (constrained || outer == kNoSide || !conflicts(cell_of(outer), xy_[v])) {
      rim_.push_back({cell.vertex[after(corner)], cell.vertex[before(corner)], outer, constrained});
      continue;
    }
    cavity_.push_back(cell_of(outer));
    pending_.push_back(side_of(cell_of(outer), before(corner_of(outer))));
    pending_.push_back(side_of(cell_of(outer), after(corner_of(outer))));
  }
}

// If v lies on the outline, the side there goes, and the rim runs from its end to its start.
bool GrowingTin::open_at_outline(std::uint32_t v) {
  for (std::size_t i = 0; i < rim_.size(); ++i) {
    if (rim_[i].outer != kNoSide || orientation(xy_[rim_[i].from], xy_[rim_[i].to], xy_[v]) != 0) continue;
    std::rotate(rim_.begin(), rim_.begin() + static_cast<std::ptrdiff_t>(i) + 1, rim_.end());
    rim_.pop_back();
    return true;
  }
  return false;
}

// A new cell for each side of the rim; cells of the cavity first.
void GrowingTin::fill(std::uint32_t v, bool open) {
  const std::size_t count = rim_.size();
  while (cavity_.size() < count) {
    cavity_.push_back(static_cast<std::uint32_t>(cells_.size()));
    cells_.emplace_back();
    first_.push_back(kNoSide);
    worst_error_.push_back(0);
    worst_vertex_.push_back(kNoSide);
  }
  THALWEG_ASSERT(cavity_.size() == count);
  planes_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const RimSide& side = rim_[i];
    const std::uint32_t made = cavity_[i];
    const bool first = open && i == 0, last = open && i + 1 == count;
    const std::uint32_t following = cavity_[i + 1 == count ? 0 : i + 1];
    const std::uint32_t previous = cavity_[i == 0 ? count - 1 : i - 1];
    cells_[made] = {
        {v, side.from, side.to},
        {side.outer, last ? kNoSide : side_of(following, 2), first ? kNoSide : side_of(previous, 1)},
        side.constrained ? 1U : 0U,
        0};
    if (side.outer != kNoSide)
      cells_[cell_of(side.outer)].neighbour[corner_of(side.outer)] = side_of(made, 0);
    planes_[i] = plane_of(cells_[made]);
  }
}

// Step 3. Spoke i runs from v to rim_[i].from.
void GrowingTin::deal(std::uint32_t v, bool open) {
  const Point2 centre = xy_[v];
  const std::size_t count = rim_.size();
  std::size_t wedge = 0;
  for (const std::uint32_t q : dealt_) {
    if (q == v) continue;
    const Point2 p = xy_[q];
    if (orientation(centre, xy_[rim_[wedge].from], p) >= 0) {
      while (!(open && wedge + 1 == count) && orientation(centre, xy_[rim_[wedge].to], p) >= 0) {
        wedge = wedge + 1 == count ? 0 : wedge + 1;
      }
    } else {
      do {
        wedge = wedge == 0 ? count - 1 : wedge - 1;
      } while (orientation(centre, xy_[rim_[wedge].from], p) < 0);
    }
    const std::uint32_t cell = cavity_[wedge];
    add_waiting(q, cell, error_of(q, planes_[wedge], cells_[cell]));
  }
  for (const std::uint32_t cell : cavity_) push_peak(cell);
}

void GrowingTin::insert(std::uint32_t v) {
  THALWEG_ASSERT(cell_[v] != kNoSide);
  dig(v);
  dealt_.clear();
  for (const std::uint32_t cell : cavity_) {
    for (std::uint32_t q = first_[cell]; q != kNoSide; q = next_[q]) dealt_.push_back(q);
    forget_waiting(cell);
  }
  const bool open = open_at_outline(v);
  fill(v, open);
  cell_[v] = kNoSide;
  deal(v, open);
}

}  // namespace thalweg::detail
