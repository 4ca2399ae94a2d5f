#include <thalweg/io/nodata_region.hpp>

namespace thalweg {
bool NodataRegion::outside(Point2) const {
  return false;
}
}  // namespace thalweg
