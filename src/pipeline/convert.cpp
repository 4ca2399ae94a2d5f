// Conversion of a TIN file.
//
// 1. Read the TIN, bring it to its plane, and refuse one that breaks a law: values between its vertices would
//    mean nothing.
// 2. Mesh and layers: written as they are. Orders follow their triangles, which a Tin sorts.
// 3. Raster: strips of rows; each cell centre goes to the plane and is sampled there.
// 4. Contours: traced in the plane, written in the TIN's coordinates. Profiles likewise.
#include "base/lower_case.hpp"
#include "base/printable.hpp"
#include "pipeline/loaded_tin.hpp"
#include "pipeline/memory_estimate.hpp"
#include "pipeline/profile.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/io/read_tin.hpp>
#include <thalweg/io/write_lines.hpp>
#include <thalweg/pipeline/convert.hpp>
#include <thalweg/terrain/contours.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace thalweg {

namespace {

struct Source {
  LoadedTin loaded;
  std::vector<std::uint16_t> orders;  ///< of the TIN's triangles; empty: not known
};

// Orders in the order in which a Tin sorts its triangles.
std::vector<std::uint16_t> sorted_orders(const TinFile& file) {
  if (file.triangle_orders.empty()) return {};
  std::vector<std::pair<Triangle, std::uint16_t>> rows;
  rows.reserve(file.triangles.size());
  for (std::size_t t = 0; t < file.triangles.size(); ++t) {
    Triangle triangle = file.triangles[t];
    std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
    rows.emplace_back(triangle, file.triangle_orders[t]);
  }
  std::sort(rows.begin(), rows.end());
  std::vector<std::uint16_t> orders(rows.size());
  std::transform(rows.begin(), rows.end(), orders.begin(), [](const auto& row) { return row.second; });
  return orders;
}

Source load_source(const std::string& path, Progress& progress) {
  TinFile file = read_tin(path, progress);
  std::vector<std::uint16_t> orders = sorted_orders(file);
  Source source{load_tin(std::move(file), path, progress), std::move(orders)};
  refuse_broken(source.loaded.tin, path);
  return source;
}

/// What a conversion goes from and to.
struct Job {
  const ConvertConfig& config;
  const Source& source;
  PendingOutputs& outputs;
  Progress& progress;

  [[nodiscard]] Overwrite overwrite() const { return config.overwrite ? Overwrite::Yes : Overwrite::No; }
  [[nodiscard]] WriteOptions options() const { return {config.format, config.creation_options}; }
};

void write_mesh(const Job& job) {
  const std::vector<std::uint8_t> pits = job.source.loaded.inner_pits();
  TinView view = job.source.loaded.view(pits);
  view.triangle_orders = job.source.orders;
  write_tin(job.config.output, view, job.options(), job.outputs, job.overwrite(), job.progress);
}

// Doubles that should be whole numbers of cells are so up to rounding.
double cell_count(double length, double cell) {
  constexpr double kSlack = 1e-6;
  return std::max(1.0, std::floor(length / cell + kSlack));
}

RasterGrid grid_over(const Box2& box, double cell) {
  constexpr double kMostCells = 2e9;  // of a side too, which GDAL counts by int
  const double columns = cell_count(box.width(), cell), rows = cell_count(box.height(), cell);
  if (!(columns * rows < kMostCells)) {
    throw Error(ErrorCode::SizeLimit,
                "the raster would have more than 2e9 cells; choose a larger --resolution");
  }
  return {box.x_min, box.y_max, cell, static_cast<std::size_t>(columns), static_cast<std::size_t>(rows)};
}

RasterGrid make_grid(const RasterConfig& raster, const Source& source, std::vector<std::string>& notes) {
  if (!(raster.resolution > 0) || !std::isfinite(raster.resolution)) {
    throw Error(ErrorCode::Usage,
                "a raster needs the side of its cells, in units of the TIN's coordinates: --resolution SIZE");
  }
  const double cell = raster.resolution;
  Box2 box;
  if (raster.extent) {
    box = *raster.extent;
  } else {
    for (const Triangle& t : source.loaded.tin.triangles()) {
      for (const VertexId v : t) box.add(source.loaded.written_points()[v.index()]);
    }
    if (source.loaded.plane.projected() && box.width() > source.loaded.plane.x_period() / 2) {
      throw Error(
          ErrorCode::Usage,
          "the TIN crosses the antimeridian; say which side of it the raster shall show with --extent");
    }
    box = {box.x_min - cell / 2, box.y_min - cell / 2, box.x_max + cell / 2, box.y_max + cell / 2};
  }
  const RasterGrid grid = grid_over(box, cell);
  const double east = box.width() - static_cast<double>(grid.columns) * cell,
               south = box.height() - static_cast<double>(grid.rows) * cell;
  if (raster.extent && std::max(std::abs(east), std::abs(south)) > 1e-6 * cell) {
    notes.push_back(fmt::format(
        "the extent holds no whole number of cells: the raster ends {:.6g} {} its east and {:.6g} {} its "
        "south",
        std::abs(east), east < 0 ? "beyond" : "before", std::abs(south), south < 0 ? "beyond" : "before"));
  }
  return grid;
}

const char* band_name(SurfaceValue value) {
  switch (value) {
    case SurfaceValue::Elevation:
      return "elevation";
    case SurfaceValue::Hillshade:
      return "hillshade";
    case SurfaceValue::Slope:
      return "slope";
    case SurfaceValue::Aspect:
      return "aspect";
  }
  return "";
}

/// The box of a TIN's vertices, to which centres of cells that lie a hair beyond are moved: sides of cells as
/// 0.000277777777778 for a third of a ten-thousandth are short of their last digits.
class Brim {
 public:
  Brim(std::span<const Point2> points, double cell) : box_(bounding_box(points)), hair_(1e-6 * cell) {}
  [[nodiscard]] Point2 operator()(Point2 p) const {
    return {within(p.x, box_.x_min, box_.x_max), within(p.y, box_.y_min, box_.y_max)};
  }

 private:
  [[nodiscard]] double within(double value, double low, double high) const {
    const double clamped = std::clamp(value, low, high);
    return std::abs(value - clamped) <= hair_ ? clamped : value;
  }
  Box2 box_;
  double hair_;
};

void write_surface(const Job& job, const RasterConfig& raster, ConvertResult& result) {
  const RasterGrid grid = make_grid(raster, job.source, result.notes);
  const RasterType type = raster.value == SurfaceValue::Hillshade ? RasterType::Byte : raster.type;
  require_memory(grid, type);
  const Plane& plane = job.source.loaded.plane;
  const Brim brim(job.source.loaded.written_points(), grid.cell);
  const SurfaceSampler sampler(job.source.loaded.tin, plane.scale());
  job.progress.start_phase("sample");
  constexpr std::size_t kStrip = 1U << 20U;
  const std::size_t strip = std::max<std::size_t>(1, kStrip / grid.columns);
  std::vector<double> values;
  values.reserve(grid.columns * grid.rows);
  for (std::size_t row = 0; row < grid.rows; row += strip) {
    job.progress.advance(static_cast<double>(row) / static_cast<double>(grid.rows));
    std::vector<Point2> places;
    for (std::size_t r = row; r < std::min(grid.rows, row + strip); ++r) {
      for (std::size_t c = 0; c < grid.columns; ++c) places.push_back(brim(grid.centre(c, r)));
    }
    if (plane.projected()) places = plane.to_plane(places, job.progress);
    const std::vector<double> part = sampler.sample(places, raster.value, job.progress);
    values.insert(values.end(), part.begin(), part.end());
  }
  result.columns = grid.columns;
  result.rows = grid.rows;
  result.cells_without_data = static_cast<std::size_t>(
      std::count_if(values.begin(), values.end(), [](double value) { return std::isnan(value); }));
  if (result.cells_without_data == values.size()) {
    throw Error(ErrorCode::EmptyInput, job.config.output +
                                           ": the TIN holds the centre of no cell; look at "
                                           "--extent and --resolution");
  }
  const RasterView view{
      .grid = grid,
      .values = values,
      .type = type,
      .crs_wkt = job.source.loaded.crs.wkt,
      .description = band_name(raster.value),
      .metres_per_unit = raster.value == SurfaceValue::Elevation ? plane.vertical_metres_per_unit() : 0};
  write_raster(job.config.output, view, job.options(), job.outputs, job.overwrite(), job.progress);
}

void write_contours(const Job& job, const ContourConfig& contours, ConvertResult& result) {
  job.progress.start_phase("contours");
  const Plane& plane = job.source.loaded.plane;
  std::vector<LevelLine> lines;
  for (ContourLine& line :
       trace_contours(job.source.loaded.tin, {contours.interval, contours.base}, job.progress)) {
    if (plane.projected()) {
      for (Point2& p : line.points) p = plane.without_jump(plane.to_written(p));
    }
    lines.push_back({line.height, std::move(line.points)});
  }
  result.lines = lines.size();
  const LineLayerView view{.lines = lines,
                           .layer = "contours",
                           .field = contours.field.value_or("elev"),
                           .field_wanted = contours.field.has_value(),
                           .crs_wkt = job.source.loaded.crs.wkt};
  write_level_lines(job.config.output, view, job.options(), job.outputs, job.overwrite(), job.progress);
}

void write_profile(const Job& job, const ProfileConfig& config, ConvertResult& result) {
  const ProfileTable table = profile_table(job.source.loaded, config, job.progress);
  result.lines = table.lines;
  result.profile_rows = table.rows;
  write_text(job.outputs.add(job.config.output, job.overwrite()), job.config.output, table.csv);
}

bool is_mesh_format(const ConvertConfig& config) {
  try {
    check_write_options(config.output, {config.format, {}});
    return true;
  } catch (const Error& error) {
    return error.code() != ErrorCode::Usage;
  }
}

ConvertResult::Kind kind_of(const ConvertConfig& config) {
  if (config.profile) {
    if (!config.format.empty() || !config.creation_options.empty()) {
      throw Error(ErrorCode::Usage, "--profile gives a .csv table, and takes no --of and no --co");
    }
    if (config.output.ends_with(".csv")) return ConvertResult::Kind::Profile;
    throw Error(ErrorCode::Usage, config.output + ": a profile is a table; give a name that ends in .csv");
  }
  if (config.contours) return ConvertResult::Kind::Contours;
  if (is_mesh_format(config)) {
    if (config.raster) {
      throw Error(ErrorCode::Usage, config.output +
                                        ": is a format of TINs, but options of a raster are given; " +
                                        "name a raster format with --of");
    }
    check_write_options(config.output, {config.format, config.creation_options});
    return ConvertResult::Kind::Tin;
  }
  if (is_raster_format(config.output, config.format)) return ConvertResult::Kind::Raster;
  throw Error(ErrorCode::Usage, config.output +
                                    ": names no format of TINs (thalweg formats) and none of rasters "
                                    "(gdalinfo --formats); give another extension or --of NAME");
}

/// GeoJSON cannot say that the CRS is unknown.
void note_false_crs(const ConvertConfig& config, const CrsInfo& crs, ConvertResult& result) {
  const std::string format = config.format.empty() ? extension_of(config.output) : lower(config.format);
  if (crs.known || format.find("json") == std::string::npos) return;
  result.notes.push_back(config.output +
                         ": the CRS is unknown, but whoever reads GeoJSON takes it for longitude and "
                         "latitude; give the TIN a CRS (build --a-crs), or write another format");
}

}  // namespace

ConvertResult convert_tin(const ConvertConfig& config, Progress& progress) {
  ConvertResult result;
  result.kind = kind_of(config);
  std::vector<std::string> sources = {config.input};
  if (config.profile) sources.push_back(config.profile->lines.path);
  PendingOutputs outputs(sources);
  progress.start_phase("read");
  const Source source = load_source(config.input, progress);
  result.notes = source.loaded.notes;
  result.vertices = source.loaded.tin.vertex_count();
  result.triangles = source.loaded.tin.triangle_count();
  const Job job{config, source, outputs, progress};
  switch (result.kind) {
    case ConvertResult::Kind::Tin:
      write_mesh(job);
      break;
    case ConvertResult::Kind::Raster:
      write_surface(job, config.raster.value_or(RasterConfig{}), result);
      break;
    case ConvertResult::Kind::Contours:
      write_contours(job, *config.contours, result);
      break;
    case ConvertResult::Kind::Profile:
      write_profile(job, *config.profile, result);
      break;
  }
  note_false_crs(config, source.loaded.crs, result);
  progress.advance(1);
  if (config.announce) config.announce(result);
  outputs.commit();
  return result;
}

std::string to_json(const ConvertResult& result) {
  nlohmann::ordered_json json = {{"vertices", result.vertices}, {"triangles", result.triangles}};
  if (result.kind == ConvertResult::Kind::Raster) {
    json["raster"] = {{"columns", result.columns},
                      {"rows", result.rows},
                      {"cells_without_data", result.cells_without_data}};
  }
  if (result.kind == ConvertResult::Kind::Contours) json["contour_lines"] = result.lines;
  if (result.kind == ConvertResult::Kind::Profile) {
    json["profile"] = {{"lines", result.lines}, {"rows", result.profile_rows}};
  }
  json["notes"] = result.notes;
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string to_text(const ConvertResult& result) {
  std::string notes;
  for (const std::string& note : result.notes) notes += fmt::format("Note: {}\n", printable(note));
  const std::string tin = fmt::format("{} vertices, {} triangles", result.vertices, result.triangles);
  if (result.kind == ConvertResult::Kind::Raster) {
    return fmt::format("{}: {} x {} cells, {} of them without data\n{}", tin, result.columns, result.rows,
                       result.cells_without_data, notes);
  }
  if (result.kind == ConvertResult::Kind::Contours)
    return fmt::format("{}: {} contour lines\n{}", tin, result.lines, notes);
  if (result.kind == ConvertResult::Kind::Profile)
    return fmt::format("{}: profiles of {} lines, {} rows\n{}", tin, result.lines, result.profile_rows,
                       notes);
  return tin + "\n" + notes;
}

}  // namespace thalweg
