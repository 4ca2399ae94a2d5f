#pragma once

/// How messages and conflicts name what was measured: "points.csv point 17", counted from 1,
/// "lines.gpkg|valleys feature 12 part 0 vertex 3".

#include <thalweg/mesh/survey.hpp>

#include <string>

namespace thalweg {

/// In the coordinates of the sources.
std::string describe_place(const Survey& survey, Point2 p);
/// Rows count from 1 within a run of points.
std::string describe_point(const Survey& survey, std::size_t point);
std::string describe_line(const Survey& survey, std::size_t line);
std::string describe_line_vertex(const Survey& survey, std::size_t line, std::size_t vertex);
/// The edge from the line's vertex to the next one.
std::string describe_line_edge(const Survey& survey, std::size_t line, std::size_t vertex);

}  // namespace thalweg
