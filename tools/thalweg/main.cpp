// The command line: parses, runs one subcommand, maps errors to one line and an exit status.
#include "base/printable.hpp"
#include "command.hpp"
#include "interrupt.hpp"
#include "pipeline/one_of.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/io/pending_outputs.hpp>
#include <thalweg/pipeline/report.hpp>

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <new>
#include <regex>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace thalweg::cli {

namespace {

constexpr int kFailed = 1;
constexpr int kUsage = 2;

std::atomic<bool> progress_line_is_open{false};

/// Draws each phase as one line `read         0...10...20...100 - done.`
class ProgressLine {
 public:
  void operator()(const std::string& phase, double fraction) {
    if (phase != phase_) {
      end_progress_line();
      progress_line_is_open = true;
      phase_ = phase;
      tick_ = 0;
      std::fputs(fmt::format("{:<12} ", phase).c_str(), stderr);
    }
    while (tick_ <= kTicks && fraction * kTicks >= tick_) {
      std::fputs(tick_ % 4 == 0 ? std::to_string(tick_ * 100 / kTicks).c_str() : ".", stderr);
      if (tick_ == kTicks) {
        std::fputs(" - done.\n", stderr);
        progress_line_is_open = false;
      }
      ++tick_;
    }
    std::fflush(stderr);
  }

 private:
  static constexpr int kTicks = 40;
  std::string phase_;
  int tick_ = 0;
};

/// A shell's variable that is not set makes an empty word, which CLI11 takes for none, or for another word.
/// Throws: Error{Usage}.
void refuse_empty_words(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i], before = i > 1 ? argv[i - 1] : "";
    if (word.starts_with("--") && word.find('=') == word.size() - 1) {
      throw Error(ErrorCode::Usage, std::string(word.substr(0, word.size() - 1)) +
                                        " has an empty value; give one, or leave the option out");
    }
    if (!word.empty()) continue;
    if (before.size() > 1 && before.starts_with('-') && before != "--") {
      throw Error(ErrorCode::Usage,
                  std::string(before) +
                      " is followed by an empty word; give a value or a name, or leave the empty word out");
    }
    throw Error(ErrorCode::Usage, "an empty word stands for the name of a file or command, after '" +
                                      std::string(i > 1 ? before : "thalweg") + "'; give the name");
  }
}

/// GDAL's habit of long options with one dash, and its names for CRS options.
std::vector<std::string> normalise(int argc, char** argv) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 8> kNames{{
      {"-s_srs", "--s-crs"},
      {"-t_srs", "--t-crs"},
      {"-a_srs", "--a-crs"},
      {"--s_srs", "--s-crs"},
      {"--t_srs", "--t-crs"},
      {"--a_srs", "--a-crs"},
      {"-of", "--of"},
      {"-co", "--co"},
  }};
  std::vector<std::string> arguments;
  for (int i = argc - 1; i > 0; --i) {  // CLI11 takes them last first
    std::string argument = argv[i];
    for (const auto& [name, replacement] : kNames) {
      if (argument == name) argument = replacement;
    }
    arguments.push_back(std::move(argument));
  }
  return arguments;
}

int fail(std::string_view code, std::string_view message, int status) {
  end_progress_line();
  std::fputs(fmt::format("ERROR {}: {}\n", code, printable(message)).c_str(), stderr);
  return status;
}

/// Whether it says that the system gives no more threads: in the words of the C++ library, or of TBB.
bool lacks_threads(const std::exception& error) {
  const auto* const system = dynamic_cast<const std::system_error*>(&error);
  return (system != nullptr && system->code() == std::errc::resource_unavailable_try_again) ||
         std::string_view(error.what()).find("pthread_create") != std::string_view::npos;
}

/// Shows the names that an option takes, "{first,last}", without the kind of value that they stand for.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option_opts(const CLI::Option* option) const override {
    static const std::regex choice("(ENUM|TEXT):\\{");
    return std::regex_replace(CLI::Formatter::make_option_opts(option), choice, "{");
  }
};

int run(int argc, char** argv) {
  CLI::App app{
      "Thalweg builds terrain TINs: higher-order constrained Delaunay triangulations of elevation\n"
      "points and ridge and valley lines, optimised with proof.",
      "thalweg"};
  app.set_version_flag("--version", "thalweg " + version());
  app.formatter(std::make_shared<HelpFormatter>());
  app.require_subcommand(1);
  app.footer(
      "Exit status: 0 done; 1 failed (data, input/output, memory); 2 usage; 130 interrupted.\n"
      "Sources are PATH or 'PATH|layername=NAME'. `thalweg COMMAND --help` tells more.");
  add_build_command(app);
  add_optimize_command(app);
  add_convert_command(app);
  add_order_command(app);
  add_info_command(app);
  add_verify_command(app);
  add_view_command(app);
  add_drain_command(app);
  add_formats_command(app);
  refuse_empty_words(argc, argv);
  try {
    app.parse(normalise(argc, argv));
  } catch (const CLI::Success& success) {
    std::ostringstream help;
    const int status = app.exit(success, help);
    print(help.str());
    return status;
  } catch (const CLI::RequiredError& error) {
    // CLI11 says that one is required, too, where the word is not the name of any.
    const std::string word = argc > 1 ? argv[1] : "";
    if (app.get_subcommands().empty() && !word.empty() && word[0] != '-') {
      return fail("usage", "there is no command '" + word + "'; thalweg --help lists them", kUsage);
    }
    return fail("usage", std::string(error.what()) + " (see --help)", kUsage);
  } catch (const CLI::ParseError& error) {
    return fail("usage", std::string(error.what()) + " (see --help)", kUsage);
  }
  return 0;
}

}  // namespace

void add_report_option(CLI::App& command, std::string& path) {
  command.add_option("--report", path, "JSON report; - for stdout")
      ->transform([](const std::string& name) { return is_standard_output(name) ? "-" : name; }, "");
}

void add_examples(CLI::App& command, const std::string& lines) {
  command.footer("Examples:\n" + lines + "\n" + command.get_footer());
}

void add_common_options(CLI::App& command, Common& common) {
  command.set_version_flag("--version", "thalweg " + version());
  command.add_flag("-q,--quiet", common.quiet,
                   "no progress and no summary (but what -f json asks for); only errors");
  command.add_flag("--progress", common.progress, "draw progress also where stderr is no terminal");
  take_one_of<Format>(command.add_option("-f,--format", common.format, "what is printed: text or json"),
                      {{"text", Format::Text}, {"json", Format::Json}})
      ->default_str("text");
  command.add_option("--threads", common.threads, "threads to use; the result does not depend on it")
      ->check(CLI::Range(1, 1024))
      ->default_str("all cores");
}

Progress& progress_of(const Common& common) {
  static std::unique_ptr<tbb::global_control> limit;
  if (common.threads > 0) {
    limit =
        std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, common.threads);
  }
  const bool draw = common.quiet == 0 && (common.progress || isatty(STDERR_FILENO) != 0);
  static auto* const progress = draw ? new Progress(ProgressLine{}) : new Progress;  // outlives all threads
  cancel_on_signal(*progress);
  return *progress;
}

void end_progress_line() {
  if (progress_line_is_open.exchange(false)) std::fputc('\n', stderr);
}

constexpr const char* kNoMemory = "the machine has not enough memory for this input; nothing was written";

// Where memory ends within a library that lets no exception pass, nothing can be unwound.
[[noreturn]] void end_where_nothing_unwinds() {
  abandon_pending_outputs();
  try {
    if (const std::exception_ptr thrown = std::current_exception()) std::rethrow_exception(thrown);
  } catch (const std::bad_alloc&) {
    end_progress_line();
    for (const char* part : {"ERROR out-of-memory: ", kNoMemory, "\n"}) std::fputs(part, stderr);
    ::_exit(kFailed);
  } catch (...) {
    end_progress_line();
    std::fputs("ERROR internal: an error where none may pass; nothing was written\n", stderr);
  }
  std::abort();
}

void print(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) {
    throw Error(ErrorCode::WriteFailed,
                "standard output cannot be written; is its reader gone or its disk full?");
  }
}

}  // namespace thalweg::cli

int main(int argc, char** argv) {
  using namespace thalweg;
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  std::set_terminate(cli::end_where_nothing_unwinds);
  try {
    cli::watch_signals();
    return cli::run(argc, argv);
  } catch (const Error& error) {
    const int status = error.code() == ErrorCode::Usage       ? cli::kUsage
                       : error.code() == ErrorCode::Cancelled ? cli::kInterrupted
                                                              : cli::kFailed;
    if (error.code() == ErrorCode::Cancelled) cli::claim_interruption();
    return cli::fail(error_name(error.code()), error.what(), status);
  } catch (const std::bad_alloc&) {
    return cli::fail("out-of-memory", cli::kNoMemory, cli::kFailed);
  } catch (const std::exception& error) {
    if (cli::lacks_threads(error)) {
      return cli::fail(
          "out-of-memory",
          "the system gives no more threads: too little memory (ulimit -v) or too many processes "
          "(ulimit -u); fewer threads: --threads 1; nothing was written",
          cli::kFailed);
    }
    return cli::fail("internal", error.what(), cli::kFailed);
  }
}
