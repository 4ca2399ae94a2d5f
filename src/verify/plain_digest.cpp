// "The SHA-256 of the little-endian doubles x, y, z of all vertices sorted by (x, y), then x, y, x, y of all
// constraint edges, lower end first, sorted."
#include "verify/plain_digest.hpp"

#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

namespace thalweg::verify {

namespace {

void append(std::vector<unsigned char>& bytes, double value) {
  constexpr unsigned kByte = 8;
  const auto bits = std::bit_cast<std::uint64_t>(value);
  for (unsigned i = 0; i < sizeof(bits); ++i)
    bytes.push_back(static_cast<unsigned char>(bits >> kByte * i & 0xffU));
}

}  // namespace

std::string plain_digest(const PlainMesh& mesh, std::span<const Point2> written) {
  std::vector<std::array<double, 3>> vertices;
  for (std::size_t v = 0; v < written.size(); ++v)
    vertices.push_back({written[v].x, written[v].y, mesh.z[v]});
  std::sort(vertices.begin(), vertices.end());
  std::vector<std::array<double, 4>> edges;
  for (const auto& [edge, kind] : mesh.constraints) {
    const Point2 low = std::min(written[edge.first], written[edge.second]);
    const Point2 high = std::max(written[edge.first], written[edge.second]);
    edges.push_back({low.x, low.y, high.x, high.y});
  }
  std::sort(edges.begin(), edges.end());
  std::vector<unsigned char> bytes;
  for (const auto& vertex : vertices) {
    for (const double value : vertex) append(bytes, value);
  }
  for (const auto& edge : edges) {
    for (const double value : edge) append(bytes, value);
  }
  std::array<unsigned char, EVP_MAX_MD_SIZE> hash{};
  unsigned length = 0;
  EVP_Digest(bytes.data(), bytes.size(), hash.data(), &length, EVP_sha256(), nullptr);
  constexpr const char* kDigits = "0123456789abcdef";
  std::string text;
  for (unsigned i = 0; i < length; ++i) {
    text += kDigits[hash[i] >> 4U];
    text += kDigits[hash[i] & 0xfU];
  }
  return text;
}

}  // namespace thalweg::verify
