#pragma once

/// The inputs that triangulations are measured on, and CGAL's constrained Delaunay triangulation as measure.

#include "bench/seconds.hpp"

#include <thalweg/mesh/survey.hpp>
#include <thalweg/mesh/tin.hpp>

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

namespace thalweg::bench {

/// Spacing 30 m, heights fractal: nine octaves of noise, 12.8 km down to 50 m. The square's side is the root
/// of the number of points, rounded. Jittered: a lattice whose points move by up to 0.4 of a cell. Lattice:
/// at coordinates as of UTM. Lines: Uniform, and a breakline of one edge in each cell of a 250 x 200 frame
/// (fewer where there are fewer than twenty points an edge), between its lowest and highest point in x.
enum class InputKind { Uniform, Jittered, Lattice, Lines };

inline constexpr std::array<std::string_view, 4> kInputNames{"uniform", "jittered", "lattice", "lines"};

Survey make_survey(InputKind kind, std::size_t points);

/// The edges of the survey's lines as ids of its points.
std::vector<ConstraintEdge> line_edges(const Survey& survey);

/// Seconds of CGAL's constrained Delaunay triangulation of points and edges, as its manual has it:
/// points in spatial order, each located from the one before; then the edges between vertices known.
Seconds seconds_of_cgal(const Survey& survey, const std::vector<ConstraintEdge>& edges);

/// Starts counting the peak of resident memory anew; bytes that are resident now.
double start_peak();
/// The peak since then.
double peak_bytes();

}  // namespace thalweg::bench
