#pragma once

/// Options about sources, which several commands and faces share.

#include <thalweg/delaunay/ground.hpp>
#include <thalweg/io/source.hpp>

#include <CLI/CLI.hpp>

#include <span>
#include <string>
#include <vector>

namespace thalweg::cli {

/// Names of files as typed.
struct SourceArguments {
  std::vector<std::string> ridges, valleys, breaklines, boundary, holes, lakes;
  std::string bbox;
};

void add_source_options(CLI::App& command, SourceArguments& arguments, ReadOptions& read);
void add_crossing_option(CLI::App& command, GroundOptions& ground);
/// Throws: Error{Usage} if --crossing asks for something, and no lines are given.
void require_lines_to_cross(CrossingRule crossing, CrossingRule by_default,
                            std::span<const LineSource> lines);
/// Reads "xmin,ymin,xmax,ymax"; `option` is named in errors. Throws: Error{Usage}.
Box2 parse_box(const std::string& option, const std::string& text);
/// Checks of options: a finite number above 0; one that is not below it.
CLI::Validator positive_number();
CLI::Validator non_negative_number();
/// Turns the names into sources. Throws: Error{Usage}.
void apply_sources(const SourceArguments& arguments, ReadOptions& read, std::vector<LineSource>& lines);

}  // namespace thalweg::cli
