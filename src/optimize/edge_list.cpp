// What is as good as random, such as which of two neighbours comes first, or whether a triangle is in a
// quadrilateral, is decided without branches: everything is written, and what is not wanted written over.
#include "optimize/edge_list.hpp"

#include <algorithm>
#include <array>
#include <bit>

namespace thalweg {

namespace {

constexpr bool is_at_u_v(std::size_t side) {
  return side == 0 || side == 3;
}

}  // namespace

void EdgeList::load(std::size_t begin, std::size_t end) {
  begin_ = begin, end_ = end;
  const auto first_from = [&](std::size_t t) {
    const auto at = std::ranges::lower_bound(faces_.quadrilaterals, t, {},
                                             [](const Quadrilateral& q) { return q.diagonal.index() / 3; });
    return static_cast<std::uint32_t>(at - faces_.quadrilaterals.begin());
  };
  first_q_ = first_from(begin), end_q_ = first_from(end);
  clear();
  for (std::uint32_t q = first_q_; q < end_q_; ++q) {
    add_flipped(q, true);
    add_flipped(q, false);
  }
  list_quadrilaterals();
  for (const Beside& at : to_free_.all()) list_single(at);
  for (const Beside& at : to_owned_.all()) list_pair(at);
  list_constants();
}

void EdgeList::clear() {
  const std::size_t count = end_q_ - first_q_, triangles = end_ - begin_;
  others_.clear(11 * count + 3 * triangles);
  kept_.clear(count);
  owned_.clear(count);
  to_free_.clear(4 * count);
  to_owned_.clear(4 * count);
  singles_.clear(5 * count);
  pairs_.clear(4 * count);
  constants_.clear(3 * triangles);
  sides_.clear(18 * count + 3 * triangles);
}

std::uint32_t EdgeList::add_flipped(std::uint32_t q, bool at_s_u) {
  const auto& [s, u, t, v, diagonal] = faces_.quadrilaterals[q];
  return add_other(at_s_u ? Triangle{s, u, t} : Triangle{t, v, s});
}

void EdgeList::list_quadrilaterals() {
  for (std::uint32_t q = first_q_; q < end_q_; ++q) {
    const HalfedgeId uv = faces_.quadrilaterals[q].diagonal;
    const BodyPair kept{body(uv), body(faces_.tin.twin(uv))};
    kept_.add(kept);
    singles_.add(q);
    sides_.add(kept);
    sides_.add({flipped_body(q, true), flipped_body(q, false)});
    const std::array<Side, 4> sides = sides_of(faces_.tin, faces_.quadrilaterals[q]);
    std::uint32_t slot = first_[q], owned = 0;
    for (std::uint32_t i = 0; i < sides.size(); ++i) {
      const HalfedgeId outer = faces_.tin.twin(sides[i].inner);
      if (!outer.valid()) continue;
      const std::uint32_t p = faces_.owner[Tin::triangle_of(outer).index()];
      const Beside at{q, i, outer, p, slot};
      const auto is_owned = static_cast<std::uint32_t>(p != kNone);
      to_free_.add_if(is_owned == 0, at);
      to_owned_.add_if((is_owned & static_cast<std::uint32_t>(p > q)) != 0, at);
      owned |= is_owned << i;
      slot += is_owned;
    }
    owned_.add(owned);
  }
}

BodyPair EdgeList::bodies_at(std::uint32_t q, std::size_t side) const {
  return {kept_.all()[q - first_q_][is_at_u_v(side) ? 0 : 1], flipped_body(q, side < 2)};
}

void EdgeList::list_single(const Beside& at) {
  const std::uint32_t outside = body(at.outer);
  singles_.add(at.q);
  for (const std::uint32_t own : bodies_at(at.q, at.side)) sides_.add({own, outside});
}

std::uint32_t EdgeList::owned_before(std::uint32_t p, std::size_t side) const {
  if (here(p))
    return static_cast<std::uint32_t>(std::popcount(owned_.all()[p - first_q_] & ((1U << side) - 1)));
  const std::array<Side, 4> sides = sides_of(faces_.tin, faces_.quadrilaterals[p]);
  return static_cast<std::uint32_t>(
      std::count_if(sides.begin(), sides.begin() + side,
                    [&](const Side& earlier) { return faces_.owner_across(earlier.inner) != kNone; }));
}

// The edge between q and a later p.
void EdgeList::list_pair(const Beside& at) {
  const std::array<Side, 4> sides = sides_of(faces_.tin, faces_.quadrilaterals[at.p]);
  std::size_t side = 0;
  for (std::size_t i = 1; i < sides.size(); ++i) side += sides[i].inner == at.outer ? i : 0;
  pairs_.add({at.q, at.p, at.slot, first_[at.p] + owned_before(at.p, side)});
  const BodyPair of_p =
      here(at.p) ? bodies_at(at.p, side) : BodyPair{body(at.outer), add_flipped(at.p, sides[side].at_s_u)};
  for (const std::uint32_t other : of_p) {
    for (const std::uint32_t own : bodies_at(at.q, at.side)) sides_.add({own, other});
  }
}

void EdgeList::list_constants() {
  for (std::size_t t = begin_; t < end_; ++t) {
    const auto is_free = faces_.owner[t] == kNone;
    for (std::size_t i = 0; i < 3; ++i) {
      const HalfedgeId h = Tin::halfedge(TriangleId{t}, i), outer = faces_.tin.twin(h);
      if (!outer.valid()) continue;
      const auto free_across = faces_.owner[Tin::triangle_of(outer).index()] == kNone;
      constants_.add_if((is_free & free_across & (h < outer)) != 0, h);
    }
  }
  for (const HalfedgeId h : constants_.all()) sides_.add({body(h), body(faces_.tin.twin(h))});
}

}  // namespace thalweg
