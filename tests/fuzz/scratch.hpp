#pragma once

/// Files for targets that read files.

#include <string>
#include <string_view>
#include <vector>

namespace thalweg::fuzz {

/// A path in a folder of this process, which goes when it ends.
std::string scratch_path(std::string_view name);
void write_file(const std::string& path, std::string_view bytes);
std::string read_file(const std::string& path);

/// A small TIN with ridge, valley and pits in every format that is read, by `thalweg build`'s code; and its
/// report and proof. Made once. The format is told by the extension.
struct TinyTin {
  std::string mesh;  ///< path of the PLY
  std::string report;
  std::string proof;
  std::vector<std::string> meshes;  ///< contents, one a format
};
const TinyTin& tiny_tin();

}  // namespace thalweg::fuzz
