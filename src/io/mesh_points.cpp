// Points that are the vertices of a mesh. The whole mesh is read when it is opened, because its CRS may stand
// anywhere in it; its faces are dropped, so that a cloud of points without any will do.
#include "io/mesh_points.hpp"

#include "base/lower_case.hpp"
#include "base/release.hpp"
#include "io/file_content.hpp"
#include "io/point_collector.hpp"
#include "io/spatial_reference.hpp"
#include "io/tin_format.hpp"

#include <thalweg/base/error.hpp>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>

namespace thalweg {

namespace {

class MeshPoints : public SourceReader {
 public:
  MeshPoints(const SourceSpec& spec, TinFile mesh) : SourceReader(spec), mesh_(std::move(mesh)) {
    if (!mesh_.crs.empty()) set_reference(parse_reference(mesh_.crs));
  }

  void read(ReadContext& run, PlaneTransform& transform) override {
    if (!run.options.where.empty()) run.where.refusals.push_back(name() + " is a mesh and has no attributes");
    if (!run.options.z_field.empty()) run.z_field.refusals.push_back(name() + " is a mesh and has no fields");
    for (const std::string& note : mesh_.notes) run.note(note);
    expect_points(run, static_cast<double>(mesh_.points.size()));
    PointCollector points(run, transform);
    for (std::size_t i = 0; i < mesh_.points.size(); ++i) {
      const Point2 p = mesh_.points[i];
      if (!is_usable(p.x) || !is_usable(p.y) || !is_usable(mesh_.heights[i])) {
        throw Error(ErrorCode::BadCoordinate,
                    name() + " vertex " + std::to_string(i) + " has no usable coordinates");
      }
      points.add(p, mesh_.heights[i]);
    }
    points.finish();
    mesh_ = {};
  }

 private:
  TinFile mesh_;
};

}  // namespace

bool is_mesh(const SourceSpec& spec) {
  const std::string extension = extension_of(spec.path);
  constexpr std::array<std::string_view, 7> kMeshes = {".ply", ".2dm", ".obj",    ".off",
                                                       ".stl", ".xml", ".landxml"};
  if (extension == ".nc") return spec.layer.empty() && holds_ugrid_mesh(spec.path);
  return std::find(kMeshes.begin(), kMeshes.end(), extension) != kMeshes.end();
}

std::unique_ptr<SourceReader> open_mesh(const SourceSpec& spec, const Progress& progress) {
  constexpr std::size_t kHead = 512;
  const std::string head = read_head(spec.path, kHead);
  // The run reports its own fraction; only the wish to stop is passed on.
  Progress quiet([&](const std::string&, double) { progress.check(); });
  for (const TinFormat& format : tin_format_table()) {
    if (format.read == nullptr || !format.recognises(head, spec.path)) continue;
    TinFile mesh = format.read(spec.path, quiet);
    release(mesh.triangles);
    if (mesh.points.empty()) throw Error(ErrorCode::EmptyInput, spec.path + " holds no vertices");
    if (mesh.crs.empty() && format.crs == TinFormat::Crs::InSidecar) mesh.crs = read_prj_sidecar(spec.path);
    return std::make_unique<MeshPoints>(spec, std::move(mesh));
  }
  throw Error(ErrorCode::Unsupported, spec.path + " is no mesh of a format that is known; convert it to PLY");
}

}  // namespace thalweg
