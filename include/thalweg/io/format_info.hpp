#pragma once

/// What is known about a file format.

#include <string>
#include <vector>

namespace thalweg {

/// One format, as listed to users.
struct FormatInfo {
  std::string name;                     ///< as after --of: "PLY"
  std::string description;              ///< one line
  std::vector<std::string> extensions;  ///< lower case, with the dot; the first is the usual one
  bool reads = false;
  bool writes = false;
  std::vector<std::string> creation_options;  ///< "EDGES=YES|NO", the default first
};

/// Whether points are read of compressed LAS files (LAZ): where Thalweg was built with PDAL.
bool reads_laz();

}  // namespace thalweg
