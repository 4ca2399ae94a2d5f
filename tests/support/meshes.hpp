#pragma once

/// Small TINs that tests build by hand or at random.

#include "support/random.hpp"

#include <thalweg/mesh/tin.hpp>

#include <cstddef>
#include <initializer_list>
#include <vector>

namespace thalweg::test {

inline Triangle triangle(std::size_t a, std::size_t b, std::size_t c) {
  return {VertexId{a}, VertexId{b}, VertexId{c}};
}

inline ConstraintEdge edge(std::size_t a, std::size_t b, EdgeKind kind = EdgeKind::Breakline) {
  return {VertexId{a}, VertexId{b}, kind};
}

/// A TIN of the given parts; heights are 0 where none are given.
inline Tin make_tin(std::vector<Point2> points, std::vector<Triangle> triangles,
                    std::initializer_list<ConstraintEdge> constraints = {},
                    std::vector<double> heights = {}) {
  heights.resize(points.size(), 0);
  return {std::move(points), std::move(heights), std::move(triangles),
          std::vector<ConstraintEdge>(constraints)};
}

/// A lattice of columns x rows vertices at whole coordinates, row by row, each cell with a random diagonal;
/// heights are whole numbers from 0 to `levels` - 1 at random, so that few levels make many plateaus.
inline Tin random_lattice(std::size_t columns, std::size_t rows, int levels, Random& random) {
  std::vector<Point2> points;
  std::vector<double> heights;
  for (std::size_t y = 0; y < rows; ++y) {
    for (std::size_t x = 0; x < columns; ++x) {
      points.push_back({static_cast<double>(x), static_cast<double>(y)});
      heights.push_back(random.integer(0, levels - 1));
    }
  }
  std::vector<Triangle> triangles;
  for (std::size_t y = 0; y + 1 < rows; ++y) {
    for (std::size_t x = 0; x + 1 < columns; ++x) {
      const std::size_t a = y * columns + x, b = a + 1, c = b + columns, d = a + columns;
      if (random.integer(0, 1) == 0) {
        triangles.insert(triangles.end(), {triangle(a, b, c), triangle(a, c, d)});
      } else {
        triangles.insert(triangles.end(), {triangle(a, b, d), triangle(b, c, d)});
      }
    }
  }
  return make_tin(std::move(points), std::move(triangles), {}, std::move(heights));
}

}  // namespace thalweg::test
