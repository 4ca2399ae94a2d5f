// thalweg convert: from a TIN to another mesh, to vector layers, to a raster, to contours.
#include "command.hpp"
#include "pipeline/one_of.hpp"
#include "pipeline/source_options.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/io/pending_outputs.hpp>
#include <thalweg/pipeline/convert.hpp>

#include <memory>
#include <string>

namespace thalweg::cli {

namespace {

struct ConvertArguments {
  ConvertConfig config;
  RasterConfig raster;
  ContourConfig contours;
  std::string extent;
  std::string profile;
  bool has_contours = false;
  Common common;
};

void add_raster_options(CLI::App& command, ConvertArguments& a) {
  command
      .add_option("--resolution", a.raster.resolution,
                  "raster: side of a cell, in units of the TIN's coordinates")
      ->check(positive_number());
  command.add_option("--extent", a.extent, "raster: xmin,ymin,xmax,ymax of its sides (default: the TIN's)");
  take_one_of<SurfaceValue>(command.add_option("--surface", a.raster.value,
                                               "raster: elevation, hillshade, slope, aspect (degrees)"),
                            {{"elevation", SurfaceValue::Elevation},
                             {"hillshade", SurfaceValue::Hillshade},
                             {"slope", SurfaceValue::Slope},
                             {"aspect", SurfaceValue::Aspect}})
      ->default_str("elevation");
  take_one_of<RasterType>(
      command.add_option("--ot", a.raster.type, "raster: type of the values, float32 or float64"),
      {{"float32", RasterType::Float32}, {"float64", RasterType::Float64}})
      ->default_str("float32");
}

void add_contour_options(CLI::App& command, ConvertArguments& a) {
  CLI::Option* contours = command.add_flag("--contours", a.has_contours, "contour lines, in a vector layer");
  command
      .add_option("--interval", a.contours.interval,
                  "contours: between heights, in the TIN's unit of heights")
      ->check(positive_number())
      ->needs(contours);
  command.add_option("--base", a.contours.base, "contours: a height that is a contour's")->needs(contours);
  command.add_option("--field", a.contours.field, "contours: attribute with the height")
      ->needs(contours)
      ->default_str("elev");
}

void add_profile_option(CLI::App& command, ConvertArguments& a) {
  command.add_option("--profile", a.profile, "lines along which a table of heights is written, .csv");
}

void run_convert(const CLI::App& command, ConvertArguments& a) {
  if (!a.extent.empty()) a.raster.extent = parse_box("--extent", a.extent);
  bool raster = false;
  for (const char* option : {"--resolution", "--extent", "--surface", "--ot"})
    raster |= command.count(option) > 0;
  if (command.count("--ot") > 0 && a.raster.value == SurfaceValue::Hillshade) {
    throw Error(ErrorCode::Usage, "--ot is about heights, slope and aspect; a hillshade is of bytes");
  }
  if (a.has_contours) {
    if (raster) throw Error(ErrorCode::Usage, "--contours gives lines, and takes no options of a raster");
    if (command.count("--interval") == 0) {
      throw Error(ErrorCode::Usage, "--contours needs --interval H, the difference between their heights");
    }
    a.config.contours = a.contours;
  }
  if (!a.profile.empty()) {
    if (raster || a.has_contours) {
      throw Error(ErrorCode::Usage,
                  "--profile gives a table, and takes no options of a raster or of contours");
    }
    a.config.profile = ProfileConfig{parse_source(a.profile)};
  }
  if (raster) a.config.raster = a.raster;
  a.config.announce = [&a](const ConvertResult& result) {
    if (!is_standard_output(a.config.output)) print_result(result, a.common);
  };
  convert_tin(a.config, progress_of(a.common));
}

}  // namespace

void add_convert_command(CLI::App& app) {
  auto a = std::make_shared<ConvertArguments>();
  CLI::App* command =
      app.add_subcommand("convert", "a TIN to another mesh, vector layers, a raster, contours, profiles");
  command->add_option("TIN", a->config.input, "TIN file")->required();
  command->add_option("OUTPUT", a->config.output, "file to write; its extension or --of says what")
      ->required();
  add_raster_options(*command, *a);
  add_contour_options(*command, *a);
  add_profile_option(*command, *a);
  command->add_option("--of", a->config.format,
                      "format: of `thalweg formats`, or GDAL's name (GTiff, COG, ...)");
  command->add_option("--co", a->config.creation_options, "creation option K=V; repeatable")
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_flag("--overwrite", a->config.overwrite, "replace an existing output");
  add_common_options(*command, a->common);
  add_examples(*command,
               "  thalweg convert tin.ply tin.xml\n"
               "  thalweg convert tin.ply layers.gpkg --co LAYERS=triangles,breaklines\n"
               "  thalweg convert tin.ply heights.tif --resolution 5\n"
               "  thalweg convert tin.ply shade.tif --of COG --surface hillshade --resolution 5\n"
               "  thalweg convert tin.ply contours.gpkg --contours --interval 10\n"
               "  thalweg convert tin.ply profile.csv --profile 'lines.gpkg|layername=valleys'\n");
  command->callback([a, command] { run_convert(*command, *a); });
}

}  // namespace thalweg::cli
