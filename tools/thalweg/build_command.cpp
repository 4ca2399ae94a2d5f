// thalweg build: points and lines in, optimised TIN out.
#include "command.hpp"
#include "output_options.hpp"
#include "pipeline/build_arguments.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/pipeline/build.hpp>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace thalweg::cli {

namespace {

struct BuildCommand {
  std::vector<std::string> files;  ///< points, and the output last
  BuildArguments arguments;
  OutputConfig output;
  Common common;
};

void run_build(const CLI::App& command, BuildCommand& a) {
  if (a.files.size() < 2) {
    throw Error(ErrorCode::Usage,
                "build takes sources of points first and the output last; only one name was given");
  }
  std::vector<SourceSpec> points;
  for (std::size_t i = 0; i + 1 < a.files.size(); ++i) points.push_back(parse_source(a.files[i]));
  BuildConfig config = config_of(command, std::move(a.arguments));
  require_lines_to_cross(config.ground.crossing, GroundOptions().crossing, config.lines);
  config.points = std::move(points);
  config.output = a.output;
  config.output.path = a.files.back();
  config.output.announce = report_printer(a.common, config.output);
  build(config, progress_of(a.common));
}

}  // namespace

void add_build_command(CLI::App& app) {
  auto a = std::make_shared<BuildCommand>();
  CLI::App* command = app.add_subcommand("build", "points and lines in, optimised TIN out");
  command
      ->add_option("POINTS... OUTPUT", a->files, "sources of points (vector, text, LAS, DEM), and the output")
      ->required()
      ->type_name("");
  add_build_options(*command, a->arguments);
  add_output_options(*command, a->output);
  add_common_options(*command, a->common);
  add_examples(
      *command,
      "  thalweg build points.csv tin.ply --a-crs EPSG:32632 --report report.json --picture tin.png\n"
      "  thalweg build points.csv tin.gpkg --valleys 'lines.gpkg|layername=valleys' "
      "--ridges 'lines.gpkg|layername=ridges'\n"
      "  thalweg build dem.tif tin.nc --max-error 5\n"
      "  thalweg build points.csv short.ply --optimize edge-length --order 2\n");
  command->callback([a, command] { run_build(*command, *a); });
}

}  // namespace thalweg::cli
