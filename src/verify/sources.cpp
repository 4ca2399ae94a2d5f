// Looking up what was given.
//
// 1. Positions of vertices are sorted. With a snap distance points are merged by the rule first, and a vertex
//    of a line is where the nearest of the points that are left is, else the nearest vertex within it.
// 2. A piece of a line, from a to b, is covered by a constraint edge of its kind where that edge, cut to the
//    strip across the piece, stays within reach. The intervals have to leave no gap. A gap whose middle is on
//    a triangle is a fault; one off the surface is where the surface was cut.
// 3. Heights. At a vertex that hard lines touch, its height lies in the range of theirs there; else in the
//    range of the points at it, so it is theirs where they agree. Wherever a source says another height than
//    the vertex has, the report has to name the place and the height used. In a lake all heights are one.
#include "verify/exact.hpp"
#include "verify/plain_grid.hpp"
#include "verify/plain_lakes.hpp"
#include "verify/plain_mesh.hpp"

#include <thalweg/verify/sources.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace thalweg::verify {

namespace {

/// What does not hold, the first few in words.
class Faults {
 public:
  void add(const std::string& what) {
    constexpr std::size_t kNamed = 5;
    if (count_++ < kNamed) text_ += (text_.empty() ? "" : "; ") + what;
  }
  [[nodiscard]] Finding finding(std::string claim, std::string held) const {
    if (count_ == 0) return {std::move(claim), Verdict::Holds, std::move(held)};
    return {std::move(claim), Verdict::Broken, fmt::format("{} {}: {}", count_, "missing", text_)};
  }
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::size_t count_ = 0;
  std::string text_;
};

struct Interval {
  double from, to;
};

/// Where points are once those within a distance are one: in order of (x, y) each goes to the first within
/// reach of those that have stayed where they were, or stays.
class PlainMerge {
 public:
  PlainMerge(std::span<const Point2> points, double snap) : snap_(snap) {
    std::vector<Point2> sorted(points.begin(), points.end());
    std::sort(sorted.begin(), sorted.end());
    for (const Point2 p : sorted) {
      if (!first_within(p)) kept_.push_back(p);
    }
  }

  /// Pre: one of the points.
  [[nodiscard]] Point2 place_of(Point2 p) const {
    return std::binary_search(kept_.begin(), kept_.end(), p) ? p : first_within(p).value();
  }
  /// Of the points that stayed the nearest within reach.
  [[nodiscard]] std::optional<Point2> nearest(Point2 p) const {
    std::optional<Point2> best;
    visit(p, [&](Point2 q) {
      if (!best || square(p, q) < square(p, *best)) best = q;
      return false;
    });
    return best;
  }

 private:
  static double square(Point2 p, Point2 q) { return (p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y); }

  [[nodiscard]] std::optional<Point2> first_within(Point2 p) const {
    std::optional<Point2> first;
    visit(p, [&](Point2 q) {
      first = q;
      return true;
    });
    return first;
  }

  /// Calls `stop(q)` for those within reach of p, in order, until that is true.
  template <class Stop>
  void visit(Point2 p, const Stop& stop) const {
    constexpr double kLowest = -std::numeric_limits<double>::infinity();
    const auto from = std::lower_bound(kept_.begin(), kept_.end(), Point2{p.x - snap_, kLowest});
    for (auto q = from; q != kept_.end() && q->x <= p.x + snap_; ++q) {
      if (square(p, *q) <= snap_ * snap_ && stop(*q)) return;
    }
  }

  double snap_;
  std::vector<Point2> kept_;  // sorted
};

/// Heights that sources say of one vertex.
struct Said {
  std::vector<double> points;
  std::vector<Interval> lines;  ///< from, to: as computed, with the error of the computation
};

class SourceChecker {
 public:
  SourceChecker(const Subject& subject, const Sources& sources, Progress& progress)
      : subject_(subject),
        sources_(sources),
        progress_(progress),
        box_(bounding_box(subject.points)),
        vertices_(box_, subject.points.size(), 2),
        edges_(box_, subject.points.size(), 2),
        triangles_(box_, subject.points.size(), 2),
        lakes_(sources.lines, sources.snap + sources.pixel + sources.bend),
        merge_(sources.snap > 0 ? sources.points : std::span<const Point2>(), sources.snap),
        said_(subject.points.size()) {
    for (Index v = 0; v < subject.points.size(); ++v) {
      const Point2 p = subject.points[v];
      at_.emplace(p, v);
      vertices_.file_box({p.x, p.y, p.x, p.y}, v);
    }
    for (Index e = 0; e < subject.constraints.size(); ++e) {
      edges_.file_box(box_of({end(e, false), end(e, true)}), e);
    }
    for (Index t = 0; t < subject.triangles.size(); ++t) {
      const Triangle& corner = subject.triangles[t];
      triangles_.file_box(box_of({at(corner[0]), at(corner[1]), at(corner[2])}), t);
    }
  }

  std::vector<Finding> run() {
    std::vector<Finding> findings;
    progress_.start_phase("sources");
    findings.push_back(check_points());
    if (!sources_.lines.empty()) {
      findings.push_back(check_line_vertices());
      findings.push_back(check_coverage());
    }
    findings.push_back(check_heights());
    if (lakes_.any()) findings.push_back(lakes_.check_flat(subject_));
    return findings;
  }

 private:
  static constexpr double kMicrometre = 1e-6;

  [[nodiscard]] Point2 at(VertexId v) const { return subject_.points[v.index()]; }
  [[nodiscard]] Point2 end(Index edge, bool second) const {
    return at(second ? subject_.constraints[edge].b : subject_.constraints[edge].a);
  }
  static Box2 box_of(std::initializer_list<Point2> points) {
    Box2 box;
    for (const Point2 p : points) box.add(p);
    return box;
  }
  static Box2 grown(Box2 box, double by) {
    return {box.x_min - by, box.y_min - by, box.x_max + by, box.y_max + by};
  }
  static std::string text(Point2 p) { return fmt::format("({}, {})", p.x, p.y); }

  /// The vertex of a line's vertex.
  [[nodiscard]] std::optional<Index> vertex_on_line(Point2 p) const {
    if (const auto point = merge_.nearest(p)) {
      if (const auto found = at_.find(*point); found != at_.end()) return found->second;
    }
    return vertex_near(p, sources_.snap + sources_.pixel);
  }

  /// The vertex at a position, or the nearest one within the distance.
  [[nodiscard]] std::optional<Index> vertex_near(Point2 p, double distance_limit) const {
    if (const auto found = at_.find(p); found != at_.end()) return found->second;
    std::optional<Index> nearest;
    if (!(distance_limit > 0)) return nearest;
    double least = distance_limit * (1 + 1e-12);
    vertices_.for_cells(grown(box_of({p}), distance_limit), [&](std::size_t cell, const Box2&) {
      for (const Index v : vertices_.in(cell)) {
        const double distance = std::hypot(subject_.points[v].x - p.x, subject_.points[v].y - p.y);
        if (distance > least) continue;
        least = distance;
        nearest = v;
      }
    });
    return nearest;
  }

  [[nodiscard]] bool on_surface(Point2 p) const { return height_at(p).has_value(); }

  /// The height of a triangle that holds the position.
  [[nodiscard]] std::optional<double> height_at(Point2 p) const {
    std::optional<double> found;
    if (p.x < box_.x_min || p.x > box_.x_max || p.y < box_.y_min || p.y > box_.y_max) return found;
    triangles_.for_cells(box_of({p}), [&](std::size_t cell, const Box2&) {
      for (const Index t : triangles_.in(cell)) {
        const Triangle& c = subject_.triangles[t];
        const Point2 u = at(c[0]), v = at(c[1]), w = at(c[2]);
        if (turn(u, v, p) < 0 || turn(v, w, p) < 0 || turn(w, u, p) < 0) continue;
        using Extended = long double;
        const auto area = [](Point2 a, Point2 b, Point2 d) {
          return (Extended{b.x} - a.x) * (Extended{d.y} - a.y) -
                 (Extended{b.y} - a.y) * (Extended{d.x} - a.x);
        };
        const auto z = [&](std::size_t i) { return Extended{subject_.heights[c[i].index()]}; };
        found = static_cast<double>((area(v, w, p) * z(0) + area(w, u, p) * z(1) + area(u, v, p) * z(2)) /
                                    area(u, v, w));
      }
    });
    return found;
  }

  [[nodiscard]] std::string name_of_point(std::size_t i) const {
    const auto& first = sources_.first_of_run;
    const auto run = std::upper_bound(first.begin(), first.end(), i) - first.begin() - 1;
    const auto number = static_cast<std::size_t>(run);
    return fmt::format("{} point {}", sources_.names[number], i - first[number] + 1);
  }

  [[nodiscard]] bool is_within_error(double error) const {
    return error <= *sources_.largest_error * (1 + 1e-9) + 1e-9;
  }

  /// Whether the report says that another height was used in place of this one, and the TIN is near to that.
  [[nodiscard]] bool lost_a_conflict(Point2 p, double said, double height) const {
    if (!sources_.conflicts) return false;
    const double near = std::max(kMicrometre, sources_.snap + sources_.pixel);
    return std::ranges::any_of(*sources_.conflicts, [&](const Conflict& c) {
      return std::hypot(c.xy.x - p.x, c.xy.y - p.y) <= near && (c.z_a == said || c.z_b == said) &&
             is_within_error(std::abs(c.z_used - height));
    });
  }

  Finding check_points() {
    Faults faults;
    std::set<Point2> off_surface;
    std::size_t merged = 0, near = 0;
    std::set<Index> met;
    for (std::size_t i = 0; i < sources_.points.size(); ++i) {
      if (i % kStep == 0) progress_.check();
      const Point2 p = sources_.snap > 0 ? merge_.place_of(sources_.points[i]) : sources_.points[i];
      if (const auto v = at_.find(p); v != at_.end()) {
        said_[v->second].points.push_back(sources_.heights[i]);
        merged += met.insert(v->second).second ? 0 : 1;
      } else if (const auto height = height_at(p)) {
        const double error = std::abs(*height - sources_.heights[i]);
        const bool levelled = sources_.largest_error && lakes_.hold(p);
        if (levelled || (sources_.largest_error && is_within_error(error)) ||
            (sources_.largest_error && lost_a_conflict(p, sources_.heights[i], *height))) {
          ++near;
          continue;
        }
        faults.add(name_of_point(i) + " at " + text(p) +
                   (sources_.largest_error ? fmt::format(", {} from the TIN", error) : ""));
      } else {
        off_surface.insert(p);
        const bool allowed = sources_.positions_left_out ? off_surface.size() <= *sources_.positions_left_out
                                                         : sources_.is_cut;
        if (!allowed) {
          faults.add(name_of_point(i) + " at " + text(p) + ", off the surface");
        }
      }
    }
    const std::string held = fmt::format("{} points, {} of them merged, {} positions off the surface",
                                         sources_.points.size(), merged, off_surface.size());
    if (!sources_.largest_error) return faults.finding("every point is a vertex", held);
    return faults.finding(
        fmt::format("every point is a vertex, or within {:.6g} of the TIN", *sources_.largest_error),
        held + fmt::format(", {} within", near));
  }

  [[nodiscard]] static bool is_given(const SourceLine& line, std::size_t i) {
    return line.given.empty() || line.given[i];
  }

  Finding check_line_vertices() {
    Faults faults;
    std::size_t count = 0;
    for (const SourceLine& line : sources_.lines) {
      progress_.check();
      for (std::size_t i = 0; i < line.xy.size(); ++i) {
        if (!is_given(line, i)) continue;
        ++count;
        const auto v = vertex_on_line(line.xy[i]);
        if (v && !line.z.empty()) said_[*v].lines.push_back({line.z[i], line.z[i]});
        if (!v && (on_surface(line.xy[i]) || !sources_.is_cut)) {
          faults.add(fmt::format("{} at {}", line.name, text(line.xy[i])));
        }
      }
    }
    return faults.finding("every vertex of a line is a vertex", fmt::format("{} of them", count));
  }

  /// What an edge covers of the piece, from 0 to 1.
  [[nodiscard]] std::optional<Interval> covered(Point2 a, Point2 b, Point2 c, Point2 d, double reach) const {
    const double x = b.x - a.x, y = b.y - a.y, square = x * x + y * y;
    const auto along = [&](Point2 p) { return ((p.x - a.x) * x + (p.y - a.y) * y) / square; };
    const auto off = [&](Point2 p) { return ((p.y - a.y) * x - (p.x - a.x) * y) / std::sqrt(square); };
    double from = along(c), to = along(d), off_from = off(c), off_to = off(d);
    if (from > to) {
      std::swap(from, to);
      std::swap(off_from, off_to);
    }
    const double low = std::max(from, 0.0), high = std::min(to, 1.0);
    if (!(low < high)) return std::nullopt;
    const auto off_at = [&](double t) { return off_from + (off_to - off_from) * (t - from) / (to - from); };
    if (std::abs(off_at(low)) > reach || std::abs(off_at(high)) > reach) return std::nullopt;
    return Interval{low, high};
  }

  struct Piece {
    Point2 a, b;
    std::optional<Interval> z;  ///< at a and b
    [[nodiscard]] Point2 at(double t) const { return {a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t}; }
  };

  /// One place may be where the line touches the rim of the surface; two are not.
  [[nodiscard]] bool is_over_surface(const Piece& piece, const Interval& gap) const {
    const auto places = {0.382, 0.5, 0.618};
    return std::count_if(places.begin(), places.end(), [&](double share) {
             return on_surface(piece.at(gap.from + (gap.to - gap.from) * share));
           }) > 1;
  }

  /// A hard line says its height where constraint edges of it end.
  void say_height(const Piece& piece, Index v) {
    if (!piece.z) return;
    const double x = piece.b.x - piece.a.x, y = piece.b.y - piece.a.y, square = x * x + y * y;
    const Point2 p = subject_.points[v];
    const double t = ((p.x - piece.a.x) * x + (p.y - piece.a.y) * y) / square;
    if (t < 0 || t > 1) return;
    const double z = piece.z->from + (piece.z->to - piece.z->from) * t;
    const double error =
        1e-9 * (1 + std::abs(z)) + std::abs(piece.z->to - piece.z->from) * 2 * (reach() / std::sqrt(square));
    said_[v].lines.push_back({z - error, z + error});
  }

  [[nodiscard]] double reach() const { return sources_.snap + sources_.pixel + sources_.bend; }

  /// Gaps that the constraint edges of a kind leave on the piece.
  std::vector<Interval> gaps_of(const Piece& piece, EdgeKind kind) {
    const double length = std::hypot(piece.b.x - piece.a.x, piece.b.y - piece.a.y);
    std::set<Index> near;
    edges_.for_cells(grown(box_of({piece.a, piece.b}), reach()), [&](std::size_t cell, const Box2&) {
      near.insert(edges_.in(cell).begin(), edges_.in(cell).end());
    });
    std::vector<Interval> intervals;
    for (const Index e : near) {
      if ((subject_.constraints[e].kind & kind) != kind) continue;
      const auto interval = covered(piece.a, piece.b, end(e, false), end(e, true), reach());
      if (!interval) continue;
      intervals.push_back(*interval);
      say_height(piece, subject_.constraints[e].a.value());
      say_height(piece, subject_.constraints[e].b.value());
    }
    std::sort(intervals.begin(), intervals.end(),
              [](const Interval& s, const Interval& t) { return s.from < t.from; });
    std::vector<Interval> gaps;
    const double slack = reach() / length + 1e-12;
    double reached = 0;
    for (const Interval& interval : intervals) {
      if (interval.from > reached + slack) gaps.push_back({reached, interval.from});
      reached = std::max(reached, interval.to);
    }
    if (reached < 1 - slack) gaps.push_back({reached, 1});
    return gaps;
  }

  Finding check_coverage() {
    Faults faults;
    std::size_t pieces = 0, off_surface = 0;
    for (const SourceLine& line : sources_.lines) {
      progress_.check();
      for (std::size_t i = 0; i + 1 < line.xy.size(); ++i) {
        Piece piece{line.xy[i], line.xy[i + 1], std::nullopt};
        if (!line.z.empty()) piece.z = {line.z[i], line.z[i + 1]};
        const double length = std::hypot(piece.b.x - piece.a.x, piece.b.y - piece.a.y);
        if (length <= 2 * sources_.snap || length == 0) continue;  // its ends may be one vertex
        ++pieces;
        bool ends = false;
        for (const Interval& gap : gaps_of(piece, line.kind)) {
          if (is_over_surface(piece, gap) || !sources_.is_cut) {
            faults.add(fmt::format("{} from {} to {}, near {}", line.name, text(piece.a), text(piece.b),
                                   text(piece.at((gap.from + gap.to) / 2))));
          } else {
            ends = true;
          }
        }
        off_surface += ends ? 1 : 0;
      }
    }
    return faults.finding("every line is covered by constraint edges",
                          fmt::format("{} pieces, {} of them partly off the surface", pieces, off_surface));
  }

  using Conflicts = std::map<Index, std::vector<const Conflict*>>;

  /// Whether the report says that the height `said` was in a conflict at the vertex, which got `z` by one.
  [[nodiscard]] static bool explained(const Conflicts& conflicts, Index v, double said, double z) {
    const auto at = conflicts.find(v);
    if (at == conflicts.end()) return false;
    const auto any = [&](const auto& fits) { return std::ranges::any_of(at->second, fits); };
    return any([&](const Conflict* c) { return c->z_a == said || c->z_b == said; }) &&
           any([&](const Conflict* c) { return c->z_used == z; });
  }

  [[nodiscard]] std::string height_fault(Index v, const Conflicts& conflicts) const {
    const Said& said = said_[v];
    const auto changed = conditioned_.find(v);
    if (changed != conditioned_.end() && changed->second->after != subject_.heights[v]) {
      return fmt::format("vertex {} at {} has height {}, not {} as the report says it was conditioned to", v,
                         text(subject_.points[v]), subject_.heights[v], changed->second->after);
    }
    const double z = changed != conditioned_.end() ? changed->second->before : subject_.heights[v];
    std::vector<Interval> heights = said.lines;
    if (heights.empty()) {
      for (const double point : said.points) heights.push_back({point, point});
    }
    if (heights.empty()) return {};
    double least = heights.front().from, most = heights.front().to;
    for (const Interval& height : heights) {
      least = std::min(least, height.from);
      most = std::max(most, height.to);
    }
    const std::string where = fmt::format("vertex {} at {} has height {}", v, text(subject_.points[v]), z);
    const bool beyond = z < least || z > most;
    const bool all_explained = std::all_of(heights.begin(), heights.end(), [&](const Interval& height) {
      return height.from == height.to && explained(conflicts, v, height.from, z);
    });
    if (beyond && !all_explained && !lakes_.hold(subject_.points[v]))
      return where + fmt::format(", sources say {} to {}", least, most);
    if (!sources_.conflicts) return {};
    const auto disagrees = [&](double height) { return height != z; };
    if (std::none_of(said.points.begin(), said.points.end(), disagrees)) return {};
    const auto named = conflicts.find(v);
    const auto uses_z = [&](const Conflict* conflict) { return conflict->z_used == z; };
    if (named != conflicts.end() && std::any_of(named->second.begin(), named->second.end(), uses_z))
      return {};
    return where + ", a source another one, and the report names no conflict there";
  }

  Finding check_heights() {
    Conflicts conflicts;
    for (std::size_t i = 0; sources_.conflicts && i < sources_.conflicts->size(); ++i) {
      const Conflict& conflict = (*sources_.conflicts)[i];
      const auto v = vertex_near(conflict.xy, std::max(kMicrometre, sources_.snap + sources_.pixel));
      if (v) conflicts[*v].push_back(&conflict);
    }
    for (const Sources::Conditioned& change : sources_.conditioned) {
      if (const auto v = vertex_near(change.xy, kMicrometre)) conditioned_[*v] = &change;
    }
    Faults faults;
    std::size_t count = 0;
    for (Index v = 0; v < said_.size(); ++v) {
      if (said_[v].points.empty() && said_[v].lines.empty()) continue;
      ++count;
      if (const std::string fault = height_fault(v, conflicts); !fault.empty()) faults.add(fault);
    }
    if (faults.count() == 0) {
      return {"heights are those of the sources", Verdict::Holds,
              conditioned_.empty() ? fmt::format("at {} vertices", count)
                                   : fmt::format("at {} vertices, of which {} were conditioned since", count,
                                                 conditioned_.size())};
    }
    return {"heights are those of the sources", Verdict::Broken,
            fmt::format("{} are not: {}", faults.count(), faults.text())};
  }

  static constexpr std::size_t kStep = 4096;
  const Subject& subject_;
  const Sources& sources_;
  Progress& progress_;
  Box2 box_;
  PlainGrid vertices_, edges_, triangles_;
  std::map<Point2, Index> at_;
  PlainLakes lakes_;
  PlainMerge merge_;
  std::vector<Said> said_;  ///< by vertex
  std::map<Index, const Sources::Conditioned*> conditioned_;
};

}  // namespace

std::vector<Finding> check_sources(const Subject& subject, const Sources& sources, Progress& progress) {
  return SourceChecker(subject, sources, progress).run();
}

}  // namespace thalweg::verify
