// thalweg verify: a TIN re-checked by slow and plain code.
#include "command.hpp"
#include "pipeline/labelling_options.hpp"
#include "pipeline/source_options.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/pipeline/verify_tin.hpp>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace thalweg::cli {

namespace {

/// Throws: Error{Usage} if one of these options was given.
void refuse_given(const std::vector<CLI::Option*>& of_sources) {
  for (const CLI::Option* option : of_sources) {
    if (option->count() == 0) continue;
    throw Error(ErrorCode::Usage, option->get_name() + " says how sources are read; name them with --points");
  }
}

/// Throws: Error{InvalidTin} if something does not hold.
void tell(const VerifyResult& result, const Common& common) {
  print_result(result, common);
  if (result.holds()) return;
  const auto broken =
      std::find_if(result.findings.begin(), result.findings.end(),
                   [](const verify::Finding& f) { return f.verdict == verify::Verdict::Broken; });
  throw Error(ErrorCode::InvalidTin,
              result.path + " does not hold what it claims: " + broken->claim + ": " + broken->detail);
}

}  // namespace

void add_verify_command(CLI::App& app) {
  struct Arguments {
    VerifyConfig config;
    std::string definition;
    std::vector<std::string> points;
    std::string reference;
    SourceArguments sources;
    Common common;
  };
  auto a = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("verify", "re-check a TIN against what it claims, by slow and plain code");
  command->add_option("TIN", a->config.input, "TIN file")->required();
  command->add_option("--report", a->config.report_path, "the JSON report whose claims are checked");
  command->add_option("--proof", a->config.proof_path,
                      "the proof that --proof of build wrote, checked step by step; needs --report");
  command->add_option(
      "--definition", a->definition,
      "which constrained order (default: the report's, else sees-opp): " + definition_names());
  command
      ->add_option("--order", a->config.order, "largest order of a triangle (default: the report's, else 1)")
      ->check(CLI::Range(0U, kLargestOrder));
  command->add_option("--reference", a->reference,
                      "what vertical-error was measured against: a DEM, or points");
  command->add_option("--points", a->points, "sources of points that the TIN was built of; repeatable")
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  const std::size_t before = command->get_options().size();
  add_source_options(*command, a->sources, a->config.read);
  command->add_option("--snap", a->config.snap_m, "as given to build, metres")->check(non_negative_number());
  const auto all = command->get_options();
  const std::vector<CLI::Option*> of_sources(all.begin() + static_cast<std::ptrdiff_t>(before), all.end());
  add_common_options(*command, a->common);
  add_examples(*command, "  thalweg verify tin.ply --report report.json --points points.csv\n");
  command->callback([a, of_sources] {
    if (!a->reference.empty()) a->config.reference = parse_source(a->reference);
    for (const std::string& file : a->points) a->config.points.push_back(parse_source(file));
    apply_sources(a->sources, a->config.read, a->config.lines);
    if (a->config.points.empty() && a->config.lines.empty()) refuse_given(of_sources);
    if (!a->config.proof_path.empty() && a->config.report_path.empty()) {
      throw Error(ErrorCode::Usage, "--proof proves what a report claims; give --report too");
    }
    if (!a->definition.empty()) a->config.definition = parse_definition(a->definition);
    const VerifyResult result = verify_tin(a->config, progress_of(a->common));
    tell(result, a->common);
  });
}

}  // namespace thalweg::cli
