// thalweg order: constrained orders of triangles, all triangles and useful edges of an order, quadrilaterals.
#include "command.hpp"
#include "pipeline/labelling_options.hpp"
#include "pipeline/source_options.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/io/pending_outputs.hpp>
#include <thalweg/pipeline/order_points.hpp>

#include <charconv>
#include <memory>
#include <string>
#include <vector>

namespace thalweg::cli {

namespace {

struct OrderArguments {
  std::vector<std::string> points;
  SourceArguments sources;
  std::vector<std::string> triangles;
  std::string definition = "sees-opp";
  std::string order = "1";
  OrderConfig config;
  Common common;
};

std::array<std::uint32_t, 3> parse_triangle(const std::string& text) {
  std::array<std::uint32_t, 3> corners{};
  const char* at = text.data();
  const char* const end = at + text.size();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto [rest, error] = std::from_chars(at, end, corners[i]);
    const bool last = i + 1 == corners.size();
    if (error != std::errc() || (last ? rest != end : rest == end || *rest != ',')) {
      throw Error(ErrorCode::Usage, "--triangle takes three ids A,B,C, not '" + text + "'");
    }
    at = last ? rest : rest + 1;
  }
  return corners;
}

// Refuses what would be read and not used.
void check_use(const CLI::App& command, const OrderArguments& a) {
  bool of_order = false;
  for (const char* option : {"--list-triangles", "--list-edges", "--list-conflicts"})
    of_order |= command.count(option) > 0;
  const bool lists = of_order || command.count("--list-quadrilaterals") > 0;
  const bool other = !a.triangles.empty() || a.config.census;
  // Without a list std tells of the smallest order that a triangulation can have.
  if (command.count("--definition") > 0 && !lists && (other || a.definition != "std")) {
    throw Error(ErrorCode::Usage,
                "--definition is that of lists; --triangle and --census tell of all definitions");
  }
  if (command.count("--order") > 0 && !of_order && !a.config.census) {
    throw Error(
        ErrorCode::Usage,
        "--order is the largest of lists and of --census; ask for one of them (quadrilaterals have 1)");
  }
}

void run_order(const CLI::App& command, OrderArguments& a) {
  OrderConfig& config = a.config;
  check_use(command, a);
  bool list_is_printed = false;
  for (const std::string* path :
       {&config.triangles_path, &config.edges_path, &config.conflicts_path, &config.quadrilaterals_path})
    list_is_printed |= is_standard_output(*path);
  if (list_is_printed && (!a.triangles.empty() || config.census)) {
    throw Error(ErrorCode::Usage,
                "a list and answers cannot both go to standard output; name a file for the list");
  }
  for (const std::string& source : a.points) config.points.push_back(parse_source(source));
  apply_sources(a.sources, config.read, config.lines);
  require_lines_to_cross(config.ground.crossing, OrderConfig().ground.crossing, config.lines);
  for (const std::string& triangle : a.triangles) config.triangles.push_back(parse_triangle(triangle));
  config.definition = parse_definition(a.definition);
  config.max_order = parse_order("--order", a.order);
  config.announce = [&a, list_is_printed](const OrderResult& result) {
    if (list_is_printed) return;
    if (a.common.format == Format::Json) {
      print(to_json(result));
    } else if (a.common.quiet == 0 || !result.asked.empty() || a.config.census) {
      print(to_text(result));
    }
  };
  order_points(config, progress_of(a.common));
}

}  // namespace

void add_order_command(CLI::App& app) {
  auto a = std::make_shared<OrderArguments>();
  CLI::App* command =
      app.add_subcommand("order", "constrained orders: of triangles, useful edges, quadrilaterals");
  command->add_option("POINTS", a->points, "sources of points; x and y suffice, of lines too")->required();
  add_source_options(*command, a->sources, a->config.read);
  add_crossing_option(*command, a->config.ground);
  command
      ->add_option("--triangle", a->triangles,
                   "A,B,C: the orders of this triangle under all definitions; repeatable")
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_option(
      "--picture", a->config.picture_path,
      "picture of the triangle, which vertices count under each definition: .png, .svg, .pdf");
  command->add_option("--definition", a->definition, "which constrained order: " + definition_names())
      ->capture_default_str();
  command->add_option("--order", a->order, "largest order of what is listed and counted")
      ->capture_default_str();
  command->add_option("--list-triangles", a->config.triangles_path,
                      "CSV a,b,c,order of every valid triangle of that order");
  command->add_option("--list-edges", a->config.edges_path,
                      "CSV a,b,order of every useful edge, with the smallest order at which it is useful");
  command->add_option("--list-conflicts", a->config.conflicts_path,
                      "CSV a,b,c,d,crossing of edges ab, cd that no triangulation of that order holds both");
  command->add_flag("--census", a->config.census,
                    "count triangles and useful edges of order 0 to --order under every definition");
  command->add_option("--list-quadrilaterals", a->config.quadrilaterals_path,
                      "CSV s,u,t,v,delaunay of the first-order quadrilaterals");
  command->add_flag("--overwrite", a->config.overwrite, "replace existing outputs");
  add_common_options(*command, a->common);
  add_examples(*command,
               "  thalweg order points.csv --triangle 0,1,2 -f json\n"
               "  thalweg order points.csv --valleys 'lines.gpkg|layername=valleys' --order 2 "
               "--list-triangles triangles.csv\n");
  command->callback([a, command] { run_order(*command, *a); });
}

}  // namespace thalweg::cli
