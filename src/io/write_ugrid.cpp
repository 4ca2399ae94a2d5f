// UGRID 1.0 in NetCDF (64-bit offset form), as QGIS (MDAL) and Delft3D read it.
//
// One mesh topology, Mesh2, of nodes and triangles; heights are Mesh2_node_z; the CRS is the variable
// projected_coordinate_system, with its WKT and code. UGRID has no place for marked edges: the constraint
// edges stand in two variables of their own, which other programs pass over. Values of vertices and edges are
// data on nodes and edges; edges are listed only for those.
#include "io/netcdf_file.hpp"
#include "io/write_steps.hpp"

#include <thalweg/io/crs.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace thalweg {

namespace {

constexpr std::size_t kBlock = std::size_t{1} << 16U;

class UgridWriter {
 public:
  explicit UgridWriter(const TinWriteJob& job)
      : job_(job), edges_(edges_to_write(job)), file_(job.path, job.target, NetcdfFile::Mode::Create) {
    const std::string& definition = job.view.crs_wkt.empty() ? job.view.crs_authority : job.view.crs_wkt;
    if (!definition.empty()) crs_ = describe_crs(definition);
  }

  void write() {
    define();
    const Tin& tin = job_.view.tin;
    const std::size_t vertices = tin.vertex_count(), triangles = tin.triangle_count();
    put<double>(x_, vertices, 1, 0, [&](std::size_t v, double* out) { *out = job_.xy()[v].x; });
    put<double>(y_, vertices, 1, 0, [&](std::size_t v, double* out) { *out = job_.xy()[v].y; });
    put<double>(z_, vertices, 1, 0, [&](std::size_t v, double* out) { *out = tin.heights()[v]; });
    put<int>(faces_, triangles, 3, vertices, [&](std::size_t t, int* out) {
      for (const VertexId v : tin.triangles()[t]) *out++ = static_cast<int>(v.value());
    });
    if (!job_.view.triangle_orders.empty()) {
      put<int>(orders_, triangles, 1, vertices,
               [&](std::size_t t, int* out) { *out = job_.view.triangle_orders[t]; });
    }
    if (!edges_.empty()) {
      put<int>(constraints_, edges_.size(), 2, 0, [&](std::size_t e, int* out) {
        out[0] = static_cast<int>(edges_[e].a.value());
        out[1] = static_cast<int>(edges_[e].b.value());
      });
      put<int>(kinds_, edges_.size(), 1, 0,
               [&](std::size_t e, int* out) { *out = static_cast<int>(edges_[e].kind); });
    }
    write_attributes();
    file_.close();
  }

 private:
  void write_attributes() {
    const Tin& tin = job_.view.tin;
    if (!job_.view.edge_attributes.empty()) {
      std::size_t i = 0;  // rows come in order
      put<int>(edge_nodes_, tin.edge_count(), 2, 0, [&](std::size_t, int* out) {
        while (!tin.represents_edge(HalfedgeId{i})) ++i;
        out[0] = static_cast<int>(tin.origin(HalfedgeId{i}).value());
        out[1] = static_cast<int>(tin.target(HalfedgeId{i++}).value());
      });
    }
    const auto put_all = [&](std::span<const TinAttribute> attributes, const std::vector<int>& variables) {
      for (std::size_t a = 0; a < attributes.size(); ++a) {
        const std::vector<double>& values = attributes[a].values;
        put<double>(variables[a], values.size(), 1, 0,
                    [&](std::size_t row, double* out) { *out = values[row]; });
      }
    };
    put_all(job_.view.vertex_attributes, vertex_values_);
    put_all(job_.view.edge_attributes, edge_values_);
  }

  void define_attributes(int mesh, int nodes) {
    const auto define_all = [&](std::span<const TinAttribute> attributes, int elements, const char* location,
                                std::vector<int>& variables) {
      for (const TinAttribute& attribute_of : attributes) {
        const std::string name = std::string("Mesh2_") + location + "_" + attribute_of.name;
        const int id = variable(name.c_str(), NC_DOUBLE, {elements});
        attribute(id, "long_name", attribute_of.description);
        attribute(id, "units", attribute_of.unit);
        const double none = std::numeric_limits<double>::quiet_NaN();
        file_.check(nc_put_att_double(file_.id(), id, "_FillValue", NC_DOUBLE, 1, &none));
        place(id, location);
        variables.push_back(id);
      }
    };
    define_all(job_.view.vertex_attributes, nodes, "node", vertex_values_);
    if (job_.view.edge_attributes.empty()) return;
    const int edges = dimension("nMesh2_edge", job_.view.tin.edge_count());
    edge_nodes_ = variable("Mesh2_edge_nodes", NC_INT, {edges, dimension("Two", 2)});
    attribute(edge_nodes_, "cf_role", "edge_node_connectivity");
    attribute(edge_nodes_, "start_index", 0);
    attribute(mesh, "edge_node_connectivity", "Mesh2_edge_nodes");
    attribute(mesh, "edge_dimension", "nMesh2_edge");
    define_all(job_.view.edge_attributes, edges, "edge", edge_values_);
  }

  int dimension(const char* name, std::size_t size) {
    int id = 0;
    file_.check(nc_def_dim(file_.id(), name, size, &id));
    return id;
  }
  int variable(const char* name, nc_type type, const std::vector<int>& dimensions) {
    int id = 0;
    file_.check(
        nc_def_var(file_.id(), name, type, static_cast<int>(dimensions.size()), dimensions.data(), &id));
    return id;
  }
  void attribute(int variable, const char* name, const std::string& text) {
    file_.check(nc_put_att_text(file_.id(), variable, name, text.size(), text.c_str()));
  }
  void attribute(int variable, const char* name, int value) {
    file_.check(nc_put_att_int(file_.id(), variable, name, NC_INT, 1, &value));
  }

  void define() {
    const Tin& tin = job_.view.tin;
    int filled = 0;
    file_.check(nc_set_fill(file_.id(), NC_NOFILL, &filled));
    attribute(NC_GLOBAL, "Conventions", "CF-1.8 UGRID-1.0");
    const int nodes = dimension("nMesh2_node", tin.vertex_count());
    const int faces = dimension("nMesh2_face", tin.triangle_count());
    const int corners = dimension("nMaxMesh2_face_nodes", 3);

    const int mesh = variable("Mesh2", NC_INT, {});
    attribute(mesh, "cf_role", "mesh_topology");
    attribute(mesh, "long_name", "triangulated irregular network");
    attribute(mesh, "topology_dimension", 2);
    attribute(mesh, "node_coordinates", "Mesh2_node_x Mesh2_node_y");
    attribute(mesh, "face_node_connectivity", "Mesh2_face_nodes");

    x_ = variable("Mesh2_node_x", NC_DOUBLE, {nodes});
    y_ = variable("Mesh2_node_y", NC_DOUBLE, {nodes});
    attribute(x_, "standard_name", crs_.geographic ? "longitude" : "projection_x_coordinate");
    attribute(y_, "standard_name", crs_.geographic ? "latitude" : "projection_y_coordinate");
    attribute(x_, "units", crs_.geographic ? "degrees_east" : unit(crs_.horizontal_metres_per_unit));
    attribute(y_, "units", crs_.geographic ? "degrees_north" : unit(crs_.horizontal_metres_per_unit));
    z_ = variable("Mesh2_node_z", NC_DOUBLE, {nodes});
    attribute(z_, "standard_name", "altitude");
    attribute(z_, "long_name", "height of the nodes");
    attribute(z_, "units", unit(crs_.vertical_metres_per_unit));
    place(z_, "node");
    faces_ = variable("Mesh2_face_nodes", NC_INT, {faces, corners});
    attribute(faces_, "cf_role", "face_node_connectivity");
    attribute(faces_, "start_index", 0);
    if (!job_.view.triangle_orders.empty()) {
      orders_ = variable("Mesh2_face_order", NC_INT, {faces});
      attribute(orders_, "long_name", "constrained order of the triangle");
      place(orders_, "face");
    }
    if (!edges_.empty()) {
      const int count = dimension("thalweg_constraint", edges_.size());
      constraints_ = variable("thalweg_constraint_nodes", NC_INT, {count, dimension("thalweg_two", 2)});
      kinds_ = variable("thalweg_constraint_kind", NC_INT, {count});
      attribute(constraints_, "start_index", 0);
      attribute(kinds_, "long_name",
                "1 breakline, 2 ridge, 4 valley, 8 boundary, 16 hole, 32 lake, added up");
    }
    define_attributes(mesh, nodes);
    define_crs();
    file_.check(nc_enddef(file_.id()));
  }

  void place(int variable, const char* location) {
    attribute(variable, "mesh", "Mesh2");
    attribute(variable, "location", location);
    if (crs_.known) attribute(variable, "grid_mapping", "projected_coordinate_system");
  }

  void define_crs() {
    if (!crs_.known) return;
    const int crs = variable("projected_coordinate_system", NC_INT, {});
    attribute(crs, "name", crs_.name);
    attribute(crs, "wkt", crs_.wkt);
    attribute(crs, "crs_wkt", crs_.wkt);
    if (crs_.authority.empty()) return;
    attribute(crs, "EPSG_code", crs_.authority);
    const std::size_t colon = crs_.authority.find(':');
    if (const std::optional<std::int64_t> code = parse_code(crs_.authority.substr(colon + 1))) {
      attribute(crs, "epsg", static_cast<int>(*code));
    }
  }

  static std::optional<std::int64_t> parse_code(const std::string& text) {
    if (text.empty() || text.size() > 9 || text.find_first_not_of("0123456789") != std::string::npos)
      return {};
    return std::stoll(text);
  }

  static std::string unit(double metres) { return metres == 1 ? "m" : fmt::format("{} m", metres); }

  static int put_block(int file, int variable, const std::size_t* start, const std::size_t* count,
                       const double* p) {
    return nc_put_vara_double(file, variable, start, count, p);
  }
  static int put_block(int file, int variable, const std::size_t* start, const std::size_t* count,
                       const int* p) {
    return nc_put_vara_int(file, variable, start, count, p);
  }

  // Writes `rows` rows of `width` values; `fill` makes one row.
  template <class Value, class Fill>
  void put(int variable, std::size_t rows, std::size_t width, std::size_t progress_start, const Fill& fill) {
    std::vector<Value> block(std::min(rows, kBlock) * width);
    const double total =
        static_cast<double>(job_.view.tin.vertex_count() + job_.view.tin.triangle_count() + 1);
    for (std::size_t row = 0; row < rows; row += kBlock) {
      job_.progress.advance(std::min(1.0, static_cast<double>(progress_start + row) / total));
      const std::size_t count = std::min(kBlock, rows - row);
      for (std::size_t i = 0; i < count; ++i) fill(row + i, block.data() + i * width);
      const std::array<std::size_t, 2> start = {row, 0}, counts = {count, width};
      file_.check(put_block(file_.id(), variable, start.data(), counts.data(), block.data()));
    }
  }

  const TinWriteJob& job_;
  std::vector<ConstraintEdge> edges_;
  CrsInfo crs_;
  NetcdfFile file_;
  int x_ = 0, y_ = 0, z_ = 0, faces_ = 0, orders_ = 0, constraints_ = 0, kinds_ = 0, edge_nodes_ = 0;
  std::vector<int> vertex_values_, edge_values_;
};

}  // namespace

void write_ugrid(const TinWriteJob& job) {
  UgridWriter(job).write();
}

}  // namespace thalweg
