// A piece of the line at a time.
//
// 1. Triangles whose boxes meet the piece's are looked at: each side that the piece crosses, and each corner
//    on it, is a place of the profile, with the height of the side there.
// 2. Places are sorted along the piece; its two ends join them where they are on the surface. Two places that
//    follow each other belong together if both are on one triangle: what lies between them meets no edge.
#include "terrain/triangle_grid.hpp"

#include <thalweg/delaunay/surface.hpp>
#include <thalweg/geometry/predicates.hpp>
#include <thalweg/terrain/profile.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace thalweg {

namespace {

struct Place {
  double share = 0;  ///< of the piece, 0 to 1
  Point2 xy;
  double z = 0;
  bool joined = false;  ///< to the place before
};

/// What a triangle has of the piece.
struct Stretch {
  double from = 0, to = 0;
};

double height_in(const Tin& tin, TriangleId t, Point2 p) {
  const Triangle& corner = tin.triangle(t);
  std::array<Point2, 3> xy;
  std::array<double, 3> z{};
  for (std::size_t i = 0; i < 3; ++i) {
    xy[i] = tin.point(corner[i]);
    z[i] = tin.height(corner[i]);
    if (xy[i] == p) return z[i];
  }
  return interpolate_on_triangle(xy, z, p);
}

double share_of(Point2 a, Point2 b, Point2 p) {
  const double x = b.x - a.x, y = b.y - a.y;
  return std::clamp(((p.x - a.x) * x + (p.y - a.y) * y) / (x * x + y * y), 0.0, 1.0);
}

}  // namespace

struct ProfileTracer::Index {
  const Tin& tin;
  TriangleGrid grid;

  explicit Index(const Tin& the_tin) : tin(the_tin), grid(the_tin) {}

  /// Places at one side of a triangle, the same for both triangles there.
  void meet_side(Point2 a, Point2 b, HalfedgeId h, std::vector<Place>& places) const {
    if (!tin.represents_edge(h)) h = tin.twin(h);
    const Point2 p = tin.point(tin.origin(h)), q = tin.point(tin.target(h));
    for (const VertexId v : {tin.origin(h), tin.target(h)}) {
      const Point2 at = tin.point(v);
      if (on_segment(a, b, at)) places.push_back({share_of(a, b, at), at, tin.height(v)});
    }
    if (!cross_properly(a, b, p, q)) return;
    const double above = (q.x - p.x) * (a.y - p.y) - (q.y - p.y) * (a.x - p.x);
    const double below = (q.x - p.x) * (b.y - p.y) - (q.y - p.y) * (b.x - p.x);
    const double share = above == below ? 0.5 : std::clamp(above / (above - below), 0.0, 1.0);
    const Point2 xy{a.x + (b.x - a.x) * share, a.y + (b.y - a.y) * share};
    places.push_back(
        {share, xy, interpolate_on_segment(p, tin.height(tin.origin(h)), q, tin.height(tin.target(h)), xy)});
  }

  [[nodiscard]] bool holds(TriangleId t, Point2 p) const {
    const Triangle& corner = tin.triangle(t);
    for (std::size_t i = 0; i < 3; ++i) {
      if (orientation(tin.point(corner[i]), tin.point(corner[(i + 1) % 3]), p) < 0) return false;
    }
    return true;
  }

  [[nodiscard]] std::vector<Place> places_of(Point2 a, Point2 b) const {
    std::vector<Place> places;
    std::vector<Stretch> stretches;
    grid.visit(a, b, [&](TriangleId t) {
      const std::size_t first = places.size();
      if (holds(t, a)) places.push_back({0, a, height_in(tin, t, a)});
      if (holds(t, b)) places.push_back({1, b, height_in(tin, t, b)});
      for (std::size_t side = 0; side < 3; ++side) meet_side(a, b, Tin::halfedge(t, side), places);
      if (places.size() == first) return;
      const auto [from, to] = std::ranges::minmax(std::span(places).subspan(first), {}, &Place::share);
      if (from.share < to.share) stretches.push_back({from.share, to.share});
    });
    std::ranges::stable_sort(places, {}, &Place::share);
    std::ranges::sort(stretches, {}, &Stretch::from);
    join(places, stretches);
    return places;
  }

  /// Leaves one of the places that rounding puts at the same point; says which follow each other on one
  /// triangle.
  static void join(std::vector<Place>& places, std::span<const Stretch> stretches) {
    std::size_t kept = 0;
    auto next = stretches.begin();
    double covered = -1;  // up to here by triangles that start at places before, or here
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Place place = places[i];
      const bool again =
          kept > 0 && (places[kept - 1].xy == place.xy || places[kept - 1].share == place.share);
      if (!again) {
        places[kept] = place;
        places[kept].joined = covered >= place.share;
        ++kept;
      }
      for (; next != stretches.end() && next->from <= place.share; ++next)
        covered = std::max(covered, next->to);
    }
    places.resize(kept);
  }
};

ProfileTracer::ProfileTracer(const Tin& tin) : index_(std::make_unique<const Index>(tin)) {}
ProfileTracer::~ProfileTracer() = default;

std::vector<ProfilePoint> ProfileTracer::trace(std::span<const Point2> line, const Progress& progress) const {
  std::vector<ProfilePoint> profile;
  double start = 0;
  std::size_t part = 0;
  bool open = false;  // the place before, if any, and this one are on one part
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    progress.check();
    const Point2 a = line[i], b = line[i + 1];
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    if (length == 0) continue;
    for (const Place& place : index_->places_of(a, b)) {
      const bool goes_on = open && (place.joined || profile.back().xy == place.xy);
      if (goes_on && profile.back().xy == place.xy) continue;  // the end of the piece before
      if (!goes_on && !profile.empty()) ++part;
      profile.push_back({part, start + length * place.share, place.xy, place.z});
      open = true;
    }
    if (open && profile.back().xy != b) open = false;
    start += length;
  }
  return profile;
}

}  // namespace thalweg
