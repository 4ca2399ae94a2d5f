// Reading sources into one survey.
#include <thalweg/base/error.hpp>
#include <thalweg/io/source.hpp>

#include <span>

namespace thalweg {

ReadResult read_survey(std::span<const SourceSpec> points, std::span<const LineSource>, const ReadOptions&,
                       Progress&) {
  throw Error(ErrorCode::Unsupported,
              "sources cannot be read yet: " + (points.empty() ? "" : points[0].path));
}

}  // namespace thalweg
