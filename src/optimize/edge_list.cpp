#include "optimize/edge_list.hpp"

#include <array>

namespace thalweg {

void EdgeList::load_quadrilaterals(std::uint32_t begin, std::uint32_t end) {
  begin_ = begin, end_ = end;
  const std::size_t count = end - begin;
  triangles_.clear(12 * count);
  edges_.clear(5 * count);
  sides_.clear(18 * count);
  for (std::uint32_t q = begin; q < end; ++q) {
    const HalfedgeId uv = faces_.quadrilaterals[q].diagonal;
    add(uv);
    add(faces_.tin.twin(uv));
    add_flipped(q, true);
    add_flipped(q, false);
  }
  for (std::uint32_t q = begin; q < end; ++q) list_edges(q);
}

void EdgeList::load_triangles(std::size_t begin, std::size_t end) {
  triangles_.clear(4 * (end - begin));
  edges_.clear(0);
  sides_.clear(3 * (end - begin));
  for (std::size_t t = begin; t < end; ++t) {
    if (faces_.owner[t] != kNone) continue;
    const std::uint32_t own = add(Tin::halfedge(TriangleId{t}, 0));
    for (std::size_t i = 0; i < 3; ++i) {
      const HalfedgeId h = Tin::halfedge(TriangleId{t}, i), outer = faces_.tin.twin(h);
      if (!outer.valid() || outer < h || faces_.owner[Tin::triangle_of(outer).index()] != kNone) continue;
      sides_.add({own, add(outer)});
    }
  }
}

void EdgeList::list_edges(std::uint32_t q) {
  const std::uint32_t own = 4 * (q - begin_), at_s = own, at_t = own + 1, at_u = own + 2, at_v = own + 3;
  edges_.add({q, kNone, 0, 0});
  sides_.add({at_s, at_t});
  sides_.add({at_u, at_v});
  const std::array<Side, 4> sides = sides_of(faces_.tin, faces_.quadrilaterals[q]);
  std::uint32_t slot = first_[q];
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const HalfedgeId outer = faces_.tin.twin(sides[i].inner);
    if (!outer.valid()) continue;
    const std::uint32_t p = faces_.owner[Tin::triangle_of(outer).index()];
    const BodyPair of_q{i == 0 || i == 3 ? at_s : at_t, sides[i].at_s_u ? at_u : at_v};
    if (p != kNone) {
      if (p > q) list_pair(q, p, outer, slot, of_q);
      ++slot;
      continue;
    }
    const std::uint32_t outside = add(outer);
    edges_.add({q, kNone, 0, 0});
    for (const std::uint32_t body : of_q) sides_.add({body, outside});
  }
}

// The edge between q and a later p, where q has a body for each of its labels.
void EdgeList::list_pair(std::uint32_t q, std::uint32_t p, HalfedgeId outer, std::uint32_t q_slot,
                         BodyPair of_q) {
  const std::array<Side, 4> sides = sides_of(faces_.tin, faces_.quadrilaterals[p]);
  std::uint32_t p_slot = first_[p];
  std::size_t j = 0;
  for (; sides[j].inner != outer; ++j) p_slot += faces_.owner_across(sides[j].inner) != kNone ? 1 : 0;
  const std::uint32_t its = 4 * (p - begin_);
  const BodyPair of_p = here(p) ? BodyPair{its + (j == 0 || j == 3 ? 0 : 1), its + (sides[j].at_s_u ? 2 : 3)}
                                : BodyPair{add(outer), add_flipped(p, sides[j].at_s_u)};
  edges_.add({q, p, q_slot, p_slot});
  for (const std::uint32_t other : of_p) {
    for (const std::uint32_t body : of_q) sides_.add({body, other});
  }
}

}  // namespace thalweg
