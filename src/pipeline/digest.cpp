// SHA-256 (OpenSSL) over a canonical order of vertices and constraint edges, independent of ids.
#include "pipeline/digest.hpp"

#include <fmt/format.h>
#include <openssl/evp.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace thalweg {

namespace {

class Sha256 {
 public:
  Sha256() : context_(EVP_MD_CTX_new(), &EVP_MD_CTX_free) {
    EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr);
  }
  template <std::size_t Count>
  void add(const std::vector<std::array<double, Count>>& rows) {
    EVP_DigestUpdate(context_.get(), rows.data(), rows.size() * sizeof(rows[0]));
  }
  std::string hexadecimal() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> bytes{};
    unsigned length = 0;
    EVP_DigestFinal_ex(context_.get(), bytes.data(), &length);
    std::string text;
    for (unsigned i = 0; i < length; ++i) text += fmt::format("{:02x}", bytes[i]);
    return text;
  }

 private:
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

}  // namespace

std::string digest_of(const Tin& tin, std::span<const Point2> written) {
  const std::span<const Point2> xy = written.empty() ? tin.points() : written;
  std::vector<std::array<double, 3>> vertices(xy.size());
  for (std::size_t v = 0; v < xy.size(); ++v) vertices[v] = {xy[v].x, xy[v].y, tin.heights()[v]};
  tbb::parallel_sort(vertices.begin(), vertices.end());
  Sha256 digest;
  digest.add(vertices);

  std::vector<std::pair<Point2, Point2>> edges;
  for (const ConstraintEdge& edge : tin.constraint_edges()) {
    edges.emplace_back(std::minmax(xy[edge.a.index()], xy[edge.b.index()]));
  }
  std::sort(edges.begin(), edges.end());
  std::vector<std::array<double, 4>> ends;
  ends.reserve(edges.size());
  for (const auto& [low, high] : edges) ends.push_back({low.x, low.y, high.x, high.y});
  digest.add(ends);
  return digest.hexadecimal();
}

}  // namespace thalweg
