// Pits and smoothness at orders 0 to K on one set of points: the optimum, its bound, and the flip heuristic.
// Usage: bench_higher_order POINTS.csv K NAME; x,y,z with a header; metres. Prints rows of a markdown table.
#include "flip_heuristic.hpp"

#include <thalweg/delaunay/triangulate.hpp>
#include <thalweg/optimize/optimize_faces.hpp>
#include <thalweg/terrain/pits.hpp>

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace thalweg::bench {
namespace {

Tin read_points(const char* path) {
  std::ifstream file(path);
  std::map<Point2, double> at;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream row(line);
    Point2 p;
    double z = 0;
    char comma = 0;
    if (row >> p.x >> comma >> p.y >> comma >> z) at.emplace(p, z);
  }
  std::vector<Point2> points;
  std::vector<double> heights;
  for (const auto& [p, z] : at) {
    points.push_back(p);
    heights.push_back(z);
  }
  Progress progress;
  return triangulate(std::move(points), std::move(heights), {}, progress);
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::string proof(const CriterionResult& line) {
  if (line.optimal) return "optimal";
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "bound %.6g", line.bound);
  return text.data();
}

void print_row(const char* name, const Tin& tin, std::size_t k) {
  Progress progress;
  auto start = std::chrono::steady_clock::now();
  const ConstrainedOrder order(tin);
  const auto faces =
      find_fixed_faces(tin, find_order_triangles(order, {.max_order = k}, progress), {}, progress);
  const double listing = seconds_since(start);
  start = std::chrono::steady_clock::now();
  const FaceOptimizeResult result = optimize_faces(tin, *faces, {}, progress);
  const double choosing = seconds_since(start);
  const std::size_t flipped = find_pits(flip_to_lowest(tin, *faces)).interior;
  const CriterionResult &pits = result.criteria[0], &angles = result.criteria[1];
  std::printf("| %s | %zu | %.0f | %s | %zu | %.2f | %s | %zu | %zu | %zu | %zu | %zu | %.1f | %.1f |\n",
              name, k, pits.result, proof(pits).c_str(), flipped, angles.result, proof(angles).c_str(),
              result.faces, result.partial_faces, result.largest_face, result.labels, result.largest_piece,
              listing, choosing);
  std::fflush(stdout);
}

}  // namespace
}  // namespace thalweg::bench

int main(int count, char** arguments) {
  if (count < 4) {
    std::fprintf(stderr, "usage: bench_higher_order POINTS.csv K NAME\n");
    return 2;
  }
  const thalweg::Tin tin = thalweg::bench::read_points(arguments[1]);
  const auto most = static_cast<std::size_t>(std::strtoul(arguments[2], nullptr, 10));
  for (std::size_t k = 0; k <= most; ++k) thalweg::bench::print_row(arguments[3], tin, k);
  return 0;
}
