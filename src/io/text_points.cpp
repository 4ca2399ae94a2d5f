// Points from tables of text.
//
// 1. The first block of rows tells the format and, with a condition, the types of the columns.
// 2. The rows of a block are parsed in place, on all threads, and taken in order; those that do not parse are
//    passed over (blank, comment), or explained. The CRS stands in a .prj file of the same name, where there
//    is one.
#include "io/text_points.hpp"

#include "base/lower_case.hpp"
#include "base/parallel.hpp"
#include "io/gdal_session.hpp"
#include "io/point_collector.hpp"
#include "io/row_filter.hpp"
#include "io/row_parser.hpp"
#include "io/spatial_reference.hpp"
#include "io/text_blocks.hpp"
#include "io/text_format.hpp"

#include <thalweg/base/error.hpp>

#include <cpl_vsi.h>
#include <gdal_priv.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace thalweg {

namespace {

bool ends_with(const std::string& text, std::string_view end) {
  return lower(text).ends_with(end);
}

std::string without_gz(const std::string& path) {
  return ends_with(path, ".gz") ? path.substr(0, path.size() - 3) : path;
}

/// The path under which GDAL gives the text itself.
std::string virtual_path(const std::string& path) {
  const bool plain_gz = ends_with(path, ".gz") && path.find("/vsigzip/") == std::string::npos;
  return plain_gz ? "/vsigzip/" + path : path;
}

/// True if GDAL knows the file as data of these kinds, but no list of points in text.
bool is_more_than_text(const std::string& path, unsigned kinds) {
  GdalSession session;
  GDALDriverH driver = GDALIdentifyDriverEx(path.c_str(), kinds, nullptr, nullptr);
  if (driver == nullptr) return false;
  const std::string_view name(GDALGetDriverShortName(driver));
  return name != "XYZ" && name != "CSV";
}

class TextPoints : public SourceReader {
 public:
  TextPoints(const SourceSpec& spec, const ReadOptions& options)
      : SourceReader(spec), blocks_(virtual_path(spec.path), name()) {
    read_prj(spec);
    const bool other_datum = options.coords == PositionForm::Dms && reference().IsGeographic() != 0;
    if (options.coords && !other_datum) set_reference(parse_reference("EPSG:4326"));
  }

  void read(ReadContext& run, PlaneTransform& transform) override {
    std::string_view block = without_byte_order_mark(blocks_.next());
    const TextFormat format = detect_format(block, name(), run.options);
    take_format(run, format, block);
    const RowParser parser(format, name(), run.options);
    run.coords.taken = true;
    PointCollector points(run, transform);
    rows_to_skip_ = format.header_rows;
    const auto rows = static_cast<double>(std::count(block.begin(), block.end(), '\n'));
    expect_points(run, std::max(rows, rows * blocks_.size() / static_cast<double>(block.size())));
    while (!block.empty()) {
      read_block(block, parser, points);
      run.advance(blocks_.fraction());
      block = blocks_.next();
    }
    points.finish();
  }

 private:
  void read_prj(const SourceSpec& spec) {
    const std::string path = without_gz(spec.path);
    const std::size_t dot = path.find_last_of("./");
    if (dot == std::string::npos || path[dot] != '.') return;
    const std::string prj = path.substr(0, dot) + ".prj";
    VSIStatBufL stat;
    if (VSIStatExL(prj.c_str(), &stat, VSI_STAT_EXISTS_FLAG) == 0) set_reference(parse_reference(prj));
  }

  static std::string_view without_byte_order_mark(std::string_view text) {
    constexpr std::string_view kMark = "\xef\xbb\xbf";
    return text.substr(0, kMark.size()) == kMark ? text.substr(kMark.size()) : text;
  }

  void take_format(ReadContext& run, const TextFormat& format, std::string_view sample) {
    for (const std::string& note : format.notes) run.note(note);
    if (format.is_geographic && !run.result.crs.known) {
      run.note(
          name() +
          " has columns of longitude and latitude, but no CRS is known: they are taken as planar metres; "
          "give --a-crs EPSG:4326 if they are degrees");
    }
    if (!run.options.z_field.empty()) {
      run.z_field.taken |= format.has_z_field;
      if (!format.has_z_field)
        run.z_field.refusals.push_back(name() + " has no column " + run.options.z_field +
                                       " (its columns: " + list_columns(format) + ")");
    }
    if (run.options.where.empty()) return;
    try {
      filter_.emplace(format, sample, run.options.where, name());
      run.where.taken = true;
    } catch (const Error& error) {
      run.where.refusals.emplace_back(error.what());
    }
  }

  struct Row {
    std::string_view text;
    std::optional<RowParser::Coordinates> xyz;  ///< none: not as plain as that
  };

  void read_block(std::string_view block, const RowParser& parser, PointCollector& points) {
    const std::vector<std::string_view> parts = split_at_rows(block);
    rows_.resize(parts.size());
    for_each_block(parts.size(), 1, Progress(), [&](std::size_t part, std::size_t) {
      rows_[part].clear();
      for (std::string_view rest = parts[part]; !rest.empty();) {
        const std::string_view row = rest.substr(0, rest.find('\n'));
        rest.remove_prefix(row.size() + 1);
        rows_[part].push_back({row, parser.parse(row.data(), row.data() + row.size())});
      }
    });
    for (const std::vector<Row>& part : rows_) {
      for (const Row& row : part) take_row(row, parser, points);
    }
  }

  /// Parts of whole rows, large enough to be worth a task of their own.
  static std::vector<std::string_view> split_at_rows(std::string_view block) {
    constexpr std::size_t kPart = std::size_t{64} << 10U;
    std::vector<std::string_view> parts;
    while (!block.empty()) {
      const std::size_t size = block.size() > kPart ? block.find('\n', kPart - 1) + 1 : block.size();
      parts.push_back(block.substr(0, size));
      block.remove_prefix(size);
    }
    return parts;
  }

  void take_row(const Row& row, const RowParser& parser, PointCollector& points) {
    ++row_number_;
    if (rows_to_skip_ > 0) {
      --rows_to_skip_;
      return;
    }
    if (!row.xyz && is_passed_over(row.text)) return;
    if (filter_ && !filter_->accepts(row.text, row_number_)) return;
    const auto [x, y, z] = row.xyz ? *row.xyz : parser.parse_or_explain(row.text, row_number_);
    points.add({x, y}, z);
  }

  TextBlocks blocks_;
  std::optional<RowFilter> filter_;
  std::size_t rows_to_skip_ = 0;
  std::size_t row_number_ = 0;
  std::vector<std::vector<Row>> rows_;  ///< of the parts of a block
};

}  // namespace

bool is_text(const SourceSpec& spec) {
  // What is looked at stays in memory, and is read again.
  if (spec.path.find("/vsistdin") != std::string::npos)
    return !is_more_than_text(spec.path, GDAL_OF_RASTER | GDAL_OF_VECTOR);
  const std::string path = without_gz(spec.path);
  for (const std::string_view extension : {".csv", ".tsv", ".xyz"}) {
    if (ends_with(path, extension)) return true;
  }
  for (const std::string_view extension : {".txt", ".asc", ".dat"}) {
    if (ends_with(path, extension)) return !is_more_than_text(virtual_path(spec.path), GDAL_OF_RASTER);
  }
  return false;
}

std::unique_ptr<SourceReader> open_text(const SourceSpec& spec, const ReadOptions& options) {
  return std::make_unique<TextPoints>(spec, options);
}

}  // namespace thalweg
