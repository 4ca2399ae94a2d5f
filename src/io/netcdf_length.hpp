#pragma once

/// How long a NetCDF file must be to hold what its header promises: libnetcdf reads what is missing as zeros.

#include <string>

namespace thalweg {

/// Bytes up to the end of the last variable of a file in one of the classic formats (CDF-1, CDF-2, CDF-5);
/// infinite where its header breaks off, as one does that lies about how much it lists (libnetcdf would make
/// room for all of it first), or names a type of values that there is not (libnetcdf divides by its size). 0
/// where the file is in another format, or cannot be read.
/// Complexity: linear in the header.
[[nodiscard]] double promised_netcdf_length(const std::string& path);

/// To be called before libnetcdf or GDAL opens a path. Throws: Error{BadFormat} where that is a file shorter
/// than promised.
void check_netcdf_length(const std::string& path);

}  // namespace thalweg
