#pragma once

/// A TIN file re-checked against what its report claims.

#include <thalweg/base/progress.hpp>
#include <thalweg/io/source.hpp>
#include <thalweg/order/definition.hpp>
#include <thalweg/verify/verify.hpp>

#include <optional>
#include <string>
#include <vector>

namespace thalweg {

struct VerifyConfig {
  std::string input;                          ///< TIN file
  std::string report_path;                    ///< JSON report; empty: only what needs none is checked
  std::string proof_path;                     ///< what --proof wrote; empty: bounds are proved again
  std::optional<OrderDefinition> definition;  ///< none: the report's, else sees-opp
  std::optional<unsigned> order;              ///< none: the report's, else 1
  std::optional<SourceSpec> reference;        ///< what vertical-error is measured against
  /// What the TIN was made of; without points and lines, the sources are not checked.
  std::vector<SourceSpec> points;
  std::vector<LineSource> lines;
  ReadOptions read;   ///< as given to build
  double snap_m = 0;  ///< metres in the metric plane, as given to build
};

struct VerifyResult {
  std::string path;
  std::vector<verify::Finding> findings;
  /// True if no line is broken; lines that were not checked are no reason for or against.
  [[nodiscard]] bool holds() const;
};

/// Reads the file as it is and checks it (see verify::check, verify::check_sources) in the plane that the
/// report names, else in that of the file's own extent.
/// Throws: what reading throws; Error{BadFormat} for a report that is none.
VerifyResult verify_tin(const VerifyConfig& config, Progress& progress);

std::string to_json(const VerifyResult& result);
std::string to_text(const VerifyResult& result);

}  // namespace thalweg
