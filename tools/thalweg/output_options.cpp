// Where results go.
#include "output_options.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/io/pending_outputs.hpp>

namespace thalweg::cli {

void add_output_options(CLI::App& command, OutputConfig& output) {
  command.add_option("--of", output.format,
                     "output format (default: by the extension; see `thalweg formats`)");
  command.add_option("--co", output.creation_options, "creation option of the format, K=V; repeatable")
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command.add_flag("--overwrite", output.overwrite, "replace existing outputs");
  add_report_option(command, output.report_path);
  command.add_option("--picture", output.picture_path, "picture of the result: .png, .svg or .pdf");
  command.add_option("--dump-problem", output.problem_path,
                     "the labelling problem for another solver, toulbar2's .cfn");
  command.add_option("--condition-layer", output.changes_path,
                     "GeoPackage for the heights that --condition changes, with old and new value");
  command.add_option("--proof", output.proof_path, "a proof of the criteria's bounds, for thalweg verify");
}

std::function<void(const Report&)> report_printer(const Common& common, const OutputConfig& output) {
  if (output.report_path == "-" && is_standard_output(output.path)) {
    throw Error(ErrorCode::Usage, "TIN and report cannot both go to standard output; name a file for one");
  }
  if (output.report_path == "-") return [](const Report& report) { print(to_json(report)); };
  // No summary into what is read by a program.
  for (const std::string* path : {&output.path, &output.proof_path, &output.problem_path}) {
    if (is_standard_output(*path)) return {};
  }
  return [&common](const Report& report) { print_result(report, common); };
}

}  // namespace thalweg::cli
