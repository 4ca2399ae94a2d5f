// A folder of GDAL's /vsimem/ with a name of its own.
#include "io/memory_folder.hpp"

#include "base/lower_case.hpp"
#include "io/file_content.hpp"
#include "io/file_writer.hpp"
#include "io/spatial_reference.hpp"

#include <thalweg/base/error.hpp>

#include <cpl_string.h>
#include <cpl_vsi.h>

#include <atomic>
#include <filesystem>
#include <string_view>
#include <utility>
#include <vector>

namespace thalweg {

namespace {

bool is_folder(const std::string& path) {
  VSIStatBufL status;
  return VSIStatL(path.c_str(), &status) == 0 && VSI_ISDIR(status.st_mode) != 0;
}

void copy_out(const std::string& from, const std::string& to, const std::string& target) {
  vsi_l_offset size = 0;
  const GByte* bytes = VSIGetMemFileBuffer(from.c_str(), &size, FALSE);
  VSIStatBufL status;
  if (VSIStatL(from.c_str(), &status) != 0) {
    throw Error(ErrorCode::WriteFailed, target + ": the driver made no file; choose another format");
  }
  FileWriter file(to, target);
  // The standard lets bytes be looked at as characters.
  if (bytes != nullptr) file.text({reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(size)});
  file.close();
}

void refuse_files_beside(const std::string& folder, const std::string& path, const std::string& target) {
  const CPLStringList names(VSIReadDir(folder.c_str()));
  for (int i = 0; i < names.size(); ++i) {
    const std::string name = names[i];
    if (name == "." || name == ".." || folder + "/" + name == path || name.ends_with(".prj")) continue;
    throw Error(ErrorCode::Unsupported, target + ": is a pipe or a device, and the format needs " + name +
                                            " beside; give the name of a file, or choose another format");
  }
}

/// The files that GDAL would take for a part of this one.
std::vector<std::string> companions(const std::string& target) {
  std::vector<std::string> files;
  for (const char* end : {".aux.xml", ".ovr", ".msk"}) files.push_back(target + end);
  const std::string extension = extension_of(target);
  const auto beside = [&](const char* end) {
    files.push_back(std::filesystem::path(target).replace_extension(end).string());
  };
  if (extension == ".shp") {
    for (const char* end : {".prj", ".qpj", ".cpg", ".qix", ".sbn", ".sbx", ".idm", ".ind"}) beside(end);
  } else if (extension == ".asc" || extension == ".bil" || extension == ".flt") {
    beside(".prj");
  } else if (extension == ".png") {
    for (const char* end : {".wld", ".pgw", ".pngw"}) beside(end);
  }
  return files;
}

}  // namespace

MemoryFolder::MemoryFolder(std::string target) : target_(std::move(target)) {
  static std::atomic<unsigned> counter{0};
  folder_ = "/vsimem/thalweg-" + std::to_string(counter++);
  path_ = folder_ + "/" + std::filesystem::path(target_).filename().string();
  VSIMkdir(folder_.c_str(), 0700);
}

MemoryFolder::~MemoryFolder() {
  VSIRmdirRecursive(folder_.c_str());
}

void MemoryFolder::deliver(const std::string& written, PendingOutputs& pending, Overwrite mode) const {
  if (is_folder(path_)) {
    throw Error(ErrorCode::Unsupported, target_ + ": the format makes a folder; choose one of files alone");
  }
  if (is_stream(target_)) {
    refuse_files_beside(folder_, path_, target_);
    return copy_out(path_, written, target_);
  }
  copy_out(path_, written, target_);
  std::vector<std::string> stale = companions(target_);
  const CPLStringList names(VSIReadDir(folder_.c_str()));
  for (int i = 0; i < names.size(); ++i) {
    const std::string name = names[i];
    const std::string from = folder_ + "/" + name;
    if (from == path_ || name == "." || name == "..") continue;
    if (is_folder(from)) {
      throw Error(ErrorCode::Unsupported, target_ +
                                              ": the format makes folders beside the file; choose one "
                                              "of files alone");
    }
    const std::string beside = std::filesystem::path(target_).replace_filename(name).string();
    std::erase(stale, beside);
    if (from.ends_with(".prj") && keeps_prj(beside, read_prj_sidecar(from), target_, mode)) continue;
    copy_out(from, pending.add(beside, mode), beside);
  }
  for (const std::string& file : stale) {
    if (file.ends_with(".prj")) keeps_prj(file, {}, target_, mode);
    pending.remove_stale(file, mode);
  }
}

}  // namespace thalweg
