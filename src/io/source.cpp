// Source names as users and QGIS write them.
#include "base/lower_case.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/io/source.hpp>

#include <string>
#include <string_view>

namespace thalweg {

SourceSpec parse_source(std::string_view text) {
  const std::string small = lower(text);
  constexpr std::string_view kLayer = "|layername=";
  for (const std::string_view other :
       {"|layerid=", "|subset=", "|geometrytype=", "|uniquegeometrytype=", "|option:"}) {
    if (small.find(other) == std::string::npos) continue;
    throw Error(ErrorCode::Usage,
                "source \"" + std::string(text) + "\": " + std::string(other) +
                    " is not supported; name a layer with |layername=NAME, filter with --where");
  }
  const std::size_t bar = small.find(kLayer);
  SourceSpec spec;
  spec.path = text.substr(0, bar);
  if (bar != std::string::npos) spec.layer = text.substr(bar + kLayer.size());
  if (spec.path.empty() || (bar != std::string::npos && spec.layer.empty())) {
    throw Error(ErrorCode::Usage,
                "source \"" + std::string(text) + "\" is not of the form PATH or PATH|layername=NAME");
  }
  return spec;
}

}  // namespace thalweg
