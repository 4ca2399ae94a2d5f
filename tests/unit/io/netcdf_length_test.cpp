// The length that a header promises is that of the file which libnetcdf wrote, up to padding.
#include "io/netcdf_length.hpp"

#include "io/netcdf_file.hpp"
#include "write_scene.hpp"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace thalweg {
namespace {

struct Shape {
  int format;      ///< of libnetcdf
  int fixed;       ///< variables of 7 x 3 values
  int in_records;  ///< variables of 3 values in each of 5 records
  nc_type type;
};

std::string numbered(char kind, int number) {
  std::string name(1, kind);
  return name.append(std::to_string(number));
}

class NetcdfLength : public testing::TestWithParam<Shape> {};

TEST_P(NetcdfLength, IsThatOfTheFile) {
  const Shape shape = GetParam();
  const test::TempFolder folder;
  const std::string path = folder.file("a.nc");
  int file = 0;
  std::array<int, 3> axes{};
  const auto check = [](int status) { ASSERT_EQ(status, NC_NOERR) << nc_strerror(status); };
  check(nc_create(path.c_str(), NC_CLOBBER | shape.format, &file));
  check(nc_def_dim(file, "record", NC_UNLIMITED, &axes[0]));
  check(nc_def_dim(file, "seven", 7, &axes[1]));
  check(nc_def_dim(file, "three", 3, &axes[2]));
  check(nc_put_att_text(file, NC_GLOBAL, "title", 5, "cubes"));
  std::vector<int> fixed, in_records;
  for (int i = 0; i < shape.fixed; ++i) {
    check(nc_def_var(file, numbered('f', i).c_str(), shape.type, 2, &axes[1], &fixed.emplace_back()));
    const double none = -9;
    check(nc_put_att_double(file, fixed.back(), "none", NC_DOUBLE, 1, &none));
  }
  for (int i = 0; i < shape.in_records; ++i) {
    const std::array<int, 2> own{axes[0], axes[2]};
    check(nc_def_var(file, numbered('r', i).c_str(), shape.type, 2, own.data(), &in_records.emplace_back()));
  }
  check(nc_enddef(file));
  const std::vector<double> values(21, 1.0);
  for (const int id : fixed) check(nc_put_var_double(file, id, values.data()));
  const std::array<std::size_t, 2> start{0, 0}, count{5, 3};
  for (const int id : in_records)
    check(nc_put_vara_double(file, id, start.data(), count.data(), values.data()));
  check(nc_close(file));
  const auto length = static_cast<double>(std::filesystem::file_size(path));
  EXPECT_LE(promised_netcdf_length(path), length);
  EXPECT_GT(promised_netcdf_length(path), length - 4);
}

INSTANTIATE_TEST_SUITE_P(Classic, NetcdfLength,
                         testing::Values(Shape{0, 2, 0, NC_SHORT}, Shape{0, 1, 1, NC_SHORT},
                                         Shape{0, 1, 2, NC_SHORT}, Shape{NC_64BIT_OFFSET, 3, 2, NC_BYTE},
                                         Shape{NC_64BIT_OFFSET, 1, 0, NC_DOUBLE},
                                         Shape{NC_64BIT_DATA, 2, 3, NC_INT},
                                         Shape{NC_64BIT_DATA, 2, 1, NC_INT64}));

TEST(NetcdfLength, NoFileIsLongEnoughForAHeaderThatBreaksOff) {
  const test::TempFolder folder;
  const std::string path = folder.file("a.nc");
  const std::string nothing(8, '\0');
  const std::string many("\0\0\0\x0b\x7f\xff\xff\xff", 8);  // variables
  // One attribute or variable of type 12, which is none.
  const std::string attribute("\0\0\0\x0c\0\0\0\1\0\0\0\1a\0\0\0\0\0\0\x0c\0\0\0\0", 24);
  const std::string variable = std::string("\0\0\0\x0b\0\0\0\1\0\0\0\1v\0\0\0\0\0\0\0", 20) + nothing +
                               std::string("\0\0\0\x0c\0\0\0\4\0\0\0\0", 12);
  for (const std::string& lists :
       {nothing, nothing + nothing + many, nothing + attribute + nothing, nothing + nothing + variable}) {
    test::write_text(path, std::string("CDF\x01\0\0\0\0", 8) + lists);
    EXPECT_EQ(promised_netcdf_length(path), std::numeric_limits<double>::infinity());
  }
}

TEST(NetcdfLength, NothingIsPromisedByOtherFormats) {
  const test::TempFolder folder;
  const std::string path = folder.file("a.nc");
  int file = 0;
  ASSERT_EQ(nc_create(path.c_str(), NC_NETCDF4, &file), NC_NOERR);
  ASSERT_EQ(nc_close(file), NC_NOERR);
  EXPECT_EQ(promised_netcdf_length(path), 0);
  EXPECT_EQ(promised_netcdf_length(folder.file("absent.nc")), 0);
}

}  // namespace
}  // namespace thalweg
