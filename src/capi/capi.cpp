// The C interface. Every function that can fail runs inside `guarded`, which turns exceptions into a status
// and keeps the message for the thread.
#include "base/printable.hpp"
#include "pipeline/build_arguments.hpp"
#include "pipeline/condition_options.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/pipeline/build.hpp>
#include <thalweg/thalweg.h>

#include <tbb/global_control.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

struct thalweg_job {
  std::vector<thalweg::SourceSpec> points;
  thalweg::MemorySource memory;
  std::vector<std::pair<std::string, std::string>> options;
  thalweg_progress callback = nullptr;
  void* user = nullptr;

  thalweg_job() : progress(fresh_progress()) {}
  [[nodiscard]] std::unique_ptr<thalweg::Progress> fresh_progress() {
    return std::make_unique<thalweg::Progress>([this](const std::string& phase, double fraction) {
      if (callback != nullptr && callback(phase.c_str(), fraction, user) != 0) progress->cancel();
    });
  }
  /// A wish to stop is for one build.
  void renew(std::unique_ptr<thalweg::Progress> fresh) noexcept {
    const std::lock_guard lock(mutex);
    progress.swap(fresh);
  }
  void cancel() noexcept {
    const std::lock_guard lock(mutex);
    progress->cancel();
  }

  std::mutex mutex;  ///< of the pointer, which other threads read to cancel
  std::unique_ptr<thalweg::Progress> progress;
};

struct thalweg_tin {
  thalweg::BuiltTin built;
  std::vector<thalweg::ConstraintEdge> constraints;
  std::string report;
};

namespace {

using thalweg::Error;
using thalweg::ErrorCode;

thread_local thalweg_status last_status = THALWEG_OK;
thread_local std::string last_message;

thalweg_status status_of(ErrorCode code) {
  return static_cast<thalweg_status>(static_cast<int>(code) + 1);
}
static_assert(static_cast<int>(ErrorCode::Usage) + 1 == THALWEG_USAGE);
static_assert(static_cast<int>(ErrorCode::Collinear) + 1 == THALWEG_COLLINEAR);
static_assert(static_cast<int>(ErrorCode::InvalidTin) + 1 == THALWEG_INVALID_TIN);
static_assert(static_cast<int>(ErrorCode::Internal) + 1 == THALWEG_INTERNAL);

thalweg_status failed(thalweg_status status, const char* message) noexcept {
  last_status = status;
  try {
    last_message = thalweg::printable(message);
  } catch (const std::bad_alloc&) {
    last_message.clear();
  }
  return status;
}

template <class Body>
thalweg_status guarded(const Body& body) noexcept {
  try {
    body();
    return THALWEG_OK;
  } catch (const Error& error) {
    return failed(status_of(error.code()), error.what());
  } catch (const std::bad_alloc&) {
    return failed(THALWEG_OUT_OF_MEMORY, "the machine has not enough memory for this input");
  } catch (const std::exception& error) {
    return failed(THALWEG_INTERNAL, error.what());
  } catch (...) {
    return failed(THALWEG_INTERNAL, "something was thrown that is no exception");
  }
}

void require(const void* argument, const char* what) {
  if (argument == nullptr) throw Error(ErrorCode::Usage, std::string(what) + " is NULL");
}

/// Reserves memory for more elements so that few at a time cost no more than many. Throws: Error{SizeLimit},
/// std::bad_alloc.
template <class T>
void make_room(std::vector<T>& array, std::size_t more) {
  if (more > array.max_size() - array.size()) {
    throw Error(ErrorCode::SizeLimit, std::to_string(more) + " points are more than memory can hold");
  }
  if (array.capacity() - array.size() >= more) return;
  array.reserve(std::max(array.size() + more, std::min(2 * array.capacity(), array.max_size())));
}

// A command line of build's options alone.
struct Options {
  thalweg::cli::BuildArguments arguments;
  std::size_t threads = 0;
  CLI::App command;

  Options() {
    thalweg::cli::add_build_options(command, arguments);
    command.add_option("--threads", threads)->check(CLI::Range(1, 1024));
    command.set_help_flag();
  }
};

void check_name(const std::string& name) {
  const Options options;
  if (options.command.get_option_no_throw("--" + name) != nullptr) return;
  throw Error(ErrorCode::Usage,
              "there is no option '" + name + "' of what is built; see `thalweg build --help`");
}

void parse(CLI::App& command, const thalweg_job& job) {
  std::vector<std::string> words;  // the last one first, as CLI11 takes them
  for (const auto& [name, value] : job.options) {
    // CLI11 would take the next word for it.
    if (value.empty()) throw Error(ErrorCode::Usage, "the option " + name + " has an empty value");
    words.push_back("--" + name + "=" + value);
  }
  std::reverse(words.begin(), words.end());
  try {
    command.parse(words);
  } catch (const CLI::ParseError& error) {
    throw Error(ErrorCode::Usage, error.what());
  }
}

thalweg::BuildConfig config_of(const thalweg_job& job, std::size_t& threads) {
  Options options;
  parse(options.command, job);
  threads = options.threads;
  thalweg::BuildConfig config = thalweg::cli::config_of(options.command, std::move(options.arguments));
  config.points = job.points;
  return config;
}

/// Labelling alone, for a TIN that exists.
thalweg::OptimizeConfig optimize_config_of(const thalweg_job& job, const char* path, std::size_t& threads) {
  if (!job.points.empty() || !job.memory.xy.empty() || !job.memory.lines.empty()) {
    throw Error(ErrorCode::Usage, "a TIN is optimised as it is; use a job without points and lines");
  }
  thalweg::cli::LabellingArguments arguments;
  CLI::App command;
  thalweg::cli::ConditionArguments condition;
  thalweg::cli::add_labelling_options(command, arguments);
  thalweg::cli::add_condition_options(command, condition);
  command.add_option("--threads", threads)->check(CLI::Range(1, 1024));
  command.set_help_flag();
  parse(command, job);
  return {.input = path,
          .labelling = thalweg::cli::parse_labelling(arguments),
          .condition = thalweg::cli::parse_condition(command, condition, {"--outlets"})};
}

/// Runs `work`, which gives a BuiltTin, on so many threads (0: all).
template <class Work>
std::unique_ptr<thalweg_tin> built_by(thalweg_job& job, std::size_t threads, const Work& work) {
  std::optional<tbb::global_control> limit;
  if (threads > 0) limit.emplace(tbb::global_control::max_allowed_parallelism, threads);
  auto result = std::make_unique<thalweg_tin>();
  struct Renewal {
    thalweg_job& job;
    std::unique_ptr<thalweg::Progress> fresh;
    ~Renewal() { job.renew(std::move(fresh)); }
  } const renewal{job, job.fresh_progress()};
  result->built = work();
  result->constraints = result->built.tin.constraint_edges();
  result->report = thalweg::to_json(result->built.report);
  return result;
}

}  // namespace

extern "C" {

const char* thalweg_version(void) {
  static const std::string version = thalweg::version();
  return version.c_str();
}

int thalweg_api_version(void) {
  return THALWEG_API_VERSION;
}

thalweg_status thalweg_last_status(void) {
  return last_status;
}

const char* thalweg_last_message(void) {
  return last_message.c_str();
}

const char* thalweg_status_name(thalweg_status status) {
  if (status == THALWEG_OK) return "ok";
  if (status < THALWEG_OK || status > THALWEG_INTERNAL) return "";
  return thalweg::error_name(static_cast<ErrorCode>(status - 1)).data();
}

thalweg_job* thalweg_job_new(void) {
  thalweg_job* job = nullptr;
  guarded([&] { job = std::make_unique<thalweg_job>().release(); });
  return job;
}

void thalweg_job_free(thalweg_job* job) {
  const std::unique_ptr<thalweg_job> owner(job);
}

thalweg_status thalweg_job_add_source(thalweg_job* job, const char* source) {
  return guarded([&] {
    require(job, "the job");
    require(source, "the source");
    job->points.push_back(thalweg::parse_source(source));
  });
}

thalweg_status thalweg_job_add_points(thalweg_job* job, const double* xyz, size_t count) {
  return guarded([&] {
    require(job, "the job");
    if (count > 0) require(xyz, "the array of points");
    thalweg::MemorySource& memory = job->memory;
    make_room(memory.xy, count);
    make_room(memory.z, count);
    for (std::size_t i = 0; i < count; ++i) {
      memory.xy.push_back({xyz[3 * i], xyz[3 * i + 1]});
      memory.z.push_back(xyz[3 * i + 2]);
    }
  });
}

thalweg_status thalweg_job_add_line(thalweg_job* job, int kind, const double* coordinates, size_t count,
                                    int dimension) {
  return guarded([&] {
    require(job, "the job");
    if (count > 0) require(coordinates, "the array of coordinates");
    if (dimension != 2 && dimension != 3) {
      throw Error(ErrorCode::Usage,
                  "a line has 2 or 3 coordinates a vertex, not " + std::to_string(dimension));
    }
    if (kind != THALWEG_BREAKLINE && kind != THALWEG_RIDGE && kind != THALWEG_VALLEY &&
        kind != THALWEG_BOUNDARY && kind != THALWEG_HOLE && kind != THALWEG_LAKE) {
      throw Error(ErrorCode::Usage, "there is no kind of line " + std::to_string(kind));
    }
    thalweg::MemoryLine line{.kind = static_cast<thalweg::EdgeKind>(kind)};
    const auto width = static_cast<std::size_t>(dimension);
    for (std::size_t i = 0; i < count; ++i) {
      line.xy.push_back({coordinates[width * i], coordinates[width * i + 1]});
      if (dimension == 3) line.z.push_back(coordinates[width * i + 2]);
    }
    job->memory.lines.push_back(std::move(line));
  });
}

thalweg_status thalweg_job_set_option(thalweg_job* job, const char* name, const char* value) {
  return guarded([&] {
    require(job, "the job");
    require(name, "the option's name");
    require(value, "the option's value");
    check_name(name);
    job->options.emplace_back(name, value);
  });
}

thalweg_status thalweg_job_set_progress(thalweg_job* job, thalweg_progress callback, void* user) {
  return guarded([&] {
    require(job, "the job");
    job->callback = callback;
    job->user = user;
  });
}

void thalweg_job_cancel(thalweg_job* job) {
  if (job != nullptr) job->cancel();
}

thalweg_status thalweg_job_build(thalweg_job* job, thalweg_tin** tin) {
  return guarded([&] {
    require(job, "the job");
    require(tin, "where the TIN goes");
    std::size_t threads = 0;
    const thalweg::BuildConfig config = config_of(*job, threads);
    *tin = built_by(*job, threads, [&] {
             return thalweg::build_tin(config, job->memory, *job->progress);
           }).release();
  });
}

thalweg_status thalweg_job_optimize(thalweg_job* job, const char* path, thalweg_tin** tin) {
  return guarded([&] {
    require(job, "the job");
    require(path, "the path");
    require(tin, "where the TIN goes");
    std::size_t threads = 0;
    const thalweg::OptimizeConfig config = optimize_config_of(*job, path, threads);
    *tin = built_by(*job, threads, [&] { return thalweg::optimized_tin(config, *job->progress); }).release();
  });
}

void thalweg_tin_free(thalweg_tin* tin) {
  const std::unique_ptr<thalweg_tin> owner(tin);
}

size_t thalweg_tin_vertex_count(const thalweg_tin* tin) {
  return tin == nullptr ? 0 : tin->built.tin.vertex_count();
}

size_t thalweg_tin_triangle_count(const thalweg_tin* tin) {
  return tin == nullptr ? 0 : tin->built.tin.triangle_count();
}

size_t thalweg_tin_constraint_count(const thalweg_tin* tin) {
  return tin == nullptr ? 0 : tin->constraints.size();
}

thalweg_status thalweg_tin_vertices(const thalweg_tin* tin, double* xyz) {
  return guarded([&] {
    require(tin, "the TIN");
    require(xyz, "the array of vertices");
    const thalweg::BuiltTin& built = tin->built;
    const auto xy = built.written.empty() ? built.tin.points() : std::span(built.written);
    for (std::size_t v = 0; v < xy.size(); ++v) {
      *xyz++ = xy[v].x;
      *xyz++ = xy[v].y;
      *xyz++ = built.tin.heights()[v];
    }
  });
}

thalweg_status thalweg_tin_triangles(const thalweg_tin* tin, uint32_t* corners) {
  return guarded([&] {
    require(tin, "the TIN");
    require(corners, "the array of corners");
    for (const thalweg::Triangle& t : tin->built.tin.triangles()) {
      for (const thalweg::VertexId v : t) *corners++ = v.value();
    }
  });
}

thalweg_status thalweg_tin_orders(const thalweg_tin* tin, uint16_t* orders) {
  return guarded([&] {
    require(tin, "the TIN");
    require(orders, "the array of orders");
    std::copy(tin->built.orders.begin(), tin->built.orders.end(), orders);
  });
}

thalweg_status thalweg_tin_constraints(const thalweg_tin* tin, uint32_t* ends, uint8_t* kinds) {
  return guarded([&] {
    require(tin, "the TIN");
    require(ends, "the array of ends");
    require(kinds, "the array of kinds");
    for (const thalweg::ConstraintEdge& edge : tin->constraints) {
      *ends++ = edge.a.value();
      *ends++ = edge.b.value();
      *kinds++ = static_cast<std::uint8_t>(edge.kind);
    }
  });
}

const char* thalweg_tin_crs(const thalweg_tin* tin) {
  return tin == nullptr ? nullptr : tin->built.crs.wkt.c_str();
}

const char* thalweg_tin_report(const thalweg_tin* tin) {
  return tin == nullptr ? nullptr : tin->report.c_str();
}

thalweg_status thalweg_tin_write(const thalweg_tin* tin, const char* path, const char* format,
                                 const char* const* options, int overwrite) {
  return guarded([&] {
    require(tin, "the TIN");
    require(path, "the path");
    thalweg::OutputConfig output{.path = path, .overwrite = overwrite != 0};
    if (format != nullptr) output.format = format;
    for (; options != nullptr && *options != nullptr; ++options)
      output.creation_options.emplace_back(*options);
    thalweg::Progress progress;
    thalweg::write_built(tin->built, output, progress);
  });
}

}  // extern "C"
