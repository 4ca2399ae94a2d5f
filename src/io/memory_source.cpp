// Arrays as sources. What a file's reader promises holds here too: unusable numbers are refused by their
// place, coordinates go through the source's transform.
#include "io/memory_source.hpp"

#include "io/point_collector.hpp"

#include <thalweg/base/error.hpp>

#include <cstdint>
#include <string>
#include <utility>

namespace thalweg {

namespace {

class MemoryPoints : public SourceReader {
 public:
  explicit MemoryPoints(const MemorySource& source)
      : SourceReader({"points in memory", ""}), source_(source) {}

  void read(ReadContext& run, PlaneTransform& transform) override {
    if (!run.options.where.empty()) run.where.refusals.push_back(name() + " have no attributes");
    if (!run.options.z_field.empty()) run.z_field.refusals.push_back(name() + " have no fields");
    if (source_.z.size() != source_.xy.size()) {
      throw Error(ErrorCode::Usage, name() + ": there are " + std::to_string(source_.xy.size()) +
                                        " positions and " + std::to_string(source_.z.size()) + " heights");
    }
    expect_points(run, static_cast<double>(source_.xy.size()));
    PointCollector points(run, transform);
    for (std::size_t i = 0; i < source_.xy.size(); ++i) {
      const Point2 p = source_.xy[i];
      if (!is_usable(p.x) || !is_usable(p.y) || !is_usable(source_.z[i])) {
        throw Error(ErrorCode::BadCoordinate,
                    name() + ": point " + std::to_string(i) + " has no usable coordinates");
      }
      points.add(p, source_.z[i]);
    }
    points.finish();
  }

 private:
  const MemorySource& source_;
};

class MemoryLines : public SourceReader {
 public:
  explicit MemoryLines(const MemorySource& source) : SourceReader({"lines in memory", ""}), source_(source) {}

  void read(ReadContext& run, PlaneTransform& transform) override {
    if (!run.options.where.empty()) run.where.refusals.push_back(name() + " have no attributes");
    if (!run.options.line_z_field.empty()) run.line_z_field.refusals.push_back(name() + " have no fields");
    if (!run.options.kind_field.empty()) run.kind_field.refusals.push_back(name() + " have no fields");
    if (run.options.bbox) {
      throw Error(ErrorCode::Usage, name() + " are not cut by a box; pass only the lines that are wanted");
    }
    std::vector<SurveyLine>& lines = run.result.survey.lines;
    std::size_t too_short = 0;
    for (std::size_t i = 0; i < source_.lines.size(); ++i) {
      SurveyLine line{.kind = source_.lines[i].kind,
                      .xy = source_.lines[i].xy,
                      .z = source_.lines[i].z,
                      .source = static_cast<std::uint32_t>(run.result.survey.sources.size() - 1),
                      .feature = static_cast<std::int64_t>(i)};
      check(line, i);
      transform.apply(line.xy, line.z);
      if (take_line(run, line)) {
        lines.push_back(std::move(line));
      } else {
        ++too_short;
      }
    }
    note_short_lines(run, too_short);
  }

 private:
  void check(const SurveyLine& line, std::size_t i) const {
    const std::string where = name() + ": line " + std::to_string(i);
    if (!line.z.empty() && line.z.size() != line.xy.size()) {
      throw Error(ErrorCode::Usage, where + " has " + std::to_string(line.xy.size()) + " positions and " +
                                        std::to_string(line.z.size()) + " heights");
    }
    for (std::size_t v = 0; v < line.xy.size(); ++v) {
      if (is_usable(line.xy[v].x) && is_usable(line.xy[v].y) && (line.z.empty() || is_usable(line.z[v]))) {
        continue;
      }
      throw Error(ErrorCode::BadCoordinate,
                  where + ", vertex " + std::to_string(v) + " has no usable coordinates");
    }
  }

  const MemorySource& source_;
};

}  // namespace

std::unique_ptr<SourceReader> open_memory_points(const MemorySource& source) {
  return std::make_unique<MemoryPoints>(source);
}

std::unique_ptr<SourceReader> open_memory_lines(const MemorySource& source) {
  return std::make_unique<MemoryLines>(source);
}

}  // namespace thalweg
