// Points of compressed files by PDAL's reader, streamed through a filter that hands them on.
//
// PDAL gives coordinates already scaled; the whole numbers of the file are got back by rounding, which is
// exact: |number * 2^-52| < 1/2 for numbers of 32 bits. Flags: from 2.6 on PDAL has a dimension for each;
// before, those of point formats up to 5 are left in the class's byte, those of later formats stand in
// ClassFlags.
#include "io/laz_points.hpp"

#include <thalweg/base/error.hpp>

#include <pdal/Options.hpp>
#include <pdal/PointTable.hpp>
#include <pdal/StageFactory.hpp>
#include <pdal/filters/StreamCallbackFilter.hpp>

#include <cmath>
#include <exception>
#include <limits>
#include <string>

namespace thalweg {

namespace {

using pdal::Dimension::Id;

/// From PDAL's points to those of LAS.
class Decoder {
 public:
  Decoder(const pdal::PointLayout& layout, const LazHeader& header)
      : header_(header), withheld_(layout.findDim("Withheld")), flags_(layout.findDim("ClassFlags")) {}

  [[nodiscard]] LasRecord decode(pdal::PointRef& point) const {
    constexpr unsigned kOldClass = 0x1f, kOldWithheld = 0x80, kNewWithheld = 0x04;
    LasRecord record;
    const std::array<Id, 3> axes = {Id::X, Id::Y, Id::Z};
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const double value =
          std::round((point.getFieldAs<double>(axes[i]) - header_.offset[i]) / header_.scale[i]);
      if (!(std::abs(value) <= std::numeric_limits<std::int32_t>::max() + 1.0))
        throw Error(ErrorCode::BadFormat, "a coordinate does not fit scale and offset of the header");
      record.xyz[i] = static_cast<std::int32_t>(value);
    }
    record.return_number = point.getFieldAs<std::uint8_t>(Id::ReturnNumber);
    record.returns = point.getFieldAs<std::uint8_t>(Id::NumberOfReturns);
    const unsigned found = point.getFieldAs<std::uint8_t>(Id::Classification);
    record.point_class = header_.has_new_format ? found : found & kOldClass;
    if (withheld_ != Id::Unknown) {
      record.is_withheld = point.getFieldAs<std::uint8_t>(withheld_) != 0;
    } else if (header_.has_new_format) {
      record.is_withheld =
          flags_ != Id::Unknown && (point.getFieldAs<std::uint8_t>(flags_) & kNewWithheld) != 0;
    } else {
      record.is_withheld = (found & kOldWithheld) != 0;
    }
    return record;
  }

 private:
  const LazHeader& header_;
  Id withheld_, flags_;
};

}  // namespace

bool reads_laz() {
  return true;
}

void read_laz(const std::string& path, const LazHeader& header,
              const std::function<void(const LasRecord&)>& take) {
  constexpr pdal::point_count_t kBlock = 1U << 14U;
  std::exception_ptr from_take;
  try {
    pdal::StageFactory factory;
    pdal::Stage* const reader = factory.createStage("readers.las");
    if (reader == nullptr)
      throw Error(ErrorCode::Unsupported, path + ": this PDAL has no reader of LAS files");
    pdal::Options options;
    options.add("filename", path);
    reader->setOptions(options);
    pdal::StreamCallbackFilter filter;
    filter.setInput(*reader);
    pdal::FixedPointTable table(kBlock);
    filter.prepare(table);
    const Decoder decoder(*table.layout(), header);
    filter.setCallback([&](pdal::PointRef& point) {
      if (from_take) return true;
      try {
        take(decoder.decode(point));
      } catch (...) {
        from_take = std::current_exception();
        throw;
      }
      return true;
    });
    filter.execute(table);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    if (from_take) std::rethrow_exception(from_take);
    throw Error(ErrorCode::BadFormat, path + ": PDAL cannot read it (" + error.what() + ")");
  }
}

}  // namespace thalweg
