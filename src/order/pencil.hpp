#pragma once

/// The circles through two vertices: which vertices lie inside them, where nothing blocks.

#include <thalweg/mesh/tin.hpp>

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace thalweg::detail {

/// For an edge the nearest vertices on either side; memory is reused from edge to edge.
class Pencil {
 public:
  /// A vertex strictly left of the line from one vertex to another.
  struct Beside {
    VertexId vertex;
    double cotangent = 0;  ///< of the angle at which it sees the edge: the less, the nearer
    double error = 0;      ///< of that at most; may be infinite
  };

  /// Pre: the ground is the Delaunay triangulation of its vertices. Outlives this.
  Pencil(const Tin& ground, std::size_t most) : ground_(&ground), most_(most) {}

  /// Looks at another edge. False, and the lists say nothing, if it is one of the ground, or of no use at
  /// order `most`: a vertex lies on it, or its triangle with the nearest vertex of some side has more
  /// vertices in its circle.
  bool look_at(VertexId u, VertexId v);

  /// The `most` + 1 nearest vertices left of u to v: of these each is inside the circle through u, v and any
  /// that follows. If there are fewer, all.
  [[nodiscard]] std::span<const Beside> left() const { return left_.nearest; }
  /// The same on the right.
  [[nodiscard]] std::span<const Beside> right() const { return right_.nearest; }

  /// Vertices inside the circle through u, v and one of the list `side`; none if more than `most`.
  [[nodiscard]] std::optional<std::size_t> order(std::span<const Beside> side, std::size_t place) const;
  /// Whether that triangle has no other vertex in it or on it. Pre: look_at has said yes.
  [[nodiscard]] bool is_empty(std::span<const Beside> side, std::size_t place) const;

  /// False only if the known vertices alone tell that look_at(a, b) would say no. Complexity: linear in them.
  [[nodiscard]] bool may_be_of_use(VertexId a, VertexId b, std::span<const VertexId> known);

 private:
  /// Relative to the edge.
  struct Position {
    double along = 0;   ///< product of the vectors to it from both ends
    double across = 0;  ///< cross product of the edge and the vector from its start
    double error = 0;   ///< of either at most
  };
  /// What lies left of the edge, or of its reverse.
  struct Side {
    Point2 from, to;
    std::vector<Beside> nearest;  ///< so far; the first ones, up to the next to settle, are those of all
    std::size_t settled = 0;      ///< of these: their neighbours were met
    void start(Point2 at_from, Point2 at_to) {
      from = at_from;
      to = at_to;
      nearest.clear();
      settled = 0;
    }
  };

  bool pass(VertexId u, VertexId v);
  [[nodiscard]] bool few_inside(Side& side, const Beside& corner);
  void complete(Side& side);
  template <class Stop>
  bool settle(Side& side, const Stop& stop);
  bool meet(VertexId x, Side& side) const;
  bool insert(const Beside& fresh, Side& side) const;
  [[nodiscard]] std::optional<Beside> beside(const Side& side, VertexId x) const;
  [[nodiscard]] Position position(Point2 from, Point2 to, VertexId x) const;
  [[nodiscard]] bool nearer(const Side& side, const Beside& one, const Beside& other) const;
  [[nodiscard]] bool inside(Point2 from, Point2 to, const Beside& corner, const Beside& x) const;
  [[nodiscard]] bool is_left(std::span<const Beside> side) const {
    return side.data() == left_.nearest.data();
  }

  const Tin* ground_;
  std::size_t most_;
  VertexId u_, v_;
  Side left_, right_;
  std::vector<double> known_left_, known_right_;  ///< cotangents at most
};

}  // namespace thalweg::detail
