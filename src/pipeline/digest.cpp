// SHA-256 (OpenSSL) over a canonical order of vertices and constraint edges, independent of ids.
#include "pipeline/digest.hpp"

#include "base/buckets.hpp"
#include "base/parallel.hpp"

#include <thalweg/base/raw_vector.hpp>

#include <fmt/format.h>
#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <memory>
#include <span>
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
  void add(std::span<const std::array<double, Count>> rows) {
    EVP_DigestUpdate(context_.get(), rows.data(), rows.size_bytes());
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

using Row = std::array<double, 3>;

/// Position and height of all vertices, sorted: by x into buckets, then each of these.
RawVector<Row> sorted_rows(std::span<const Point2> xy, std::span<const double> heights) {
  constexpr std::size_t kBlock = 4096;
  RawVector<Row> rows(xy.size());
  const Buckets buckets =
      sort_into_buckets(xy.size(), xy.size() / 2 + 1, [&](std::size_t v) { return xy[v].x; });
  for_each_block(buckets.size(), kBlock, Progress(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const std::size_t first = buckets.first[b], last = buckets.first[b + 1];
      for (std::size_t i = first; i < last; ++i) {
        const std::uint32_t v = buckets.item[i];
        rows[i] = {xy[v].x, xy[v].y, heights[v]};
      }
      std::sort(rows.begin() + first, rows.begin() + last);
    }
  });
  return rows;
}

}  // namespace

std::string digest_of(const Tin& tin, std::span<const Point2> written) {
  const std::span<const Point2> xy = written.empty() ? tin.points() : written;
  Sha256 digest;
  digest.add<3>(sorted_rows(xy, tin.heights()));

  std::vector<std::pair<Point2, Point2>> edges;
  for (const ConstraintEdge& edge : tin.constraint_edges()) {
    edges.emplace_back(std::minmax(xy[edge.a.index()], xy[edge.b.index()]));
  }
  std::sort(edges.begin(), edges.end());
  std::vector<std::array<double, 4>> ends;
  ends.reserve(edges.size());
  for (const auto& [low, high] : edges) ends.push_back({low.x, low.y, high.x, high.y});
  digest.add<4>(ends);
  return digest.hexadecimal();
}

}  // namespace thalweg
