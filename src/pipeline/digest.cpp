// SHA-256 (OpenSSL) over a canonical order of vertices and constraint edges, independent of ids.
#include "pipeline/digest.hpp"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <memory>
#include <numeric>
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
  void add(std::span<const double> numbers) {
    EVP_DigestUpdate(context_.get(), numbers.data(), numbers.size_bytes());
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
  std::vector<std::uint32_t> order(xy.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return xy[a] < xy[b]; });
  std::vector<double> numbers;
  numbers.reserve(3 * order.size());
  for (const std::uint32_t v : order) numbers.insert(numbers.end(), {xy[v].x, xy[v].y, tin.heights()[v]});
  Sha256 digest;
  digest.add(numbers);

  std::vector<std::pair<Point2, Point2>> edges;
  for (const ConstraintEdge& edge : tin.constraint_edges()) {
    edges.emplace_back(std::minmax(xy[edge.a.index()], xy[edge.b.index()]));
  }
  std::sort(edges.begin(), edges.end());
  numbers.clear();
  for (const auto& [low, high] : edges) numbers.insert(numbers.end(), {low.x, low.y, high.x, high.y});
  digest.add(numbers);
  return digest.hexadecimal();
}

}  // namespace thalweg
