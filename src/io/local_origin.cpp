// The origin of files in single precision: chosen, written beside them, read again.
#include "io/file_content.hpp"
#include "io/file_writer.hpp"
#include "io/tin_format.hpp"

#include <thalweg/base/error.hpp>

#include <cpl_vsi.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace thalweg {

namespace {

bool is_single(double value) {
  return static_cast<double>(static_cast<float>(value)) == value;
}

}  // namespace

std::string origin_path(const std::string& path) {
  return path + ".json";
}

LocalOrigin choose_origin(std::span<const Point2> xy, std::span<const double> z) {
  const bool exact =
      std::all_of(xy.begin(), xy.end(), [](Point2 p) { return is_single(p.x) && is_single(p.y); }) &&
      std::all_of(z.begin(), z.end(), is_single);
  if (exact || xy.empty()) return {};
  const Box2 box = bounding_box(xy);
  const auto [low, high] = std::minmax_element(z.begin(), z.end());
  return {std::floor(box.x_min / 2 + box.x_max / 2), std::floor(box.y_min / 2 + box.y_max / 2),
          std::floor(*low / 2 + *high / 2)};
}

void write_origin(const std::string& target, const TinView& view, const LocalOrigin& origin, bool y_is_up,
                  PendingOutputs& pending, Overwrite mode) {
  const std::string path = origin_path(target);
  const bool needed = origin.x != 0 || origin.y != 0 || origin.z != 0;
  if (is_stream(target)) {
    if (!needed) return;
    throw Error(ErrorCode::Unsupported,
                target +
                    ": single precision takes an origin in a file beside, which a pipe or device does not "
                    "have; give the name of a file, or choose another format (--of)");
  }
  if (!needed) return pending.remove_stale(path, mode);
  using Json = nlohmann::ordered_json;
  const char* const about = y_is_up ? "add the origin to the file's x, -z, y (east, north, height)"
                                    : "add the origin to the file's x, y, z (east, north, height)";
  const Json json = {{"about", about},
                     {"origin", {origin.x, origin.y, origin.z}},
                     {"crs", view.crs_authority.empty() ? view.crs_wkt : view.crs_authority}};
  FileWriter file(pending.add(path, mode), path);
  file.text(json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  file.close();
}

LocalOrigin read_origin(const std::string& path) {
  const std::string sidecar = origin_path(path);
  VSIStatBufL status;
  if (VSIStatL(sidecar.c_str(), &status) != 0) return {};
  constexpr std::size_t kLongest = std::size_t{1} << 20U;
  const nlohmann::json json = nlohmann::json::parse(read_head(sidecar, kLongest), nullptr, false);
  const auto number = [&](std::size_t i) { return json["origin"][i].get<double>(); };
  const bool whole = json.is_object() && json.contains("origin") && json["origin"].is_array() &&
                     json["origin"].size() == 3 && json["origin"][0].is_number() &&
                     json["origin"][1].is_number() && json["origin"][2].is_number();
  if (!whole) {
    throw Error(ErrorCode::BadFormat,
                sidecar + ": tells no \"origin\": [x, y, z] for " + path + "; mend it or take it away");
  }
  return {number(0), number(1), number(2)};
}

}  // namespace thalweg
