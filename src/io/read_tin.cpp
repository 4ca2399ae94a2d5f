// Choosing the reader of a TIN by the file's first bytes, so that a wrong extension does no harm.
#include "io/file_content.hpp"
#include "io/tin_format.hpp"

#include <thalweg/geometry/predicates.hpp>

#include <algorithm>
#include <utility>

namespace thalweg {

namespace {

std::string list_formats() {
  std::string list;
  for (const TinFormat& format : tin_format_table()) {
    if (format.read != nullptr) list += (list.empty() ? "" : ", ") + format.info.name;
  }
  return list;
}

void check_not_empty(const TinFile& tin, const std::string& path) {
  if (tin.points.empty()) throw Error(ErrorCode::EmptyInput, path + ": holds no vertices");
  if (tin.triangles.empty()) {
    throw Error(ErrorCode::EmptyInput,
                path + ": holds no triangles; points alone can be triangulated with build");
  }
}

/// Where the convention is that faces are seen from below, all are turned.
void turn_if_clockwise(TinFile& tin) {
  const auto is_clockwise = [&](const Triangle& t) {
    return orientation(tin.points[t[0].index()], tin.points[t[1].index()], tin.points[t[2].index()]) < 0;
  };
  if (!std::ranges::all_of(tin.triangles, is_clockwise)) return;
  for (Triangle& t : tin.triangles) std::swap(t[1], t[2]);
}

}  // namespace

TinFile read_tin(const std::string& path, Progress& progress) {
  constexpr std::size_t kHead = 512;
  const std::string head = read_head(path, kHead);
  for (const TinFormat& format : tin_format_table()) {
    if (format.read == nullptr || !format.recognises(head, path)) continue;
    progress.start_phase("read " + format.info.name);
    TinFile tin = format.read(path, progress);
    check_not_empty(tin, path);
    turn_if_clockwise(tin);
    if (tin.crs.empty() && format.crs == TinFormat::Crs::InSidecar) tin.crs = read_prj_sidecar(path);
    progress.advance(1);
    return tin;
  }
  throw Error(ErrorCode::Unsupported, path + ": is in none of the formats that a TIN is read from (" +
                                          list_formats() + "); convert it to one of them");
}

}  // namespace thalweg
