#pragma once

/// What the subcommands share: options that all take, and where they print.

#include <thalweg/base/progress.hpp>

#include <CLI/CLI.hpp>

#include <string>

namespace thalweg::cli {

enum class Format { Text, Json };

/// Options of every command, and the progress that signals cancel.
struct Common {
  Format format = Format::Text;
  int quiet = 0;
  bool progress = false;    ///< drawn even if stderr is no terminal
  std::size_t threads = 0;  ///< 0: all cores
};

/// Adds --quiet, --progress, --format and, where work is parallel, --threads.
void add_common_options(CLI::App& command, Common& common);

/// Adds --report FILE; `path` is "-" for standard output, by whatever name.
void add_report_option(CLI::App& command, std::string& path);

/// What --help shows before the exit statuses: commands that work as they stand, a line each.
void add_examples(CLI::App& command, const std::string& lines);

/// The progress of the running command: drawn on stderr if that is a terminal or --progress asks for it, and
/// quiet is not set; cancelled by SIGINT, SIGTERM and SIGHUP.
Progress& progress_of(const Common& common);
/// Before an error is printed: so that it begins a line of its own.
void end_progress_line();

/// Prints data to stdout whole. Throws: Error{WriteFailed} (a closed pipe, a full disk).
void print(const std::string& text);

/// Prints a result as --format says; quiet holds back text alone, for JSON was asked for.
template <class Result>
void print_result(const Result& result, const Common& common) {
  if (common.format == Format::Json) {
    print(to_json(result));
  } else if (common.quiet == 0) {
    print(to_text(result));
  }
}

/// Registers the subcommands.
void add_build_command(CLI::App& app);
void add_optimize_command(CLI::App& app);
void add_convert_command(CLI::App& app);
void add_order_command(CLI::App& app);
void add_info_command(CLI::App& app);
void add_verify_command(CLI::App& app);
void add_view_command(CLI::App& app);
void add_drain_command(CLI::App& app);
void add_formats_command(CLI::App& app);

}  // namespace thalweg::cli
