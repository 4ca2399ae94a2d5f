// A small survey out of bytes: a few bytes choose rules, then come points, then lines. Positions are on a
// lattice, so that most of them are degenerate, or a lattice finer than doubles tell apart, or any doubles.
#include "fuzz/byte_reader.hpp"
#include "fuzz/laws.hpp"
#include "fuzz/target.hpp"
#include "fuzz/target_list.hpp"

#include <thalweg/pipeline/build.hpp>

#include <array>
#include <cmath>
#include <cstdint>

namespace thalweg::fuzz {

namespace {

enum class Frame : std::uint8_t { SmallLattice, Lattice, Fine, Utm, Degrees, Any };
constexpr std::size_t kFrames = 6;

/// Lines in degrees get many more; plain code takes its time on those.
constexpr std::size_t kMostVertices = 150;

Point2 take_point(ByteReader& bytes, Frame frame) {
  const auto small = [&bytes] { return static_cast<double>(bytes.take<std::int8_t>()); };
  switch (frame) {
    case Frame::SmallLattice: {
      const auto both = bytes.take<std::uint8_t>();
      return {static_cast<double>(both & 15U), static_cast<double>(both >> 4U)};
    }
    case Frame::Lattice:
      break;
    case Frame::Fine: {
      const double x = small(), y = small();
      return {1e7 + x * 1e-9, 1e7 + y * 1e-9};
    }
    case Frame::Utm: {
      const double x = bytes.take<std::int16_t>(), y = bytes.take<std::int16_t>();
      return {500000 + x / 1000, 5200000 + y / 1000};
    }
    case Frame::Degrees: {
      const double x = bytes.take<std::int16_t>(), y = bytes.take<std::int16_t>();
      return {10 + x / 1e5, 45 + y / 1e5};
    }
    case Frame::Any: {
      const auto x = bytes.take<double>(), y = bytes.take<double>();
      return {x, y};
    }
  }
  const double x = small(), y = small();
  return {x, y};
}

double take_height(ByteReader& bytes, Frame frame) {
  if (frame == Frame::Any) return bytes.take<double>();
  return static_cast<double>(bytes.take<std::int8_t>() / 8);
}

MemorySource take_sources(ByteReader& bytes, Frame frame) {
  constexpr std::array kKinds{EdgeKind::Breakline, EdgeKind::Ridge, EdgeKind::Valley,
                              EdgeKind::Boundary,  EdgeKind::Hole,  EdgeKind::Lake};
  constexpr std::size_t kMostPoints = 28, kMostLines = 8, kMostInLine = 6;
  MemorySource sources;
  const std::size_t points = bytes.pick(kMostPoints);
  for (std::size_t i = 0; i < points; ++i) {
    sources.xy.push_back(take_point(bytes, frame));
    sources.z.push_back(take_height(bytes, frame));
  }
  while (!bytes.empty() && sources.lines.size() < kMostLines) {
    MemoryLine line;
    line.kind = kKinds[bytes.pick(kKinds.size())];
    const bool hard = bytes.flag();
    const std::size_t vertices = bytes.pick(kMostInLine) + 1;
    for (std::size_t i = 0; i < vertices; ++i) {
      line.xy.push_back(take_point(bytes, frame));
      if (hard) line.z.push_back(take_height(bytes, frame));
    }
    const bool ring = line.kind >= EdgeKind::Boundary;
    if (ring && bytes.pick(8) != 0) {
      line.xy.push_back(line.xy.front());
      if (hard) line.z.push_back(line.z.front());
    }
    sources.lines.push_back(std::move(line));
  }
  return sources;
}

std::vector<Objective> take_criteria(ByteReader& bytes) {
  std::vector<Objective> criteria;
  const std::size_t count = bytes.pick(4);
  for (std::size_t i = 0; i < count; ++i) {
    const auto& traits = all_criteria()[bytes.pick(all_criteria().size())];
    if (traits.criterion != Criterion::VerticalError) criteria.emplace_back(traits.criterion);
  }
  return criteria;
}

BuildConfig take_config(ByteReader& bytes, Frame frame) {
  BuildConfig config;
  config.read.heights = HeightRule::Optional;
  if (frame == Frame::Degrees) config.read.assigned_crs = "EPSG:4326";
  config.labelling.order = std::array{1U, 0U, 1U, 2U}[bytes.pick(4)];
  config.labelling.definition = kOrderDefinitions[bytes.pick(kOrderDefinitions.size())];
  if (const auto criteria = take_criteria(bytes); !criteria.empty()) config.labelling.criteria = criteria;
  config.ground.crossing = static_cast<CrossingRule>(bytes.pick(7));
  config.ground.duplicates = static_cast<DuplicateRule>(bytes.pick(5));
  switch (bytes.pick(8)) {
    case 1:
      config.snap_m = 1.5;
      break;
    case 2:
      config.max_edge_m = 5;
      break;
    case 3:
      config.max_error_m = 2;
      break;
    case 4:
      config.max_points = 6;
      break;
    default:
      break;
  }
  return config;
}

bool same_tin(const Tin& a, const Tin& b) {
  const auto same = [](auto x, auto y) { return std::ranges::equal(x, y); };
  return same(a.points(), b.points()) && same(a.heights(), b.heights()) &&
         same(a.triangles(), b.triangles()) &&
         std::ranges::equal(a.constraint_edges(), b.constraint_edges(), [](const auto& e, const auto& f) {
           return e.a == f.a && e.b == f.b && e.kind == f.kind;
         });
}

void run(std::string_view input) {
  ByteReader bytes(input);
  const auto frame = static_cast<Frame>(bytes.pick(kFrames));
  BuildConfig config = take_config(bytes, frame);
  const MemorySource sources = take_sources(bytes, frame);
  BuiltTin flat, cgal;
  Progress progress;
  const auto error = error_of([&] { flat = build_tin(config, sources, progress); });
  config.ground.engine = TriangulationEngine::Cgal;
  const auto other = error_of([&] { cgal = build_tin(config, sources, progress); });
  if (error != other) throw Finding("one engine ends with another error than the other");
  if (error) return;
  if (!same_tin(flat.tin, cgal.tin)) throw Finding("the engines' triangulations differ");
  if (flat.tin.vertex_count() <= kMostVertices) check_built(flat, config.labelling.definition);
}

std::vector<std::string> seeds() {
  std::vector<std::string> all;
  // A survey of each frame, some with lines of each kind; the numbers are those of a small congruential
  // generator.
  std::uint32_t state = 1;
  for (std::size_t i = 0; i < 8 * kFrames; ++i) {
    std::string bytes(1, static_cast<char>(i % kFrames));
    bytes += std::string(6, '\0');
    bytes[1] = static_cast<char>(i / kFrames % 4);
    bytes[2] = static_cast<char>(i / kFrames);
    bytes += static_cast<char>(9 + i % 16);
    for (std::size_t k = 0; k < 40 + 8 * i; ++k) {
      state = state * 1664525U + 1013904223U;
      bytes += static_cast<char>(state >> 24U);
    }
    all.push_back(std::move(bytes));
  }
  return all;
}

}  // namespace

Target terrain_target() {
  return {"terrain", run, seeds};
}

}  // namespace thalweg::fuzz
