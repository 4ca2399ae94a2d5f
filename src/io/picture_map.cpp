// What lies over the relief.
//
// Detail follows the scale. A triangle's edges fade in as it grows from 4 to 18 pixels, each by its own size,
// so that dense and sparse parts of one TIN are both legible. Lines get thinner where they are crowded: their
// width is held below a sixth of the mean space between them. Pits shrink with their number.
#include "io/picture_map.hpp"

#include "io/edge_chains.hpp"

#include <algorithm>
#include <cmath>

namespace thalweg {

namespace {

constexpr std::array<LineStyle, 6> kLineStyles = {{{EdgeKind::Breakline, "Breaklines", rgb(0x3c3c3c), 0.9},
                                                   {EdgeKind::Boundary, "Boundary", rgb(0x000000), 1.4},
                                                   {EdgeKind::Hole, "Holes", rgb(0x000000), 1.0},
                                                   {EdgeKind::Lake, "Lakes", rgb(0x2b8fd0), 1.2},
                                                   {EdgeKind::Ridge, "Ridges", rgb(0x9b3412), 1.1},
                                                   {EdgeKind::Valley, "Valleys", rgb(0x0f5ea8), 1.2}}};

constexpr double kSmallest = 4;     // pixels: triangles of this size are not outlined
constexpr double kLargest = 18;     // from this size on outlines have their full strength
constexpr std::size_t kLevels = 8;  // of strength

// Side of the square with the area of the triangle, in pixels.
double triangle_size(const Tin& tin, const Triangle& t, const MapFrame& frame) {
  const Point2 a = tin.point(t[0]), b = tin.point(t[1]), c = tin.point(t[2]);
  const double area = std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
  return std::sqrt(area) * frame.pixels_per_unit;
}

// Strength of an edge's outline, 0 (not drawn) to kLevels.
std::size_t edge_level(const Tin& tin, HalfedgeId h, const MapFrame& frame) {
  double size = triangle_size(tin, tin.triangle(Tin::triangle_of(h)), frame);
  const HalfedgeId twin = tin.twin(h);
  if (twin.valid()) size = (size + triangle_size(tin, tin.triangle(Tin::triangle_of(twin)), frame)) / 2;
  const double share = std::clamp((size - kSmallest) / (kLargest - kSmallest), 0.0, 1.0);
  return static_cast<std::size_t>(std::ceil(share * static_cast<double>(kLevels)));
}

bool outlined(const Tin& tin, HalfedgeId h) {
  return tin.represents_edge(h) && !tin.constrained(h);
}

// Strokes many short lines in a few paths: one path a line is slow, one for all is slower still.
class SegmentPen {
 public:
  SegmentPen(Canvas& canvas, Colour colour, double width) : canvas_(canvas), colour_(colour), width_(width) {}
  ~SegmentPen() { stroke(); }
  SegmentPen(const SegmentPen&) = delete;
  SegmentPen& operator=(const SegmentPen&) = delete;

  void draw(Point2 from, Point2 to) {
    constexpr std::size_t kMost = 256;
    cairo_move_to(canvas_.cairo(), from.x, from.y);
    cairo_line_to(canvas_.cairo(), to.x, to.y);
    if (++count_ == kMost) stroke();
  }

 private:
  void stroke() {
    cairo_set_source_rgba(canvas_.cairo(), colour_.red, colour_.green, colour_.blue, colour_.alpha);
    cairo_set_line_width(canvas_.cairo(), width_);
    cairo_set_line_cap(canvas_.cairo(), CAIRO_LINE_CAP_BUTT);
    cairo_stroke(canvas_.cairo());
    count_ = 0;
  }

  Canvas& canvas_;
  Colour colour_;
  double width_;
  std::size_t count_ = 0;
};

const LineStyle& style_of(EdgeKind kind) {
  const LineStyle* style = &kLineStyles.front();
  for (const LineStyle& candidate : kLineStyles) {
    if (has(kind, candidate.kind)) style = &candidate;
  }
  return *style;
}

// Lines on the page, in the order of drawing.
struct PageLine {
  const LineStyle* style;
  std::vector<Point2> points;
};

std::vector<PageLine> page_lines(const PictureScene& scene, const MapFrame& frame) {
  const std::vector<ConstraintEdge> edges = scene.tin.constraint_edges();
  std::vector<PageLine> lines;
  for (const EdgeChain& chain : chain_edges(edges)) {
    lines.push_back({&style_of(chain.kind), {}});
    for (const VertexId v : chain.vertices) lines.back().points.push_back(frame.to_page(scene.tin.point(v)));
  }
  std::stable_sort(lines.begin(), lines.end(),
                   [](const PageLine& a, const PageLine& b) { return a.style < b.style; });
  return lines;
}

double total_length(const std::vector<PageLine>& lines) {
  double length = 0;
  for (const PageLine& line : lines) {
    for (std::size_t i = 1; i < line.points.size(); ++i) {
      length += std::hypot(line.points[i].x - line.points[i - 1].x, line.points[i].y - line.points[i - 1].y);
    }
  }
  return length;
}

void draw_lines(Canvas& canvas, const PictureScene& scene, const MapFrame& frame, double unit,
                Progress& progress) {
  constexpr double kShareOfSpace = 1.0 / 6;
  constexpr double kThinnest = 0.4;
  const std::vector<PageLine> lines = page_lines(scene, frame);
  const double space = frame.width() * frame.height() / std::max(total_length(lines), 1.0);
  const double widest = std::max(space * kShareOfSpace, kThinnest * unit);
  progress.start_phase("draw lines");
  for (std::size_t i = 0; i < lines.size(); ++i) {
    progress.advance(static_cast<double>(i) / static_cast<double>(lines.size()));
    const LineStyle& style = *lines[i].style;
    const double width = std::min(style.width * unit * 1.6, widest);
    if (width > unit) canvas.stroke_path(lines[i].points, rgb(0xffffff).with_alpha(0.55), width + unit);
    canvas.stroke_path(lines[i].points, style.colour, width);
  }
}

void draw_pits(Canvas& canvas, const PictureScene& scene, const MapFrame& frame, double unit,
               Progress& progress) {
  constexpr double kShareOfSpace = 0.22;
  const MapCounts counts = count_things(scene);
  const double most =
      static_cast<double>(std::max({counts.pits_before, counts.pits_after, counts.pits_new, std::size_t{1}}));
  const double space = std::sqrt(frame.width() * frame.height() / most);
  const double radius = std::clamp(kShareOfSpace * space, 1.3 * unit, 3.6 * unit);
  for (std::size_t v = 0; v < scene.tin.vertex_count(); ++v) {
    progress.check();
    const Point2 p = frame.to_page(scene.tin.points()[v]);
    if (!scene.pits_before.empty() && scene.pits_before[v] != 0) draw_pit_before(canvas, p, radius);
    if (!scene.pits_after.empty() && scene.pits_after[v] != 0) draw_pit_after(canvas, p, radius);
    if (!scene.pits_new.empty() && scene.pits_new[v] != 0) draw_pit_new(canvas, p, radius);
  }
}

}  // namespace

std::span<const LineStyle> line_styles() {
  return kLineStyles;
}

MapCounts count_things(const PictureScene& scene) {
  MapCounts counts;
  for (const ConstraintEdge& edge : scene.tin.constraint_edges()) {
    for (std::size_t i = 0; i < kLineStyles.size(); ++i)
      counts.edges[i] += has(edge.kind, kLineStyles[i].kind) ? 1 : 0;
  }
  const auto marked = [](std::span<const std::uint8_t> marks) {
    return static_cast<std::size_t>(
        std::count_if(marks.begin(), marks.end(), [](std::uint8_t m) { return m != 0; }));
  };
  counts.pits_before = marked(scene.pits_before);
  counts.pits_after = marked(scene.pits_after);
  counts.pits_new = marked(scene.pits_new);
  return counts;
}

std::size_t count_visible_edges(const PictureScene& scene, const MapFrame& frame) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < scene.tin.halfedge_count(); ++i) {
    const HalfedgeId h{i};
    if (outlined(scene.tin, h) && edge_level(scene.tin, h, frame) > 0) ++count;
  }
  return count;
}

void draw_triangle_edges(Canvas& canvas, const PictureScene& scene, const MapFrame& frame, double unit,
                         Progress& progress) {
  constexpr double kStrongest = 0.5;
  constexpr std::size_t kProgressStep = 1U << 10U;
  const Tin& tin = scene.tin;
  std::array<std::vector<HalfedgeId>, kLevels + 1> by_level;
  for (std::size_t i = 0; i < tin.halfedge_count(); ++i) {
    const HalfedgeId h{i};
    if (outlined(tin, h)) by_level[edge_level(tin, h, frame)].push_back(h);
  }
  progress.start_phase("draw triangles");
  for (std::size_t level = 1; level <= kLevels; ++level) {
    const double share = static_cast<double>(level) / static_cast<double>(kLevels);
    SegmentPen pen(canvas, MapColours::kTriangle.with_alpha(kStrongest * share),
                   (0.25 + 0.25 * share) * unit);
    for (std::size_t i = 0; i < by_level[level].size(); ++i) {
      if (i % kProgressStep == 0) progress.advance(share - 1.0 / static_cast<double>(kLevels));
      const HalfedgeId h = by_level[level][i];
      pen.draw(frame.to_page(tin.point(tin.origin(h))), frame.to_page(tin.point(tin.target(h))));
    }
  }
  const double count = static_cast<double>(std::max<std::size_t>(scene.flipped.size(), 1));
  const double space = std::sqrt(frame.width() * frame.height() / count);
  SegmentPen pen(canvas, MapColours::kFlipped.with_alpha(std::clamp(space / (2 * unit * 3), 0.45, 0.95)),
                 std::clamp(space / 10, 0.35 * unit, 1.1 * unit));
  for (std::size_t i = 0; i < scene.flipped.size(); ++i) {
    if (i % kProgressStep == 0) progress.check();
    pen.draw(frame.to_page(tin.point(scene.flipped[i][0])), frame.to_page(tin.point(scene.flipped[i][1])));
  }
}

void draw_lines_and_pits(Canvas& canvas, const PictureScene& scene, const MapFrame& frame, double unit,
                         Progress& progress) {
  draw_lines(canvas, scene, frame, unit, progress);
  draw_pits(canvas, scene, frame, unit, progress);
}

void draw_pit_before(Canvas& canvas, Point2 centre, double radius) {
  canvas.ring(centre, radius, rgb(0xffffff).with_alpha(0.75), 0.75 * radius);
  canvas.ring(centre, radius, MapColours::kPitInk, 0.35 * radius);
}

void draw_pit_after(Canvas& canvas, Point2 centre, double radius) {
  canvas.disc(centre, radius, MapColours::kPitFill);
  canvas.ring(centre, radius, MapColours::kPitInk, 0.35 * radius);
}

void draw_pit_new(Canvas& canvas, Point2 centre, double radius) {
  canvas.disc(centre, radius, MapColours::kPitNew);
  canvas.ring(centre, radius, MapColours::kPitInk, 0.35 * radius);
}

}  // namespace thalweg
