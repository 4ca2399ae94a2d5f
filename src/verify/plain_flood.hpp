#pragma once

/// Order under pathcon: which vertices a path inside the circle reaches.

#include "verify/plain_mesh.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace thalweg::verify {

class PlainFlood {
 public:
  /// `polygon`: paths may not leave what the mesh covers; else they may, and what the mesh lacks of its
  /// convex hull is ground, too. Pre: the mesh is sound and outlives this object.
  PlainFlood(const PlainMesh& mesh, bool polygon);
  PlainFlood(const PlainFlood&) = delete;
  PlainFlood& operator=(const PlainFlood&) = delete;
  ~PlainFlood() = default;

  /// False if the ground has a shape that is not dealt with: several parts, or holes, where paths may leave
  /// it.
  [[nodiscard]] bool covers_ground() const { return covers_ground_; }
  /// The number of vertices that count for a counter-clockwise, valid triangle, but no more than `most`.
  [[nodiscard]] std::size_t count(const Corners& t, std::size_t most) const;

 private:
  /// A triangle, or what lies outside of one of its sides on the rim.
  struct Face {
    Index triangle;
    Index outside_of = kNone;  ///< the side
    bool operator<(const Face& other) const {
      return triangle != other.triangle ? triangle < other.triangle : outside_of < other.outside_of;
    }
  };
  [[nodiscard]] bool is_convex() const;
  void list_faces();
  [[nodiscard]] Index first_triangle(const Corners& t) const;
  template <class Enter>
  void for_faces_beside(const Corners& t, const Face& face, const Enter& enter) const;
  [[nodiscard]] std::array<Index, 2> ends(Index triangle, Index side) const {
    return {mesh_.triangles[triangle][side], mesh_.triangles[triangle][(side + 1) % 3]};
  }

  PlainMesh filled_;
  const PlainMesh& mesh_;  ///< the given one, or the filled one
  bool polygon_;
  bool covers_ground_;
  std::vector<std::vector<Index>> fans_;   ///< by vertex: its triangles
  std::vector<std::vector<Face>> rim_at_;  ///< by vertex: outsides of rim sides that begin or end there
};

}  // namespace thalweg::verify
