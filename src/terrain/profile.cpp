// A piece of the line at a time.
//
// 1. Triangles whose boxes meet the piece's are looked at: each side that the piece crosses, and each corner
// on
//    it, is a place of the profile, with the height of the side there.
// 2. Places are sorted along the piece; its two ends join them where they are on the surface. Two places that
//    follow each other belong together if the surface holds the middle between them.
#include "terrain/triangle_grid.hpp"

#include <thalweg/delaunay/surface.hpp>
#include <thalweg/geometry/predicates.hpp>
#include <thalweg/terrain/profile.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace thalweg {

namespace {

struct Place {
  double share = 0;  ///< of the piece, 0 to 1
  Point2 xy;
  double z = 0;
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

  void meet_side(Point2 a, Point2 b, HalfedgeId h, std::vector<Place>& places) const {
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

  [[nodiscard]] std::vector<Place> places_of(Point2 a, Point2 b) const {
    std::vector<Place> places;
    for (const auto& [p, share] : {std::pair(a, 0.0), std::pair(b, 1.0)}) {
      if (const auto t = grid.find(p)) places.push_back({share, p, height_in(tin, *t, p)});
    }
    if (a == b) return places;
    grid.visit(a, b, [&](TriangleId t) {
      for (std::size_t side = 0; side < 3; ++side) {
        const HalfedgeId h = Tin::halfedge(t, side);
        if (tin.represents_edge(h)) meet_side(a, b, h, places);
      }
    });
    std::stable_sort(places.begin(), places.end(),
                     [](const Place& p, const Place& q) { return p.share < q.share; });
    const auto same = [](const Place& p, const Place& q) { return p.xy == q.xy || p.share == q.share; };
    places.erase(std::unique(places.begin(), places.end(), same), places.end());
    return places;
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
      const ProfilePoint* last = profile.empty() ? nullptr : &profile.back();
      if (last != nullptr && last->xy == place.xy && open) continue;  // the end of the piece before
      if (last != nullptr) {
        const Point2 from = last->distance >= start ? last->xy : a;
        const Point2 middle{(from.x + place.xy.x) / 2, (from.y + place.xy.y) / 2};
        open = open && index_->grid.find(middle).has_value();
        part += open ? 0 : 1;
      }
      profile.push_back({part, start + length * place.share, place.xy, place.z});
      open = true;
    }
    if (open && profile.back().xy != b) open = false;
    start += length;
  }
  return profile;
}

}  // namespace thalweg
