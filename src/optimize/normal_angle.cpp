// Normals and angles in batches.
//
// Loops over arrays, without branches, so that the compiler makes them ones of vector instructions; they are
// compiled for several processors and chosen at run time. As in the scalar functions all operations are
// rounded correctly and none is fused, so the bits are the same. Where the scalar function would scale its
// normals, it is called.
#include "optimize/normal_angle.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

namespace thalweg {

namespace {

constexpr std::size_t kBatch = 128;  // columns of a page each would share the cache's sets
using Column = std::array<double, kBatch>;

/// Cosine and sine of angles, but for a common factor.
struct Batch {
  Column dot, cross_squared, angle;
};

// The choice is made before sanitizers are ready.
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__) && \
    !defined(__SANITIZE_ADDRESS__)
[[gnu::target_clones("default", "avx2", "avx512f")]]
#endif
void find_angles(Batch& batch) {
  for (std::size_t i = 0; i < kBatch; ++i) {
    const double squared = batch.cross_squared[i], dot = batch.dot[i];
    batch.angle[i] = angle_of(dot, std::sqrt(squared));
  }
}

/// The corners of triangles, in turn, and their normals.
struct Corners {
  std::array<Column, 3> x, y, z;
  Column normal_x, normal_y, normal_z;
};

#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__) && \
    !defined(__SANITIZE_ADDRESS__)
[[gnu::target_clones("default", "avx2", "avx512f")]]
#endif
void find_normals_of(Corners& at, Scale scale) {
  for (std::size_t i = 0; i < kBatch; ++i) {
    const double ax = at.x[0][i], bx = at.x[1][i], cx = at.x[2][i];
    const double ay = at.y[0][i], by = at.y[1][i], cy = at.y[2][i];
    const double az = at.z[0][i], bz = at.z[1][i], cz = at.z[2][i];
    const bool b_a = (bx < ax) | ((bx == ax) & (by < ay));
    const bool c_a = (cx < ax) | ((cx == ax) & (cy < ay));
    const bool c_b = (cx < bx) | ((cx == bx) & (cy < by));
    const bool b_first = b_a & !c_b, c_first = c_a & c_b;
    const auto turned = [&](double a, double b, double c) { return b_first ? b : (c_first ? c : a); };
    const double x = turned(ax, bx, cx), y = turned(ay, by, cy), z = turned(az, bz, cz);
    const double px = (turned(bx, cx, ax) - x) * scale.horizontal;
    const double qx = (turned(cx, ax, bx) - x) * scale.horizontal;
    const double py = (turned(by, cy, ay) - y) * scale.horizontal;
    const double qy = (turned(cy, ay, by) - y) * scale.horizontal;
    const double pz = (turned(bz, cz, az) - z) * scale.vertical;
    const double qz = (turned(cz, az, bz) - z) * scale.vertical;
    at.normal_x[i] = py * qz - pz * qy;
    at.normal_y[i] = pz * qx - px * qz;
    at.normal_z[i] = px * qy - py * qx;
  }
}

}  // namespace

void find_normals(const Tin& tin, std::span<const Triangle> triangles, Scale scale,
                  std::span<Vector3> normals) {
  Corners at{};
  for (std::size_t begin = 0; begin < triangles.size(); begin += kBatch) {
    const std::size_t count = std::min(kBatch, triangles.size() - begin);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const VertexId v = triangles[begin + i][corner];
        at.x[corner][i] = tin.point(v).x;
        at.y[corner][i] = tin.point(v).y;
        at.z[corner][i] = tin.height(v);
      }
    }
    find_normals_of(at, scale);
    for (std::size_t i = 0; i < count; ++i) {
      normals[begin + i] = {at.normal_x[i], at.normal_y[i], at.normal_z[i]};
    }
  }
}

void angles_between(std::span<const Vector3> normals, std::span<const BodyPair> pairs,
                    std::span<double> angles) {
  Batch batch{};
  for (std::size_t begin = 0; begin < pairs.size(); begin += kBatch) {
    const std::size_t count = std::min(kBatch, pairs.size() - begin);
    for (std::size_t i = 0; i < count; ++i) {
      const Vector3 m = normals[pairs[begin + i][0]], n = normals[pairs[begin + i][1]];
      batch.dot[i] = m.x * n.x + m.y * n.y + m.z * n.z;
      const Vector3 cross{m.y * n.z - m.z * n.y, m.z * n.x - m.x * n.z, m.x * n.y - m.y * n.x};
      batch.cross_squared[i] = cross.x * cross.x + cross.y * cross.y + cross.z * cross.z;
    }
    find_angles(batch);
    for (std::size_t i = 0; i < count; ++i) {
      angles[begin + i] = has_plain_squares(batch.dot[i], batch.cross_squared[i])
                              ? batch.angle[i]
                              : angle_between(normals[pairs[begin + i][0]], normals[pairs[begin + i][1]]);
    }
  }
}

}  // namespace thalweg
