#pragma once

/// The file of a proof: whose it is, the stages that the optimiser writes, its end.

#include <thalweg/mesh/tin.hpp>
#include <thalweg/order/quadrilaterals.hpp>
#include <thalweg/pipeline/build.hpp>

#include <fstream>
#include <span>
#include <string>

namespace thalweg {

/// What a proof is of. The lines are those of thalweg/verify/proof.hpp.
struct ProofSubject {
  const Tin& delaunay;
  std::span<const Point2> written;   ///< empty: the plane's own
  std::span<const VertexId> number;  ///< by vertex its id in the outputs; empty: the same
  std::span<const Quadrilateral> quadrilaterals;
  const LabellingConfig& labelling;
};

class ProofFile {
 public:
  /// `path` is written, `target` named in errors.
  ProofFile(const std::string& path, std::string target, const ProofSubject& subject);
  [[nodiscard]] std::ostream& stages() { return file_; }
  /// Throws: Error{WriteFailed}.
  void finish();

 private:
  std::ofstream file_;
  std::string target_;
};

}  // namespace thalweg
