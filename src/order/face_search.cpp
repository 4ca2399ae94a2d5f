// Triangulations of a face, front by front.
//
// 1. A front is the set of directed edges that have uncovered ground of the face on their left and none that
//    is uncovered, or no ground of the face, on their right. At first: the sides of the face. Its lowest edge
//    has to be covered by some candidate on its left, one side of which it is. Sides that are in the front
//    leave it, others enter it reversed; a candidate fits if these are free, not in the front already, and
//    cross none of it: it has no vertex inside, so it then lies in what is uncovered.
// 2. Edges are numbered along the face, so that the lowest one moves over it from one end to the other, and
//    fronts differ near it only: of two that were far from each other each choice at the one would come with
//    each at the other. A front is a row of bits, one for each direction of each edge.
// 3. What is covered follows from the front, and so do the number of triangles that cover it and what can
//    follow: fronts are the nodes of a graph without cycles, whose paths from the first to the empty one are
//    the face's triangulations, each once. The smallest largest order of a path through a node or an arc
//    comes from one sweep forwards and one backwards.
#include "order/face_search.hpp"

#include <algorithm>
#include <bit>
#include <tuple>

namespace thalweg::detail {

namespace {

using Arc = FrontGraph::Arc;
using Bits = std::vector<std::uint64_t>;

/// Fronts that differ, numbered as they come: end to end, and found again by open addressing.
class FrontList {
 public:
  /// Forgets all fronts; memory stays.
  void start(std::size_t words) {
    words_ = words;
    edges_ = size_ = 0;
    bits_.clear();
    slots_.assign(kFirstSize, kFree);
    empty_.reset();
  }
  /// The front's number.
  std::uint32_t number(std::span<const std::uint64_t> front);
  [[nodiscard]] std::optional<std::uint32_t> find_empty() const { return empty_; }
  [[nodiscard]] std::uint32_t size() const { return size_; }
  [[nodiscard]] std::span<const std::uint64_t> operator[](std::uint32_t i) const {
    return std::span(bits_).subspan(i * words_, words_);
  }
  /// Edges of all, and one for each.
  [[nodiscard]] std::size_t work() const { return edges_ + size_; }

 private:
  static constexpr std::uint32_t kFree = 0xffffffffU;
  static constexpr std::size_t kFirstSize = 16;
  [[nodiscard]] std::size_t slot(std::span<const std::uint64_t> front) const;
  [[nodiscard]] bool is_at(std::uint32_t i, std::span<const std::uint64_t> front) const;
  void grow();

  std::size_t words_ = 0, edges_ = 0;
  std::uint32_t size_ = 0;
  Bits bits_;
  std::vector<std::uint32_t> slots_;
  std::optional<std::uint32_t> empty_;
};

// Where the front is, or would be. Multiplicative hashing (Knuth, The Art of Computer Programming 3, 6.4).
std::size_t FrontList::slot(std::span<const std::uint64_t> front) const {
  std::uint64_t hash = 0;
  for (const std::uint64_t word : front) hash = std::rotl((hash ^ word) * 0x9e3779b97f4a7c15ULL, 29);
  const std::size_t mask = slots_.size() - 1;
  std::size_t i = static_cast<std::size_t>(hash * 0x9e3779b97f4a7c15ULL >> 32) & mask;
  while (slots_[i] != kFree && !is_at(slots_[i], front)) i = (i + 1) & mask;
  return i;
}

bool FrontList::is_at(std::uint32_t i, std::span<const std::uint64_t> front) const {
  std::uint64_t difference = 0;
  for (std::size_t w = 0; w < words_; ++w) difference |= bits_[i * words_ + w] ^ front[w];
  return difference == 0;
}

void FrontList::grow() {
  slots_.assign(2 * slots_.size(), kFree);
  for (std::uint32_t i = 0; i < size_; ++i) slots_[slot((*this)[i])] = i;
}

std::uint32_t FrontList::number(std::span<const std::uint64_t> front) {
  const std::size_t at = slot(front);
  if (slots_[at] != kFree) return slots_[at];
  const std::uint32_t fresh = size_++;
  std::size_t edges = 0;
  for (const std::uint64_t word : front) edges += static_cast<std::size_t>(std::popcount(word));
  if (edges == 0) empty_ = fresh;
  edges_ += edges;
  bits_.insert(bits_.end(), front.begin(), front.end());
  slots_[at] = fresh;
  if (std::size_t{2} * size_ > slots_.size()) grow();
  return fresh;
}

}  // namespace

class FrontFinder::Search {
 public:
  explicit Search(const Candidates& candidates) : candidates_(candidates) {}

  void start(std::size_t face) {
    triangles_ = candidates_.faces.row(face);
    number_edges();
    words_ = (2 * edges_.size() + 63) / 64;
    note_conflicts();
    group_triangles();
  }
  [[nodiscard]] std::optional<FrontGraph> find_fronts(const FrontOptions& options);
  [[nodiscard]] FaceOrders sweep(const FrontGraph& graph) const;

 private:
  /// Of the face: twice the edge's number here, plus 1 as in FixedFaces.
  using Side = std::uint32_t;

  void number_edges();
  void sort_along();
  void note_conflicts();
  void group_triangles();
  [[nodiscard]] std::optional<std::uint32_t> number_of(std::uint32_t edge) const;
  const Bits& first_front();
  [[nodiscard]] Side lowest(std::span<const std::uint64_t> front) const;
  /// Whether the triangle fits; `next` is what it leaves of the front, if so.
  bool cover(std::span<const std::uint64_t> front, std::uint32_t triangle, Bits& next) const;
  [[nodiscard]] std::uint32_t order(std::uint32_t i) const {
    return candidates_.triangles[triangles_[i]].order;
  }

  const Candidates& candidates_;
  std::span<const std::uint32_t> triangles_;
  std::size_t words_ = 0;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges_;  ///< (edge, its number here), ascending
  std::vector<std::array<Side, 3>> sides_;                      ///< by triangle of the face
  Bits conflicts_;  ///< by edge: what of a front the edge cannot enter; all if it is fixed
  std::vector<std::uint32_t> first_on_;  ///< by side: its first triangle
  std::vector<std::uint32_t> on_;        ///< triangles of the face, by side, ascending
  // Of one step.
  std::vector<std::uint32_t> along_, next_on_;
  FrontList fronts_;
  std::vector<Arc> arcs_;
  Bits next_;
};

// Edges of the face are sorted by their end that comes first along the face, then by the other one.
void FrontFinder::Search::sort_along() {
  std::vector<std::uint32_t>& edges = along_;
  const auto point = [&](VertexId v) { return candidates_.points[v.index()]; };
  Point2 low = point(candidates_.edges[edges[0]].a), high = low;
  for (const std::uint32_t e : edges) {
    for (const Point2 p : {point(candidates_.edges[e].a), point(candidates_.edges[e].b)}) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
  }
  const bool along_x = high.x - low.x >= high.y - low.y;
  using Place = std::pair<double, double>;
  std::vector<std::tuple<Place, Place, std::uint32_t>> keys;
  keys.reserve(edges.size());
  for (const std::uint32_t e : edges) {
    const Point2 a = point(candidates_.edges[e].a), b = point(candidates_.edges[e].b);
    const Place at_a = along_x ? Place(a.x, a.y) : Place(a.y, a.x);
    const Place at_b = along_x ? Place(b.x, b.y) : Place(b.y, b.x);
    keys.emplace_back(std::min(at_a, at_b), std::max(at_a, at_b), e);
  }
  std::sort(keys.begin(), keys.end());
  for (std::size_t i = 0; i < edges.size(); ++i) edges[i] = std::get<2>(keys[i]);
}

void FrontFinder::Search::number_edges() {
  constexpr std::size_t kSmall = 24;  // triangles: fewer have so few fronts that order does not matter
  along_.clear();
  for (const std::uint32_t t : triangles_) {
    for (const std::uint32_t side : candidates_.sides[t]) along_.push_back(side / 2);
  }
  std::sort(along_.begin(), along_.end());
  along_.erase(std::unique(along_.begin(), along_.end()), along_.end());
  const bool large = triangles_.size() > kSmall;
  if (large) sort_along();
  edges_.clear();
  for (std::uint32_t i = 0; i < along_.size(); ++i) edges_.emplace_back(along_[i], i);
  if (large) std::sort(edges_.begin(), edges_.end());
  sides_.clear();
  for (const std::uint32_t t : triangles_) {
    std::array<Side, 3>& here = sides_.emplace_back();
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t side = candidates_.sides[t][corner];
      here[corner] = 2 * *number_of(side / 2) + side % 2;
    }
  }
}

// None if it is no edge of a triangle of the face.
std::optional<std::uint32_t> FrontFinder::Search::number_of(std::uint32_t edge) const {
  const auto at = std::lower_bound(edges_.begin(), edges_.end(), std::pair(edge, std::uint32_t{0}));
  return at != edges_.end() && at->first == edge ? std::optional(at->second) : std::nullopt;
}

void FrontFinder::Search::note_conflicts() {
  conflicts_.assign(edges_.size() * words_, 0);
  for (const auto& [edge, number] : edges_) {
    std::uint64_t* const row = &conflicts_[number * words_];
    const auto add = [&](std::uint32_t other) { row[other / 32] |= std::uint64_t{3} << (2 * (other % 32)); };
    if (!candidates_.edges[edge].free) std::fill_n(row, words_, ~std::uint64_t{0});
    add(number);
    for (const std::uint32_t crossed : candidates_.crossings.row(edge)) {
      if (const auto other = number_of(crossed)) add(*other);
    }
  }
}

void FrontFinder::Search::group_triangles() {
  first_on_.assign(2 * edges_.size() + 1, 0);
  for (const auto& sides : sides_) {
    for (const Side side : sides) ++first_on_[side + 1];
  }
  for (std::size_t i = 1; i < first_on_.size(); ++i) first_on_[i] += first_on_[i - 1];
  on_.resize(first_on_.back());
  next_on_.assign(first_on_.begin(), first_on_.end() - 1);
  for (std::uint32_t i = 0; i < sides_.size(); ++i) {
    for (const Side side : sides_[i]) on_[next_on_[side]++] = i;
  }
}

const Bits& FrontFinder::Search::first_front() {
  next_.assign(words_, 0);
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      if (candidates_.edges[candidates_.sides[triangles_[i]][corner] / 2].free) continue;
      next_[sides_[i][corner] / 64] |= std::uint64_t{1} << (sides_[i][corner] % 64);
    }
  }
  return next_;
}

// Pre: the front is not empty.
FrontFinder::Search::Side FrontFinder::Search::lowest(std::span<const std::uint64_t> front) const {
  std::size_t word = 0;
  while (front[word] == 0) ++word;
  return static_cast<Side>(64 * word + static_cast<std::size_t>(std::countr_zero(front[word])));
}

bool FrontFinder::Search::cover(std::span<const std::uint64_t> front, std::uint32_t triangle,
                                Bits& next) const {
  next.assign(front.begin(), front.end());
  for (const Side side : sides_[triangle]) {
    const std::uint64_t bit = std::uint64_t{1} << (side % 64);
    if ((front[side / 64] & bit) != 0) {
      next[side / 64] &= ~bit;
      continue;
    }
    const std::uint64_t* const conflicts = &conflicts_[side / 2 * words_];
    for (std::size_t w = 0; w < words_; ++w) {
      if ((front[w] & conflicts[w]) != 0) return false;
    }
    next[side / 64] |= std::uint64_t{1} << ((side ^ 1U) % 64);
  }
  return true;
}

std::optional<FrontGraph> FrontFinder::Search::find_fronts(const FrontOptions& options) {
  fronts_.start(words_);
  arcs_.clear();
  fronts_.number(first_front());
  // Each front is reached by as many triangles on every path, so those that are found first have fewer.
  for (std::uint32_t f = 0; f < fronts_.size(); ++f) {
    if (fronts_.work() > options.work_limit) return std::nullopt;
    if (fronts_.find_empty() == f) continue;
    const Side side = lowest(fronts_[f]);
    for (std::uint32_t at = first_on_[side]; at < first_on_[side + 1]; ++at) {
      const std::uint32_t triangle = on_[at];
      if (!options.usable.empty() && options.usable[triangle] == 0) continue;
      if (cover(fronts_[f], triangle, next_)) arcs_.push_back({f, fronts_.number(next_), triangle});
    }
  }
  return FrontGraph{fronts_.size(), fronts_.find_empty(), {arcs_.begin(), arcs_.end()}, fronts_.work()};
}

FaceOrders FrontFinder::Search::sweep(const FrontGraph& graph) const {
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
  FaceOrders orders{behind[0], std::vector<std::uint32_t>(triangles_.size(), kUnreachable)};
  for (const Arc& arc : arcs) {
    std::uint32_t& least = orders.with_triangle[arc.triangle];
    least = std::min(least, std::max({before[arc.from], order(arc.triangle), behind[arc.to]}));
  }
  return orders;
}

FrontFinder::FrontFinder(const Candidates& candidates) : search_(std::make_unique<Search>(candidates)) {}
FrontFinder::~FrontFinder() = default;

std::optional<FrontGraph> FrontFinder::find(std::size_t face, const FrontOptions& options) {
  search_->start(face);
  return search_->find_fronts(options);
}

std::optional<FaceOrders> FrontFinder::find_orders(std::size_t face, std::size_t work_limit) {
  const auto graph = find(face, {.work_limit = work_limit});
  if (!graph) return std::nullopt;
  return search_->sweep(*graph);
}

}  // namespace thalweg::detail

namespace thalweg {

std::optional<FrontGraph> find_fronts(const FixedFaces& faces, std::size_t face,
                                      const FrontOptions& options) {
  return detail::FrontFinder(faces).find(face, options);
}

}  // namespace thalweg
