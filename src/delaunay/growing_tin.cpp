// Greedy insertion.
//
// Based on: Garland, Heckbert, Fast polygonal approximation of terrains and height fields, 1995, for the
// queue of triangles by their worst points; the constrained cavity is as in incremental.cpp.
//
// 1. Each cell knows the worst of the vertices that wait in it. A queue holds the worst of each cell; what
//    was put there before its cell changed is skipped when it comes up.
// 2. The cavity of a vertex: the cells whose circles hold it, reached without crossing a constraint edge or
//    the outline. It is star-shaped about the vertex: across a side that the vertex sees lies a cell whose
//    circle holds the vertex, so the vertex sees its third corner through that side. A vertex on the outline
//    opens the fan of its new cells.
// 3. Waiting vertices are in lists of their cells; those of the cavity are dealt to the new cells by a walk
//    around the fan: neighbours in the list are neighbours in the plane, so the walk is short. Where they lie
//    on a lattice, as those of a raster do, cells of many have no list: their worst is looked for in rows of
//    the lattice, which is faster; a list is made when a cell is small.
// 4. A vertex on a side belongs to one of its cells: to the one that is counter-clockwise of the side as seen
//    from that end which was inserted later; so it was dealt, and so rows take it. Of sides that were there
//    at the start, to the one on their left from the lesser end.
// 5. Errors are those of rounded planes. Only those near the limit are compared exactly at once; when none is
//    left beyond it, all are compared exactly, so the bound holds without rounding (needles can round badly).
#include "growing_tin.hpp"

#include "base/parallel.hpp"

#include <thalweg/base/assert.hpp>
#include <thalweg/delaunay/surface.hpp>
#include <thalweg/geometry/vertical_distance.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace thalweg::detail {

namespace {

// Cells with fewer places are listed: with 4 and 64 places a million cells take 1.15 times as long where a
// fifth is kept, with 8 and 32 as long.
constexpr double kListedPlaces = 16;

}  // namespace

GrowingTin::GrowingTin(std::span<const Point2> xy, std::span<const double> z, double limit)
    : xy_(xy), z_(z), limit_(limit), next_(xy.size(), kNoSide), cell_(xy.size(), 0), peaks_(xy) {
  double highest = 0;
  for (const double height : z) highest = std::max(highest, std::abs(height));
  slack_ = 1e-6 * limit + 1e-9 * highest;
}

void GrowingTin::start(const Tin& tin, std::span<const std::uint32_t> ids, Progress& progress) {
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
    cell.kind[corner] = tin.kind(h);
    if (tin.on_rim(h) || tin.point(tin.origin(h)) < tin.point(tin.target(h))) cell.mark |= 1U << corner;
  }
  waiting_.assign(cells_.size(), {});
  for (const std::uint32_t v : ids) cell_[v] = kNoSide;
  std::vector<bool> waits(xy_.size());
  for (std::size_t v = 0; v < waits.size(); ++v) waits[v] = cell_[v] != kNoSide;
  lattice_ = WaitingLattice::find(xy_, z_, waits);
  if (!lattice_) locate_waiting(tin, progress);
  for (std::uint32_t c = 0; c < cells_.size(); ++c) {
    const HeightPlane plane = plane_of(cells_[c]);
    if (lattice_) measure(c, plane);
    for (std::uint32_t v = waiting_[c].first; v != kNoSide && v != kUnlisted; v = next_[v]) {
      compare(v, error_of(v, plane, cells_[c]), c);
    }
    push_peak(c);
  }
}

// On a lattice no place is looked for.
void GrowingTin::locate_waiting(const Tin& tin, Progress& progress) {
  constexpr std::size_t kBlock = 4096;
  const SurfaceLocator surface(tin);
  for_each_block(xy_.size(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    TriangleId near;
    for (std::size_t v = begin; v < end; ++v) {
      if (cell_[v] == kNoSide) continue;
      const auto place = surface.locate(xy_[v], near);
      THALWEG_ASSERT(place.has_value());
      near = place->triangle;
      cell_[v] = near.value();
    }
  });
  for (std::uint32_t v = static_cast<std::uint32_t>(xy_.size()); v-- > 0;) {
    if (cell_[v] == kNoSide) continue;
    const Cell& cell = cells_[cell_[v]];
    for (std::uint32_t i = 0; i < 3; ++i) {
      if ((cell.mark >> i & 1U) != 0) continue;
      const Point2 a = xy_[cell.vertex[after(i)]], b = xy_[cell.vertex[before(i)]];
      if (orientation(a, b, xy_[v]) == 0) cell_[v] = cell_of(cell.neighbour[i]);
    }
    add_waiting(v, cell_[v]);
  }
}

HeightPlane GrowingTin::plane_of(const Cell& cell) const {
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

double GrowingTin::error_of(std::uint32_t v, const HeightPlane& plane, const Cell& cell) const {
  const double error = std::abs(z_[v] - plane.height(xy_[v]));
  if (std::abs(error - limit_) > slack_) return error;
  if (within_limit(v, cell)) return std::min(error, limit_);
  return std::max(error, std::nextafter(limit_, std::numeric_limits<double>::infinity()));
}

OwningTriangle GrowingTin::outline_of(const Cell& cell) const {
  return {{xy_[cell.vertex[0]], xy_[cell.vertex[1]], xy_[cell.vertex[2]]}, cell.mark};
}

void GrowingTin::add_waiting(std::uint32_t v, std::uint32_t cell) {
  next_[v] = waiting_[cell].first;
  waiting_[cell].first = v;
  cell_[v] = cell;
}

void GrowingTin::compare(std::uint32_t v, double error, std::uint32_t cell) {
  Waiting& waiting = waiting_[cell];
  if (waiting.worst_vertex != kNoSide && !higher(error, v, waiting.worst_error, waiting.worst_vertex)) return;
  waiting.worst_error = error;
  waiting.worst_vertex = v;
}

// Lists what waits in a cell, by the lattice.
void GrowingTin::list(std::uint32_t cell) {
  listed_.clear();
  lattice_->append(outline_of(cells_[cell]), listed_);
  waiting_[cell].first = kNoSide;
  for (const std::uint32_t v : listed_) add_waiting(v, cell);
}

// The worst of a cell by the lattice; lists it if it is small.
void GrowingTin::measure(std::uint32_t cell, const HeightPlane& plane) {
  const OwningTriangle outline = outline_of(cells_[cell]);
  const auto [a, b, c] = outline.corner;
  const double area = ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
  if (lattice_->places(area) < kListedPlaces) {
    list(cell);
    for (const std::uint32_t v : listed_) compare(v, error_of(v, plane, cells_[cell]), cell);
    return;
  }
  waiting_[cell].first = kUnlisted;
  const LatticePeak peak = lattice_->peak(outline, plane);
  if (peak.vertex == kNoVertex) return;
  if (std::abs(peak.error - limit_) > slack_) {
    compare(peak.vertex, peak.error, cell);
    return;
  }
  listed_.clear();
  lattice_->append(outline, listed_);
  for (const std::uint32_t v : listed_) compare(v, error_of(v, plane, cells_[cell]), cell);
}

void GrowingTin::place_all() {
  for (std::uint32_t c = 0; c < cells_.size(); ++c) {
    if (waiting_[c].first == kUnlisted) list(c);
  }
}

void GrowingTin::push_peak(std::uint32_t cell) {
  const Waiting& waiting = waiting_[cell];
  if (waiting.worst_error > limit_) peaks_.push({waiting.worst_error, waiting.worst_vertex, cell});
}

std::optional<std::uint32_t> GrowingTin::worst() {
  while (const Peak* peak = peaks_.highest()) {
    const Waiting& waiting = waiting_[peak->cell];
    if (waiting.worst_vertex == peak->vertex && waiting.worst_error == peak->error) {
      cell_[peak->vertex] = peak->cell;
      return peak->vertex;
    }
    peaks_.pop();
  }
  return std::nullopt;
}

bool GrowingTin::find_missed(const Progress& progress) {
  constexpr std::uint32_t kCellsBetweenChecks = 4096;
  bool found = false;
  place_all();
  for (std::uint32_t c = 0; c < cells_.size(); ++c) {
    if (c % kCellsBetweenChecks == 0) progress.check();
    std::uint32_t missed = kNoSide;
    for (std::uint32_t v = waiting_[c].first; v != kNoSide; v = next_[v]) {
      if (within_limit(v, cells_[c])) continue;
      if (missed == kNoSide || xy_[v] < xy_[missed]) missed = v;
    }
    if (missed == kNoSide) continue;
    waiting_[c].worst_vertex = missed;
    waiting_[c].worst_error = std::nextafter(limit_, std::numeric_limits<double>::infinity());
    push_peak(c);
    found = true;
  }
  return found;
}

double GrowingTin::largest_error() const {
  double largest = 0;
  for (const Waiting& waiting : waiting_) largest = std::max(largest, waiting.worst_error);
  return largest;
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
    const EdgeKind kind = cell.kind[corner];
    if (is_constraint(kind) || outer == kNoSide || !conflicts(cell_of(outer), xy_[v])) {
      const bool owned = (cell.mark >> corner & 1U) != 0;
      rim_.push_back({cell.vertex[after(corner)], cell.vertex[before(corner)], outer, kind, owned});
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

// A new cell for each side of the rim; cells of the cavity first. Bits of `mark`: sides that are owned,
// step 4.
void GrowingTin::fill(std::uint32_t v, bool open) {
  const std::size_t count = rim_.size();
  while (cavity_.size() < count) {
    cavity_.push_back(static_cast<std::uint32_t>(cells_.size()));
    cells_.emplace_back();
    waiting_.emplace_back();
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
        {side.kind},
        (side.owned ? 1U : 0U) | (last ? 2U : 0U) | 4U};
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
    add_waiting(q, cell);
    compare(q, error_of(q, planes_[wedge], cells_[cell]), cell);
  }
}

void GrowingTin::insert(std::uint32_t v) {
  THALWEG_ASSERT(cell_[v] != kNoSide);
  dig(v);
  dealt_.clear();
  bool listed = true;
  for (const std::uint32_t cell : cavity_) {
    std::uint32_t q = waiting_[cell].first;
    waiting_[cell] = {};
    if (q == kUnlisted) listed = false;
    for (; listed && q != kNoSide; q = next_[q]) dealt_.push_back(q);
  }
  const bool open = open_at_outline(v);
  fill(v, open);
  cell_[v] = kNoSide;
  if (lattice_) lattice_->take(xy_[v]);
  if (listed) {
    deal(v, open);
  } else {
    for (std::size_t i = 0; i < cavity_.size(); ++i) measure(cavity_[i], planes_[i]);
  }
  for (const std::uint32_t cell : cavity_) push_peak(cell);
}

}  // namespace thalweg::detail
