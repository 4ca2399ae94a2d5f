// Lakes.
//
// 1. Each triangle belongs to a set of lakes, found by a flood from the rim: whoever crosses a piece of a
//    lake's ring enters or leaves that lake. Rings are closed walks, so the way does not matter. Sets are
//    numbered; there are few.
// 2. Lakes with a vertex in common are united: water there has one level.
// 3. The level of a body of water is the lowest height that its rings were given, else the lowest height
//    along its shore. Every corner of its triangles gets it.
#include "lakes.hpp"

#include "base/union_find.hpp"
#include "provenance.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

namespace thalweg {

namespace {

constexpr std::uint32_t kNone = 0xffffffffU;

/// A piece of a ring, by vertices of the TIN.
struct ShoreEdge {
  std::uint32_t low = 0;
  std::uint32_t high = 0;
  std::uint32_t lake = 0;
  [[nodiscard]] auto key() const { return std::tie(low, high, lake); }
};

bool is_lake(const SurveyLine& line) {
  return has(line.kind, EdgeKind::Lake);
}

// Numbers sets of lakes.
class LakeSets {
 public:
  LakeSets() : sets_(1) { numbers_.emplace(sets_.front(), 0); }
  [[nodiscard]] std::span<const std::uint32_t> of(std::uint32_t number) const { return sets_[number]; }
  std::uint32_t toggled(std::uint32_t number, std::span<const ShoreEdge> edges) {
    std::vector<std::uint32_t> set = sets_[number];
    for (const ShoreEdge& edge : edges) {
      const auto place = std::lower_bound(set.begin(), set.end(), edge.lake);
      if (place != set.end() && *place == edge.lake) {
        set.erase(place);
      } else {
        set.insert(place, edge.lake);
      }
    }
    const auto [found, fresh] = numbers_.emplace(std::move(set), static_cast<std::uint32_t>(sets_.size()));
    if (fresh) sets_.push_back(found->first);
    return found->second;
  }

 private:
  std::vector<std::vector<std::uint32_t>> sets_;
  std::map<std::vector<std::uint32_t>, std::uint32_t> numbers_;
};

class Leveller {
 public:
  Leveller(const Survey& survey, const Drawing& drawing, const Tin& tin,
           std::span<const std::uint32_t> now_of)
      : survey_(survey),
        drawing_(drawing),
        tin_(tin),
        now_of_(now_of),
        lake_of_line_(survey.lines.size(), kNone) {
    std::map<std::pair<std::uint32_t, std::int64_t>, std::uint32_t> numbers;
    for (std::size_t l = 0; l < survey.lines.size(); ++l) {
      const SurveyLine& line = survey.lines[l];
      if (!is_lake(line)) continue;
      lake_of_line_[l] =
          numbers.emplace(std::pair(line.source, line.feature), static_cast<std::uint32_t>(numbers.size()))
              .first->second;
    }
    bodies_ = UnionFind(numbers.size());
    lake_count_ = numbers.size();
  }

  LevelledLakes run(const Progress& progress) {
    find_shore();
    flood(progress);
    unite();
    find_levels();
    return levelled();
  }

 private:
  void find_shore();
  [[nodiscard]] std::span<const ShoreEdge> shore_at(HalfedgeId h) const;
  void flood(const Progress& progress);
  void unite();
  void find_levels();
  LevelledLakes levelled();
  void report_levels(LevelledLakes& result);

  const Survey& survey_;
  const Drawing& drawing_;
  const Tin& tin_;
  std::span<const std::uint32_t> now_of_;
  std::vector<std::uint32_t> lake_of_line_;
  std::size_t lake_count_ = 0;
  UnionFind bodies_{0};
  std::vector<ShoreEdge> shore_;  ///< sorted; pieces that are drawn twice by one lake cancel out
  LakeSets sets_;
  std::vector<std::uint32_t> set_of_triangle_;
  std::vector<std::uint32_t> lake_of_vertex_;  ///< one of its lakes, or kNone
  std::vector<double> level_;                  ///< of each body's representative
};

void Leveller::find_shore() {
  for (std::size_t s = 0; s < drawing_.pieces.size(); ++s) {
    const std::uint32_t lake = lake_of_line_[drawing_.pieces[s].line];
    if (lake == kNone) continue;
    const auto chain = drawing_.noding.chain(s);
    for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
      const auto [low, high] = std::minmax(now_of_[chain[i]], now_of_[chain[i + 1]]);
      shore_.push_back({low, high, lake});
    }
  }
  std::sort(shore_.begin(), shore_.end(), [](const auto& p, const auto& q) { return p.key() < q.key(); });
  std::size_t count = 0;
  for (const ShoreEdge& edge : shore_) {
    if (count > 0 && shore_[count - 1].key() == edge.key()) {
      --count;
    } else {
      shore_[count++] = edge;
    }
  }
  shore_.resize(count);
}

std::span<const ShoreEdge> Leveller::shore_at(HalfedgeId h) const {
  const std::pair<std::uint32_t, std::uint32_t> ends =
      std::minmax(tin_.origin(h).value(), tin_.target(h).value());
  const auto ends_of = [](const ShoreEdge& edge) { return std::pair(edge.low, edge.high); };
  const auto first = std::ranges::lower_bound(shore_, ends, {}, ends_of);
  return {first, std::ranges::upper_bound(first, shore_.end(), ends, {}, ends_of)};
}

// Step 1.
void Leveller::flood(const Progress& progress) {
  constexpr std::size_t kStepsBetweenChecks = 4096;
  set_of_triangle_.assign(tin_.triangle_count(), kNone);
  std::vector<TriangleId> stack;
  const auto reach = [&](TriangleId t, std::uint32_t from, HalfedgeId across) {
    std::uint32_t& set = set_of_triangle_[t.index()];
    if (set != kNone) return;
    set = has(tin_.kind(across), EdgeKind::Lake) ? sets_.toggled(from, shore_at(across)) : from;
    stack.push_back(t);
  };
  for (std::size_t i = 0; i < tin_.halfedge_count(); ++i) {
    if (tin_.on_rim(HalfedgeId{i})) reach(Tin::triangle_of(HalfedgeId{i}), 0, HalfedgeId{i});
  }
  for (std::size_t step = 0; !stack.empty(); ++step) {
    if (step % kStepsBetweenChecks == 0) progress.check();
    const TriangleId t = stack.back();
    stack.pop_back();
    for (std::size_t side = 0; side < 3; ++side) {
      const HalfedgeId h = Tin::halfedge(t, side);
      if (!tin_.on_rim(h)) reach(Tin::triangle_of(tin_.twin(h)), set_of_triangle_[t.index()], h);
    }
  }
}

// Step 2.
void Leveller::unite() {
  lake_of_vertex_.assign(tin_.vertex_count(), kNone);
  for (std::size_t t = 0; t < set_of_triangle_.size(); ++t) {
    for (const std::uint32_t lake : sets_.of(set_of_triangle_[t])) {
      for (const VertexId v : tin_.triangle(TriangleId{t})) {
        std::uint32_t& known = lake_of_vertex_[v.index()];
        if (known == kNone) known = lake;
        bodies_.unite(known, lake);
      }
    }
  }
}

// Step 3.
void Leveller::find_levels() {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<double> given(lake_count_, kInfinity), shore(lake_count_, kInfinity);
  for (std::size_t l = 0; l < survey_.lines.size(); ++l) {
    if (lake_of_line_[l] == kNone) continue;
    double& lowest = given[bodies_.find(lake_of_line_[l])];
    for (const double z : survey_.lines[l].z) lowest = std::min(lowest, z);
  }
  for (const ShoreEdge& edge : shore_) {
    double& lowest = shore[bodies_.find(edge.lake)];
    for (const std::uint32_t v : {edge.low, edge.high}) lowest = std::min(lowest, tin_.heights()[v]);
  }
  level_.resize(lake_count_);
  for (std::size_t i = 0; i < lake_count_; ++i) level_[i] = given[i] < kInfinity ? given[i] : shore[i];
}

LevelledLakes Leveller::levelled() {
  LevelledLakes result;
  result.z.assign(tin_.heights().begin(), tin_.heights().end());
  std::vector<bool> counted(lake_count_, false);
  for (std::size_t v = 0; v < result.z.size(); ++v) {
    if (lake_of_vertex_[v] == kNone) continue;
    const std::uint32_t body = bodies_.find(lake_of_vertex_[v]);
    result.z[v] = level_[body];
    if (!counted[body]) ++result.lakes;
    counted[body] = true;
  }
  report_levels(result);
  std::vector<std::uint32_t> first_point(now_of_.size(), kNone);
  for (std::size_t p = drawing_.vertices.of_point.size(); p-- > 0;) {
    first_point[drawing_.vertices.of_point[p]] = static_cast<std::uint32_t>(p);
  }
  auto passage = drawing_.passages.begin();
  for (std::uint32_t d = 0; d < now_of_.size(); ++d) {
    std::optional<Passage> hard;
    const std::uint32_t point = first_point[d];
    for (; passage != drawing_.passages.end() && passage->vertex == d; ++passage) {
      const SurveyLine& line = survey_.lines[passage->line];
      if (!hard && !line.z.empty() && !is_lake(line)) hard = *passage;
    }
    const std::uint32_t v = now_of_[d];
    if (v == kNone || lake_of_vertex_[v] == kNone || result.z[v] == tin_.heights()[v]) continue;
    if (!hard && point == kNone) continue;
    result.points += hard ? 0 : 1;
    const std::uint32_t lake = lake_of_vertex_[v];
    const auto line = std::find(lake_of_line_.begin(), lake_of_line_.end(), lake) - lake_of_line_.begin();
    std::string source = !hard ? describe_point(survey_, point)
                         : hard->where == Passage::Where::AtVertex
                             ? describe_line_vertex(survey_, hard->line, hard->at)
                             : describe_line_edge(survey_, hard->line, hard->at);
    result.conflict_vertices.push_back(d);
    result.conflicts.push_back({Conflict::Kind::Lake, tin_.points()[v], tin_.heights()[v], result.z[v],
                                result.z[v], std::move(source),
                                describe_line(survey_, static_cast<std::size_t>(line))});
  }
  return result;
}

// A ring that was given another height than the level: told once, at its first such vertex.
void Leveller::report_levels(LevelledLakes& result) {
  for (std::size_t l = 0; l < survey_.lines.size(); ++l) {
    const SurveyLine& line = survey_.lines[l];
    if (lake_of_line_[l] == kNone || line.z.empty()) continue;
    const double level = level_[bodies_.find(lake_of_line_[l])];
    const auto other = std::find_if(line.z.begin(), line.z.end(), [&](double z) { return z != level; });
    if (other == line.z.end()) continue;
    const auto at = static_cast<std::size_t>(other - line.z.begin());
    result.conflict_vertices.push_back(drawing_.vertices.of_line(l, at));
    result.conflicts.push_back({Conflict::Kind::Lake, line.xy[at], *other, level, level,
                                describe_line_vertex(survey_, l, at),
                                "the lowest height of the lake's rings"});
  }
}

}  // namespace

bool has_lakes(const Survey& survey) {
  return std::any_of(survey.lines.begin(), survey.lines.end(), is_lake);
}

LevelledLakes level_lakes(const Survey& survey, const Drawing& drawing, const Tin& hull,
                          std::span<const std::uint32_t> now_of, const Progress& progress) {
  return Leveller(survey, drawing, hull, now_of).run(progress);
}

}  // namespace thalweg
