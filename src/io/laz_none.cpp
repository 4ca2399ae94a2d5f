// Built without PDAL: compressed files are refused, and the message says what helps.
#include "io/laz_points.hpp"

#include <thalweg/base/error.hpp>

#include <string>

namespace thalweg {

bool reads_laz() {
  return false;
}

void read_laz(const std::string& path, const LazHeader&, const std::function<void(const LasRecord&)>&) {
  throw Error(ErrorCode::Unsupported,
              path +
                  ": is compressed (LAZ); unpack it first (laszip -i in.laz -o out.las, or pdal translate "
                  "in.laz out.las), or build Thalweg with PDAL");
}

}  // namespace thalweg
