// thalweg build: points and lines in, optimised TIN out.
#include "command.hpp"
#include "labelling_options.hpp"
#include "source_options.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/pipeline/build.hpp>

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace thalweg::cli {

namespace {

struct BuildArguments {
  std::vector<std::string> files;  ///< points, and the output last
  SourceArguments sources;
  BuildConfig config;
  LabellingArguments labelling;
  Common common;
  double max_edge = 0;
  double max_error = 0;
  std::size_t max_points = 0;
};

void add_ground_options(CLI::App& command, BuildArguments& a) {
  command.add_option("--duplicates", a.config.ground.duplicates, "height of points with the same x, y")
      ->transform(
          CLI::CheckedTransformer(std::map<std::string, DuplicateRule>{{"first", DuplicateRule::First},
                                                                       {"last", DuplicateRule::Last},
                                                                       {"lowest", DuplicateRule::Lowest},
                                                                       {"highest", DuplicateRule::Highest},
                                                                       {"mean", DuplicateRule::Mean}}))
      ->default_str("first");
  command.add_option("--snap", a.config.snap_m, "points nearer than this, in metres, count as duplicates")
      ->check(CLI::NonNegativeNumber);
  command.add_option("--max-edge", a.max_edge, "drop rim triangles with a longer rim edge, metres")
      ->check(CLI::PositiveNumber);
}

void add_simplify_options(CLI::App& command, BuildArguments& a) {
  command
      .add_option("--max-error", a.max_error,
                  "simplify: fewest vertices from which no source point is vertically farther, metres")
      ->check(CLI::NonNegativeNumber);
  command
      .add_option("--max-points", a.max_points,
                  "simplify: number of vertices, lines and outline included; the first limit reached stops")
      ->check(CLI::Range(3U, 0xfffffffeU));
}

void run_build(const CLI::App& command, BuildArguments& a) {
  if (a.files.size() < 2) {
    throw Error(ErrorCode::Usage,
                "build takes sources of points first and the output last; only one name was given");
  }
  BuildConfig& config = a.config;
  config.output.path = a.files.back();
  for (std::size_t i = 0; i + 1 < a.files.size(); ++i) config.points.push_back(parse_source(a.files[i]));
  apply_sources(a.sources, config.read, config.lines);
  if (a.max_edge > 0) config.max_edge_m = a.max_edge;
  if (command.count("--max-error") > 0) config.max_error_m = a.max_error;
  if (command.count("--max-points") > 0) config.max_points = a.max_points;
  config.labelling = parse_labelling(a.labelling);
  const Report report = build(config, progress_of(a.common));
  print_report(report, a.common, config.output);
}

}  // namespace

void add_build_command(CLI::App& app) {
  auto arguments = std::make_shared<BuildArguments>();
  CLI::App* command = app.add_subcommand("build", "points and lines in, optimised TIN out");
  command
      ->add_option("POINTS... OUTPUT", arguments->files,
                   "sources of points (vector, text, DEM), and the output")
      ->required()
      ->type_name("");
  add_source_options(*command, arguments->sources, arguments->config.read);
  add_crossing_option(*command, arguments->config.ground);
  add_ground_options(*command, *arguments);
  add_simplify_options(*command, *arguments);
  add_labelling_options(*command, arguments->labelling);
  add_output_options(*command, arguments->config.output);
  add_common_options(*command, arguments->common);
  command->callback([arguments, command] { run_build(*command, *arguments); });
}

}  // namespace thalweg::cli
