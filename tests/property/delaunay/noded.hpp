#pragma once

/// Checks of a noding straight from its laws: every pair of links, every vertex against every link.

#include <thalweg/geometry/predicates.hpp>

#include <delaunay/noding.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

namespace thalweg::test {

struct Soup {
  std::vector<Point2> vertices;  // distinct
  std::vector<SegmentEnds> segments;
};

/// Numbers distinct positions and turns polylines of positions into segments.
inline Soup make_soup(const std::vector<std::vector<Point2>>& lines) {
  std::set<Point2> distinct;
  for (const auto& line : lines) distinct.insert(line.begin(), line.end());
  Soup soup;
  soup.vertices.assign(distinct.begin(), distinct.end());
  const auto id = [&](Point2 p) {
    return static_cast<std::uint32_t>(std::lower_bound(soup.vertices.begin(), soup.vertices.end(), p) -
                                      soup.vertices.begin());
  };
  for (const auto& line : lines) {
    for (std::size_t i = 0; i + 1 < line.size(); ++i) soup.segments.push_back({id(line[i]), id(line[i + 1])});
  }
  return soup;
}

inline std::vector<Point2> all_vertices(const Soup& soup, const Noding& noding) {
  std::vector<Point2> xy = soup.vertices;
  xy.insert(xy.end(), noding.crossings.begin(), noding.crossings.end());
  return xy;
}

inline std::set<std::pair<std::uint32_t, std::uint32_t>> all_links(const Noding& noding) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> links;
  for (std::size_t s = 0; s + 1 < noding.first_node.size(); ++s) {
    const auto chain = noding.chain(s);
    for (std::size_t i = 0; i + 1 < chain.size(); ++i) links.insert(std::minmax(chain[i], chain[i + 1]));
  }
  return links;
}

inline long double distance_to_segment(Point2 a, Point2 b, Point2 p) {
  const long double dx = static_cast<long double>(b.x) - a.x, dy = static_cast<long double>(b.y) - a.y;
  const long double x = static_cast<long double>(p.x) - a.x, y = static_cast<long double>(p.y) - a.y;
  const long double squared = dx * dx + dy * dy;
  const long double t = squared > 0 ? std::clamp((x * dx + y * dy) / squared, 0.0L, 1.0L) : 0.0L;
  return std::hypot(x - t * dx, y - t * dy);
}

/// How many pairs break law (2), in exact arithmetic.
inline std::size_t count_contacts(const std::vector<Point2>& xy,
                                  const std::set<std::pair<std::uint32_t, std::uint32_t>>& links) {
  std::size_t contacts = 0;
  for (auto i = links.begin(); i != links.end(); ++i) {
    const Point2 a = xy[i->first], b = xy[i->second];
    for (auto j = std::next(i); j != links.end(); ++j) {
      contacts += cross_properly(a, b, xy[j->first], xy[j->second]) ? 1 : 0;
    }
    for (std::uint32_t v = 0; v < xy.size(); ++v) {
      if (v != i->first && v != i->second && on_segment(a, b, xy[v])) ++contacts;
    }
  }
  return contacts;
}

inline void expect_noded(const Soup& soup, const Noding& noding) {
  ASSERT_FALSE(noding.failure.has_value());
  const std::vector<Point2> xy = all_vertices(soup, noding);
  EXPECT_EQ(std::set<Point2>(xy.begin(), xy.end()).size(), xy.size()) << "repeated vertices";
  EXPECT_EQ(count_contacts(xy, all_links(noding)), 0U);
  ASSERT_EQ(noding.first_node.size(), soup.segments.size() + 1);
  for (std::size_t s = 0; s < soup.segments.size(); ++s) {
    const auto chain = noding.chain(s);
    const auto [from, to] = soup.segments[s];
    ASSERT_FALSE(chain.empty());
    EXPECT_EQ(chain.front(), from);
    EXPECT_EQ(chain.back(), to);
    for (const std::uint32_t node : chain) {
      EXPECT_LT(distance_to_segment(xy[from], xy[to], xy[node]), noding.pixel);
    }
  }
}

}  // namespace thalweg::test
