// thalweg drain: pits, flow paths, network and catchments of a TIN.
#include "command.hpp"
#include "pipeline/condition_options.hpp"
#include "pipeline/source_options.hpp"

#include <thalweg/pipeline/drain.hpp>

#include <memory>
#include <string>
#include <vector>

namespace thalweg::cli {

namespace {

struct Arguments {
  DrainConfig config;
  std::vector<std::string> outlets, seeds;
  double seed_spacing = 0;
  double min_area = -1;
  ConditionArguments condition;
  Common common;
};

}  // namespace

void add_drain_command(CLI::App& app) {
  auto a = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("drain", "pits, flow paths, drainage network and catchments of a TIN");
  command->add_option("TIN", a->config.input, "TIN file")->required();
  command->add_option("OUTPUT", a->config.output, "GeoPackage to write (.gpkg)")->required();
  const auto points = [&](const char* name, std::vector<std::string>& files, const char* what) {
    command->add_option(name, files, what)
        ->expected(1)
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  };
  points("--outlets", a->outlets, "points where water leaves; repeatable");
  points("--seeds", a->seeds, "points from which flow paths are followed; repeatable");
  command->add_option("--seed-spacing", a->seed_spacing, "follow flow paths from a lattice, metres")
      ->check(positive_number());
  command->add_option("--min-area", a->min_area, "least area that a reach of the network drains, m2")
      ->check(non_negative_number())
      ->default_str("a thousandth of the TIN");
  command->add_option("--pass-pits", a->config.pass_pits_m, "pits at most so deep are full and spill, metres")
      ->check(non_negative_number())
      ->default_str("0");
  add_condition_options(*command, a->condition,
                        "Heights change before all else; what is found and counted is of the changed TIN");
  command->add_option("--conditioned", a->config.conditioned_path,
                      "TIN file for the changed heights, format by extension");
  command->add_option(
      "--mesh", a->config.mesh_path,
      "mesh with catchments, areas upstream and valleys on its vertices and edges: .nc (UGRID) "
      "or .gpkg");
  command->add_option("--swmm", a->config.swmm_path,
                      "network and subcatchments as an input file of EPA SWMM 5 (.inp)");
  add_report_option(*command, a->config.report_path);
  command->add_flag("--overwrite", a->config.overwrite, "replace existing outputs");
  add_common_options(*command, a->common);
  add_examples(*command,
               "  thalweg drain tin.ply water.gpkg --seed-spacing 50 --report water.json\n"
               "  thalweg drain tin.ply dry.gpkg --condition monotone-valleys,fill,breach "
               "--conditioned conditioned.ply\n");
  command->callback([a, command] {
    for (const std::string& file : a->outlets) a->config.outlets.push_back(parse_source(file));
    for (const std::string& file : a->seeds) a->config.seeds.push_back(parse_source(file));
    if (a->seed_spacing > 0) a->config.seed_spacing_m = a->seed_spacing;
    if (a->min_area >= 0) a->config.min_area_m2 = a->min_area;
    a->config.condition = parse_condition(*command, a->condition, {"--conditioned"});
    a->config.announce = [&a](const DrainReport& report) {
      if (a->config.report_path == "-") {
        print(to_json(report));
      } else {
        print_result(report, a->common);
      }
    };
    drain_tin(a->config, progress_of(a->common));
  });
}

}  // namespace thalweg::cli
