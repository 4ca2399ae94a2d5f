// Which height a vertex gets.
//
// 1. Points: the height of the only one at the vertex; where several share it, the duplicate rule.
// 2. Hard lines, but rings of lakes: at a vertex of theirs the height given there, on an edge the height
//    between its ends. If all agree, that is the height (a point's, if it agrees as well, then a given one
//    rather than one between); else the crossing rule says.
// 3. Heights between ends are rounded, and belong to a place that noding may have moved by up to a pixel. Two
//    heights agree if they differ by no more than that can explain, or, both given, not at all.
// 4. Each height that disagrees with the first one, and a point's that disagrees with the lines', is a
//    conflict. Means are sums of sorted heights, so they do not depend on the order of input.
#include "heights.hpp"

#include "base/ordered_blocks.hpp"
#include "provenance.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/delaunay/surface.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>
#include <iterator>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <utility>

namespace thalweg {

namespace {

constexpr std::size_t kBlock = 1 << 14;  // vertices; a multiple of the bits that a word of flags holds

// What a hard line says about a vertex.
struct Claim {
  double z = 0;
  double slack = 0;  // how far z may be off
  Passage passage;
  [[nodiscard]] bool given() const { return passage.where == Passage::Where::AtVertex; }
};

bool agree(const Claim& a, const Claim& b) {
  return std::abs(a.z - b.z) <= a.slack + b.slack;
}

double mean(std::vector<double> heights) {
  std::sort(heights.begin(), heights.end());
  const double sum = std::accumulate(heights.begin(), heights.end(), 0.0);
  return std::clamp(sum / static_cast<double>(heights.size()), heights.front(), heights.back());
}

// Pre: in file order, not empty.
double choose(DuplicateRule rule, const std::vector<double>& heights) {
  switch (rule) {
    case DuplicateRule::First:
      return heights.front();
    case DuplicateRule::Last:
      return heights.back();
    case DuplicateRule::Lowest:
      return *std::min_element(heights.begin(), heights.end());
    case DuplicateRule::Highest:
      return *std::max_element(heights.begin(), heights.end());
    case DuplicateRule::Mean:
      return mean(heights);
  }
  return heights.front();
}

// Pre: in order of lines, not empty; `kind` is what the lines are together.
double choose(CrossingRule rule, const std::vector<double>& heights, EdgeKind kind) {
  const double lowest = *std::min_element(heights.begin(), heights.end());
  const double highest = *std::max_element(heights.begin(), heights.end());
  switch (rule) {
    case CrossingRule::First:
      return heights.front();
    case CrossingRule::Last:
      return heights.back();
    case CrossingRule::Lower:
    case CrossingRule::Error:
      return lowest;
    case CrossingRule::Higher:
      return highest;
    case CrossingRule::Mean:
      return mean(heights);
    case CrossingRule::Auto:
      break;
  }
  if (has(kind, EdgeKind::Valley)) return lowest;
  return has(kind, EdgeKind::Ridge) ? highest : mean(heights);
}

// The items whose vertices lie in [begin, end). Pre: they are in order of vertices.
template <class Item, class VertexOf>
std::span<const Item> items_at(std::span<const Item> all, std::size_t begin, std::size_t end,
                               const VertexOf& vertex_of) {
  const auto first = std::ranges::lower_bound(all, begin, {}, vertex_of);
  return {first, std::ranges::lower_bound(first, all.end(), end, {}, vertex_of)};
}

// What a block of vertices has told.
struct Findings {
  std::vector<Conflict> conflicts;
  std::vector<std::uint32_t> vertices;  // of each conflict
  std::exception_ptr refusal;
};

class Resolver {
 public:
  Resolver(const Survey& survey, const Drawing& drawing, const GroundOptions& options)
      : survey_(survey), drawing_(drawing), options_(options) {
    const std::size_t count = drawing.vertices.xy.size();
    heights_.z.resize(count);
    heights_.known.resize(count);
  }

  Heights run(const Progress& progress) {
    const std::vector<std::uint32_t> later = find_first_points();
    for_each_block_in_order<Findings>(
        heights_.z.size(), kBlock, progress,
        [&](std::size_t begin, std::size_t end, Findings& found) {
          found = {};
          try {
            settle_block(begin, end, later, found);
          } catch (const Error&) {
            found.refusal = std::current_exception();  // the first in order counts
          }
        },
        [&](std::size_t, std::size_t, Findings& found) {
          if (found.refusal) std::rethrow_exception(found.refusal);
          std::ranges::move(found.conflicts, std::back_inserter(heights_.conflicts));
          std::ranges::copy(found.vertices, std::back_inserter(heights_.conflict_vertices));
        });
    return std::move(heights_);
  }

 private:
  void settle_block(std::size_t begin, std::size_t end, std::span<const std::uint32_t> later,
                    Findings& found) {
    for (std::size_t v = begin; v < std::min(end, drawing_.vertices.point_count); ++v) {
      set(static_cast<std::uint32_t>(v), survey_.points.z[first_point(static_cast<std::uint32_t>(v))]);
    }
    const auto of_point = [this](std::uint32_t p) { return drawing_.vertices.of_point[p]; };
    auto points = items_at(later, begin, end, of_point);
    auto passages = items_at(std::span(drawing_.passages), begin, end, &Passage::vertex);
    const auto take_at = [](auto& rest, std::uint32_t v, const auto& vertex_of) {
      std::size_t count = 0;
      while (count < rest.size() && std::invoke(vertex_of, rest[count]) == v) ++count;
      const auto here = rest.first(count);
      rest = rest.subspan(count);
      return here;
    };
    while (!points.empty() || !passages.empty()) {
      std::uint32_t v = VertexId::kInvalid;
      if (!points.empty()) v = of_point(points.front());
      if (!passages.empty()) v = std::min(v, passages.front().vertex);
      take_points(v, take_at(points, v, of_point), found);
      take_lines(v, take_at(passages, v, &Passage::vertex), found);
    }
  }

  [[nodiscard]] std::uint32_t first_point(std::uint32_t v) const {
    return first_point_.empty() ? v : first_point_[v];
  }

  // Finds each vertex's first point; returns the others, in order of vertices, then file order.
  std::vector<std::uint32_t> find_first_points() {
    const MergedVertices& vertices = drawing_.vertices;
    if (vertices.point_count == vertices.of_point.size()) return {};  // each is the only one at its vertex
    first_point_.assign(vertices.point_count, VertexId::kInvalid);
    std::vector<std::uint32_t> later;
    for (std::uint32_t p = 0; p < vertices.of_point.size(); ++p) {
      std::uint32_t& first = first_point_[vertices.of_point[p]];
      if (first == VertexId::kInvalid) {
        first = p;
      } else {
        later.push_back(p);
      }
    }
    std::stable_sort(later.begin(), later.end(),
                     [&](auto p, auto q) { return vertices.of_point[p] < vertices.of_point[q]; });
    return later;
  }

  void set(std::uint32_t v, double z) {
    heights_.z[v] = z;
    heights_.known[v] = true;
  }

  void report(Findings& found, Conflict::Kind kind, std::uint32_t v, double z_a, double z_b,
              std::string source_a, std::string source_b) const {
    found.vertices.push_back(v);
    found.conflicts.push_back(
        {kind, drawing_.vertices.xy[v], z_a, z_b, heights_.z[v], std::move(source_a), std::move(source_b)});
  }

  void take_points(std::uint32_t v, std::span<const std::uint32_t> later, Findings& found) {
    if (later.empty()) return;
    const std::uint32_t first = first_point(v);
    const double z = survey_.points.z[first];
    std::vector<double> all{z};
    for (const std::uint32_t p : later) all.push_back(survey_.points.z[p]);
    set(v, choose(options_.duplicates, all));
    for (const std::uint32_t p : later) {
      if (survey_.points.z[p] == z) continue;
      report(found, Conflict::Kind::DuplicatePoint, v, z, survey_.points.z[p], describe_point(survey_, first),
             describe_point(survey_, p));
    }
  }

  void take_lines(std::uint32_t v, std::span<const Passage> passages, Findings& found) {
    if (passages.empty()) return;
    if (options_.crossing == CrossingRule::Error) refuse_contacts(v, passages);
    const std::vector<Claim> claims = claims_of(v, passages);
    if (claims.empty()) return take_lakes(v, passages);
    const bool is_point = v < drawing_.vertices.point_count;
    const Claim point{.z = heights_.z[v], .slack = 0, .passage = {}};
    const bool point_agrees = is_point && std::all_of(claims.begin(), claims.end(), [&](const Claim& claim) {
                                return agree(point, claim);
                              });
    if (point_agrees) return;
    const Claim& first = claims.front();
    set(v, settle(v, claims));
    for (const Claim& claim : claims) {
      if (agree(claim, first)) continue;
      report(found, claim.given() && first.given() ? Conflict::Kind::LineVertex : Conflict::Kind::Crossing, v,
             first.z, claim.z, describe(first), describe(claim));
    }
    if (is_point) {
      report(found, Conflict::Kind::PointOnLine, v, point.z, first.z, describe_point(survey_, first_point(v)),
             describe(first));
    }
  }

  // A vertex that nothing else gives a height has that of a lake's ring until lakes are levelled.
  void take_lakes(std::uint32_t v, std::span<const Passage> passages) {
    for (const Passage& passage : passages) {
      const SurveyLine& line = survey_.lines[passage.line];
      if (!heights_.known[v] && !line.z.empty()) set(v, claim_of(v, passage, line).z);
    }
  }

  // The height that the lines agree on, or that the rule gives. A given height comes before the others.
  [[nodiscard]] double settle(std::uint32_t v, std::span<const Claim> claims) const {
    const Claim& first = claims.front();
    const auto other =
        std::find_if(claims.begin(), claims.end(), [&](const Claim& claim) { return !agree(claim, first); });
    if (other == claims.end() && first.given()) return first.z;
    if (other != claims.end() && options_.crossing == CrossingRule::Error) {
      throw Error(ErrorCode::CrossingLines,
                  fmt::format("{} and {} meet at {} with heights {} and {}; choose one with --crossing",
                              describe(first), describe(*other),
                              describe_place(survey_, drawing_.vertices.xy[v]), first.z, other->z));
    }
    std::vector<double> all;
    EdgeKind kind = EdgeKind::None;
    for (const Claim& claim : claims) {
      all.push_back(claim.z);
      kind = kind | survey_.lines[claim.passage.line].kind;
    }
    return choose(options_.crossing, all, kind);
  }

  // In order of lines, but given heights first where all agree with one; a line says the same only once.
  [[nodiscard]] std::vector<Claim> claims_of(std::uint32_t v, std::span<const Passage> passages) const {
    std::vector<Claim> claims;
    for (const Passage& passage : passages) {
      const SurveyLine& line = survey_.lines[passage.line];
      if (line.z.empty() || has(line.kind, EdgeKind::Lake)) continue;
      const Claim claim = claim_of(v, passage, line);
      bool said = false;
      for (auto last = claims.rbegin(); last != claims.rend() && last->passage.line == passage.line; ++last) {
        said = said || last->z == claim.z;
      }
      if (!said) claims.push_back(claim);
    }
    const auto given = std::find_if(claims.begin(), claims.end(), [](const Claim& c) { return c.given(); });
    if (given != claims.end() &&
        std::all_of(claims.begin(), claims.end(), [&](const Claim& c) { return agree(c, *given); })) {
      std::rotate(claims.begin(), given, given + 1);
    }
    return claims;
  }

  [[nodiscard]] Claim claim_of(std::uint32_t v, const Passage& passage, const SurveyLine& line) const {
    const double z_a = line.z[passage.at];
    if (passage.where == Passage::Where::AtVertex) return {z_a, 0, passage};
    const double z_b = line.z[passage.at + 1];
    const MergedVertices& vertices = drawing_.vertices;
    const Point2 a = vertices.xy[vertices.of_line(passage.line, passage.at)];
    const Point2 b = vertices.xy[vertices.of_line(passage.line, passage.at + 1)];
    const double slack = height_slack(a, z_a, b, z_b, drawing_.noding.pixel);
    return {interpolate_on_segment(a, z_a, b, z_b, vertices.xy[v]), slack, passage};
  }

  [[nodiscard]] std::string describe(const Claim& claim) const { return describe(claim.passage); }
  [[nodiscard]] std::string describe(const Passage& passage) const {
    return passage.where == Passage::Where::AtVertex ? describe_line_vertex(survey_, passage.line, passage.at)
                                                     : describe_line_edge(survey_, passage.line, passage.at);
  }

  // Lines that meet at vertices of their own are noded already: that is no crossing.
  void refuse_contacts(std::uint32_t v, std::span<const Passage> passages) const {
    for (const Passage& one : passages) {
      if (one.where != Passage::Where::OnEdge) continue;
      for (const Passage& other : passages) {
        if (&one == &other || is_harmless(one, other)) continue;
        throw Error(
            ErrorCode::CrossingLines,
            fmt::format("{} and {} cross, touch or overlap at {}; repair them, or say with --crossing which "
                        "height counts there",
                        describe(one), describe(other), describe_place(survey_, drawing_.vertices.xy[v])));
      }
    }
  }

  // The ring of an area may cut lines; neighbouring pieces of one line may come back to their common vertex.
  [[nodiscard]] bool is_harmless(const Passage& one, const Passage& other) const {
    constexpr EdgeKind kArea = EdgeKind::Boundary | EdgeKind::Hole | EdgeKind::Lake;
    const EdgeKind kinds = survey_.lines[one.line].kind | survey_.lines[other.line].kind;
    if (has(kinds, kArea)) return true;
    const std::uint32_t apart = std::max(one.at, other.at) - std::min(one.at, other.at);
    return one.line == other.line && apart <= 2;
  }

  const Survey& survey_;
  const Drawing& drawing_;
  const GroundOptions& options_;
  std::vector<std::uint32_t> first_point_;  // of each vertex that is a point; empty: the vertex's number
  Heights heights_;
};

}  // namespace

double height_slack(Point2 a, double z_a, Point2 b, double z_b, double pixel) {
  // Interpolation rounds a handful of times, each time by at most half a unit in the last place.
  constexpr double kRounding = 0x1p-49;
  const double slope = std::abs(z_b - z_a) / std::hypot(b.x - a.x, b.y - a.y);
  const double rounding = z_a == z_b ? 0 : kRounding * std::max(std::abs(z_a), std::abs(z_b));
  return slope * pixel + rounding;
}

Heights resolve_heights(const Survey& survey, const Drawing& drawing, const GroundOptions& options,
                        Progress& progress) {
  progress.start_phase("settling heights");
  Heights heights = Resolver(survey, drawing, options).run(progress);
  progress.advance(1);
  return heights;
}

}  // namespace thalweg
