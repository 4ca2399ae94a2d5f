// Names of measured things, from a survey's sources and runs.
#include "provenance.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace thalweg {

namespace {

std::string describe_source(const Survey& survey, std::uint32_t source) {
  if (source >= survey.sources.size()) return "source " + std::to_string(source);
  const SourceLayer& from = survey.sources[source];
  return from.layer.empty() ? from.file : from.file + "|" + from.layer;
}

}  // namespace

std::string describe_place(const Survey& survey, Point2 p) {
  if (survey.to_source) p = survey.to_source(p);
  return fmt::format("({}, {})", p.x, p.y);
}

std::string describe_point(const Survey& survey, std::size_t point) {
  const auto& runs = survey.points.runs;
  const auto after =
      std::upper_bound(runs.begin(), runs.end(), point,
                       [](std::size_t p, const SurveyPoints::Run& run) { return p < run.first; });
  if (after == runs.begin()) return fmt::format("point {}", point + 1);
  const SurveyPoints::Run& run = *std::prev(after);
  return fmt::format("{} point {}", describe_source(survey, run.source), point - run.first + 1);
}

std::string describe_line(const Survey& survey, std::size_t line) {
  const SurveyLine& l = survey.lines[line];
  return fmt::format("{} feature {} part {}", describe_source(survey, l.source), l.feature, l.part);
}

std::string describe_line_vertex(const Survey& survey, std::size_t line, std::size_t vertex) {
  return fmt::format("{} vertex {}", describe_line(survey, line), vertex);
}

std::string describe_line_edge(const Survey& survey, std::size_t line, std::size_t vertex) {
  return fmt::format("{} between vertices {} and {}", describe_line(survey, line), vertex, vertex + 1);
}

}  // namespace thalweg
