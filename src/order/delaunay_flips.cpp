// Lawson's flips.
//
// Based on: Lawson, Software for C1 surface interpolation, 1977; Lee and Lin, Generalized Delaunay
// triangulation for planar graphs, 1986: while an edge is broken its quadrilateral is strictly convex, its
// flip lowers the lifted surface, and where no edge is broken the triangulation is the (constrained) Delaunay
// triangulation. Signs are those of the perturbed lifted points, so this holds for cocircular points too.
//
// 1. Edges to look at are on a stack of halfedges. A flip moves the edges of its two triangles to other
//    halfedges and puts the four outer ones on the stack anew, so an entry out of date does no harm.
// 2. Edge ab between triangles a b c and b a d becomes cd between a d c, in the first's place, and d b c, in
//    the second's.
#include "order/delaunay_flips.hpp"

#include <thalweg/geometry/predicates.hpp>

#include <algorithm>

namespace thalweg::detail {

bool breaks_delaunay(const Tin& tin, HalfedgeId h, FlipRule rule) {
  const HalfedgeId twin = tin.twin(h);
  if (!twin.valid() || (rule == FlipRule::KeepConstraints && tin.constrained(h))) return false;
  return in_circle_perturbed(tin.point(tin.origin(h)), tin.point(tin.target(h)), tin.point(tin.apex(h)),
                             tin.point(tin.apex(twin)));
}

DelaunayFlips::DelaunayFlips(const Tin& tin, FlipRule rule, std::span<const HalfedgeId> broken)
    : tin_(&tin),
      corners_(tin.triangles().begin(), tin.triangles().end()),
      twins_(tin.arrays().twins.begin(), tin.arrays().twins.end()),
      keeps_(tin.halfedge_count(), 0),
      changes_(tin.triangle_count(), 0),
      pending_(broken.rbegin(), broken.rend()) {
  if (rule == FlipRule::FlipAll) return;
  for (std::size_t h = 0; h < keeps_.size(); ++h) keeps_[h] = tin.constrained(HalfedgeId{h}) ? 1 : 0;
}

bool DelaunayFlips::run(std::size_t most, const Progress& progress) {
  constexpr std::size_t kCheck = 4096;
  for (std::size_t flips = 0; !pending_.empty();) {
    const HalfedgeId h = pending_.back();
    pending_.pop_back();
    if (!broken(h)) continue;
    if (flips++ == most) return false;
    if (flips % kCheck == 0) progress.check();
    flip(h);
  }
  return true;
}

bool DelaunayFlips::broken(HalfedgeId h) const {
  const HalfedgeId twin = twins_[h.index()];
  if (!twin.valid() || keeps_[h.index()] != 0) return false;
  const Triangle& t = corners_[h.index() / 3];
  return in_circle_perturbed(tin_->point(t[0]), tin_->point(t[1]), tin_->point(t[2]),
                             tin_->point(apex(twin)));
}

void DelaunayFlips::place(HalfedgeId h, HalfedgeId twin, bool kept) {
  twins_[h.index()] = twin;
  keeps_[h.index()] = kept ? 1 : 0;
  if (!twin.valid()) return;
  twins_[twin.index()] = h;
  pending_.push_back(h);
}

void DelaunayFlips::flip(HalfedgeId h) {
  const HalfedgeId g = twins_[h.index()];
  const Flip flip{Tin::triangle_of(h), Tin::triangle_of(g), origin(h), origin(g), apex(h), apex(g)};
  const auto outer = [&](HalfedgeId side) {
    return std::pair(twins_[side.index()], keeps_[side.index()] != 0);
  };
  const auto [beyond_ad, keeps_ad] = outer(Tin::next(g));
  const auto [beyond_db, keeps_db] = outer(Tin::previous(g));
  const auto [beyond_bc, keeps_bc] = outer(Tin::next(h));
  const auto [beyond_ca, keeps_ca] = outer(Tin::previous(h));
  corners_[flip.left.index()] = {flip.a, flip.d, flip.c};
  corners_[flip.right.index()] = {flip.d, flip.b, flip.c};
  const HalfedgeId diagonal = Tin::halfedge(flip.left, 1), back = Tin::halfedge(flip.right, 2);
  twins_[diagonal.index()] = back;
  twins_[back.index()] = diagonal;
  keeps_[diagonal.index()] = keeps_[back.index()] = 0;
  place(Tin::halfedge(flip.left, 0), beyond_ad, keeps_ad);
  place(Tin::halfedge(flip.left, 2), beyond_ca, keeps_ca);
  place(Tin::halfedge(flip.right, 0), beyond_db, keeps_db);
  place(Tin::halfedge(flip.right, 1), beyond_bc, keeps_bc);
  std::uint8_t& left = changes_[flip.left.index()];
  std::uint8_t& right = changes_[flip.right.index()];
  if (left == 0 && right == 0) first_flips_.push_back(flip);
  left = static_cast<std::uint8_t>(std::min(2, left + 1));
  right = static_cast<std::uint8_t>(std::min(2, right + 1));
}

std::vector<DelaunayFlips::Flip> DelaunayFlips::single_flips() const {
  std::vector<Flip> single;
  for (const Flip& flip : first_flips_) {
    if (changes_[flip.left.index()] == 1 && changes_[flip.right.index()] == 1) single.push_back(flip);
  }
  return single;
}

bool DelaunayFlips::alone_inside_left(const Flip& flip) const {
  return alone({flip.a, flip.b, flip.c}, Tin::halfedge(flip.left, 1), Tin::halfedge(flip.right, 0));
}

bool DelaunayFlips::alone_inside_right(const Flip& flip) const {
  return alone({flip.b, flip.a, flip.d}, Tin::halfedge(flip.right, 2), Tin::halfedge(flip.left, 2));
}

// `first` and `last` start at the inner vertex, in the two triangles at the diagonal, counter-clockwise of
// it and clockwise: round the rest of its fan from either, until the other or the rim comes.
bool DelaunayFlips::alone(const Triangle& circle, HalfedgeId first, HalfedgeId last) const {
  const auto inside = [&](VertexId x) {
    return x != circle[0] && x != circle[1] && x != circle[2] &&
           in_circle_perturbed(tin_->point(circle[0]), tin_->point(circle[1]), tin_->point(circle[2]),
                               tin_->point(x));
  };
  HalfedgeId h = twins_[Tin::previous(first).index()];
  for (; h.valid() && h != last; h = twins_[Tin::previous(h).index()]) {
    if (inside(apex(h))) return false;
  }
  if (h.valid()) return true;
  for (HalfedgeId g = twins_[last.index()]; g.valid(); g = twins_[Tin::next(g).index()]) {
    if (inside(apex(g))) return false;
  }
  return true;
}

}  // namespace thalweg::detail
