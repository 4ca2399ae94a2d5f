// LAS 1.2 to 1.4, point formats 0 to 10. Based on: ASPRS, LAS Specification 1.4 - R15, 2019.
//
// 1. The header tells where points start, their format and number, and scale and offset of the coordinates.
// 2. The CRS stands in variable length records: WKT (record 2112), or GeoTIFF keys (34735, with 34736, 34737)
// that name EPSG codes or, user-defined, describe it by parameters. WKT is the surer one: libLAS, which wrote
// its own record of it, gave the keys of a projection in feet its false easting in metres.
// 3. Points are read in blocks. A coordinate is X * scale + offset; where the scale is 1 / n and the offset a
//    whole number of n-ths, as it nearly always is, (X + offset n) / n rounds once and so gives the very
//    double of the decimal number that was measured.
// Points marked as withheld are deleted ones, says the specification, and are left out.
#include "io/las_points.hpp"

#include "base/lower_case.hpp"
#include "io/gdal_session.hpp"
#include "io/geotiff_keys.hpp"
#include "io/laz_points.hpp"
#include "io/point_collector.hpp"
#include "io/spatial_reference.hpp"

#include <thalweg/base/error.hpp>

#include <cpl_vsi.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace thalweg {

namespace {

struct CloseFile {
  void operator()(VSILFILE* file) const { VSIFCloseL(file); }
};

/// Little-endian numbers in a block of bytes.
class Bytes {
 public:
  explicit Bytes(std::vector<unsigned char> data) : data_(std::move(data)) {}
  [[nodiscard]] std::size_t size() const { return data_.size(); }
  [[nodiscard]] const std::vector<unsigned char>& all() const { return data_; }
  [[nodiscard]] std::uint64_t unsigned_at(std::size_t at, std::size_t width) const {
    std::uint64_t value = 0;
    for (std::size_t i = width; i-- > 0;) value = value << 8U | data_[at + i];
    return value;
  }
  [[nodiscard]] std::int32_t int_at(std::size_t at) const {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(unsigned_at(at, 4)));
  }
  [[nodiscard]] double double_at(std::size_t at) const { return std::bit_cast<double>(unsigned_at(at, 8)); }
  [[nodiscard]] unsigned byte_at(std::size_t at) const { return data_[at]; }
  [[nodiscard]] std::string text_at(std::size_t at, std::size_t width) const {
    std::string text(data_.begin() + static_cast<std::ptrdiff_t>(at),
                     data_.begin() + static_cast<std::ptrdiff_t>(at + width));
    return text.substr(0, text.find('\0'));
  }

 private:
  std::vector<unsigned char> data_;
};

/// From the whole numbers of a file to one coordinate.
struct Axis {
  double scale = 1;
  double offset = 0;
  double parts = 0;         ///< scale = 1 / parts, exactly as doubles; else 0
  double offset_parts = 0;  ///< offset in these

  Axis() = default;
  Axis(double the_scale, double the_offset) : scale(the_scale), offset(the_offset) {
    constexpr double kMost = 0x1p50;
    const double count = std::round(1 / scale);
    const double whole = std::round(offset * count);
    if (count >= 1 && count < kMost && 1 / count == scale && std::abs(whole) < kMost &&
        whole / count == offset) {
      parts = count;
      offset_parts = whole;
    }
  }
  [[nodiscard]] double coordinate(std::int32_t value) const {
    return parts > 0 ? (value + offset_parts) / parts : value * scale + offset;
  }
};

constexpr std::array<std::size_t, 11> kRecordSizes = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
constexpr unsigned kFirstNewFormat = 6;

class LasPoints : public SourceReader {
 public:
  explicit LasPoints(const SourceSpec& spec) : SourceReader(spec) {
    VSIStatBufL status;
    if (VSIStatL(spec.path.c_str(), &status) != 0)
      throw Error(ErrorCode::NotFound, spec.path + ": there is no such file; check the path");
    file_.reset(VSIFOpenL(spec.path.c_str(), "rb"));
    if (!file_) throw Error(ErrorCode::Unreadable, spec.path + ": cannot be opened; check its permissions");
    read_header();
    read_crs();
  }

  void read(ReadContext& run, PlaneTransform& transform) override {
    if (!run.options.where.empty())
      run.where.refusals.push_back(name() +
                                   " is LAS and has no attributes; choose points with --classes, --returns");
    if (!run.options.z_field.empty()) run.z_field.refusals.push_back(name() + " is LAS and has no fields");
    run.las_filter.taken = true;
    if (!note_.empty()) run.note(note_);
    const std::uint64_t room = is_compressed_ ? count_ : file_size_ / record_;
    expect_points(run, static_cast<double>(std::min(count_, room)));
    PointCollector points(run, transform);
    Counts counts;
    if (is_compressed_) {
      read_compressed(run, points, counts);
    } else {
      read_records(run, points, counts);
    }
    points.finish();
    if (counts.withheld > 0)
      run.note(name() + ": " + std::to_string(counts.withheld) + " points marked as withheld are left out");
    if (counts.left_out > 0) {
      run.note(name() + ": " + std::to_string(counts.left_out) + " of " + std::to_string(count_) +
               " points are of other classes or returns than asked for");
    }
  }

 private:
  struct Counts {
    std::uint64_t withheld = 0, left_out = 0;
  };

  void take_record(const LasRecord& record, const ReadOptions& options, PointCollector& points,
                   Counts& counts) const {
    if (record.is_withheld) {
      ++counts.withheld;
    } else if (!is_wanted(record, options)) {
      ++counts.left_out;
    } else {
      points.add({x_.coordinate(record.xyz[0]), y_.coordinate(record.xyz[1])}, z_.coordinate(record.xyz[2]));
    }
  }

  void read_compressed(ReadContext& run, PointCollector& points, Counts& counts) const {
    constexpr std::uint64_t kBlock = 1U << 15U;
    const LazHeader header{{x_.scale, y_.scale, z_.scale}, {x_.offset, y_.offset, z_.offset}, is_new_};
    std::uint64_t done = 0;
    read_laz(spec().path, header, [&](const LasRecord& record) {
      if (done++ % kBlock == 0) run.advance(static_cast<double>(done) / static_cast<double>(count_ + 1));
      take_record(record, run.options, points, counts);
    });
    if (done != count_) {
      fail(ErrorCode::BadFormat,
           "ends after point " + std::to_string(done) + " of " + std::to_string(count_) + "; copy it again");
    }
  }

  void read_records(ReadContext& run, PointCollector& points, Counts& counts) const {
    constexpr std::uint64_t kBlock = 1U << 20U;  // bytes
    const std::uint64_t at_once = std::max<std::uint64_t>(kBlock / record_, 1);
    VSIFSeekL(file_.get(), start_, SEEK_SET);
    for (std::uint64_t first = 0; first < count_; first += at_once) {
      run.advance(static_cast<double>(first) / static_cast<double>(count_));
      const std::uint64_t wanted = std::min(at_once, count_ - first);
      const Bytes block = take(wanted * record_);
      if (block.size() < wanted * record_) {
        fail(ErrorCode::BadFormat, "ends after point " + std::to_string(first + block.size() / record_) +
                                       " of " + std::to_string(count_) + "; copy it again");
      }
      for (std::uint64_t i = 0; i < wanted; ++i) {
        take_record(record_at(block, static_cast<std::size_t>(i) * record_), run.options, points, counts);
      }
    }
  }

  [[noreturn]] void fail(ErrorCode code, const std::string& what) const {
    throw Error(code, name() + ": " + what);
  }

  // The next bytes of the file; fewer at its end.
  [[nodiscard]] Bytes take(std::uint64_t size) const {
    std::vector<unsigned char> data(static_cast<std::size_t>(std::min(size, file_size_)));
    data.resize(VSIFReadL(data.data(), 1, data.size(), file_.get()));
    return Bytes(std::move(data));
  }

  void read_header() {
    constexpr std::size_t kOldHeader = 227, kNewHeader = 375;
    VSIFSeekL(file_.get(), 0, SEEK_END);
    file_size_ = VSIFTellL(file_.get());
    VSIFSeekL(file_.get(), 0, SEEK_SET);
    const Bytes head = take(kNewHeader);
    if (head.size() < kOldHeader || head.text_at(0, 4) != "LASF")
      fail(ErrorCode::BadFormat, "is no LAS file");
    const unsigned major = head.byte_at(24), minor = head.byte_at(25);
    if (major != 1 || minor > 4) {
      fail(ErrorCode::Unsupported,
           "is LAS " + std::to_string(major) + "." + std::to_string(minor) +
               "; versions up to 1.4 are read: convert it (pdal translate in.las out.las)");
    }
    header_ = head.unsigned_at(94, 2);
    start_ = head.unsigned_at(96, 4);
    records_ = head.unsigned_at(100, 4);
    // LASzip sets the highest bit of the format, older versions of it the next one.
    constexpr unsigned kCompressed = 0xc0;
    is_compressed_ = (head.byte_at(104) & kCompressed) != 0;
    if (is_compressed_ && !reads_laz()) read_laz(spec().path, {}, {});
    const unsigned format = head.byte_at(104) & ~kCompressed;
    if (format >= kRecordSizes.size())
      fail(ErrorCode::Unsupported, "has point format " + std::to_string(format) + "; 0 to 10 are read");
    is_new_ = format >= kFirstNewFormat;
    record_ = static_cast<std::size_t>(head.unsigned_at(105, 2));
    count_ = head.unsigned_at(107, 4);
    if (minor == 4 && head.size() >= kNewHeader) count_ = std::max(count_, head.unsigned_at(247, 8));
    if (record_ < kRecordSizes[format] || start_ < header_ || start_ > file_size_)
      fail(ErrorCode::BadFormat, "has a broken header: sizes do not fit its point format");
    x_ = {head.double_at(131), head.double_at(155)};
    y_ = {head.double_at(139), head.double_at(163)};
    z_ = {head.double_at(147), head.double_at(171)};
    for (const Axis& axis : {x_, y_, z_}) {
      if (!is_usable(axis.scale) || !is_usable(axis.offset) || !(axis.scale > 0))
        fail(ErrorCode::BadFormat, "has a scale or offset that is no usable number");
    }
  }

  void read_crs() {
    constexpr std::size_t kHeader = 54;
    constexpr std::uint64_t kWkt = 2112, kKeys = 34735, kDoubles = 34736, kTexts = 34737;
    std::string wkt;
    GeotiffKeys keys;
    std::uint64_t at = header_;
    for (std::uint64_t i = 0; i < records_ && at + kHeader <= start_; ++i) {
      VSIFSeekL(file_.get(), at, SEEK_SET);
      const Bytes head = take(kHeader);
      if (head.size() < kHeader) break;
      const std::size_t size = static_cast<std::size_t>(head.unsigned_at(20, 2));
      const std::uint64_t id = head.unsigned_at(18, 2);
      at += kHeader + size;
      const std::string user = head.text_at(2, 16);
      if (user != "LASF_Projection" && (user != "liblas" || id != kWkt)) continue;
      const Bytes body = take(size);
      if (body.size() < size) break;
      if (id == kWkt) wkt = body.text_at(0, size);
      if (id == kKeys) keys.directory = body.all();
      if (id == kDoubles) keys.doubles = body.all();
      if (id == kTexts) keys.texts = body.all();
    }
    if (!keys.directory.empty()) take_keys(keys);
    if (wkt.empty()) return;
    set_reference(parse_reference(wkt));
    note_.clear();
  }

  // EPSG codes, n or n+m; or what the parameters describe. A unit of heights that stands alone is set.
  void take_keys(const GeotiffKeys& all) {
    const Bytes keys(all.directory);
    constexpr std::size_t kEntry = 8;
    constexpr std::uint64_t kGeographic = 2048, kProjected = 3072, kVertical = 4096, kVerticalUnit = 4099,
                            kUserDefined = 32767;
    std::uint64_t plane = 0, vertical = 0, unit = 0;
    bool user_defined = false;
    for (std::size_t at = kEntry; at + kEntry <= keys.size(); at += kEntry) {
      const std::uint64_t id = keys.unsigned_at(at, 2), place = keys.unsigned_at(at + 2, 2),
                          value = keys.unsigned_at(at + 6, 2);
      if (place != 0) continue;
      if (id == kProjected || (id == kGeographic && plane == 0)) {
        user_defined = value == kUserDefined;
        plane = user_defined ? 0 : value;
      }
      if (id == kVertical && value != kUserDefined) vertical = value;
      if (id == kVerticalUnit) unit = value;
    }
    constexpr std::uint64_t kMetre = 9001, kFoot = 9002, kSurveyFoot = 9003;
    if (unit == kMetre) set_vertical_unit(1);
    if (unit == kFoot) set_vertical_unit(0.3048);
    if (unit == kSurveyFoot) set_vertical_unit(1200.0 / 3937);
    if (user_defined) {
      const OGRSpatialReference described = reference_of_keys(all);
      set_reference(described);
      note_ = name() + " has a CRS of its own making, " +
              (described.IsEmpty() ? "which is not understood; give it with --s-crs"
                                   : "which has no code; check it in the report");
    }
    if (plane == 0) return;
    // Codes up to 5000 are ellipsoids and datums of old files, not vertical CRSs.
    constexpr std::uint64_t kFirstVertical = 5001;
    std::string code("EPSG:");
    code += std::to_string(plane);
    if (vertical >= kFirstVertical) code.append("+").append(std::to_string(vertical));
    set_reference(parse_reference(code));
  }

  [[nodiscard]] LasRecord record_at(const Bytes& block, std::size_t at) const {
    constexpr unsigned kOldWithheld = 0x80, kNewWithheld = 0x04, kOldClass = 0x1f;
    const unsigned flags = block.byte_at(at + 14), next = block.byte_at(at + 15);
    LasRecord record{{block.int_at(at), block.int_at(at + 4), block.int_at(at + 8)}};
    record.return_number = is_new_ ? flags & 0x0fU : flags & 0x07U;
    record.returns = is_new_ ? flags >> 4U : flags >> 3U & 0x07U;
    record.point_class = is_new_ ? block.byte_at(at + 16) : next & kOldClass;
    record.is_withheld = (next & (is_new_ ? kNewWithheld : kOldWithheld)) != 0;
    return record;
  }

  [[nodiscard]] static bool is_wanted(const LasRecord& record, const ReadOptions& options) {
    const auto& classes = options.classes;
    if (!classes.empty() && std::find(classes.begin(), classes.end(), record.point_class) == classes.end())
      return false;
    switch (options.returns) {
      case LasReturns::All:
        return true;
      case LasReturns::First:
        return record.return_number <= 1;
      case LasReturns::Last:
        return record.return_number >= record.returns;
    }
    return true;
  }

  std::unique_ptr<VSILFILE, CloseFile> file_;
  std::uint64_t file_size_ = 0, header_ = 0, start_ = 0, records_ = 0, count_ = 0;
  std::size_t record_ = 1;
  bool is_new_ = false;
  bool is_compressed_ = false;
  Axis x_, y_, z_;
  std::string note_;
};

}  // namespace

bool is_las(const SourceSpec& spec) {
  const std::string extension = extension_of(spec.path);
  return extension == ".las" || extension == ".laz";
}

std::unique_ptr<SourceReader> open_las(const SourceSpec& spec) {
  return std::make_unique<LasPoints>(spec);
}

}  // namespace thalweg
