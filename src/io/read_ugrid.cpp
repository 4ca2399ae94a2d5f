// UGRID in NetCDF: the first two-dimensional mesh topology of the file.
//
// Heights are the one variable on the nodes that is called an altitude or bed level, else the one whose name
// ends in _z, else the only one there is. Values are unpacked (scale_factor, add_offset), those that are fill
// are none, depths (positive down) become heights, and their unit a part of the CRS. Faces may be stored
// corners first. Constraint edges are read where `write_tin` put them.
#include "io/height_unit.hpp"
#include "io/netcdf_file.hpp"
#include "io/netcdf_length.hpp"
#include "io/tin_format.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace thalweg {

namespace {

class UgridReader {
 public:
  UgridReader(const std::string& path, Progress& progress)
      : path_(path), progress_(progress), file_(path, path, NetcdfFile::Mode::Read) {}

  TinFile read() {
    const int mesh = find_mesh();
    read_nodes(mesh);
    progress_.advance(1.0 / 3);
    read_faces(mesh);
    progress_.advance(2.0 / 3);
    read_constraints();
    read_orders();
    read_crs();
    read_units();
    return std::move(tin_);
  }

 private:
  [[noreturn]] void fail(ErrorCode code, const std::string& what) const {
    throw Error(code, path_ + ": " + what);
  }

  [[nodiscard]] int variable_count() const {
    int count = 0;
    file_.check(nc_inq_nvars(file_.id(), &count));
    return count;
  }
  [[nodiscard]] std::string name_of(int variable) const {
    std::array<char, NC_MAX_NAME + 1> name{};
    file_.check(nc_inq_varname(file_.id(), variable, name.data()));
    return name.data();
  }
  [[nodiscard]] std::optional<int> find(const std::string& name) const {
    int id = 0;
    if (nc_inq_varid(file_.id(), name.c_str(), &id) != NC_NOERR) return std::nullopt;
    return id;
  }
  [[nodiscard]] std::string text_of(int variable, const char* name) const {
    nc_type type = 0;
    std::size_t length = 0;
    if (nc_inq_att(file_.id(), variable, name, &type, &length) != NC_NOERR || type != NC_CHAR) return {};
    std::string text(length, '\0');
    file_.check(nc_get_att_text(file_.id(), variable, name, text.data()));
    while (!text.empty() && text.back() == '\0') text.pop_back();
    return text;
  }
  [[nodiscard]] int integer_of(int variable, const char* name, int otherwise) const {
    int value = otherwise;
    std::size_t length = 0;
    if (nc_inq_attlen(file_.id(), variable, name, &length) != NC_NOERR || length != 1) return otherwise;
    return nc_get_att_int(file_.id(), variable, name, &value) == NC_NOERR ? value : otherwise;
  }
  [[nodiscard]] std::optional<double> number_of(int variable, const char* name) const {
    double value = 0;
    std::size_t length = 0;
    if (nc_inq_attlen(file_.id(), variable, name, &length) != NC_NOERR || length != 1) return std::nullopt;
    if (nc_get_att_double(file_.id(), variable, name, &value) != NC_NOERR) return std::nullopt;
    return value;
  }
  /// What stands where nothing was written, unless the variable says otherwise.
  [[nodiscard]] std::optional<double> fill_of(int variable) const {
    if (const auto told = number_of(variable, "_FillValue")) return told;
    nc_type type = 0;
    file_.check(nc_inq_vartype(file_.id(), variable, &type));
    if (type == NC_SHORT) return NC_FILL_SHORT;
    if (type == NC_INT) return NC_FILL_INT;
    if (type == NC_FLOAT) return NC_FILL_FLOAT;
    if (type == NC_DOUBLE) return NC_FILL_DOUBLE;
    return std::nullopt;
  }
  [[nodiscard]] std::vector<std::size_t> shape_of(int variable) const {
    int count = 0;
    file_.check(nc_inq_varndims(file_.id(), variable, &count));
    std::vector<int> dimensions(static_cast<std::size_t>(count));
    file_.check(nc_inq_vardimid(file_.id(), variable, dimensions.data()));
    std::vector<std::size_t> shape(dimensions.size());
    for (std::size_t i = 0; i < shape.size(); ++i)
      file_.check(nc_inq_dimlen(file_.id(), dimensions[i], &shape[i]));
    return shape;
  }
  [[nodiscard]] std::vector<double> doubles(int variable, std::size_t count) const {
    const std::vector<std::size_t> shape = shape_of(variable);
    if (shape.size() != 1 || (count != 0 && shape.front() != count))
      fail(ErrorCode::BadFormat, "the variable " + name_of(variable) + " has not one value a node");
    std::vector<double> values(shape.front());
    file_.check(nc_get_var_double(file_.id(), variable, values.data()));
    const std::optional<double> fill = fill_of(variable), missing = number_of(variable, "missing_value");
    const double scale = number_of(variable, "scale_factor").value_or(1);
    const double offset = number_of(variable, "add_offset").value_or(0);
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (values[i] == fill || values[i] == missing) {
        fail(ErrorCode::MissingHeight, "node " + std::to_string(i) + " has no " + name_of(variable) +
                                           ", but its fill value; give it one, or take the node out");
      }
      values[i] = values[i] * scale + offset;
      if (!std::isfinite(values[i]))
        fail(ErrorCode::BadCoordinate,
             name_of(variable) + " of node " + std::to_string(i) + " is not finite");
    }
    return values;
  }

  [[nodiscard]] int find_mesh() const {
    for (int v = 0; v < variable_count(); ++v) {
      if (text_of(v, "cf_role") == "mesh_topology" && integer_of(v, "topology_dimension", 0) == 2) return v;
    }
    fail(ErrorCode::Unsupported, "is NetCDF, but holds no two-dimensional UGRID mesh; convert it to one");
  }

  [[nodiscard]] int height_variable(const std::string& mesh) const {
    std::vector<int> on_nodes;
    for (int v = 0; v < variable_count(); ++v) {
      if (text_of(v, "mesh") == mesh && text_of(v, "location") == "node" && shape_of(v).size() == 1)
        on_nodes.push_back(v);
    }
    for (const int v : on_nodes) {
      const std::string standard = text_of(v, "standard_name");
      if (standard == "altitude" || standard == "sea_floor_altitude") return v;
    }
    for (const int v : on_nodes) {
      const std::string name = name_of(v);
      if (name.size() > 2 && name.substr(name.size() - 2) == "_z") return v;
    }
    if (on_nodes.size() == 1) return on_nodes.front();
    fail(ErrorCode::MissingHeight, "the mesh " + mesh + " has " + std::to_string(on_nodes.size()) +
                                       " variables on its nodes, none of which says that it is the height "
                                       "(standard_name altitude)");
  }

  void read_nodes(int mesh) {
    std::istringstream names(text_of(mesh, "node_coordinates"));
    std::string x, y;
    names >> x >> y;
    const std::optional<int> x_id = find(x), y_id = find(y);
    if (!x_id || !y_id)
      fail(ErrorCode::BadFormat, "the mesh " + name_of(mesh) + " names no node_coordinates that exist");
    const std::vector<double> xs = doubles(*x_id, 0);
    const std::vector<double> ys = doubles(*y_id, xs.size());
    const int z_id = height_variable(name_of(mesh));
    tin_.heights = doubles(z_id, xs.size());
    if (is_depth(z_id)) {
      for (double& height : tin_.heights) height = 0 - height;
      tin_.notes.push_back(path_ + ": " + name_of(z_id) +
                           " counts downwards; heights are its values with the other sign");
    }
    unit_ = text_of(*x_id, "units");
    height_unit_ = text_of(z_id, "units");
    tin_.points.resize(xs.size());
    for (std::size_t i = 0; i < xs.size(); ++i) tin_.points[i] = {xs[i], ys[i]};
  }

  [[nodiscard]] bool is_depth(int variable) const {
    const std::string positive = text_of(variable, "positive");
    if (!positive.empty()) return positive == "down";
    return text_of(variable, "standard_name").find("depth_below") != std::string::npos;
  }

  [[nodiscard]] std::vector<int> integers(int variable, std::size_t count) const {
    std::vector<int> values(count);
    if (count > 0) file_.check(nc_get_var_int(file_.id(), variable, values.data()));
    return values;
  }

  [[nodiscard]] VertexId vertex(int value, int start, const char* what, std::size_t row) const {
    const std::int64_t id = std::int64_t{value} - start;
    if (id >= 0 && id < static_cast<std::int64_t>(tin_.points.size()))
      return VertexId{static_cast<std::size_t>(id)};
    fail(ErrorCode::BadFormat, std::string(what) + " " + std::to_string(row) + " names node " +
                                   std::to_string(value) + ", which does not exist");
  }

  [[nodiscard]] bool lists_corners_first(int mesh, int faces, const std::vector<std::size_t>& shape) const {
    std::array<int, 2> dimensions{};
    file_.check(nc_inq_vardimid(file_.id(), faces, dimensions.data()));
    int of_faces = 0;
    if (nc_inq_dimid(file_.id(), text_of(mesh, "face_dimension").c_str(), &of_faces) == NC_NOERR)
      return dimensions[1] == of_faces && dimensions[0] != of_faces;
    return shape[1] < 3 || (shape[0] <= 8 && shape[1] > 8);
  }

  void read_faces(int mesh) {
    const std::optional<int> faces = find(text_of(mesh, "face_node_connectivity"));
    if (!faces) fail(ErrorCode::BadFormat, "the mesh " + name_of(mesh) + " has no face_node_connectivity");
    const std::vector<std::size_t> shape = shape_of(*faces);
    if (shape.size() != 2)
      fail(ErrorCode::BadFormat, "the faces have " + std::to_string(shape.size()) + " dimensions");
    const bool corners_first = lists_corners_first(mesh, *faces, shape);
    const std::size_t rows = corners_first ? shape[1] : shape[0], width = corners_first ? shape[0] : shape[1];
    if (width < 3) fail(ErrorCode::WrongGeometry, "the faces have fewer than three corners");
    const int start = integer_of(*faces, "start_index", 0);
    const int none = integer_of(*faces, "_FillValue", NC_FILL_INT);
    const std::vector<int> values = integers(*faces, rows * width);
    tin_.triangles.reserve(rows);
    for (std::size_t row = 0; row < rows; ++row) {
      Triangle triangle;
      for (std::size_t i = 0; i < width; ++i) {
        const int value = values[corners_first ? i * rows + row : row * width + i];
        const bool is_none = value == none || value < start;
        if ((i < 3) == is_none) {
          fail(ErrorCode::WrongGeometry,
               "face " + std::to_string(row) + " is no triangle; triangulate the mesh first");
        }
        if (i < 3) triangle[i] = vertex(value, start, "face", row);
      }
      tin_.triangles.push_back(triangle);
    }
  }

  void read_constraints() {
    const std::optional<int> nodes = find("thalweg_constraint_nodes"),
                             kinds = find("thalweg_constraint_kind");
    if (!nodes || !kinds) return;
    const std::vector<std::size_t> shape = shape_of(*nodes);
    if (shape.size() != 2 || shape[1] != 2 || shape_of(*kinds) != std::vector<std::size_t>{shape[0]})
      fail(ErrorCode::BadFormat, "the constraint edges have not two nodes and a kind each");
    const std::vector<int> ends = integers(*nodes, 2 * shape[0]);
    const std::vector<int> bits = integers(*kinds, shape[0]);
    for (std::size_t e = 0; e < shape[0]; ++e) {
      tin_.constraints.push_back({vertex(ends[2 * e], 0, "constraint edge", e),
                                  vertex(ends[2 * e + 1], 0, "constraint edge", e),
                                  static_cast<EdgeKind>(static_cast<std::uint8_t>(bits[e]))});
    }
  }

  void read_orders() {
    const std::optional<int> orders = find("Mesh2_face_order");
    if (!orders || shape_of(*orders) != std::vector<std::size_t>{tin_.triangles.size()}) return;
    for (const int order : integers(*orders, tin_.triangles.size()))
      tin_.triangle_orders.push_back(static_cast<std::uint16_t>(std::clamp(order, 0, 0xffff)));
  }

  void read_crs() {
    const std::optional<int> crs = find("projected_coordinate_system");
    if (!crs) return;
    for (const char* name : {"EPSG_code", "wkt", "crs_wkt"}) {
      tin_.crs = text_of(*crs, name);
      if (!tin_.crs.empty()) return;
    }
    if (const int code = integer_of(*crs, "epsg", 0); code > 0) tin_.crs = "EPSG:" + std::to_string(code);
  }

  void read_units() {
    const std::optional<double> unit = metres_of_unit(unit_), height_unit = metres_of_unit(height_unit_);
    if (tin_.crs.empty() && unit) tin_.crs = local_crs(unit_, *unit);
    if (height_unit) return take_height_unit(tin_, *height_unit, path_);
    if (height_unit_.empty() || height_unit_ == "1") return;
    tin_.notes.push_back(path_ + ": the unit of its heights, '" + height_unit_ +
                         "', is not known; they are taken to be in that of the CRS");
  }

  const std::string& path_;
  Progress& progress_;
  NetcdfFile file_;
  TinFile tin_;
  std::string unit_, height_unit_;  // as the file names them
};

}  // namespace

bool holds_ugrid_mesh(const std::string& path) {
  check_netcdf_length(path);
  try {
    const NetcdfFile file(path, path, NetcdfFile::Mode::Read);
    int count = 0;
    file.check(nc_inq_nvars(file.id(), &count));
    std::size_t length = 0;
    for (int variable = 0; variable < count; ++variable) {
      if (nc_inq_attlen(file.id(), variable, "topology_dimension", &length) == NC_NOERR) return true;
    }
  } catch (const Error&) {
    return false;  // whoever reads it says what is wrong
  }
  return false;
}

TinFile read_ugrid(const std::string& path, Progress& progress) {
  check_netcdf_length(path);
  return UgridReader(path, progress).read();
}

}  // namespace thalweg
