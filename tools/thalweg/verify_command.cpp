// thalweg verify: a TIN re-checked by slow and plain code.
#include "command.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/pipeline/verify_tin.hpp>

#include <algorithm>
#include <memory>
#include <string>

namespace thalweg::cli {

void add_verify_command(CLI::App& app) {
  struct Arguments {
    VerifyConfig config;
    std::string definition;
    Common common;
  };
  auto a = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("verify", "re-check a TIN against what it claims, by slow and plain code");
  command->add_option("TIN", a->config.input, "TIN file")->required();
  command->add_option("--report", a->config.report_path, "the JSON report whose claims are checked");
  command->add_option("--definition", a->definition,
                      "which constrained order (default: the report's, else sees-opp)");
  command
      ->add_option("--order", a->config.order, "largest order of a triangle (default: the report's, else 1)")
      ->check(CLI::Range(0U, 1000U));
  add_common_options(*command, a->common);
  command->callback([a] {
    if (!a->definition.empty()) a->config.definition = parse_definition(a->definition);
    const VerifyResult result = verify_tin(a->config, progress_of(a->common));
    if (a->common.format == Format::Json) {
      print(to_json(result));
    } else if (a->common.quiet == 0) {
      print(to_text(result));
    }
    if (result.holds()) return;
    const auto broken =
        std::find_if(result.findings.begin(), result.findings.end(),
                     [](const verify::Finding& f) { return f.verdict == verify::Verdict::Broken; });
    throw Error(ErrorCode::InvalidTin,
                result.path + " does not hold what it claims: " + broken->claim + ": " + broken->detail);
  });
}

}  // namespace thalweg::cli
