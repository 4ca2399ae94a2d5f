#pragma once

/// A NetCDF file held open, and its errors turned into ours.

#include <thalweg/base/error.hpp>

#include <netcdf.h>

#include <mutex>
#include <string>

namespace thalweg {

/// Owns a file of libnetcdf, which is not thread-safe: one lives at a time, the next one waits.
class NetcdfFile {
 public:
  enum class Mode { Create, Read };
  /// Errors name `target`. Throws: Error{WriteFailed} or Error{Unreadable}.
  NetcdfFile(const std::string& path, std::string target, Mode mode)
      : lock_(mutex()), target_(std::move(target)), mode_(mode) {
    check(mode == Mode::Create ? nc_create(path.c_str(), NC_CLOBBER | NC_64BIT_OFFSET, &id_)
                               : nc_open(path.c_str(), NC_NOWRITE, &id_));
    open_ = true;
  }
  ~NetcdfFile() {
    if (open_) nc_close(id_);
  }
  NetcdfFile(const NetcdfFile&) = delete;
  NetcdfFile& operator=(const NetcdfFile&) = delete;

  [[nodiscard]] int id() const { return id_; }
  /// Throws: Error{WriteFailed} or Error{BadFormat} unless `status` is success.
  void check(int status) const {
    if (status == NC_NOERR) return;
    const std::string words = nc_strerror(status);
    if (mode_ == Mode::Read) throw Error(ErrorCode::BadFormat, target_ + ": broken NetCDF (" + words + ")");
    throw Error(ErrorCode::WriteFailed,
                target_ + ": could not be written whole (" + words +
                    "); free some space or choose another place; no partial file is left");
  }
  /// Closes the file. Throws: as `check`.
  void close() {
    open_ = false;
    check(nc_close(id_));
  }

 private:
  static std::mutex& mutex() {
    static std::mutex one;
    return one;
  }

  std::unique_lock<std::mutex> lock_;
  std::string target_;
  Mode mode_;
  int id_ = -1;
  bool open_ = false;
};

}  // namespace thalweg
