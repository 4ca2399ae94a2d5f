#pragma once

/// The eight constrained orders of a triangle, by brute force straight from their definitions.
///
/// Source: Silveira, van Kreveld, Towards a Definition of Higher Order Constrained Delaunay Triangulations,
/// section 2, with its ties and sights made precise as in `exact.hpp` and `scene.hpp`.

#include <support/oracle/scene.hpp>

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace thalweg::oracle {

/// Strongest first; the names are those of the command line.
enum class Definition : std::uint8_t {
  Std,
  Pathcon,
  SeesTriang,
  SeesVtx,
  ConfEdge,
  SeesOpp,
  Sees3Vtx,
  EmptyQuad
};
inline constexpr std::size_t kDefinitionCount = 8;
inline constexpr std::array<Definition, kDefinitionCount> kDefinitions{
    Definition::Std,      Definition::Pathcon, Definition::SeesTriang, Definition::SeesVtx,
    Definition::ConfEdge, Definition::SeesOpp, Definition::Sees3Vtx,   Definition::EmptyQuad};
std::string_view name_of(Definition definition);

/// Why a triangle has no order.
enum class Validity : std::uint8_t {
  Valid,
  Flat,      ///< its corners are collinear
  Occupied,  ///< another site lies in the closed triangle
  Crossed,   ///< a side is no constraint edge and meets one
  OffGround  ///< polygon mode: the triangle does not lie in the ground
};

/// A set of sites, bit v for site v.
using SiteSet = std::uint32_t;
using Orders = std::array<int, kDefinitionCount>;

/// Answers for one scene; sights are tabulated once. Pre: defect(scene) is empty.
class Oracle {
 public:
  explicit Oracle(Scene scene);

  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] bool sees(int p, int q) const {
    return (sights_[static_cast<std::size_t>(p)] >> q & 1U) != 0;
  }
  [[nodiscard]] Validity validity(Corners t) const;
  /// Every valid triangle, counter-clockwise, lowest index first, sorted.
  [[nodiscard]] std::vector<Corners> valid_triangles() const;

  // Pre (all below): validity(t) is Valid.
  /// The sites that count in the order of t.
  [[nodiscard]] SiteSet counted(Corners t, Definition definition) const;
  [[nodiscard]] std::array<SiteSet, kDefinitionCount> counted(Corners t) const;
  [[nodiscard]] int order(Corners t, Definition definition) const;
  [[nodiscard]] Orders orders(Corners t) const;

 private:
  struct Place;
  [[nodiscard]] SiteSet members(Corners t) const;
  [[nodiscard]] bool counts(const Place& place, Definition definition) const;
  [[nodiscard]] bool sees_side(const Place& place) const;
  [[nodiscard]] bool has_conflicting_edge(const Place& place) const;
  [[nodiscard]] bool spans_empty_triangle(const Place& place) const;

  Scene scene_;
  std::vector<SiteSet> sights_;
};

}  // namespace thalweg::oracle
