// Contours by walking from triangle to triangle.
//
// 1. A vertex is high at a height H if z >= H, else low; nothing ties. An edge between a high and a low end
//    is crossed once, and a triangle has none or two crossed edges: so crossed edges form paths that are
//    closed or end on the rim.
// 2. In a triangle, the path enters by the edge whose halfedge runs from low to high and leaves by the one
//    from high to low: then high ground is to its right.
// 3. A crossing lies at a vertex if the high end is at H exactly, else at one place that is computed from the
//    low end whatever the side it is reached from. Equal neighbours in a path are one point.
// 4. A crest at exactly H (both sides lower) is walked along twice, there and back. Such pieces run along an
//    edge with both ends at H; pieces that are there in both directions are cut out of the paths and put back
//    once, as lines of their own.
#include <thalweg/base/error.hpp>
#include <thalweg/terrain/contours.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

namespace thalweg {

namespace {

using Piece = std::pair<VertexId, VertexId>;

struct PathPoint {
  Point2 xy;
  VertexId vertex;  ///< valid if the point is one
};

class LevelTracer {
 public:
  LevelTracer(const Tin& tin, double height, std::vector<bool>& done)
      : tin_(tin), height_(height), done_(done) {}

  /// Appends the lines whose walk passes the given halfedges; these are all that cross the height from low to
  /// high.
  void trace(const std::vector<HalfedgeId>& rising, std::vector<ContourLine>& lines) {
    for (const HalfedgeId h : rising) {
      if (tin_.on_rim(h)) walk(h);
    }
    for (const HalfedgeId h : rising) walk(h);
    for (const HalfedgeId h : rising) done_[h.index()] = false;
    cut_out_crests();
    for (const std::vector<PathPoint>& path : paths_) add(path, lines);
  }

 private:
  [[nodiscard]] bool high(VertexId v) const { return tin_.height(v) >= height_; }

  [[nodiscard]] PathPoint crossing(HalfedgeId h) const {
    VertexId low = tin_.origin(h), top = tin_.target(h);
    if (high(low)) std::swap(low, top);
    if (tin_.height(top) == height_) return {tin_.point(top), top};
    const Point2 a = tin_.point(low), b = tin_.point(top);
    const double t = (height_ - tin_.height(low)) / (tin_.height(top) - tin_.height(low));
    return {{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)}, {}};
  }

  /// From a rising halfedge through triangles until the rim or the start.
  void walk(HalfedgeId start) {
    if (done_[start.index()]) return;
    std::vector<PathPoint> path;
    HalfedgeId in = start;
    while (true) {
      done_[in.index()] = true;
      append(path, crossing(in));
      HalfedgeId out = Tin::next(in);
      if (!(high(tin_.origin(out)) && !high(tin_.target(out)))) out = Tin::next(out);
      const HalfedgeId across = tin_.twin(out);
      if (!across.valid() || done_[across.index()]) {
        append(path, crossing(out));
        break;
      }
      in = across;
    }
    paths_.push_back(std::move(path));
  }

  static void append(std::vector<PathPoint>& path, const PathPoint& point) {
    if (path.empty() || path.back().xy != point.xy) path.push_back(point);
  }

  static bool runs_along_edge(const PathPoint& a, const PathPoint& b) {
    return a.vertex.valid() && b.vertex.valid();
  }

  void cut_out_crests() {
    std::vector<Piece> pieces;
    for (const std::vector<PathPoint>& path : paths_) {
      for (std::size_t i = 1; i < path.size(); ++i) {
        if (runs_along_edge(path[i - 1], path[i])) pieces.emplace_back(path[i - 1].vertex, path[i].vertex);
      }
    }
    if (pieces.empty()) return;
    std::sort(pieces.begin(), pieces.end());
    std::vector<Piece> crests;
    for (const Piece& piece : pieces) {
      const Piece back{piece.second, piece.first};
      if (piece < back && std::binary_search(pieces.begin(), pieces.end(), back)) crests.push_back(piece);
    }
    if (crests.empty()) return;
    std::vector<std::vector<PathPoint>> cut;
    for (const std::vector<PathPoint>& path : paths_) cut_path(path, crests, cut);
    for (const Piece& crest : crests) {
      cut.push_back({{tin_.point(crest.first), crest.first}, {tin_.point(crest.second), crest.second}});
    }
    paths_ = std::move(cut);
  }

  static void cut_path(std::vector<PathPoint> path, const std::vector<Piece>& crests,
                       std::vector<std::vector<PathPoint>>& cut) {
    const auto is_crest = [&](const PathPoint& a, const PathPoint& b) {
      return runs_along_edge(a, b) &&
             std::binary_search(crests.begin(), crests.end(), Piece(std::minmax(a.vertex, b.vertex)));
    };
    // A closed path starts behind one of its crests, if it has any, so that no cut falls elsewhere.
    if (path.size() > 1 && path.front().xy == path.back().xy) {
      for (std::size_t i = 1; i < path.size(); ++i) {
        if (!is_crest(path[i - 1], path[i])) continue;
        path.pop_back();
        std::rotate(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(i % path.size()), path.end());
        path.push_back(path.front());
        break;
      }
    }
    std::vector<PathPoint> piece;
    for (std::size_t i = 0; i < path.size(); ++i) {
      if (i > 0 && is_crest(path[i - 1], path[i])) {
        if (piece.size() > 1) cut.push_back(piece);
        piece.clear();
      }
      piece.push_back(path[i]);
    }
    if (piece.size() > 1) cut.push_back(piece);
  }

  void add(const std::vector<PathPoint>& path, std::vector<ContourLine>& lines) const {
    if (path.size() < 2) return;
    ContourLine line{height_, path.size() > 3 && path.front().xy == path.back().xy, {}};
    line.points.reserve(path.size());
    for (const PathPoint& point : path) line.points.push_back(point.xy);
    lines.push_back(std::move(line));
  }

  const Tin& tin_;
  double height_;
  std::vector<bool>& done_;
  std::vector<std::vector<PathPoint>> paths_;
};

/// In intervals. A height is a product and a sum of numbers about as large as the base, each rounded by at
/// most 2^-53 of it, as the interval was: below 0.0004 of the interval, where the base is no farther than
/// this.
constexpr double kFarthestBase = 1e12;

/// The decimal number near `value` that rounding may have missed in a sum of numbers as large as `scale`:
/// 0.3, not 3 * 0.1.
double nearest_decimal(double value, double scale) {
  constexpr double kRounding = 2 * std::numeric_limits<double>::epsilon();
  constexpr int kDigits = 15;
  const int places =
      scale > 0 ? std::max(kDigits - 1 - static_cast<int>(std::floor(std::log10(scale))), 0) : 0;
  const std::string text = fmt::format("{:.{}f}", value, places);
  double decimal = value;
  std::from_chars(text.data(), text.data() + text.size(), decimal);
  return std::abs(decimal - value) <= kRounding * scale ? decimal : value;
}

/// The heights of the contours, ascending. Throws: Error{Usage}.
std::vector<double> list_heights(const Tin& tin, const ContourOptions& options) {
  if (!(options.interval > 0) || !std::isfinite(options.interval) || !std::isfinite(options.base)) {
    throw Error(ErrorCode::Usage, "the interval of contours has to be positive, and their base finite");
  }
  if (std::abs(options.base) > kFarthestBase * options.interval) {
    throw Error(
        ErrorCode::Usage,
        fmt::format("the base of contours, {}, is too many intervals of {} away from 0 for exact heights; "
                    "choose one that is near the heights",
                    options.base, options.interval));
  }
  double low = 0, top = 0;
  bool any = false;
  for (const Triangle& t : tin.triangles()) {
    for (const VertexId v : t) {
      low = any ? std::min(low, tin.height(v)) : tin.height(v);
      top = any ? std::max(top, tin.height(v)) : tin.height(v);
      any = true;
    }
  }
  if (!any) return {};
  constexpr double kMostHeights = 1e6;
  const double first = std::ceil((low - options.base) / options.interval) - 1;
  const double last = std::floor((top - options.base) / options.interval) + 1;
  if (!(last - first <= kMostHeights)) {
    throw Error(ErrorCode::Usage,
                fmt::format("an interval of {} gives more than a million contours; choose a larger one",
                            options.interval));
  }
  // One more at both ends, because divisions are rounded.
  std::vector<double> heights;
  for (std::size_t i = 0; i <= static_cast<std::size_t>(last - first); ++i) {
    const double rise = (first + static_cast<double>(i)) * options.interval;
    const double height =
        nearest_decimal(options.base + rise, std::max(std::abs(options.base), std::abs(rise)));
    const bool is_new = heights.empty() || height > heights.back();
    if (is_new && height >= low && height <= top) heights.push_back(height);
  }
  return heights;
}

}  // namespace

std::vector<ContourLine> trace_contours(const Tin& tin, const ContourOptions& options, Progress& progress) {
  const std::vector<double> heights = list_heights(tin, options);
  const std::size_t levels = heights.size();

  // Buckets: the rising halfedges of each height.
  std::vector<std::vector<HalfedgeId>> rising(levels);
  for (std::size_t i = 0; i < tin.halfedge_count(); ++i) {
    if (i % 65536 == 0)
      progress.advance(0.5 * static_cast<double>(i) / static_cast<double>(tin.halfedge_count()));
    const HalfedgeId h{i};
    const double from = tin.height(tin.origin(h)), to = tin.height(tin.target(h));
    if (!(from < to)) continue;
    const auto above = std::upper_bound(heights.begin(), heights.end(), from);
    for (auto level = static_cast<std::size_t>(above - heights.begin()); level < levels; ++level) {
      if (heights[level] > to) break;
      rising[level].push_back(h);
    }
  }
  std::vector<ContourLine> lines;
  std::vector<bool> done(tin.halfedge_count(), false);
  for (std::size_t level = 0; level < levels; ++level) {
    progress.advance(0.5 + 0.5 * static_cast<double>(level) / static_cast<double>(levels));
    LevelTracer(tin, heights[level], done).trace(rising[level], lines);
  }
  return lines;
}

}  // namespace thalweg
