// 1. The header is walked: dimensions, attributes (skipped), variables with type, shape and first byte.
// 2. A variable ends after its values; one with the unlimited dimension has a slab in each record, and a
//    record is as long as the slabs of all such variables, each padded to four bytes unless there is one
//    only.
//
// Based on: Unidata, NetCDF Classic Format Specification (CDF-1, CDF-2, CDF-5). Numbers are doubles, so that
// no header overflows them; files are shorter than 2^53 bytes.
#include "io/netcdf_length.hpp"

#include <thalweg/base/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <vector>

namespace thalweg {

namespace {

class ClassicHeader {
 public:
  explicit ClassicHeader(const std::string& path) : file_(path, std::ios::binary) {}

  double promised_length() {
    std::array<char, 3> magic{};
    file_.read(magic.data(), magic.size());
    const int version = file_.get();
    if (!file_ || magic != std::array{'C', 'D', 'F'}) return 0;
    if (version != 1 && version != 2 && version != 5) return 0;
    count_bytes_ = version == 5 ? 8 : 4;
    offset_bytes_ = version == 1 ? 4 : 8;
    double records = count();
    if (records == (version == 5 ? 0x1p64 : 0x1p32 - 1)) records = 0;  // being streamed: not known
    read_dimensions();
    skip_attributes();
    read_variables();
    return file_ ? end_of_values(records) : std::numeric_limits<double>::infinity();
  }

 private:
  struct Variable {
    double begin = 0;
    double bytes = 0;  ///< in each record, if it has any
    bool in_records = false;
  };

  double number(int bytes) {
    double value = 0;
    for (int i = 0; i < bytes; ++i) value = value * 256 + std::max(file_.get(), 0);
    return value;
  }
  double count() { return number(count_bytes_); }
  static double padded(double bytes) { return std::ceil(bytes / 4) * 4; }
  void skip(double bytes) {
    if (bytes < 0x1p62) file_.seekg(static_cast<std::streamoff>(padded(bytes)), std::ios::cur);
    if (bytes >= 0x1p62) file_.setstate(std::ios::failbit);
  }
  /// Number of elements of the list that follows.
  double list_size() {
    number(4);  // the kind of list, 0 if it is absent
    return count();
  }
  double value_bytes() {
    constexpr std::array<double, 12> kBytes{0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};
    const double type = number(4);
    if (type > 0 && type < kBytes.size()) return kBytes[static_cast<std::size_t>(type)];
    file_.setstate(std::ios::failbit);
    return 0;
  }

  void read_dimensions() {
    for (double left = list_size(); left > 0 && file_; --left) {
      skip(count());
      dimensions_.push_back(count());
    }
  }
  void skip_attributes() {
    for (double left = list_size(); left > 0 && file_; --left) {
      skip(count());
      const double bytes = value_bytes();
      skip(bytes * count());
    }
  }
  void read_variables() {
    for (double left = list_size(); left > 0 && file_; --left) {
      Variable variable;
      skip(count());
      double values = 1;
      for (double axes = count(); axes > 0 && file_; --axes) {
        const double id = count();
        if (id >= static_cast<double>(dimensions_.size())) continue;
        const double length = dimensions_[static_cast<std::size_t>(id)];
        if (length == 0) variable.in_records = true;
        if (length != 0) values *= length;
      }
      skip_attributes();
      variable.bytes = values * value_bytes();
      if (variable.bytes >= 0x1p62) file_.setstate(std::ios::failbit);
      count();  // the same, but of no use for large variables
      variable.begin = number(offset_bytes_);
      variables_.push_back(variable);
    }
  }

  [[nodiscard]] double end_of_values(double records) const {
    double record = 0;
    const auto in_records = std::ranges::count(variables_, true, &Variable::in_records);
    for (const Variable& variable : variables_) {
      if (variable.in_records) record += in_records == 1 ? variable.bytes : padded(variable.bytes);
    }
    double end = 0;
    for (const Variable& variable : variables_) {
      if (variable.in_records && records == 0) continue;
      const double before = variable.in_records ? (records - 1) * record : 0;
      end = std::max(end, variable.begin + before + variable.bytes);
    }
    return end;
  }

  std::ifstream file_;
  int count_bytes_ = 4;
  int offset_bytes_ = 4;
  std::vector<double> dimensions_;  ///< 0: the unlimited one
  std::vector<Variable> variables_;
};

}  // namespace

double promised_netcdf_length(const std::string& path) {
  return ClassicHeader(path).promised_length();
}

void check_netcdf_length(const std::string& path) {
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(path, unknown)) return;  // what is read from a pipe is gone
  const double promised = promised_netcdf_length(path);
  const auto length = static_cast<double>(std::filesystem::file_size(path, unknown));
  if (unknown || promised <= length) return;
  const std::string what =
      std::isfinite(promised)
          ? fmt::format("its header promises {:.0f} bytes, there are {:.0f}", promised, length)
          : "its header breaks off, or lies about what it lists";
  throw Error(ErrorCode::BadFormat, path + ": is cut off: " + what);
}

}  // namespace thalweg
