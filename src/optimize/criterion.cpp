// The one place where a criterion is declared: its name in the enumeration, and here its term and its line in
// the table. Solver, option, report and proof follow from what it couples and how its values combine.
//
// Lengths, areas and angles between edges are measured in the plane of triangulation, in metres; normals in
// space, with heights in metres. A term is a plain function of geometry that depends neither on ids nor on
// the order of corners, and uses only operations that IEEE 754 rounds correctly.
#include "optimize/declaration.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/geometry/predicates.hpp>
#include <thalweg/geometry/slope.hpp>
#include <thalweg/optimize/criterion.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace thalweg {

namespace {

double angle_squared(double radians) {
  return radians * radians;
}

/// The corner of `right` that is none of `left`.
const Corner& apex_across(const Face& left, const Face& right) {
  return *std::find_if(right.corner.begin(), right.corner.end(), [&](const Corner& corner) {
    return std::find(left.corner.begin(), left.corner.end(), corner) == left.corner.end();
  });
}

/// Length of an interior edge in the plane, in metres: the sum is what a minimum-weight triangulation
/// minimises.
double edge_length(const Face& left, const Face& right, Scale scale) {
  const Corner& apex = apex_across(right, left);
  const auto i = static_cast<std::size_t>(&apex - left.corner.data());
  const Point2 a = left.corner[(i + 1) % 3].at, b = left.corner[(i + 2) % 3].at;
  const double x = (b.x - a.x) * scale.horizontal, y = (b.y - a.y) * scale.horizontal;
  return std::sqrt(x * x + y * y);
}

/// Larger area of the two triangles at an edge, divided by the smaller; at most 2^20. Van Kreveld, Loeffler,
/// Silveira 2010: a triangulation whose neighbours differ little in size.
double area_ratio(const Face& left, const Face& right, Scale /*scale*/) {
  const double a = left.normal.z, b = right.normal.z;
  constexpr double kMost = 0x1p20;
  const double larger = std::max(a, b), smaller = std::min(a, b);
  return larger < kMost * smaller ? larger / smaller : kMost;
}

/// 1 if the surface is strictly convex at the edge: the apex of one triangle lies strictly below the plane of
/// the other (both ways say the same). Decided exactly, on the coordinates as they are.
double convex_edge(const Face& left, const Face& right, Scale /*scale*/) {
  const Corner& d = apex_across(left, right);
  const auto& [a, b, c] = left.corner;
  return side_of_plane(a.at, b.at, c.at, d.at, {a.height, b.height, c.height, d.height}) < 0 ? 1 : 0;
}

/// 1 if the three heights are equal: what contour lines leave between their bends.
double flat_triangle(const Face& face, Scale /*scale*/) {
  const auto& [a, b, c] = face.corner;
  return a.height == b.height && b.height == c.height ? 1 : 0;
}

constexpr double kDegreesPerRadian = 0x1.ca5dc1a63c1f8p+5;

double angle_in_degrees(double radians) {
  return radians * kDegreesPerRadian;
}

/// Area of a triangle in the plane. In units of 1024 square metres, so that the largest that can be told is
/// above 10^6 square kilometres, and the smallest difference a quarter of a square millimetre.
constexpr double kAreaUnit = 1024;
double area(const Face& face, Scale /*scale*/) {
  return face.normal.z / 2 / kAreaUnit;
}

/// Angles of a triangle in the plane at its three corners, in degrees.
std::array<double, 3> angles_of(const Face& face, Scale scale) {
  std::array<double, 3> angles{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Point2 at = face.corner[i].at, p = face.corner[(i + 1) % 3].at, q = face.corner[(i + 2) % 3].at;
    const double px = (p.x - at.x) * scale.horizontal, py = (p.y - at.y) * scale.horizontal;
    const double qx = (q.x - at.x) * scale.horizontal, qy = (q.y - at.y) * scale.horizontal;
    angles[i] = angle_between({px, py, 0}, {qx, qy, 0}) * kDegreesPerRadian;
  }
  return angles;
}

double largest_angle(const Face& face, Scale scale) {
  const std::array<double, 3> angles = angles_of(face, scale);
  return *std::max_element(angles.begin(), angles.end());
}

double smallest_angle(const Face& face, Scale scale) {
  const std::array<double, 3> angles = angles_of(face, scale);
  return *std::min_element(angles.begin(), angles.end());
}

/// Sum of squares of the vertical distances, in metres, between the triangle and the reference's points that
/// it owns (reference.hpp): each point on the surface counts once.
double vertical_squares(const Face& face, Scale scale, const Reference& reference) {
  const auto& [a, b, c] = face.corner;
  return reference.squares({a.at, b.at, c.at}, {a.height, b.height, c.height}) * scale.vertical *
         scale.vertical;
}

/// 1 if all edges at an interior vertex are strictly convex. Van Kreveld, Loeffler, Silveira 2010, where
/// edges are convex or reflex; one at which the surface is flat is neither.
std::int64_t convex_vertex(const Star& star) {
  return !star.on_rim && !star.reflex && !star.flat ? 1 : 0;
}

/// 1 if an interior vertex has both a strictly convex and a strictly reflex edge. Same source.
std::int64_t mixed_vertex(const Star& star) {
  return !star.on_rim && star.convex && star.reflex ? 1 : 0;
}

/// Number of edges at a vertex, on the rim too. Same source. Their sum is twice the number of edges.
std::int64_t degree(const Star& star) {
  return star.edges;
}

/// Whether an edge at the vertex is drawn as a valley.
bool on_valley(const Tin& tin, VertexId v) {
  const std::span<const HalfedgeId> outgoing = tin.outgoing(v);
  return std::any_of(outgoing.begin(), outgoing.end(), [&](HalfedgeId h) {
    return has(tin.kind(h), EdgeKind::Valley) || has(tin.kind(Tin::previous(h)), EdgeKind::Valley);
  });
}

/// 1 if all three corners are on drawn valleys: water short-circuits the channel there, or meets a dam.
double valley_triangle(const Face& face, const Tin& tin) {
  const auto& corner = face.corner;
  return std::all_of(corner.begin(), corner.end(), [&](const Corner& c) { return on_valley(tin, c.vertex); })
             ? 1
             : 0;
}

/// Length in the plane, in metres, of an edge that is drawn as a valley and is a valley edge of the surface:
/// not level, and both triangles drain into it, at least one of them not just along it. Decided exactly.
double draining_valley(const Face& left, const Face& right, Scale scale, const Tin& tin) {
  const Corner &l = apex_across(right, left), &r = apex_across(left, right);
  const auto i = static_cast<std::size_t>(&l - left.corner.data());
  const Corner &a = left.corner[(i + 1) % 3], &b = left.corner[(i + 2) % 3];
  if (a.height == b.height) return 0;
  HalfedgeId h = tin.find_halfedge(a.vertex, b.vertex);
  if (!h.valid()) h = tin.find_halfedge(b.vertex, a.vertex);
  if (!h.valid() || !has(tin.kind(h), EdgeKind::Valley)) return 0;
  const auto fall = [&](const Corner& apex) {
    return fall_across(a.at, a.height, b.at, b.height, apex.at, apex.height);
  };
  return makes_valley(fall(l), fall(r)) ? edge_length(left, right, scale) : 0;
}

constexpr auto kMinimise = Direction::Minimise;
constexpr auto kMaximise = Direction::Maximise;

constexpr std::array kDeclarations = {
    // Interior pits as find_pits counts them: maximal connected sets of vertices of equal height without a
    // lower neighbour, off the boundary, and no lake. De Kok, van Kreveld, Loeffler 2007.
    Declaration{
        {Criterion::LocalMinima, "local-minima", "count", kMinimise, Coupling::Plateau, Combination::Count}},
    // Its sum and its largest value are measures of smoothness in van Kreveld, Loeffler, Silveira,
    // Optimization for first order Delaunay triangulations, 2010.
    Declaration{.traits = {Criterion::NormalAngleSum, "normal-angle-sum", "radians", kMinimise,
                           Coupling::Edge, Combination::Sum},
                .of_angle = the_angle},
    Declaration{.traits = {Criterion::NormalAngleSquares, "normal-angle-squares", "radians^2", kMinimise,
                           Coupling::Edge, Combination::Sum},
                .of_angle = angle_squared},
    Declaration{{Criterion::EdgeLength, "edge-length", "metres", kMinimise, Coupling::Edge, Combination::Sum},
                nullptr,
                edge_length},
    Declaration{
        {Criterion::AreaRatioSum, "area-ratio-sum", "ratio", kMinimise, Coupling::Edge, Combination::Sum},
        nullptr,
        area_ratio},
    Declaration{
        {Criterion::ConvexEdges, "convex-edges", "count", kMaximise, Coupling::Edge, Combination::Count},
        nullptr,
        convex_edge},
    Declaration{{Criterion::FlatTriangles, "flat-triangles", "count", kMinimise, Coupling::OneTriangle,
                 Combination::Count},
                flat_triangle},
    Declaration{.traits = {Criterion::NormalAngleMax, "normal-angle-max", "degrees", kMinimise,
                           Coupling::Edge, Combination::Max},
                .of_angle = angle_in_degrees},
    Declaration{
        {Criterion::AreaRatioMax, "area-ratio-max", "ratio", kMinimise, Coupling::Edge, Combination::Max},
        nullptr,
        area_ratio},
    Declaration{{Criterion::MaxArea, "max-area", "square metres", kMinimise, Coupling::OneTriangle,
                 Combination::Max, kAreaUnit},
                area},
    // Bern, Eppstein, Mesh generation and optimal triangulation, 1992: the min-max angle and the max-min
    // angle triangulation.
    Declaration{
        {Criterion::MaxAngle, "max-angle", "degrees", kMinimise, Coupling::OneTriangle, Combination::Max},
        largest_angle},
    Declaration{
        {Criterion::MinAngle, "min-angle", "degrees", kMaximise, Coupling::OneTriangle, Combination::Min},
        smallest_angle},
    Declaration{{Criterion::VerticalError, "vertical-error", "square metres", kMinimise,
                 Coupling::OneTriangle, Combination::Sum},
                nullptr,
                nullptr,
                vertical_squares},
    Declaration{{Criterion::ConvexVertices, "convex-vertices", "count", kMaximise, Coupling::VertexStar,
                 Combination::Count},
                nullptr,
                nullptr,
                nullptr,
                convex_vertex},
    Declaration{{Criterion::MixedVertices, "mixed-vertices", "count", kMinimise, Coupling::VertexStar,
                 Combination::Count},
                nullptr,
                nullptr,
                nullptr,
                mixed_vertex},
    Declaration{
        {Criterion::MaxDegree, "max-degree", "edges", kMinimise, Coupling::VertexStar, Combination::Max},
        nullptr,
        nullptr,
        nullptr,
        degree,
        true},
    // The depth of every interior pit, summed: from its bottom up to the lowest height at which it is joined,
    // along edges, to a lower bottom, to the rim or to a lake (of bottoms of equal height, one counts as the
    // lower). On a TIN ways along edges have the lowest highest points of all ways on the surface, so that is
    // where the pit spills. Equal to the sum of persistences in Edelsbrunner, Letscher, Zomorodian,
    // Topological persistence and simplification, 2002, and to the weight of a minimum spanning tree of the
    // edges, each at its higher end, less all heights. Where it is least, so is the water on every vertex
    // when all pits are full, and its volume, whatever ground each vertex stands for (spills.cpp).
    Declaration{{Criterion::PitDepth, "pit-depth", "metres", kMinimise, Coupling::Plateau, Combination::Sum}},
    // Watershed-workflow and others repair these by hand.
    Declaration{.traits = {Criterion::ValleyTriangles, "valley-triangles", "count", kMinimise,
                           Coupling::OneTriangle, Combination::Count},
                .drawn_triangle = valley_triangle},
    Declaration{.traits = {Criterion::DrainingValleys, "draining-valleys", "metres", kMaximise,
                           Coupling::Edge, Combination::Sum},
                .drawn_edge = draining_valley},
};

constexpr auto kTraits = [] {
  std::array<CriterionTraits, kDeclarations.size()> traits{};
  for (std::size_t i = 0; i < traits.size(); ++i) traits[i] = kDeclarations[i].traits;
  return traits;
}();
static_assert([] {
  for (std::size_t i = 0; i < kTraits.size(); ++i) {
    if (static_cast<std::size_t>(kTraits[i].criterion) != i) return false;
  }
  return true;
}());

std::string criterion_names() {
  std::string names;
  for (const CriterionTraits& traits : kTraits) {
    names += (names.empty() ? "" : ", ") + std::string(traits.name);
  }
  return names;
}

std::string shortest(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

}  // namespace

double steps_per_unit(const Objective& objective) {
  const double sign = objective.direction() == Direction::Maximise ? -1 : 1;
  return sign * kStepsPerUnit /
         (objective.is_weighted ? 1 : traits_of(objective.parts.front().criterion).term_unit);
}

void refuse_term() {
  throw Error(
      ErrorCode::SizeLimit,
      "a term of a criterion is too large to be added exactly; are heights and units right? Split the "
      "area, or give a criterion that is a sum a small weight, such as 0.001*vertical-error");
}

std::span<const CriterionTraits> all_criteria() {
  return kTraits;
}

const CriterionTraits& traits_of(Criterion criterion) {
  return kTraits[static_cast<std::size_t>(criterion)];
}

const Declaration& declaration_of(Criterion criterion) {
  return kDeclarations[static_cast<std::size_t>(criterion)];
}

std::optional<Criterion> find_criterion(std::string_view name) {
  for (const CriterionTraits& traits : kTraits) {
    if (traits.name == name) return traits.criterion;
  }
  return std::nullopt;
}

bool Objective::is_extreme() const {
  const Combination combination = traits_of(parts.front().criterion).combination;
  return !is_weighted && (combination == Combination::Max || combination == Combination::Min);
}

bool Objective::needs_reference() const {
  return std::any_of(parts.begin(), parts.end(), [](const Part& part) {
    return declaration_of(part.criterion).against_reference != nullptr;
  });
}

Objective::Objective(std::vector<Part> weighted) : parts(std::move(weighted)), is_weighted(true) {
  if (parts.empty()) throw Error(ErrorCode::Usage, "an objective has no part; give it a criterion");
}

bool Objective::is_of_pits() const {
  return traits_of(parts.front().criterion).coupling == Coupling::Plateau;
}

std::string Objective::name() const {
  if (!is_weighted) return std::string(traits_of(parts.front().criterion).name);
  std::string text;
  for (const Part& part : parts) {
    if (!text.empty() && part.weight >= 0) text += '+';
    text += shortest(part.weight) + '*' + std::string(traits_of(part.criterion).name);
  }
  return text;
}

std::string_view Objective::unit() const {
  return is_weighted ? "weighted" : traits_of(parts.front().criterion).unit;
}

Direction Objective::direction() const {
  return is_weighted ? Direction::Minimise : traits_of(parts.front().criterion).direction;
}

namespace {

/// Weight and name of one part, which may start with a sign.
Objective::Part parse_part(std::string_view part, std::string_view whole) {
  const auto fail = [&](const std::string& why) {
    return Error(ErrorCode::Usage, "criterion '" + std::string(whole) + "': " + why);
  };
  double weight = 1, sign = 1;
  if (part.starts_with('+') || part.starts_with('-')) {
    sign = part.front() == '-' ? -1 : 1;
    part.remove_prefix(1);
  }
  if (const std::size_t star = part.find('*'); star != std::string_view::npos) {
    const auto [end, error] = std::from_chars(part.data(), part.data() + star, weight);
    if (error != std::errc() || end != part.data() + star || !std::isfinite(weight) || weight == 0) {
      throw fail("'" + std::string(part.substr(0, star)) + "' is no weight; give a number other than 0");
    }
    part.remove_prefix(star + 1);
  }
  const auto criterion = find_criterion(part);
  if (!criterion) throw fail("'" + std::string(part) + "' is no criterion; there are " + criterion_names());
  return {*criterion, sign * weight};
}

/// Where the next part starts: at a sign before a name or a number, none of which holds a sign but after a
/// letter or in an exponent.
std::size_t end_of_part(std::string_view text) {
  for (std::size_t i = 1; i < text.size(); ++i) {
    if (text[i] != '+' && text[i] != '-') continue;
    const bool in_exponent = i > 1 && (text[i - 1] == 'e' || text[i - 1] == 'E') &&
                             ((text[i - 2] >= '0' && text[i - 2] <= '9') || text[i - 2] == '.');
    if (in_exponent) continue;
    if (text[i] == '+') return i;
    const std::string_view before = text.substr(0, i);
    const std::size_t name = before.find_last_of("*+") == std::string_view::npos
                                 ? before.find_first_not_of("+-")
                                 : before.find_last_of("*+") + 1;
    if (name < i && find_criterion(before.substr(name))) return i;
  }
  return text.size();
}

}  // namespace

Objective parse_objective(std::string_view text) {
  if (const auto criterion = find_criterion(text)) return *criterion;
  std::vector<Objective::Part> parts;
  for (std::string_view rest = text; parts.empty() || !rest.empty();) {
    const std::size_t end = end_of_part(rest);
    parts.push_back(parse_part(rest.substr(0, end), text));
    rest.remove_prefix(end);
    const CriterionTraits& traits = traits_of(parts.back().criterion);
    const bool is_sum = traits.combination == Combination::Sum || traits.combination == Combination::Count;
    if (!is_sum || traits.coupling == Coupling::Plateau) {
      throw Error(ErrorCode::Usage, "criterion '" + std::string(text) + "': " + std::string(traits.name) +
                                        " is no sum of terms, and cannot be weighted; give it a priority of "
                                        "its own");
    }
    const auto same = [&](const Objective::Part& p) { return p.criterion == traits.criterion; };
    if (std::count_if(parts.begin(), parts.end(), same) > 1) {
      throw Error(ErrorCode::Usage,
                  "criterion '" + std::string(text) + "' names " + std::string(traits.name) + " twice");
    }
  }
  return Objective(std::move(parts));
}

}  // namespace thalweg
