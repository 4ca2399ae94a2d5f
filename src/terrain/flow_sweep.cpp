// Which area drains to each channel and vertex first, and to each sink.
//
// 1. From both sides of each channel a strip of all water that comes to it first is followed upwards. Where
//    it meets a high corner it parts; above a low corner it is a part of the side. Strips never meet, so
//    blocks of channels are done side by side, and each sums up its ground by itself: sums do not depend on
//    threads.
// 2. The strips of a block wait in one queue, and are taken from it in batches: what is computed of one does
//    not wait for what was computed of others. All are treated alike, in loops over columns without branches,
//    which could not be foreseen.
// 3. Water on a level triangle comes to its low corner.
#include "base/parallel.hpp"
#include "base/prefetch.hpp"
#include "terrain/flow_graph.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace thalweg {

namespace {

constexpr std::size_t kBlock = 4096;
constexpr std::size_t kSweptAtOnce = 512;  // nodes whose triangles and strips stay in a core's cache
constexpr std::size_t kBatch = 64;
using Column = std::array<double, kBatch>;
/// Strips of water that come to an Out side of a triangle, and how the triangle parts them.
///
/// What comes to the side below its middle came over one other side (of number 0), what comes above it over
/// another (of number 1). Beside a low corner, where all came over the split side, the middle is an end.
/// Of flags 1 is yes, 0 no.
struct Batch {
  // Given.
  Column low, high;   ///< shares of the way along the side's twin
  Column at, area;    ///< of the triangle
  Column low_corner;  ///< the side is beside a low corner ...
  Column before;      ///< ... and comes before the split side
  // Found: the part of the strip that came over each side, as shares of its way.
  std::array<Column, 2> begin, end;
  /// A sum: 1, 2 if there is such a part of number 0, 1; 4, 8 if that begins at the side's origin; 16 if the
  /// strip holds the middle, 32 if it begins there, at a high corner's line.
  Column found;
  Column ground;  ///< area of the strip in the triangle
  // Between.
  Column middle, scale_0, scale_1;
};

// The choice is made before sanitizers are ready.
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__) && \
    !defined(__SANITIZE_ADDRESS__)
[[gnu::target_clones("default", "avx2", "avx512f")]]
#endif
void part(Batch& batch) {
  // Loops of their own, and flags as numbers, so that GCC 12 makes vector instructions of them.
  for (std::size_t i = 0; i < kBatch; ++i) {
    const double top = 1 - batch.at[i];
    batch.middle[i] = top;
    batch.scale_0[i] = 1 / top;
    batch.scale_1[i] = 1 / (1 - top);
  }
  for (std::size_t i = 0; i < kBatch; ++i) {
    const double at = batch.at[i], top = batch.middle[i], below = batch.scale_0[i], above = batch.scale_1[i];
    const bool low_corner = batch.low_corner[i] != 0;
    batch.middle[i] = low_corner ? batch.before[i] : top;
    batch.scale_0[i] = low_corner ? at : below;  // by what shares grow on the way to each side
    batch.scale_1[i] = low_corner ? top : above;
  }
  for (std::size_t i = 0; i < kBatch; ++i) {
    // The area of a strip is the difference of squares of the distances from the end of the side.
    const double low = batch.low[i], high = batch.high[i], middle = batch.middle[i];
    const double to = std::min(high, middle), from = std::max(low, middle);
    const double doubled_0 = std::max(to - low, 0.0) * (to + low);
    const double doubled_1 = std::max(high - from, 0.0) * (2 - from - high);
    batch.ground[i] = batch.area[i] * (batch.scale_0[i] * doubled_0 + batch.scale_1[i] * doubled_1);
  }
  for (std::size_t i = 0; i < kBatch; ++i) {
    const double end = batch.low_corner[i] != 0 ? batch.at[i] : 1.0;
    const double low = batch.low[i] * batch.scale_0[i], high = batch.high[i] * batch.scale_0[i];
    const double inner = std::min(high, end);
    batch.begin[0][i] = std::min(low, end);
    batch.end[0][i] = batch.high[i] < batch.middle[i] ? inner : end;
  }
  for (std::size_t i = 0; i < kBatch; ++i) {
    const double begin = batch.low_corner[i] * batch.at[i];
    const double middle = batch.middle[i], from = std::max(batch.low[i], middle);
    const double low = begin + (from - middle) * batch.scale_1[i];
    const double high = begin + (batch.high[i] - middle) * batch.scale_1[i];
    const double inner = std::min(high, 1.0);
    batch.begin[1][i] = std::min(low, 1.0);
    batch.end[1][i] = batch.high[i] < 1 ? inner : 1.0;
  }
  for (std::size_t i = 0; i < kBatch; ++i) {
    const double below = batch.low[i] < batch.middle[i] ? 1.0 : 0.0;
    const double above = batch.high[i] > batch.middle[i] ? 1.0 : 0.0;
    const double part_0 = batch.begin[0][i] < batch.end[0][i] ? below : 0.0;
    const double part_1 = batch.begin[1][i] < batch.end[1][i] ? above : 0.0;
    const double first_0 = batch.begin[0][i] == 0 ? part_0 : 0.0;
    const double first_1 = batch.begin[1][i] == 0 ? part_1 : 0.0;
    const double at_end = batch.high[i] == 1 ? batch.before[i] : 0.0;
    const double middle = batch.low[i] <= batch.middle[i] ? std::max(above, at_end) : 0.0;
    const double begins = batch.low[i] == batch.middle[i] ? 1 - batch.low_corner[i] : 0.0;
    batch.found[i] = part_0 + 2 * part_1 + 4 * first_0 + 8 * first_1 + 16 * middle + 32 * begins;
  }
}

/// Follows the strips of a block of channels.
class Sweep {
 public:
  explicit Sweep(FlowGraph& graph)
      : graph_(graph), targets_({&elsewhere_, graph.target.data()}), streams_(4 * kSweptAtOnce) {}
  Sweep(const Sweep&) = delete;
  Sweep& operator=(const Sweep&) = delete;
  ~Sweep() = default;

  /// The grounds of the channels of these numbers.
  void run(std::size_t begin, std::size_t end) {
    count_ = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const auto node = static_cast<FlowNode>(i);
      graph_.ground[i] = 0;
      if (graph_.is_vertex(node)) continue;
      const HalfedgeId h = graph_.channel_of(node).edge, twin = graph_.mesh.twin(h);
      streams_[count_] = {h, node, 0, 1};
      count_ += graph_.fall(h) == Fall::Out ? 1 : 0;
      streams_[count_] = {twin, node, 0, 1};
      count_ += twin.valid() && graph_.fall(twin) == Fall::Out ? 1 : 0;
    }
    for (std::size_t next = 0; next < count_;) {
      const std::size_t stop = std::min(next + kBatch, count_);
      if (streams_.size() < count_ + 2 * kBatch) streams_.resize(2 * streams_.size());
      load(next, stop);
      part(batch_);
      for (std::size_t i = 0; next + i < stop; ++i) climb(streams_[next + i], i);
      next = stop;
    }
  }

  [[nodiscard]] std::vector<HalfedgeId>& touching() { return touching_; }

 private:
  /// Water that comes to a node, and runs over `side` out of its triangle.
  struct Stream {
    HalfedgeId side;
    FlowNode node;
    double low, high;
  };

  void load(std::size_t begin, std::size_t end) {
    for (std::size_t i = 0; begin + i < end; ++i) {
      if (begin + i + kBatch < count_) ask_for(streams_[begin + i + kBatch].side);
      const Stream& stream = streams_[begin + i];
      const std::size_t t = stream.side.index() / 3, side = stream.side.index() - 3 * t;
      const TriangleShape shape = graph_.shape[t];
      batch_.low[i] = stream.low;
      batch_.high[i] = stream.high;
      batch_.at[i] = graph_.strips[t].at;
      batch_.area[i] = graph_.strips[t].area;
      const int low_corner = shape.corner_is_low;
      batch_.low_corner[i] = low_corner;
      batch_.before[i] = low_corner & (side == kPreviousSide[shape.split] ? 1 : 0);
    }
  }

  /// What a strip that comes to its turn in the next batch will need.
  void ask_for(HalfedgeId side) const {
    prefetch(&graph_.strips[side.index() / 3]);
    prefetch(&graph_.shape[side.index() / 3]);
    prefetch(&graph_.target[side.index()]);
    graph_.mesh.ask_for_twin(side);
  }

  void climb(const Stream& stream, std::size_t i) {
    const FlowNode node = stream.node;
    const std::size_t t = stream.side.index() / 3, first = 3 * t, side = stream.side.index() - first;
    const TriangleShape shape = graph_.shape[t];
    const std::size_t low = shape.corner_is_low, split = shape.split;
    graph_.ground[node] += batch_.ground[i];
    const Visit visit{first, node, static_cast<unsigned>(static_cast<int>(batch_.found[i])), i};
    set_target(stream.side.index(), node, visit.found >> 4U & 1U);
    if (visit.found >> 5U != 0) touching_.push_back(stream.side);
    const std::array<std::size_t, 2> over_0 = {kNextSide[side], split}, over_1 = {kPreviousSide[side], split};
    come_over(over_0[low], visit, 0);
    come_over(over_1[low], visit, 1);
  }

  /// A strip in a triangle.
  struct Visit {
    std::size_t first;  ///< side of the triangle
    FlowNode node;
    unsigned found;  ///< as in the batch ...
    std::size_t i;   ///< ... at this place
  };

  void come_over(std::size_t side, const Visit& visit, unsigned part) {
    set_target(visit.first + side, visit.node, visit.found >> (2 + part) & 1U);
    streams_[count_] = {graph_.mesh.twin(HalfedgeId{visit.first + side}), visit.node,
                        batch_.begin[part][visit.i], batch_.end[part][visit.i]};
    count_ += visit.found >> part & graph_.inflow_sides[visit.first / 3] >> side & 1U;
  }

  void set_target(std::size_t h, FlowNode node, std::size_t really) { targets_[really][h & -really] = node; }

  FlowGraph& graph_;
  FlowNode elsewhere_ = kNoNode;
  std::array<FlowNode*, 2> targets_;  // so that one is set, or not, without a jump
  RawVector<Stream> streams_;
  std::size_t count_ = 0;
  std::vector<HalfedgeId> touching_;
  Batch batch_{};
};

}  // namespace

void sweep_grounds(FlowGraph& graph, const Progress& progress) {
  graph.ground.resize(graph.node_count());
  std::vector<std::vector<HalfedgeId>> touching(graph.node_count() / kBlock + 1);
  for_each_block(graph.node_count(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    Sweep sweep(graph);
    for (std::size_t i = begin; i < end; i += kSweptAtOnce) sweep.run(i, std::min(end, i + kSweptAtOnce));
    touching[begin / kBlock] = std::move(sweep.touching());
  });
  for (const auto& part : touching) graph.touching.insert(graph.touching.end(), part.begin(), part.end());
  for (std::size_t t = 0; t < graph.mesh.triangle_count(); ++t) {
    if (!graph.level(TriangleId{t})) continue;
    graph.ground[graph.node_of(graph.low_corner(TriangleId{t}))] += graph.strips[t].area;
  }
}

void add_up_sinks(FlowGraph& graph, const Progress& progress) {
  graph.sink_of_node.resize(graph.node_count());
  for_each_block(graph.node_count(), kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto node = static_cast<FlowNode>(i);
      const bool vertex = graph.is_vertex(node);
      const bool leaves = !vertex && graph.channel_of(node).on_rim;
      const VertexId v = vertex ? graph.vertex_of(node) : graph.channel_of(node).low;
      graph.sink_of_node[i] = leaves ? graph.rim_sink[v.index()] : graph.sink[v.index()];
    }
  });
  for (std::size_t node = 0; node < graph.ground.size(); ++node) {
    const double area = graph.ground[node];
    if (area > 0) graph.sinks[graph.sink_of_node[node]].area += area;
  }
}

}  // namespace thalweg
