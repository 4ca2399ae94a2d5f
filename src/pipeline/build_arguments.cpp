// The options of the main job by name.
#include "pipeline/build_arguments.hpp"

#include "pipeline/one_of.hpp"

#include <string>
#include <utility>

namespace thalweg::cli {

namespace {

void add_ground_options(CLI::App& command, BuildArguments& a) {
  take_one_of<DuplicateRule>(
      command.add_option("--duplicates", a.config.ground.duplicates, "height of points with the same x, y"),
      {{"first", DuplicateRule::First},
       {"last", DuplicateRule::Last},
       {"lowest", DuplicateRule::Lowest},
       {"highest", DuplicateRule::Highest},
       {"mean", DuplicateRule::Mean}})
      ->default_str("first");
  command.add_option("--snap", a.config.snap_m, "points nearer than this, in metres, count as duplicates")
      ->check(non_negative_number());
  command.add_option("--max-edge", a.max_edge_m, "drop rim triangles with a longer rim edge, metres")
      ->check(positive_number());
  take_one_of<TriangulationEngine>(
      command.add_option("--engine", a.config.ground.engine,
                         "who triangulates: our own, or CGAL as a check; the triangulation is the same"),
      {{"flat", TriangulationEngine::Flat}, {"cgal", TriangulationEngine::Cgal}})
      ->default_str("flat");
  command
      .add_option("--memory-limit", a.memory_limit_bytes,
                  "refuse what needs more memory, as 4G or 500M, by an estimate before the work starts")
      ->transform(CLI::AsSizeValue(false))
      ->transform(CLI::Validator(
          [](const std::string& text) {  // CLI11 takes -1 for the largest number
            const bool begins_right = text.find_first_of("0123456789") == 0;
            return begins_right ? std::string() : "takes a size, as 4G or 500M, not '" + text + "'";
          },
          ""))
      ->type_name("SIZE")
      ->default_str("what the machine has");
}

void add_simplify_options(CLI::App& command, BuildArguments& a) {
  command
      .add_option("--max-error", a.max_error_m,
                  "simplify: fewest vertices from which no source point is vertically farther, metres")
      ->check(non_negative_number());
  command
      .add_option("--max-points", a.max_points,
                  "simplify: number of vertices, lines and outline included; the first limit reached stops")
      ->check(CLI::Range(3U, 0xfffffffeU));
}

}  // namespace

void add_build_options(CLI::App& command, BuildArguments& arguments) {
  add_source_options(command, arguments.sources, arguments.config.read);
  add_crossing_option(command, arguments.config.ground);
  add_ground_options(command, arguments);
  add_simplify_options(command, arguments);
  add_labelling_options(command, arguments.labelling);
  add_condition_options(command, arguments.condition);
}

BuildConfig config_of(const CLI::App& command, BuildArguments arguments) {
  BuildConfig config = std::move(arguments.config);
  apply_sources(arguments.sources, config.read, config.lines);
  if (command.count("--max-edge") > 0) config.max_edge_m = arguments.max_edge_m;
  if (command.count("--max-error") > 0) config.max_error_m = arguments.max_error_m;
  if (command.count("--memory-limit") > 0) config.memory_limit_bytes = arguments.memory_limit_bytes;
  if (command.count("--max-points") > 0) config.max_points = arguments.max_points;
  config.labelling = parse_labelling(arguments.labelling);
  config.condition = parse_condition(command, arguments.condition, {"--outlets"});
  return config;
}

}  // namespace thalweg::cli
