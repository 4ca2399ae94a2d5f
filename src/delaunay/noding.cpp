// Noding by snap rounding about the vertices themselves.
//
// The unit is a pixel, 2^9 units in the last place of the largest coordinate. Round r = 0, 1, ... works with
// a grid of width g = pixel / 2^(r + 1); the cell of a vertex v is v + K, K = [-g/2, g/2)^2. A round:
//   1. Links are the distinct pieces of all chains. Find each crossing of two links, and each pair of a link
//      and a vertex, no end of it, whose cell it meets. If r > 0, no links cross and no vertex lies on a
//      link, the work is done.
//   2. A crossing that lies in no vertex's cell gets a vertex of its own: the grid node nearest to it.
//   3. Each link is rerouted through every vertex whose cell it meets, in the order in which it enters them.
//      Where cells overlap a chain may come back to a vertex; such loops are cut off.
// Searches use a tree of boxes (box_tree.hpp); every decision is exact (segments.hpp). A link that was one of
// the round before, and met no cell then, meets no smaller one now, and crosses no other such link: where
// they crossed there was a cell. So from the second round on only links that are new are looked at, among
// all.
//
// Why links then do not cross, as long as the cells are disjoint. Shrink every cell m + K to its centre: at
// time t it is m + (1 - t) K, and what lies in it shrinks with it. A part of a link between two cells, from p
// (where it leaves m + K) to q (where it enters n + K), stays straight, from p + t (m - p) to q + t (n - q).
// At time 0 all crossings lie inside cells, and inside a cell shrinking keeps all crossings as they are.
// Suppose the outer part of a link touches a shrunken cell w + (1 - t) K, in its point of parameter s: then
//   (1 - s) p + s q - t k = w + (1 - t) k'   with k = (1 - s) (p - m) + s (q - n),
// where k, by convexity, and k' lie in K. So (1 - s) p + s q = w + t k + (1 - t) k' lies in w + K: the link
// met that cell there, between p and q, so m and n were not successive. Hence no outer part ever touches a
// cell but its own two, in particular no end of another outer part, and outer parts that did not cross at
// time 0 do not at time 1, when they are the new links. (Half-open cells behave as closed ones moved by an
// infinitesimal. Hobby, Practical segment intersection with finite precision output, 1999, and Guibas,
// Marimont, Rounding arrangements dynamically, 1998, prove this for the cells of one grid; centring cells on
// vertices lets vertices off the grid stay where they are.)
//
// Cells of grid nodes tile the plane. Two cells overlap only where a vertex off the grid is closer than g to
// another vertex; there a crossing, or a vertex on a link, may remain. So the outcome is checked exactly, and
// the next round repeats all with half the width, in which fewer cells overlap. From the tenth round on, g is
// finer than the doubles about the largest coordinates are spaced; cells there stay as wide as that spacing,
// and are those of the grid of all doubles, so they tile the plane too. So rounds end, unless vertices close
// to the origin in both x and y are closer together than 2^-41 pixels: that is reported as a failure.
//
// A round moves a point of a link by at most half a cell's diagonal. The first nine rounds add up to less
// than pixel / sqrt 2, the others to at most 31 units in the last place, or 0.05 pixel: together less than a
// pixel.
#include "noding.hpp"

#include "base/ordered_blocks.hpp"
#include "box_tree.hpp"
#include "spatial_order.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/geometry/predicates.hpp>

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <utility>

namespace thalweg {

namespace {

constexpr int kRounds = 40;
constexpr int kPixelBits = 44;  // a pixel is 2^-44 of the power of two above the largest coordinate
constexpr std::size_t kBlock = 1 << 11;
// Each crossing may become a vertex: so many would need more than 20 GiB.
constexpr std::size_t kMostCrossings = std::size_t{1} << 26U;
// A link that runs along others stops at their ends; each crossing makes two stops.
constexpr std::size_t kMostStops = 2 * kMostCrossings;
constexpr std::size_t kNowhere = std::numeric_limits<std::size_t>::max();

// A link whose way leads through the cell of a vertex.
struct Stop {
  std::uint32_t link = 0;
  std::uint32_t vertex = 0;
  bool on_link = false;  // exactly
};

using LinkPair = std::array<std::uint32_t, 2>;

/// Holds the cell.
Box2 box_of(const Cell& cell) {
  return box_around(cell.centre, std::max(cell.half_x, cell.half_y));
}

// Counts what all threads find together, and gives up where it is too much.
class Tally {
 public:
  Tally(std::size_t most, const char* what) : most_(most), what_(what) {}
  void add(std::size_t found) {
    if (count_.fetch_add(found, std::memory_order_relaxed) + found <= most_) return;
    throw Error(ErrorCode::SizeLimit, std::string("the lines ") + what_ + " more than " +
                                          std::to_string(most_) +
                                          " times; thin them out, or read them in parts (--bbox)");
  }

 private:
  std::size_t most_;
  const char* what_;
  std::atomic<std::size_t> count_ = 0;
};

class Noder {
 public:
  Noder(std::span<const Point2> vertices, std::span<const SegmentEnds> segments, Progress& progress,
        double least_pixel)
      : xy_(vertices.begin(), vertices.end()),
        given_(vertices.size()),
        pixel_(snapping_pixel(vertices, least_pixel)),
        progress_(progress) {
    first_node_.reserve(segments.size() + 1);
    for (const SegmentEnds& ends : segments) {
      first_node_.push_back(nodes_.size());
      nodes_.push_back(ends[0]);
      if (ends[1] != ends[0]) nodes_.push_back(ends[1]);
    }
    first_node_.push_back(nodes_.size());
  }

  Noding run() {
    progress_.start_phase("noding lines");
    for (int round = 0;; ++round) {
      progress_.advance(1 - std::ldexp(1.0, -round));
      // The check after the last round is exact; the width plays no part in it.
      const double grid = std::ldexp(pixel_, -1 - std::min(round, kRounds - 1));
      collect_links();
      BoxTree tree = segment_tree(links_, progress_);
      tree.note_ends(ends_);
      const std::vector<LinkPair> crossings = find_crossings(tree);
      std::vector<Stop> stops = round == 0 ? find_stops(tree, {}, 0, grid) : find_stops_of_new(grid);
      const auto contact = std::find_if(stops.begin(), stops.end(), [](const Stop& s) { return s.on_link; });
      if (crossings.empty() && (round == 0 ? stops.empty() : contact == stops.end())) return finish();
      if (round == kRounds) return fail(crossings, contact == stops.end() ? nullptr : &*contact);
      add_crossing_vertices(tree, crossings, stops, grid);
      reroute(stops, grid);
      keep_quiet(stops);
    }
  }

 private:
  // The distinct links of all chains, each from its lexicographically smaller end, and for each step of a
  // chain its link.
  void collect_links() {
    struct Step {
      std::uint32_t from, to;
      std::size_t node;
    };
    std::vector<Step> steps;
    steps.reserve(nodes_.size());
    for (std::size_t s = 0; s + 1 < first_node_.size(); ++s) {
      for (std::size_t i = first_node_[s]; i + 1 < first_node_[s + 1]; ++i) {
        const auto [from, to] = std::pair(nodes_[i], nodes_[i + 1]);
        steps.push_back(xy_[from] < xy_[to] ? Step{from, to, i} : Step{to, from, i});
      }
    }
    tbb::parallel_sort(steps.begin(), steps.end(), [](const Step& p, const Step& q) {
      return std::tie(p.from, p.to, p.node) < std::tie(q.from, q.to, q.node);
    });
    ends_.clear();
    links_.clear();
    new_.clear();
    link_of_step_.assign(nodes_.size(), 0);
    for (const Step& step : steps) {
      const SegmentEnds ends{step.from, step.to};
      if (ends_.empty() || ends_.back() != ends) {
        ends_.push_back(ends);
        links_.push_back({xy_[step.from], xy_[step.to]});
        new_.push_back(!std::binary_search(quiet_.begin(), quiet_.end(), ends));
      }
      link_of_step_[step.node] = static_cast<std::uint32_t>(ends_.size() - 1);
    }
  }

  // Pre: `stops` in order of links.
  void keep_quiet(std::span<const Stop> stops) {
    quiet_.clear();
    for (std::uint32_t link = 0; link < ends_.size(); ++link) {
      std::size_t count = 0;
      while (count < stops.size() && stops[count].link == link) ++count;
      if (count == 0) quiet_.push_back(ends_[link]);
      stops = stops.subspan(count);
    }
  }

  [[nodiscard]] bool is_end(std::uint32_t link, std::uint32_t vertex) const {
    return ends_[link][0] == vertex || ends_[link][1] == vertex;
  }

  [[nodiscard]] std::vector<LinkPair> find_crossings(const BoxTree& tree) const {
    Tally tally(kMostCrossings, "cross each other");
    const auto list = [&](std::size_t begin, std::size_t end, std::vector<LinkPair>& found) {
      for (std::size_t i = begin; i < end; ++i) {
        const std::uint32_t one = tree.item(i);
        if (!new_[one]) continue;
        const std::size_t before = found.size();
        tree.visit_apart(ends_[one], tree.box(i), [&](std::uint32_t other) {
          if (other == one || (new_[other] && other < one)) return;
          if (is_end(one, ends_[other][0]) || is_end(one, ends_[other][1])) return;
          const auto& [a, b] = links_[one];
          const auto& [c, d] = links_[other];
          if (cross_properly(a, b, c, d)) {
            found.push_back({std::min(one, other), std::max(one, other)});
          }
        });
        tally.add(found.size() - before);
      }
    };
    auto crossings = list_in_order<LinkPair>(tree.size(), kBlock, progress_, list);
    std::sort(crossings.begin(), crossings.end());
    crossings.erase(std::unique(crossings.begin(), crossings.end()), crossings.end());
    return crossings;
  }

  // Vertices from `first` on that may lie near a link, along a curve: what the search about one of them reads
  // is at hand for the next.
  [[nodiscard]] std::vector<std::uint32_t> find_near(const BoxTree& tree, std::size_t first,
                                                     double grid) const {
    const auto list = [&](std::size_t begin, std::size_t end, std::vector<std::uint32_t>& found) {
      for (std::size_t v = first + begin; v < first + end; ++v) {
        if (tree.may_meet(box_of({xy_[v], grid}))) found.push_back(static_cast<std::uint32_t>(v));
      }
    };
    const auto near = list_in_order<std::uint32_t>(xy_.size() - first, kBlock, progress_, list);
    std::vector<Point2> positions(near.size());
    for (std::size_t i = 0; i < near.size(); ++i) positions[i] = xy_[near[i]];
    std::vector<std::uint32_t> along = coarse_hilbert_order(positions, progress_);
    for (std::uint32_t& i : along) i = near[i];
    return along;
  }

  // The stops at vertices from `first` on, in order of links. `links`: what the tree's items are; none:
  // links.
  [[nodiscard]] std::vector<Stop> find_stops(const BoxTree& tree, std::span<const std::uint32_t> links,
                                             std::size_t first, double grid) const {
    const std::vector<std::uint32_t> near = find_near(tree, first, grid);
    Tally tally(kMostStops, "run along each other or through vertices");
    const auto list = [&](std::size_t begin, std::size_t end, std::vector<Stop>& found) {
      for (std::size_t i = begin; i < end; ++i) {
        const std::size_t before = found.size();
        const std::uint32_t vertex = near[i];
        const Cell cell(xy_[vertex], grid);
        tree.visit(box_of(cell), [&](std::uint32_t item) {
          const std::uint32_t link = links.empty() ? item : links[item];
          if (is_end(link, vertex)) return;
          const bool on_link = on_segment(links_[link].a, links_[link].b, cell.centre);
          if (on_link || meets_cell(links_[link], cell)) {
            found.push_back({link, vertex, on_link});
          }
        });
        tally.add(found.size() - before);
      }
    };
    auto stops = list_in_order<Stop>(near.size(), kBlock, progress_, list);
    sort_stops(stops);
    return stops;
  }

  [[nodiscard]] std::vector<Stop> find_stops_of_new(double grid) const {
    std::vector<std::uint32_t> links;
    std::vector<Segment> segments;
    for (std::uint32_t link = 0; link < links_.size(); ++link) {
      if (!new_[link]) continue;
      links.push_back(link);
      segments.push_back(links_[link]);
    }
    return find_stops(segment_tree(segments, progress_), links, 0, grid);
  }

  static void sort_stops(std::vector<Stop>& stops) {
    const auto key = [](const Stop& s) { return std::pair(s.link, s.vertex); };
    std::sort(stops.begin(), stops.end(), [&](const Stop& p, const Stop& q) { return key(p) < key(q); });
    stops.erase(std::unique(stops.begin(), stops.end(),
                            [&](const Stop& p, const Stop& q) { return key(p) == key(q); }),
                stops.end());
  }

  static std::span<const Stop> stops_of(std::uint32_t link, std::span<const Stop> stops) {
    const auto before = [](const Stop& stop, std::uint32_t at) { return stop.link < at; };
    const auto from = std::lower_bound(stops.begin(), stops.end(), link, before);
    return {from, std::lower_bound(from, stops.end(), link + 1, before)};
  }

  // Step 2. Only cells that a link meets can hold its crossings.
  void add_crossing_vertices(const BoxTree& tree, std::span<const LinkPair> crossings,
                             std::vector<Stop>& stops, double grid) {
    const auto list = [&](std::size_t begin, std::size_t end, std::vector<Point2>& found) {
      for (std::size_t i = begin; i < end; ++i) {
        if (crosses_at_vertex(crossings[i], stops, grid)) continue;
        const auto [one, other] = crossings[i];
        found.push_back(round_crossing(links_[one], links_[other], grid));
      }
    };
    auto nodes = list_in_order<Point2>(crossings.size(), kBlock, progress_, list);
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    const std::size_t first_new = xy_.size();
    xy_.insert(xy_.end(), nodes.begin(), nodes.end());
    const std::vector<Stop> more = find_stops(tree, {}, first_new, grid);
    stops.insert(stops.end(), more.begin(), more.end());
    sort_stops(stops);
  }

  [[nodiscard]] bool crosses_at_vertex(const LinkPair& pair, std::span<const Stop> stops, double grid) const {
    const std::uint32_t one = pair[0], other = pair[1];
    const auto holds = [&](std::uint32_t vertex) {
      return crosses_in_cell(links_[one], links_[other], Cell(xy_[vertex], grid));
    };
    if (holds(ends_[one][0]) || holds(ends_[one][1])) return true;
    const std::span<const Stop> of_one = stops_of(one, stops);
    const std::span<const Stop> of_other = stops_of(other, stops);
    if (of_other.size() < of_one.size() && (holds(ends_[other][0]) || holds(ends_[other][1]))) return true;
    const std::span<const Stop> fewer = of_other.size() < of_one.size() ? of_other : of_one;
    return std::any_of(fewer.begin(), fewer.end(), [&](const Stop& stop) { return holds(stop.vertex); });
  }

  // Step 3. Pre: `stops` in order of links.
  void reroute(std::span<Stop> stops, double grid) {
    for (std::size_t from = 0; from < stops.size();) {
      progress_.check();
      std::size_t to = from;
      while (to < stops.size() && stops[to].link == stops[from].link) ++to;
      const Segment& link = links_[stops[from].link];
      std::sort(stops.begin() + from, stops.begin() + to, [&](const Stop& p, const Stop& q) {
        return enters_before(link, Cell(xy_[p.vertex], grid), Cell(xy_[q.vertex], grid));
      });
      from = to;
    }
    std::vector<std::uint32_t> nodes;
    std::vector<std::size_t> first_node;
    std::vector<std::size_t> place(xy_.size(), kNowhere);
    for (std::size_t s = 0; s + 1 < first_node_.size(); ++s) {
      first_node.push_back(nodes.size());
      for (std::size_t i = first_node_[s]; i < first_node_[s + 1]; ++i) {
        nodes.push_back(nodes_[i]);
        if (i + 1 < first_node_[s + 1]) append_stops(link_of_step_[i], nodes_[i], stops, nodes);
      }
      if (nodes.size() - first_node.back() > 2) cut_loops(first_node.back(), nodes, place);
    }
    first_node.push_back(nodes.size());
    nodes_ = std::move(nodes);
    first_node_ = std::move(first_node);
  }

  // Cuts each loop off the chain from `first` on, walking from its lexicographically smaller end, so that the
  // outcome does not depend on the chain's direction. `place` is scratch, kNowhere for all vertices.
  void cut_loops(std::size_t first, std::vector<std::uint32_t>& nodes,
                 std::vector<std::size_t>& place) const {
    const auto begin = nodes.begin() + static_cast<std::ptrdiff_t>(first);
    const bool backwards = xy_[nodes.back()] < xy_[*begin];
    if (backwards) std::reverse(begin, nodes.end());
    std::size_t end = first;
    for (std::size_t i = first; i < nodes.size(); ++i) {
      const std::uint32_t node = nodes[i];
      if (place[node] == kNowhere) {
        place[node] = end;
        nodes[end++] = node;
      } else {
        while (end > place[node] + 1) place[nodes[--end]] = kNowhere;
      }
    }
    nodes.resize(end);
    for (std::size_t i = first; i < end; ++i) place[nodes[i]] = kNowhere;
    if (backwards) std::reverse(begin, nodes.end());
  }

  // A chain may run along a link in either direction.
  void append_stops(std::uint32_t link, std::uint32_t from, std::span<const Stop> stops,
                    std::vector<std::uint32_t>& nodes) const {
    const std::span<const Stop> here = stops_of(link, stops);
    if (from == ends_[link][0]) {
      for (const Stop& stop : here) nodes.push_back(stop.vertex);
    } else {
      for (std::size_t i = here.size(); i-- > 0;) nodes.push_back(here[i].vertex);
    }
  }

  // New vertices of all rounds get their final numbers, by position; those on no chain any more vanish.
  Noding finish() {
    std::vector<bool> used(xy_.size() - given_);
    for (const std::uint32_t node : nodes_) {
      if (node >= given_) used[node - given_] = true;
    }
    std::vector<std::uint32_t> order;
    for (std::size_t i = 0; i < used.size(); ++i) {
      if (used[i]) order.push_back(static_cast<std::uint32_t>(given_ + i));
    }
    std::sort(order.begin(), order.end(), [&](auto i, auto j) { return xy_[i] < xy_[j]; });
    std::vector<std::uint32_t> number(used.size());
    Noding result;
    for (const std::uint32_t vertex : order) {
      number[vertex - given_] = static_cast<std::uint32_t>(given_ + result.crossings.size());
      result.crossings.push_back(xy_[vertex]);
    }
    for (std::uint32_t& node : nodes_) {
      if (node >= given_) node = number[node - given_];
    }
    result.first_node = std::move(first_node_);
    result.nodes = std::move(nodes_);
    result.pixel = pixel_;
    progress_.advance(1);
    return result;
  }

  [[nodiscard]] std::uint32_t segment_with(std::uint32_t link) const {
    std::size_t segment = 0;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      while (first_node_[segment + 1] <= i) ++segment;
      if (i + 1 < first_node_[segment + 1] && link_of_step_[i] == link) break;
    }
    return static_cast<std::uint32_t>(segment);
  }

  [[nodiscard]] Noding fail(std::span<const LinkPair> crossings, const Stop* contact) const {
    Noding result;
    result.pixel = pixel_;
    if (contact != nullptr) {
      const std::uint32_t segment = segment_with(contact->link);
      result.failure = {segment, segment, xy_[contact->vertex]};
    } else {
      const auto [one, other] = crossings.front();
      result.failure = {segment_with(one), segment_with(other), links_[one].a};
    }
    return result;
  }

  std::vector<Point2> xy_;
  std::size_t given_;
  double pixel_;
  Progress& progress_;
  // The chains so far, as in Noding.
  std::vector<std::size_t> first_node_;
  std::vector<std::uint32_t> nodes_;
  // The links of the round at hand.
  std::vector<SegmentEnds> ends_;
  std::vector<Segment> links_;
  std::vector<std::uint32_t> link_of_step_;
  std::vector<bool> new_;
  std::vector<SegmentEnds> quiet_;  // the links of the round before that had no stops, sorted
};

}  // namespace

double snapping_pixel(std::span<const Point2> positions, double least) {
  double largest = 0;
  for (const Point2 p : positions) largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
  int exponent = 0;
  std::frexp(largest, &exponent);
  const double pixel = largest > 0 ? std::ldexp(1.0, exponent - kPixelBits) : std::ldexp(1.0, -kPixelBits);
  return std::max(pixel, least);
}

Noding node_segments(std::span<const Point2> vertices, std::span<const SegmentEnds> segments,
                     Progress& progress, double least_pixel) {
  return Noder(vertices, segments, progress, least_pixel).run();
}

}  // namespace thalweg
