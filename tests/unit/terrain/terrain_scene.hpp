#pragma once

/// Small TINs over a lattice of unit cells.

#include <thalweg/mesh/tin.hpp>

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

namespace thalweg::test {

/// columns x rows vertices at whole coordinates, each cell cut from lower left to upper right.
template <class Height>
Tin grid_tin(std::size_t columns, std::size_t rows, const Height& height) {
  std::vector<Point2> points;
  std::vector<double> heights;
  for (std::size_t j = 0; j < rows; ++j) {
    for (std::size_t i = 0; i < columns; ++i) {
      points.push_back({static_cast<double>(i), static_cast<double>(j)});
      heights.push_back(height(points.back().x, points.back().y));
    }
  }
  std::vector<Triangle> triangles;
  const auto id = [&](std::size_t i, std::size_t j) { return VertexId{j * columns + i}; };
  for (std::size_t j = 0; j + 1 < rows; ++j) {
    for (std::size_t i = 0; i + 1 < columns; ++i) {
      triangles.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
      triangles.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
    }
  }
  return {std::move(points), std::move(heights), std::move(triangles), {}};
}

}  // namespace thalweg::test
