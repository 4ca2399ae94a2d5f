// The picture of a triangle's orders.
//
// 1. What is in sight is listed once: vertices and constraint edges that meet the frame. Each panel draws
//    them from bottom to top: disc, triangle, lines, dots, rings and discs, ids.
// 2. Symbols have one size while there is room, and shrink where they are many.
// 3. Coordinates are taken relative to the first corner before anything is squared, so that large coordinates
//    do not move the circle.
#include "io/picture_page.hpp"

#include <thalweg/base/assert.hpp>
#include <thalweg/io/order_picture.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

namespace thalweg {

namespace {

constexpr std::size_t kColumns = 4;
constexpr double kTallest = 1.1;  // height of a panel's map over its width
constexpr double kFontsAcross = 115;
constexpr double kSmallestFont = 7;

struct OrderColours {
  static constexpr Colour kDisc = rgb(0xe8f0f8);
  static constexpr Colour kCircle = rgb(0x5b8db8);
  static constexpr Colour kTriangle = rgb(0xc9ced4);
  static constexpr Colour kSide = rgb(0x6d747c);
  static constexpr Colour kOffGround = rgb(0xd9d7d0);
  static constexpr Colour kMarked = rgb(0xb8253a);
  static constexpr Colour kDot = rgb(0x9a9a9a);
};

struct Circle {
  Point2 centre;
  double radius = 0;
};

std::optional<Circle> circle_of(const Tin& ground, const Triangle& t) {
  const Point2 a = ground.point(t[0]), b = ground.point(t[1]), c = ground.point(t[2]);
  const double bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y;
  const double twice = 2 * (bx * cy - by * cx);
  const double b2 = bx * bx + by * by, c2 = cx * cx + cy * cy;
  const double x = (cy * b2 - by * c2) / twice, y = (bx * c2 - cx * b2) / twice;
  if (!std::isfinite(x) || !std::isfinite(y)) return std::nullopt;
  return Circle{{a.x + x, a.y + y}, std::hypot(x, y)};
}

// What a panel shows: the triangle, what is marked, and as much of the disc as has ground in it.
Box2 view_of(const OrderPictureScene& scene, const std::optional<Circle>& circle) {
  Box2 view;
  for (const VertexId v : scene.triangle) view.add(scene.ground.point(v));
  for (const OrderPanel& panel : scene.panels) {
    for (const VertexId v : panel.marked) view.add(scene.ground.point(v));
    for (const VertexId v : panel.unmarked) view.add(scene.ground.point(v));
  }
  if (circle) {
    // A disc much larger than what lies in it is cut: it would leave no room for the rest.
    constexpr double kLargest = 1.7, kBeyond = 0.15;
    const double extent = std::max(view.width(), view.height());
    const auto [centre, radius] = *circle;
    const double beyond = 2 * radius > kLargest * extent ? kBeyond * extent : 2 * radius;
    const Box2 content = view;
    view.add({std::max(centre.x - radius, content.x_min - beyond),
              std::max(centre.y - radius, content.y_min - beyond)});
    view.add({std::min(centre.x + radius, content.x_max + beyond),
              std::min(centre.y + radius, content.y_max + beyond)});
  }
  const double least = std::max(view.width(), view.height()) / 4;  // of a flat triangle
  const double margin = 0.05 * std::max(view.width(), view.height());
  const double more_x = margin + std::max(0.0, least - view.width()) / 2;
  const double more_y = margin + std::max(0.0, least - view.height()) / 2;
  Box2 framed;
  framed.add({view.x_min - more_x, view.y_min - more_y});
  framed.add({view.x_max + more_x, view.y_max + more_y});
  return framed;
}

class OrderPicture {
 public:
  explicit OrderPicture(const OrderPictureScene& scene)
      : scene_(scene),
        font_size_(std::max(kSmallestFont, scene.width_px / kFontsAcross)),
        circle_(circle_of(scene.ground, scene.triangle)) {
    lay_out();
    list_what_is_in_sight();
  }

  [[nodiscard]] double width() const { return width_; }
  [[nodiscard]] double height() const { return height_; }
  void draw(Canvas& canvas);

 private:
  void lay_out();
  void list_what_is_in_sight();
  void draw_head(Canvas& canvas, const OrderPanel& panel, double left, double top) const;
  void draw_ground(Canvas& canvas) const;
  void draw_disc_and_triangle(Canvas& canvas) const;
  void draw_lines(Canvas& canvas) const;
  void draw_vertices(Canvas& canvas, const OrderPanel& panel) const;
  [[nodiscard]] Point2 place_id(VertexId v, double width) const;
  void draw_id(Canvas& canvas, VertexId v, Colour colour) const;
  void draw_legend(Canvas& canvas) const;
  [[nodiscard]] Point2 at(VertexId v) const { return panel_.frame.to_page(scene_.ground.point(v)); }
  [[nodiscard]] bool corner(VertexId v) const {
    return std::find(scene_.triangle.begin(), scene_.triangle.end(), v) != scene_.triangle.end();
  }

  const OrderPictureScene& scene_;
  double font_size_;
  std::optional<Circle> circle_;
  double width_ = 0, margin_ = 0, head_ = 0, height_ = 0, legend_middle_ = 0, first_top_ = 0;
  std::size_t columns_ = 1;
  MapPanel panel_;               // the one that is drawn
  double symbol_ = 0, dot_ = 0;  // radii
  bool ids_ = false;
  std::vector<VertexId> vertices_;
  std::vector<HalfedgeId> lines_;
  std::vector<TriangleId> faces_;  // of a polygon
};

void OrderPicture::lay_out() {
  margin_ = 1.6 * font_size_;
  head_ = 3.1 * font_size_;
  columns_ = std::min(kColumns, scene_.panels.size());
  const auto columns = static_cast<double>(columns_);
  const double rows = std::ceil(static_cast<double>(scene_.panels.size()) / columns);
  // A single panel gets half a page.
  const double share = columns_ == 1 ? kColumns / 2.0 : static_cast<double>(kColumns);
  panel_.width = std::floor((scene_.width_px - margin_) / share - margin_);
  width_ = std::ceil(margin_ + columns * (panel_.width + margin_));
  panel_.font_size = font_size_;
  first_top_ = scene_.title.empty() ? margin_ : margin_ + 2.6 * font_size_;
  fit_ground(panel_, view_of(scene_, circle_), kTallest, 0);
  legend_middle_ = first_top_ + rows * (head_ + panel_.height + margin_) + 0.4 * font_size_;
  height_ = std::ceil(legend_middle_ + font_size_ + margin_ / 2);
}

void OrderPicture::list_what_is_in_sight() {
  const Tin& ground = scene_.ground;
  const auto meets = [](const Box2& a, const Box2& b) {
    return a.x_min <= b.x_max && a.x_max >= b.x_min && a.y_min <= b.y_max && a.y_max >= b.y_min;
  };
  // The panel's box in the plane: the frame lies in its middle.
  const double scale = panel_.frame.pixels_per_unit;
  Box2 sight = panel_.frame.ground;
  const double more_x = (panel_.width / scale - sight.width()) / 2;
  const double more_y = (panel_.height / scale - sight.height()) / 2;
  sight.add({sight.x_min - more_x, sight.y_min - more_y});
  sight.add({sight.x_max + more_x, sight.y_max + more_y});
  for (std::size_t i = 0; i < ground.vertex_count(); ++i) {
    if (sight.contains(ground.point(VertexId{i}))) vertices_.emplace_back(i);
  }
  for (std::size_t i = 0; i < ground.halfedge_count(); ++i) {
    const HalfedgeId h{i};
    if (!ground.constrained(h) || (!ground.on_rim(h) && ground.twin(h) < h)) continue;
    Box2 box;
    box.add(ground.point(ground.origin(h)));
    box.add(ground.point(ground.target(h)));
    if (meets(box, sight)) lines_.push_back(h);
  }
  for (std::size_t i = 0; scene_.mode == GroundMode::Polygon && i < ground.triangle_count(); ++i) {
    Box2 box;
    for (const VertexId v : ground.triangle(TriangleId{i})) box.add(ground.point(v));
    if (meets(box, sight)) faces_.emplace_back(i);
  }
  constexpr std::size_t kMostIds = 60;
  ids_ = vertices_.size() <= kMostIds;
  std::size_t most = 1;
  for (const OrderPanel& panel : scene_.panels) {
    most = std::max(most, panel.marked.size() + panel.unmarked.size());
  }
  // A symbol is as large as a third of the room that it has, if they are spread evenly.
  const auto size_among = [&](std::size_t count) {
    const double room = std::sqrt(panel_.width * panel_.height / static_cast<double>(count + 1));
    return std::clamp(room / 6, 0.12 * font_size_, 0.42 * font_size_);
  };
  symbol_ = size_among(most);
  dot_ = 0.45 * std::min(symbol_, size_among(vertices_.size()));
}

void OrderPicture::draw_head(Canvas& canvas, const OrderPanel& panel, double left, double top) const {
  const double baseline = top + 1.1 * font_size_;
  canvas.set_font(1.35 * font_size_, Weight::Bold);
  const double value_width = canvas.text_width(panel.value);
  canvas.text(left + panel_.width - value_width, baseline, panel.value, OrderColours::kMarked);
  canvas.set_font(1.15 * font_size_, Weight::Bold);
  canvas.text(left, baseline, canvas.fitted(printable(panel.title), panel_.width - value_width - font_size_),
              MapColours::kInk);
  canvas.set_font(0.85 * font_size_, Weight::Normal);
  canvas.text(left, baseline + 1.25 * font_size_, canvas.fitted(printable(panel.note), panel_.width),
              MapColours::kQuietInk);
}

// Over a polygon: the ground white on grey.
void OrderPicture::draw_ground(Canvas& canvas) const {
  const bool polygon = scene_.mode == GroundMode::Polygon;
  canvas.fill_box(panel_.left, panel_.top, panel_.width, panel_.height,
                  polygon ? OrderColours::kOffGround : MapColours::kPaper);
  if (!polygon) return;
  for (const TriangleId face : faces_) {
    const Triangle& t = scene_.ground.triangle(face);
    const std::array<Point2, 3> corners = {at(t[0]), at(t[1]), at(t[2])};
    canvas.add_polygon(corners);
  }
  canvas.fill(MapColours::kPaper);
}

void OrderPicture::draw_disc_and_triangle(Canvas& canvas) const {
  if (circle_) {
    const Point2 centre = panel_.frame.to_page(circle_->centre);
    const double radius = circle_->radius * panel_.frame.pixels_per_unit;
    canvas.disc(centre, radius, OrderColours::kDisc.with_alpha(0.75));
    canvas.ring(centre, radius, OrderColours::kCircle, 0.11 * font_size_);
  }
  const std::array<Point2, 4> corners = {at(scene_.triangle[0]), at(scene_.triangle[1]),
                                         at(scene_.triangle[2]), at(scene_.triangle[0])};
  canvas.add_polygon(corners);
  canvas.fill(OrderColours::kTriangle);
  canvas.stroke_path(corners, OrderColours::kSide, 0.1 * font_size_);
}

void OrderPicture::draw_lines(Canvas& canvas) const {
  for (const HalfedgeId h : lines_) {
    canvas.stroke_line(at(scene_.ground.origin(h)), at(scene_.ground.target(h)), MapColours::kInk,
                       std::min(0.26 * font_size_, 1.5 * dot_));
  }
}

// Distance of a point to a segment.
double distance_to(Point2 p, Point2 a, Point2 b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  const double length2 = dx * dx + dy * dy;
  const double along =
      length2 > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / length2, 0.0, 1.0) : 0.0;
  return std::hypot(p.x - a.x - along * dx, p.y - a.y - along * dy);
}

// The middle of a vertex's id, `width` wide: of eight places around the vertex the one with the most room.
Point2 OrderPicture::place_id(VertexId v, double width) const {
  constexpr int kPlaces = 8;
  const Point2 p = at(v);
  Point2 best = p;
  double most_room = -1e9;
  for (int i = 0; i < kPlaces; ++i) {
    const double angle = 2 * std::numbers::pi * i / kPlaces;
    const Point2 place{p.x + (symbol_ + 0.3 * font_size_ + width / 2) * std::cos(angle),
                       p.y - (symbol_ + 0.6 * font_size_) * std::sin(angle)};
    const double to_frame =
        std::min({place.x - width / 2 - panel_.left, place.y - font_size_ / 2 - panel_.top,
                  panel_.left + panel_.width - width / 2 - place.x,
                  panel_.top + panel_.height - font_size_ / 2 - place.y});
    double room = to_frame < 0 ? to_frame : 2 * font_size_;
    for (const VertexId other : vertices_) {
      if (other != v) room = std::min(room, distance_to(place, at(other), at(other)) - symbol_);
    }
    for (const HalfedgeId h : lines_) {
      room = std::min(room, distance_to(place, at(scene_.ground.origin(h)), at(scene_.ground.target(h))));
    }
    for (std::size_t k = 0; k < 3; ++k) {
      room = std::min(room, distance_to(place, at(scene_.triangle[k]), at(scene_.triangle[(k + 1) % 3])));
    }
    if (room > most_room + 1e-6) {
      most_room = room;
      best = place;
    }
  }
  return best;
}

void OrderPicture::draw_id(Canvas& canvas, VertexId v, Colour colour) const {
  const std::string text = std::to_string(v.value());
  canvas.set_font(0.8 * font_size_, corner(v) ? Weight::Bold : Weight::Normal);
  const double width = canvas.text_width(text);
  const Point2 middle = place_id(v, width);
  canvas.text(middle.x - width / 2, middle.y + 0.29 * font_size_, text, colour);
}

void OrderPicture::draw_vertices(Canvas& canvas, const OrderPanel& panel) const {
  for (const VertexId v : vertices_) {
    if (corner(v)) continue;
    const bool symbol = std::binary_search(panel.marked.begin(), panel.marked.end(), v) ||
                        std::binary_search(panel.unmarked.begin(), panel.unmarked.end(), v);
    if (!symbol) canvas.disc(at(v), dot_, OrderColours::kDot);
    if (ids_) draw_id(canvas, v, MapColours::kQuietInk);
  }
  for (const VertexId v : panel.unmarked) {
    canvas.disc(at(v), symbol_, MapColours::kPaper);
    canvas.ring(at(v), symbol_, OrderColours::kMarked, 0.3 * symbol_);
  }
  for (const VertexId v : panel.marked) canvas.disc(at(v), 1.15 * symbol_, OrderColours::kMarked);
  for (const VertexId v : scene_.triangle) {
    canvas.disc(at(v), 0.6 * symbol_, MapColours::kInk);
    draw_id(canvas, v, MapColours::kInk);
  }
}

void OrderPicture::draw_legend(Canvas& canvas) const {
  const double middle = legend_middle_;
  const double radius = 0.42 * font_size_;
  double x = margin_;
  canvas.set_font(0.95 * font_size_, Weight::Normal);
  const auto label = [&](const std::string& text) {
    x += 0.7 * font_size_;
    canvas.text(x, middle + 0.33 * font_size_, text, MapColours::kQuietInk);
    x += canvas.text_width(text) + 2 * font_size_;
  };
  if (!scene_.marked_label.empty()) {
    canvas.disc({x + radius, middle}, 1.15 * radius, OrderColours::kMarked);
    x += 2 * radius;
    label(scene_.marked_label);
  }
  if (!scene_.unmarked_label.empty()) {
    canvas.ring({x + radius, middle}, radius, OrderColours::kMarked, 0.3 * radius);
    x += 2 * radius;
    label(scene_.unmarked_label);
  }
  if (!lines_.empty()) {
    canvas.stroke_line({x, middle}, {x + 1.6 * font_size_, middle}, MapColours::kInk, 0.26 * font_size_);
    x += 1.6 * font_size_;
    label("constraint edge");
  }
}

void OrderPicture::draw(Canvas& canvas) {
  canvas.fill_box(0, 0, width(), height_, MapColours::kPaper);
  if (!scene_.title.empty()) {
    canvas.set_font(1.5 * font_size_, Weight::Bold);
    canvas.text(margin_, margin_ + 1.1 * font_size_,
                canvas.fitted(printable(scene_.title), width() - 2 * margin_), MapColours::kInk);
  }
  const MapFrame frame = panel_.frame;
  for (std::size_t i = 0; i < scene_.panels.size(); ++i) {
    const OrderPanel& panel = scene_.panels[i];
    const std::size_t column = i % columns_, row = i / columns_;
    const double left = margin_ + static_cast<double>(column) * (panel_.width + margin_);
    const double top = first_top_ + static_cast<double>(row) * (head_ + panel_.height + margin_);
    draw_head(canvas, panel, left, top);
    panel_.left = left;
    panel_.top = top + head_;
    panel_.frame.left = frame.left + panel_.left;
    panel_.frame.top = frame.top + panel_.top;
    {
      const Canvas::Clip clip(canvas, panel_.left, panel_.top, panel_.width, panel_.height);
      draw_ground(canvas);
      draw_disc_and_triangle(canvas);
      draw_lines(canvas);
      draw_vertices(canvas, panel);
    }
    canvas.stroke_box(panel_.left, panel_.top, panel_.width, panel_.height, MapColours::kQuietInk,
                      0.06 * font_size_);
  }
  draw_legend(canvas);
}

}  // namespace

void draw_order_picture(const std::string& path, const std::string& extension,
                        const OrderPictureScene& scene) {
  THALWEG_ASSERT(!scene.panels.empty());
  const PictureFormat format = parse_picture_extension(extension);
  check_width(scene.width_px);
  OrderPicture picture(scene);
  write_page(path, scene.target.empty() ? path : scene.target, {picture.width(), picture.height(), format},
             [&picture](Canvas& canvas) { picture.draw(canvas); });
}

}  // namespace thalweg
