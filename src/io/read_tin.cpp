// Choosing the reader of a TIN by the file's first bytes, so that a wrong extension does no harm.
#include "io/file_content.hpp"
#include "io/tin_format.hpp"

#include <algorithm>

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

}  // namespace

TinFile read_tin(const std::string& path, Progress& progress) {
  constexpr std::size_t kHead = 512;
  const std::string head = read_head(path, kHead);
  for (const TinFormat& format : tin_format_table()) {
    if (format.read == nullptr || !format.recognises(head, path)) continue;
    progress.start_phase("read " + format.info.name);
    TinFile tin = format.read(path, progress);
    check_not_empty(tin, path);
    if (tin.crs.empty() && format.crs == TinFormat::Crs::InSidecar) tin.crs = read_prj_sidecar(path);
    progress.advance(1);
    return tin;
  }
  throw Error(ErrorCode::Unsupported, path + ": is in none of the formats that a TIN is read from (" +
                                          list_formats() + "); convert it to one of them");
}

}  // namespace thalweg
