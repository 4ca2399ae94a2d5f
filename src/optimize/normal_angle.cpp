// Angles in batches.
//
// A loop over arrays, without branches, so that the compiler makes it one of vector instructions; it is
// compiled for several processors and chosen at run time. As in the scalar function all operations are
// rounded correctly and none is fused, so the bits are the same. Where the scalar function would scale its
// normals, it is called.
#include "optimize/normal_angle.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

namespace thalweg {

namespace {

constexpr std::size_t kBatch = 512;
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

}  // namespace

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
