// thalweg info, view and formats.
#include "command.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/io/picture.hpp>
#include <thalweg/io/write_tin.hpp>
#include <thalweg/pipeline/inspect.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace thalweg::cli {

void add_info_command(CLI::App& app) {
  struct Arguments {
    std::string input;
    double above = 0;
    VolumeConfig volumes;
    Common common;
  };
  auto a = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("info", "what a TIN is: counts, CRS, extent, pits, histograms, validity");
  command->add_option("TIN", a->input, "TIN file")->required();
  command->add_option("--volume-above", a->above,
                      "volume above and below the level plane at this height, in the TIN's unit of heights");
  command->add_option("--volume-between", a->volumes.between,
                      "volume above and below another TIN of the same CRS, where both are");
  add_common_options(*command, a->common);
  add_examples(*command,
               "  thalweg info tin.ply\n"
               "  thalweg info tin.ply -f json --volume-above 450 --volume-between before.ply\n");
  command->callback([a, command] {
    if (!std::isfinite(a->above)) throw Error(ErrorCode::Usage, "--volume-above takes a finite height");
    if (command->count("--volume-above") > 0) a->volumes.above = a->above;
    const TinInfo info = inspect_tin(a->input, progress_of(a->common), a->volumes);
    print(a->common.format == Format::Json ? to_json(info) : to_text(info));
  });
}

void add_view_command(CLI::App& app) {
  struct Arguments {
    ViewConfig config;
    std::string before;
    std::optional<int> width_px;
    Common common;
  };
  auto a = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("view", "a picture of a TIN");
  command->add_option("TIN", a->config.input, "TIN file")->required();
  command->add_option("OUTPUT", a->config.output, "picture: .png, .svg or .pdf")->required();
  command->add_option("--compare", a->before,
                      "another TIN of the same vertices: both side by side, and what changed from it to TIN");
  command->add_option("--width", a->width_px, "width in pixels (default: 1600, to compare 2400)")
      ->check(CLI::Range(400, 8000));
  command->add_flag("--overwrite", a->config.overwrite, "replace an existing output");
  add_common_options(*command, a->common);
  add_examples(*command,
               "  thalweg view tin.ply view.svg\n"
               "  thalweg view --compare before.ply tin.ply difference.png\n");
  command->callback([a] {
    if (a->before.empty()) {
      if (a->width_px) a->config.width_px = *a->width_px;
      view_tin(a->config, progress_of(a->common));
      return;
    }
    CompareConfig config{a->before, a->config.input, a->config.output, a->config.overwrite};
    if (a->width_px) config.width_px = *a->width_px;
    view_comparison(config, progress_of(a->common));
  });
}

namespace {

std::vector<std::string> picture_extensions() {
  std::vector<std::string> extensions;
  for (const FormatInfo& format : picture_formats()) extensions.push_back(format.extensions.front());
  return extensions;
}

std::string formats_text() {
  std::string text = fmt::format("{:<12}{:<18}{:<8}{}\n", "TIN", "extensions", "access", "what it is");
  for (const FormatInfo& format : tin_formats()) {
    std::string extensions;
    for (const std::string& extension : format.extensions) extensions += extension + " ";
    text +=
        fmt::format("{:<12}{:<18}{:<8}{}\n", format.name, extensions,
                    std::string(format.reads ? "r" : "-") + (format.writes ? "w" : "-"), format.description);
  }
  text +=
      "\nPoints: any OGR point layer; text (.csv .xyz .txt); any GDAL raster, a point a cell centre;\n"
      "LAS 1.2 to 1.4, " +
      std::string(reads_laz() ? "compressed (LAZ) or not" : "uncompressed (built without PDAL: no LAZ)") +
      "; vertices of a mesh.\n"
      "Lines and areas: any OGR line or polygon layer. Pictures:";
  for (const std::string& extension : picture_extensions()) text += " " + extension;
  return text + ".\n";
}

std::string formats_json() {
  using Json = nlohmann::ordered_json;
  Json tins = Json::array();
  for (const FormatInfo& format : tin_formats()) {
    tins.push_back({{"name", format.name},
                    {"description", format.description},
                    {"extensions", format.extensions},
                    {"reads", format.reads},
                    {"writes", format.writes}});
  }
  Json points = {"OGR point layers", "text (.csv .xyz .txt)", "GDAL rasters", "LAS 1.2 to 1.4"};
  if (reads_laz()) points.push_back("LAZ");
  const Json json = {{"tin", tins},
                     {"points", points},
                     {"lines", {"OGR line and polygon layers"}},
                     {"pictures", picture_extensions()}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

void add_formats_command(CLI::App& app) {
  auto common = std::make_shared<Common>();
  CLI::App* command = app.add_subcommand("formats", "what is read and written");
  add_common_options(*command, *common);
  command->callback([common] { print(common->format == Format::Json ? formats_json() : formats_text()); });
}

}  // namespace thalweg::cli
