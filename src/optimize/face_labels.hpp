#pragma once

/// The triangulations of one face that the rest of the problem has to choose from.

#include "optimize/face_model.hpp"

#include <thalweg/order/face_fronts.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace thalweg {

template <std::size_t Criteria>
struct FaceLabels {
  FaceTriangulations triangulations;  ///< by label
  std::vector<Cost<Criteria>> unary;  ///< by label
  std::vector<std::uint32_t> side;    ///< sides beyond which there is another face, ascending
  /// For each of these, for each label: which of the side's candidates it has.
  std::vector<std::uint16_t> at_side;
  std::vector<PlateauLink> link;    ///< what free edges of the face join, ascending
  std::vector<std::uint8_t> joins;  ///< for each of these, for each label: 1 if it does
  /// Whether, whatever is chosen in other faces, one of the labels costs no more than any triangulation of
  /// the face.
  bool complete = true;
  bool relaxed = false;  ///< one label that stands for all triangulations; none is listed

  /// By label: the candidate that it has at one of the sides.
  [[nodiscard]] std::span<const std::uint16_t> places(std::size_t at) const {
    return std::span(at_side).subspan(at * unary.size(), unary.size());
  }
  [[nodiscard]] bool has_link(std::size_t at, std::size_t label) const {
    return joins[at * unary.size() + label] != 0;
  }
};

struct LabelLimits {
  std::size_t most_comparisons = 0;
  std::size_t few_labels = 1;  ///< kept at each front once all comparisons are spent
};

/// Labels faces one by one: memory is reused from face to face.
template <std::size_t Criteria>
class FaceLabeller {
 public:
  FaceLabeller();
  ~FaceLabeller();
  FaceLabeller(const FaceLabeller&) = delete;
  FaceLabeller& operator=(const FaceLabeller&) = delete;

  /// The triangulations that may be best for something that is chosen in other faces, found without listing
  /// the others. Where the limits leave some out, the labels are not complete.
  /// Pre: the graph is of the face and has an empty front. Complexity: for each front what comes to it times
  /// what is kept there.
  FaceLabels<Criteria> label(const FaceModel<Criteria>& model, const FrontGraph& graph,
                             const LabelLimits& limits);

 private:
  class Program;
  std::unique_ptr<Program> program_;
};

/// Adds labels of the same face. Pre: both are of one model.
template <std::size_t Criteria>
void add_labels(const FaceLabels<Criteria>& more, FaceLabels<Criteria>& labels);

/// Notes which candidates at sides of faces no label need have. Complexity: linear in labels and sides.
template <std::size_t Criteria>
void note_possible(const FaceSides& sides, const std::vector<FaceLabels<Criteria>>& faces,
                   SideWeights<Criteria>& weights);

/// One label in the place of all triangulations of a face: it costs no more than any of them under any labels
/// of the neighbours. At each side it has a class of its own, after the candidates (LabelNetwork couples it
/// at the least cost), and it joins what any candidate edge of the face joins. `size`: triangles of a
/// triangulation. Complexity: pairs of candidates at the face's edges, and its fronts or pairs of edges that
/// cross.
template <std::size_t Criteria>
FaceLabels<Criteria> relax_face(const FaceModel<Criteria>& model, std::uint32_t size);

}  // namespace thalweg
