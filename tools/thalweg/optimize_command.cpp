// thalweg optimize: the same optimisation on a TIN that exists.
#include "command.hpp"
#include "output_options.hpp"
#include "pipeline/condition_options.hpp"
#include "pipeline/labelling_options.hpp"

#include <thalweg/pipeline/build.hpp>

#include <memory>

namespace thalweg::cli {

void add_optimize_command(CLI::App& app) {
  struct Arguments {
    OptimizeConfig config;
    LabellingArguments labelling;
    ConditionArguments condition;
    Common common;
  };
  auto a = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("optimize", "optimise a TIN that exists; its constraint edges are kept");
  command->add_option("TIN", a->config.input, "TIN file")->required();
  command->add_option("OUTPUT", a->config.output.path, "TIN file to write")->required();
  add_labelling_options(*command, a->labelling);
  add_condition_options(*command, a->condition);
  add_output_options(*command, a->config.output);
  add_common_options(*command, a->common);
  add_examples(*command,
               "  thalweg optimize tin.ply smooth.ply --optimize normal-angle-squares\n"
               "  thalweg optimize tin.ply tin.xml --of LandXML --report -\n");
  command->callback([a, command] {
    a->config.labelling = parse_labelling(a->labelling);
    a->config.condition = parse_condition(*command, a->condition, {"--outlets"});
    a->config.output.announce = report_printer(a->common, a->config.output);
    optimize_tin(a->config, progress_of(a->common));
  });
}

}  // namespace thalweg::cli
