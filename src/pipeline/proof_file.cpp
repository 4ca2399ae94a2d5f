// Begin and end of a proof.
#include "pipeline/proof_file.hpp"

#include "pipeline/digest.hpp"

#include <thalweg/base/error.hpp>

#include <utility>

namespace thalweg {

ProofFile::ProofFile(const std::string& path, std::string target, const ProofSubject& subject)
    : file_(path, std::ios::binary), target_(std::move(target)) {
  file_ << "thalweg-proof 1\ndigest " << digest_of(subject.delaunay, subject.written) << "\ndefinition "
        << definition_name(subject.labelling.definition) << "\ncriteria ";
  const char* separator = "";
  for (const Objective& objective : subject.labelling.criteria) {
    file_ << std::exchange(separator, ",") << objective.name();
  }
  file_ << "\nquadrilaterals " << subject.quadrilaterals.size() << '\n';
  const auto number = [&](VertexId v) {
    return subject.number.empty() ? v.value() : subject.number[v.index()].value();
  };
  for (const Quadrilateral& q : subject.quadrilaterals) {
    file_ << "q " << number(q.s) << ' ' << number(q.u) << ' ' << number(q.t) << ' ' << number(q.v) << '\n';
  }
}

void ProofFile::finish() {
  file_ << "end\n";
  file_.close();
  if (!file_) throw Error(ErrorCode::WriteFailed, target_ + " could not be written whole; is the disk full?");
}

}  // namespace thalweg
