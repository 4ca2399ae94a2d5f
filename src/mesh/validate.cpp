// The laws of a TIN, checked.
//
// 1. What one vertex, one triangle or one halfedge shows alone is scanned in parallel; each scan keeps the
//    first few finds.
// 2. Where twins are given, each has to lead back and to join the same vertices, and no edge of the rim may
//    be there twice, in whatever direction. Then the rim alone tells overlap (3), and if there is none, no
//    two triangles lie on the same side of an edge, and no edge lacks a twin. Where that fails, or twins are
//    not given, halfedges are bucketed by origin: two with the same target break a law; the twin of a -> b is
//    looked up among those of b (by bisection where b has many).
// 3. Overlap, touching vertices and equal positions are told from the rim alone (rim_sweep.cpp); that holds
//    once all triangles are counter-clockwise and edges are used once a side. Crossed constraint edges need
//    no test: a constraint edge is an edge of a triangle, and triangles do not overlap.
// 4. The rim proves that all positions differ only where nothing is wrong; otherwise all vertices are
//    sorted.
#include "base/parallel.hpp"
#include "mesh/rim_sweep.hpp"
#include "mesh/used_vertices.hpp"

#include <thalweg/geometry/predicates.hpp>
#include <thalweg/mesh/validate.hpp>

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace thalweg {

namespace {

constexpr std::size_t kListed = 20;
constexpr std::size_t kBlock = 16384;

std::string name(VertexId v) {
  return std::to_string(v.value());
}
std::string name(VertexId a, VertexId b) {
  return name(a) + ", " + name(b);
}

// Halfedges by origin; among those of one vertex sorted by target.
class Fans {
 public:
  // Target in the upper half, halfedge in the lower one: sorted as a number, found without a look at
  // triangles.
  using Spoke = std::uint64_t;

  Fans() = default;
  // Pre: ids of triangles exist.
  Fans(std::span<const Triangle> triangles, std::size_t vertex_count)
      : start_(vertex_count + 1, 0), spokes_(3 * triangles.size()) {
    for (const Triangle& t : triangles) {
      for (const VertexId v : t) ++start_[v.index() + 1];
    }
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    std::vector<std::uint32_t> fill(start_.begin(), start_.end() - 1);
    std::size_t h = 0;
    for (const Triangle& t : triangles) {
      for (std::size_t i = 0; i < 3; ++i) spokes_[fill[t[i].index()]++] = spoke(t[i == 2 ? 0 : i + 1], h++);
    }
    for_each_block(vertex_count, kBlock, Progress(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        std::sort(spokes_.begin() + start_[v], spokes_.begin() + start_[v + 1]);
      }
    });
  }
  static VertexId target(Spoke s) { return VertexId{s >> 32}; }
  static HalfedgeId halfedge(Spoke s) { return HalfedgeId{s & 0xffffffffU}; }
  [[nodiscard]] std::span<const Spoke> of(VertexId v) const {
    return std::span(spokes_).subspan(start_[v.index()], start_[v.index() + 1] - start_[v.index()]);
  }
  // The first halfedge between the two, in this direction.
  [[nodiscard]] HalfedgeId find(VertexId from, VertexId to) const {
    constexpr std::size_t kFew = 32;  // up to here reading on beats bisection
    const std::span<const Spoke> fan = of(from);
    const Spoke least = spoke(to, 0);
    const auto at = fan.size() <= kFew
                        ? std::find_if(fan.begin(), fan.end(), [&](Spoke s) { return s >= least; })
                        : std::lower_bound(fan.begin(), fan.end(), least);
    return at != fan.end() && target(*at) == to ? halfedge(*at) : HalfedgeId{};
  }
  // The second of two halfedges from v to the same vertex, if there are any.
  [[nodiscard]] HalfedgeId find_repeated(VertexId v) const {
    const std::span<const Spoke> fan = of(v);
    const auto at =
        std::adjacent_find(fan.begin(), fan.end(), [](Spoke s, Spoke t) { return target(s) == target(t); });
    return at != fan.end() ? halfedge(*std::next(at)) : HalfedgeId{};
  }

 private:
  static Spoke spoke(VertexId to, std::size_t h) { return Spoke{to.value()} << 32 | h; }

  std::vector<std::uint32_t> start_;
  std::vector<Spoke> spokes_;
};

class Inspection {
 public:
  Inspection(const TinArrays& tin, std::span<const Point2> written, IsolatedVertices isolated)
      : tin_(tin), written_(written), isolated_policy_(isolated) {}

  std::vector<Violation> run() && {
    check_lengths();
    check_numbers();
    check_triangles();
    if (ids_exist_) {
      list_isolated();
      linked_ = plane_is_sound_ && tin_.constraints.empty() && twins_are_right() && rim_is_clean();
      if (!linked_) {
        fans_ = Fans(tin_.triangles, tin_.points.size());
        check_edges();
        check_constraints();
        if (plane_is_sound_) check_overlap(tin_.points, violation::kOverlap);
      }
      check_kinds();
      check_isolated();
      if (plane_is_sound_ && written_is_sound_) check_overlap(written_, violation::kOverlapInWritten);
    }
    if (!ids_exist_ || !plane_is_sound_) check_positions();
    std::stable_sort(violations_.begin(), violations_.end(),
                     [](const Violation& a, const Violation& b) { return a.code < b.code; });
    return std::move(violations_);
  }

 private:
  struct Finds {
    std::size_t count = 0;
    std::vector<std::size_t> first;
    void add(std::size_t i) {
      ++count;
      if (first.size() < kListed) first.push_back(i);
    }
  };

  // Indices in [0, count) for which `is_broken` holds, found on all threads.
  template <class IsBroken>
  static Finds find_broken(std::size_t count, const IsBroken& is_broken) {
    std::vector<Finds> blocks((count + kBlock - 1) / kBlock);
    for_each_block(count, kBlock, Progress(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (is_broken(i)) blocks[begin / kBlock].add(i);
      }
    });
    Finds all;
    for (const Finds& block : blocks) {
      all.count += block.count;
      for (const std::size_t i : block.first) {
        if (all.first.size() < kListed) all.first.push_back(i);
      }
    }
    return all;
  }

  // True if nothing was broken.
  template <class Describe>
  bool report(int code, const Finds& finds, const Describe& describe) {
    for (const std::size_t i : finds.first) violations_.push_back({code, describe(i)});
    if (finds.count > finds.first.size()) {
      violations_.push_back({code, "and " + std::to_string(finds.count - finds.first.size()) + " more"});
    }
    return finds.count == 0;
  }

  [[nodiscard]] std::string triangle_name(std::size_t t) const {
    const Triangle& corners = tin_.triangles[t];
    return "triangle " + std::to_string(t) + " (" + name(corners[0], corners[1]) + ", " + name(corners[2]) +
           ")";
  }
  [[nodiscard]] std::string edge_name(std::size_t h) const {
    return "edge " + name(origin(HalfedgeId{h}), target(HalfedgeId{h}));
  }

  void check_length(std::size_t length, std::size_t expected, const char* what) {
    if (length == expected) return;
    violations_.push_back({violation::kLengthsDiffer, std::to_string(length) + " " + what + " where " +
                                                          std::to_string(expected) + " belong"});
  }

  void check_lengths() {
    const std::size_t n = tin_.points.size();
    const std::size_t halfedges = 3 * tin_.triangles.size();
    check_length(tin_.heights.size(), n, "heights");
    if (!tin_.twins.empty()) check_length(tin_.twins.size(), halfedges, "twins");
    if (!tin_.kinds.empty()) check_length(tin_.kinds.size(), halfedges, "kinds");
    if (!written_.empty()) check_length(written_.size(), n, "written positions");
    has_written_ = !written_.empty() && written_.size() == n;
  }

  void check_numbers() {
    constexpr double kLimit = 1e100;
    const auto sound = [](double x) { return std::abs(x) < kLimit; };
    const auto broken = [&](std::size_t v) {
      if (v < tin_.heights.size() && !sound(tin_.heights[v])) return true;
      if (has_written_ && !(sound(written_[v].x) && sound(written_[v].y))) return true;
      return !(sound(tin_.points[v].x) && sound(tin_.points[v].y));
    };
    plane_is_sound_ =
        report(violation::kNotFinite, find_broken(tin_.points.size(), broken), [](std::size_t v) {
          return "vertex " + std::to_string(v) +
                 " has a coordinate or height that is not finite or too large";
        });
    numbers_are_sound_ = plane_is_sound_;
  }

  void check_triangles() {
    const auto& triangles = tin_.triangles;
    const auto ids_are_bad = [&](std::size_t t) {
      const Triangle& c = triangles[t];
      return c[0] == c[1] || c[1] == c[2] || c[2] == c[0] ||
             std::any_of(c.begin(), c.end(), [&](VertexId v) { return v.index() >= tin_.points.size(); });
    };
    ids_exist_ =
        report(violation::kBadTriangle, find_broken(triangles.size(), ids_are_bad), [&](std::size_t t) {
          return triangle_name(t) + " repeats a vertex or names one that does not exist";
        });
    const auto out_of_order = [&](std::size_t t) {
      const Triangle& c = triangles[t];
      return c[0] > c[1] || c[0] > c[2] || (t > 0 && !(triangles[t - 1] < c));
    };
    report(violation::kNotCanonical, find_broken(triangles.size(), out_of_order), [&](std::size_t t) {
      return triangle_name(t) + " does not start at its smallest vertex or is not above the one before it";
    });
    if (!ids_exist_ || !numbers_are_sound_) return;
    plane_is_sound_ = check_turns(tin_.points, violation::kNotCounterClockwise, "in the plane");
    if (has_written_) {
      written_is_sound_ = check_turns(written_, violation::kTurnedInWritten, "in the written coordinates");
    }
  }

  bool check_turns(std::span<const Point2> xy, int code, const char* where) {
    const auto turned = [&](std::size_t t) {
      const Triangle& c = tin_.triangles[t];
      return orientation(xy[c[0].index()], xy[c[1].index()], xy[c[2].index()]) <= 0;
    };
    return report(code, find_broken(tin_.triangles.size(), turned), [&](std::size_t t) {
      const Triangle& c = tin_.triangles[t];
      const bool flat = orientation(xy[c[0].index()], xy[c[1].index()], xy[c[2].index()]) == 0;
      return triangle_name(t) + (flat ? " is flat " : " is clockwise ") + where;
    });
  }

  [[nodiscard]] VertexId origin(HalfedgeId h) const { return tin_.triangles[h.index() / 3][h.index() % 3]; }
  [[nodiscard]] VertexId target(HalfedgeId h) const { return origin(Tin::next(h)); }
  // For each halfedge the one on the other side.
  [[nodiscard]] std::span<const HalfedgeId> opposites() const {
    return linked_ ? tin_.twins : std::span<const HalfedgeId>(opposite_);
  }

  [[nodiscard]] std::vector<RimEdge> rim_of(std::span<const HalfedgeId> opposite) const {
    std::vector<RimEdge> rim;
    for (std::size_t h = 0; h < opposite.size(); ++h) {
      if (!opposite[h].valid()) rim.push_back({origin(HalfedgeId{h}), target(HalfedgeId{h})});
    }
    return rim;
  }

  // Each leads back and joins the same vertices.
  [[nodiscard]] bool twins_are_right() const {
    if (tin_.twins.size() != 3 * tin_.triangles.size()) return false;
    const auto wrong = [&](std::size_t i) {
      const HalfedgeId h{i}, twin = tin_.twins[i];
      return twin.valid() && (twin.index() >= tin_.twins.size() || tin_.twins[twin.index()] != h ||
                              origin(twin) != target(h) || target(twin) != origin(h));
    };
    return find_broken(tin_.twins.size(), wrong).count == 0;
  }

  // Pre: twins_are_right().
  [[nodiscard]] bool rim_is_clean() {
    rim_ = rim_of(tin_.twins);
    std::vector<std::pair<VertexId, VertexId>> ends;
    for (const RimEdge& edge : rim_) ends.emplace_back(std::minmax({edge.from, edge.to}));
    std::sort(ends.begin(), ends.end());
    return std::adjacent_find(ends.begin(), ends.end()) == ends.end() &&
           sweep_rim(tin_.points, rim_, isolated_).empty();
  }

  void check_edges() {
    const std::size_t n = tin_.points.size();
    const auto repeats = [&](std::size_t v) { return fans_.find_repeated(VertexId{v}).valid(); };
    const bool once_a_side = report(violation::kSameSide, find_broken(n, repeats), [&](std::size_t v) {
      const std::size_t h = fans_.find_repeated(VertexId{v}).index();
      return "triangle " + std::to_string(h / 3) + " lies on the same side of " + edge_name(h) +
             " as another one";
    });
    plane_is_sound_ = plane_is_sound_ && once_a_side;
    if (!once_a_side) return;
    find_opposites();
    if (tin_.twins.size() == opposite_.size()) {
      const auto wrong = [&](std::size_t h) { return tin_.twins[h] != opposite_[h]; };
      report(violation::kTwinWrong, find_broken(opposite_.size(), wrong), [&](std::size_t h) {
        return "halfedge " + std::to_string(h) + " (" + edge_name(h) + ") has a wrong twin";
      });
    }
    rim_ = rim_of(opposite_);
  }

  void check_kinds() {
    const std::span<const HalfedgeId> opposite = opposites();
    if (tin_.kinds.size() != opposite.size()) return;
    const auto differ = [&](std::size_t h) {
      return opposite[h].index() < h && tin_.kinds[h] != tin_.kinds[opposite[h].index()];
    };
    report(violation::kKindsDiffer, find_broken(opposite.size(), differ),
           [&](std::size_t h) { return "the two sides of " + edge_name(h) + " differ in kind"; });
  }

  // Each pair is found once, from its smaller vertex; so no two threads write the same place.
  void find_opposites() {
    opposite_.assign(3 * tin_.triangles.size(), HalfedgeId{});
    for_each_block(tin_.points.size(), kBlock, Progress(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        for (const Fans::Spoke s : fans_.of(VertexId{v})) {
          const VertexId to = Fans::target(s);
          if (to < VertexId{v}) continue;
          const HalfedgeId other = fans_.find(to, VertexId{v});
          if (!other.valid()) continue;
          opposite_[Fans::halfedge(s).index()] = other;
          opposite_[other.index()] = Fans::halfedge(s);
        }
      }
    });
  }

  void check_constraints() {
    const std::size_t n = tin_.points.size();
    const auto missing = [&](std::size_t i) {
      const ConstraintEdge& e = tin_.constraints[i];
      if (e.a.index() >= n || e.b.index() >= n) return true;
      return !fans_.find(e.a, e.b).valid() && !fans_.find(e.b, e.a).valid();
    };
    report(violation::kConstraintNoEdge, find_broken(tin_.constraints.size(), missing), [&](std::size_t i) {
      return "constraint edge " + name(tin_.constraints[i].a, tin_.constraints[i].b) +
             " is no edge of a triangle";
    });
  }

  void list_isolated() {
    const std::vector<std::uint8_t> used = used_vertices(tin_.triangles, tin_.points.size());
    for (std::size_t v = 0; v < used.size(); ++v) {
      if (used[v] == 0) isolated_.push_back(VertexId{v});
    }
  }

  void check_isolated() {
    if (isolated_policy_ == IsolatedVertices::Allow) return;
    Finds finds;
    for (const VertexId v : isolated_) finds.add(v.index());
    report(violation::kIsolatedVertex, finds,
           [](std::size_t v) { return "vertex " + std::to_string(v) + " is in no triangle"; });
  }

  void check_overlap(std::span<const Point2> xy, int code) {
    const bool written = code == violation::kOverlapInWritten;
    const std::vector<RimFinding> found = sweep_rim(xy, rim_, isolated_);
    Finds touching, overlapping;
    for (std::size_t i = 0; i < found.size(); ++i) {
      using Kind = RimFinding::Kind;
      const Kind kind = found[i].kind;
      if (kind == Kind::SamePosition && !written) continue;  // all of them are found by sorting
      (written || kind == Kind::EdgesCross || kind == Kind::EdgeOnSurface ? overlapping : touching).add(i);
    }
    const auto describe = [&](std::size_t i) { return describe_finding(found[i]); };
    report(violation::kVertexOnSurface, touching, describe);
    report(code, overlapping, describe);
    if (!written) plane_is_sound_ = found.empty();
  }

  static std::string describe_finding(const RimFinding& f) {
    const std::string edge = "rim edge " + name(f.a.from, f.a.to);
    switch (f.kind) {
      case RimFinding::Kind::SamePosition:
        break;
      case RimFinding::Kind::VertexOnEdge:
        return "vertex " + name(f.b.from) + " lies within " + edge;
      case RimFinding::Kind::VertexOnSurface:
        return "vertex " + name(f.b.from) + " lies on a triangle below " + edge;
      case RimFinding::Kind::EdgesCross:
        return edge + " crosses rim edge " + name(f.b.from, f.b.to);
      case RimFinding::Kind::EdgeOnSurface:
        return edge + " lies on triangles that are not its own, beside rim edge " + name(f.b.from, f.b.to);
    }
    return "vertices " + name(f.a.from, f.b.from) + " share a position";
  }

  void check_positions() {
    std::vector<std::uint32_t> order;
    for (std::size_t v = 0; v < tin_.points.size(); ++v) {
      if (!std::isnan(tin_.points[v].x) && !std::isnan(tin_.points[v].y))
        order.push_back(static_cast<std::uint32_t>(v));
    }
    tbb::parallel_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::pair(tin_.points[a], a) < std::pair(tin_.points[b], b);
    });
    Finds finds;
    for (std::size_t i = 1; i < order.size(); ++i) {
      if (tin_.points[order[i]] == tin_.points[order[i - 1]]) finds.add(i);
    }
    report(violation::kSamePosition, finds, [&](std::size_t i) {
      return "vertices " + std::to_string(order[i - 1]) + " and " + std::to_string(order[i]) +
             " share a position";
    });
  }

  const TinArrays& tin_;
  std::span<const Point2> written_;
  IsolatedVertices isolated_policy_;
  bool has_written_ = false;
  bool numbers_are_sound_ = false;
  bool ids_exist_ = false;
  bool plane_is_sound_ = false;
  bool written_is_sound_ = false;
  bool linked_ = false;  ///< the TIN's twins are right and show no overlap; else these stand in for them
  Fans fans_;
  std::vector<HalfedgeId> opposite_;
  std::vector<RimEdge> rim_;
  std::vector<VertexId> isolated_;
  std::vector<Violation> violations_;
};

}  // namespace

std::vector<Violation> validate(const Tin& tin, std::span<const Point2> written_xy,
                                IsolatedVertices isolated) {
  return validate(tin.arrays(), written_xy, isolated);
}

std::vector<Violation> validate(const TinArrays& arrays, std::span<const Point2> written_xy,
                                IsolatedVertices isolated) {
  return Inspection(arrays, written_xy, isolated).run();
}

}  // namespace thalweg
