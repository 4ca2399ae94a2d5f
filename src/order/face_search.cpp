// Triangulations of a face, front by front.
//
// 1. A front is the set of directed edges that have uncovered ground of the face on their left and none that
//    is uncovered, or no ground of the face, on their right. At first: the sides of the face. Its lowest edge
//    has to be covered by some candidate on its left, one side of which it is. Sides that are in the front
//    leave it, others enter it reversed; a candidate fits if these are free, not in the front already, and
//    cross none of it: it has no vertex inside, so it then lies in what is uncovered.
// 2. What is covered follows from the front, and so do the number of triangles that cover it and what can
//    follow: fronts are the nodes of a graph without cycles, whose paths from the first to the empty one are
//    the face's triangulations, each once. The smallest largest order of a path through a node or an arc
//    comes from one sweep forwards and one backwards.
#include "order/face_search.hpp"

#include <algorithm>
#include <bit>

namespace thalweg::detail {

namespace {

using Front = std::vector<std::uint32_t>;  // directed edges, ascending

using Arc = FrontGraph::Arc;

/// Fronts that differ, numbered as they come: end to end, and found again by open addressing.
class FrontList {
 public:
  /// The front's number.
  std::uint32_t number(std::span<const std::uint32_t> front);
  [[nodiscard]] std::optional<std::uint32_t> find_empty() const { return empty_; }
  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(first_.size() - 1); }
  [[nodiscard]] std::span<const std::uint32_t> operator[](std::uint32_t i) const {
    return std::span(edges_).subspan(first_[i], first_[i + 1] - first_[i]);
  }
  /// Edges of all, and one for each.
  [[nodiscard]] std::size_t work() const { return edges_.size() + size(); }

 private:
  static constexpr std::uint32_t kFree = 0xffffffffU;
  [[nodiscard]] std::size_t slot(std::span<const std::uint32_t> front) const;
  void grow();

  std::vector<std::uint32_t> edges_, slots_ = std::vector<std::uint32_t>(16, kFree);
  std::vector<std::size_t> first_ = {0};
  std::optional<std::uint32_t> empty_;
};

// Where the front is, or would be. Multiplicative hashing (Knuth, The Art of Computer Programming 3, 6.4).
std::size_t FrontList::slot(std::span<const std::uint32_t> front) const {
  std::uint64_t hash = front.size();
  for (const std::uint32_t edge : front) {
    hash = std::rotl((hash ^ edge) * 0x9e3779b97f4a7c15ULL, 29);
  }
  const std::size_t mask = slots_.size() - 1;
  std::size_t i = static_cast<std::size_t>(hash * 0x9e3779b97f4a7c15ULL >> 32) & mask;
  while (slots_[i] != kFree && !std::ranges::equal((*this)[slots_[i]], front)) i = (i + 1) & mask;
  return i;
}

void FrontList::grow() {
  slots_.assign(2 * slots_.size(), kFree);
  for (std::uint32_t i = 0; i < size(); ++i) slots_[slot((*this)[i])] = i;
}

std::uint32_t FrontList::number(std::span<const std::uint32_t> front) {
  std::size_t at = slot(front);
  if (slots_[at] != kFree) return slots_[at];
  const std::uint32_t fresh = size();
  if (front.empty()) empty_ = fresh;
  edges_.insert(edges_.end(), front.begin(), front.end());
  first_.push_back(edges_.size());
  slots_[at] = fresh;
  if (2 * first_.size() > slots_.size()) grow();
  return fresh;
}

class FaceSearch {
 public:
  FaceSearch(const Candidates& candidates, std::size_t face)
      : candidates_(candidates), triangles_(candidates.faces.row(face)) {
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
      for (const std::uint32_t side : candidates_.sides[triangles_[i]]) on_side_.emplace_back(side, i);
    }
    std::sort(on_side_.begin(), on_side_.end());
  }

  [[nodiscard]] std::optional<FrontGraph> find_fronts(const FrontOptions& options) const;
  [[nodiscard]] FaceOrders sweep(const FrontGraph& graph) const;

 private:
  [[nodiscard]] Front first_front() const;
  /// Whether the triangle fits; `next` is what it leaves of the front, if so.
  bool cover(std::span<const std::uint32_t> front, std::uint32_t triangle, Front& next) const;
  [[nodiscard]] std::uint32_t order(std::uint32_t i) const {
    return candidates_.triangles[triangles_[i]].order;
  }

  const Candidates& candidates_;
  std::span<const std::uint32_t> triangles_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> on_side_;  // (side, index in the face), sorted
};

Front FaceSearch::first_front() const {
  Front front;
  for (const auto& [side, triangle] : on_side_) {
    if (candidates_.edges[side / 2].free) continue;
    if (front.empty() || front.back() != side) front.push_back(side);
  }
  return front;
}

bool FaceSearch::cover(std::span<const std::uint32_t> front, std::uint32_t triangle, Front& next) const {
  next.assign(front.begin(), front.end());
  for (const std::uint32_t side : candidates_.sides[triangles_[triangle]]) {
    const auto at = std::lower_bound(next.begin(), next.end(), side);
    if (at != next.end() && *at == side) {
      next.erase(at);
      continue;
    }
    if (!candidates_.edges[side / 2].free || std::binary_search(front.begin(), front.end(), side ^ 1U)) {
      return false;
    }
    for (const std::uint32_t crossed : candidates_.crossings.row(side / 2)) {
      const auto there = std::lower_bound(front.begin(), front.end(), 2 * crossed);
      if (there != front.end() && *there / 2 == crossed) return false;
    }
    next.insert(std::lower_bound(next.begin(), next.end(), side ^ 1U), side ^ 1U);
  }
  return true;
}

std::optional<FrontGraph> FaceSearch::find_fronts(const FrontOptions& options) const {
  FrontList fronts;
  Front next;
  std::vector<Arc> arcs;
  fronts.number(first_front());
  // Each front is reached by as many triangles on every path, so those that are found first have fewer.
  for (std::uint32_t f = 0; f < fronts.size(); ++f) {
    if (fronts.work() > options.work_limit) return std::nullopt;
    if (fronts[f].empty()) continue;
    const std::uint32_t lowest = fronts[f].front();
    auto at = std::lower_bound(on_side_.begin(), on_side_.end(), std::pair(lowest, std::uint32_t{0}));
    for (; at != on_side_.end() && at->first == lowest; ++at) {
      if (!options.usable.empty() && options.usable[at->second] == 0) continue;
      if (!cover(fronts[f], at->second, next)) continue;
      arcs.push_back({f, fronts.number(next), at->second});
    }
  }
  return FrontGraph{fronts.size(), fronts.find_empty(), std::move(arcs)};
}

FaceOrders FaceSearch::sweep(const FrontGraph& graph) const {
  constexpr std::uint32_t kUnreachable = FaceOrders::kUnreachable;
  const std::vector<Arc>& arcs = graph.arcs;
  std::vector<std::uint32_t> before(graph.front_count, kUnreachable), behind(graph.front_count, kUnreachable);
  before[0] = 0;
  if (graph.empty_front) behind[*graph.empty_front] = 0;
  for (const Arc& arc : arcs) {
    before[arc.to] = std::min(before[arc.to], std::max(before[arc.from], order(arc.triangle)));
  }
  std::for_each(arcs.rbegin(), arcs.rend(), [&](const Arc& arc) {
    behind[arc.from] = std::min(behind[arc.from], std::max(behind[arc.to], order(arc.triangle)));
  });
  FaceOrders orders{behind[0], Front(triangles_.size(), kUnreachable)};
  for (const Arc& arc : arcs) {
    std::uint32_t& least = orders.with_triangle[arc.triangle];
    least = std::min(least, std::max({before[arc.from], order(arc.triangle), behind[arc.to]}));
  }
  return orders;
}

}  // namespace

std::optional<FaceOrders> search_face(const Candidates& candidates, std::size_t face,
                                      std::size_t work_limit) {
  const FaceSearch search(candidates, face);
  const auto graph = search.find_fronts({.work_limit = work_limit});
  if (!graph) return std::nullopt;
  return search.sweep(*graph);
}

}  // namespace thalweg::detail

namespace thalweg {

std::optional<FrontGraph> find_fronts(const FixedFaces& faces, std::size_t face,
                                      const FrontOptions& options) {
  return detail::FaceSearch(faces, face).find_fronts(options);
}

}  // namespace thalweg
