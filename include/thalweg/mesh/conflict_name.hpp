#pragma once

/// Names of conflicts.

#include <thalweg/mesh/survey.hpp>

#include <string_view>

namespace thalweg {

/// A kind of conflict as report and layers name it: "duplicate-point".
constexpr std::string_view conflict_name(Conflict::Kind kind) {
  switch (kind) {
    case Conflict::Kind::DuplicatePoint:
      return "duplicate-point";
    case Conflict::Kind::PointOnLine:
      return "point-on-line";
    case Conflict::Kind::LineVertex:
      return "line-vertex";
    case Conflict::Kind::Crossing:
      return "crossing";
    case Conflict::Kind::Lake:
      return "lake";
  }
  return "unknown";
}

}  // namespace thalweg
