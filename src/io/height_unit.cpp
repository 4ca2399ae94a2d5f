#include "io/height_unit.hpp"

#include "base/lower_case.hpp"
#include "io/file_content.hpp"
#include "io/spatial_reference.hpp"

#include <thalweg/io/crs.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace thalweg {

std::optional<double> metres_of_unit(std::string_view name) {
  std::string unit = lower(name);
  std::ranges::replace(unit, '_', ' ');
  struct Unit {
    std::string_view name;
    double metres;
  };
  constexpr double kFoot = 0.3048;
  constexpr double kSurveyFoot = 1200.0 / 3937.0;
  for (const Unit& known :
       {Unit{"m", 1}, Unit{"metre", 1}, Unit{"metres", 1}, Unit{"meter", 1}, Unit{"meters", 1},
        Unit{"cm", 0.01}, Unit{"dm", 0.1}, Unit{"km", 1000}, Unit{"ft", kFoot}, Unit{"foot", kFoot},
        Unit{"feet", kFoot}, Unit{"international foot", kFoot}, Unit{"international feet", kFoot},
        Unit{"us-ft", kSurveyFoot}, Unit{"ftus", kSurveyFoot}, Unit{"us survey foot", kSurveyFoot},
        Unit{"us survey feet", kSurveyFoot}, Unit{"foot us", kSurveyFoot}}) {
    if (unit == known.name) return known.metres;
  }
  if (!unit.ends_with(" m")) return std::nullopt;
  const std::optional<double> metres = parse_number(std::string_view(unit).substr(0, unit.size() - 2));
  return metres && *metres > 0 ? metres : std::nullopt;
}

std::string local_crs(const std::string& unit, double metres_per_unit) {
  if (metres_per_unit == 1) return {};
  return fmt::format("LOCAL_CS[\"unknown, in {0}\",UNIT[\"{0}\",{1}]]", unit, metres_per_unit);
}

void take_height_unit(TinFile& tin, double metres_per_unit, const std::string& path) {
  const CrsInfo crs = describe_crs(tin.crs);
  if (is_same_unit(metres_per_unit, crs.vertical_metres_per_unit)) return;
  if (crs.vertical_unit_told) {
    tin.notes.push_back(
        fmt::format("{} tells heights in units of {:.12g} m, its CRS in units of {:.12g} m; the CRS counts",
                    path, metres_per_unit, crs.vertical_metres_per_unit));
    return;
  }
  if (crs.known) {
    if (const auto compound = with_heights_in(parse_reference(tin.crs), metres_per_unit)) {
      tin.crs = describe_reference(*compound, path).wkt;
      return;
    }
  }
  for (double& height : tin.heights) height *= metres_per_unit / crs.vertical_metres_per_unit;
  tin.notes.push_back(fmt::format("heights of {} are brought from units of {:.12g} m to units of {:.12g} m",
                                  path, metres_per_unit, crs.vertical_metres_per_unit));
}

}  // namespace thalweg
