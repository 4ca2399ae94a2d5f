// Choosing the writer of a TIN, and the CRS sidecar.
//
// A sidecar NAME.prj belongs to the output where the format cannot hold the CRS. If the TIN has no CRS, a
// NAME.prj that lies there already would be taken for its own: it has to go. One that says the same, as that
// of NAME in another format does, stays.
#include "base/lower_case.hpp"
#include "io/file_content.hpp"
#include "io/file_writer.hpp"
#include "io/gdal_session.hpp"
#include "io/spatial_reference.hpp"
#include "io/tin_format.hpp"

#include <thalweg/base/error.hpp>

#include <cpl_conv.h>

#include <algorithm>
#include <array>
#include <memory>

namespace thalweg {

namespace {

std::string list_formats() {
  std::string list;
  for (const TinFormat& format : tin_format_table()) {
    if (format.write == nullptr) continue;
    list += (list.empty() ? "" : ", ") + format.info.name + " (" + format.info.extensions.front() + ")";
  }
  return list;
}

const TinFormat& choose_format(const std::string& path, const std::string& name) {
  const std::string extension = extension_of(path);
  for (const TinFormat& format : tin_format_table()) {
    const std::vector<std::string>& extensions = format.info.extensions;
    const bool same = name.empty()
                          ? std::find(extensions.begin(), extensions.end(), extension) != extensions.end()
                          : lower(format.info.name) == lower(name);
    if (same && format.write != nullptr) return format;
  }
  if (!name.empty()) {
    throw Error(ErrorCode::Usage,
                "'" + name + "' is no format that a TIN can be written in; known are " + list_formats());
  }
  throw Error(ErrorCode::Usage, path + ": " +
                                    (extension.empty() ? "a name without an extension does not say"
                                                       : "the extension '" + extension + "' does not name") +
                                    " a format for a TIN; known are " + list_formats() +
                                    ", or name it with --of");
}

void check_target(const std::string& path, const TinFormat& format) {
  if (format.target == TinFormat::Target::Stream || !is_stream(path)) return;
  throw Error(ErrorCode::Unsupported, path + ": is a pipe or a device, and " + format.info.name +
                                          " can be written to a file only; give the name of one, or choose "
                                          "another format (--of)");
}

void check_sizes(const TinView& view) {
  const auto fits = [](std::size_t size, std::size_t wanted) { return size == 0 || size == wanted; };
  const std::size_t vertices = view.tin.vertex_count();
  if (!fits(view.written_xy.size(), vertices) || !fits(view.is_pit.size(), vertices) ||
      !fits(view.vertex_source.size(), vertices) ||
      !fits(view.triangle_orders.size(), view.tin.triangle_count())) {
    throw Error(ErrorCode::Internal,
                "the attributes of a TIN to write do not fit its vertices and triangles");
  }
}

// Empty if the version of WKT cannot express the reference.
std::string export_wkt(const OGRSpatialReference& reference, const char* version) {
  const std::array<const char*, 2> options = {version, nullptr};
  char* text = nullptr;
  const OGRErr failed = reference.exportToWkt(&text, options.data());
  const std::unique_ptr<char, void (*)(void*)> owner(text, CPLFree);
  return failed != OGRERR_NONE || text == nullptr ? std::string() : std::string(text);
}

// WKT 1 is what most programs expect in a .prj.
std::string prj_text(const std::string& definition) {
  const GdalSession quiet;
  const OGRSpatialReference reference = parse_reference(definition);
  const std::string wkt = export_wkt(reference, "FORMAT=WKT1_GDAL");
  return wkt.empty() ? export_wkt(reference, "FORMAT=WKT2_2019") : wkt;
}

void write_sidecar(const std::string& path, const std::string& target, const TinView& view,
                   PendingOutputs& pending, Overwrite mode) {
  if (is_stream(target)) return;
  const std::string& definition = view.crs_wkt.empty() ? view.crs_authority : view.crs_wkt;
  const std::string text = definition.empty() ? std::string() : prj_text(definition);
  if (keeps_prj(path, text, target, mode)) return;
  if (definition.empty()) {
    pending.remove_stale(path, mode);
    return;
  }
  FileWriter file(pending.add(path, mode), path);
  file.text(text + "\n");
  file.close();
}

}  // namespace

void check_write_options(const std::string& path, const WriteOptions& options) {
  const TinFormat& format = choose_format(path, options.format);
  check_target(path, format);
  const CreationOptions creation(options.creation_options, format.info);
}

void write_tin(const std::string& path, const TinView& view, const WriteOptions& options,
               PendingOutputs& pending, Overwrite mode, Progress& progress) {
  check_sizes(view);
  const TinFormat& format = choose_format(path, options.format);
  check_target(path, format);
  const CreationOptions creation(options.creation_options, format.info);
  progress.start_phase("write " + format.info.name);
  const std::string written = pending.add(path, mode);
  if (format.crs == TinFormat::Crs::InSidecar) write_sidecar(sidecar_path(path), path, view, pending, mode);
  LocalOrigin origin;
  if (format.numbers != TinFormat::Numbers::Double) {
    origin = choose_origin(view.written_xy.empty() ? view.tin.points() : view.written_xy, view.tin.heights());
    write_origin(path, view, origin, format.numbers == TinFormat::Numbers::SingleYUp, pending, mode);
  }
  format.write({written, path, view, creation, origin, pending, mode, progress});
  progress.advance(1);
}

}  // namespace thalweg
