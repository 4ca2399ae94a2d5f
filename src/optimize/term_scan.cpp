// What of the terms is topology alone: which triangle is in which quadrilateral, who is whose neighbour.
//
// Quadrilateral q offers two triangles for each label: suv and vut, or sut and tvs. A term of an edge is
// decided by no label, by one (on a diagonal, and on a side whose other triangle is free of choice), or by
// two. A side between two quadrilaterals is scanned once, by the lower one.
#include "optimize/term_scan.hpp"

#include <thalweg/base/error.hpp>

#include <algorithm>
#include <array>
#include <numeric>
#include <string>

namespace thalweg {

std::vector<std::uint32_t> quadrilaterals_of_triangles(const Tin& tin,
                                                       std::span<const Quadrilateral> quadrilaterals) {
  std::vector<std::uint32_t> owner(tin.triangle_count(), kNone);
  for (std::size_t q = 0; q < quadrilaterals.size(); ++q) {
    const HalfedgeId diagonal = quadrilaterals[q].diagonal;
    for (const HalfedgeId h : {diagonal, tin.twin(diagonal)}) {
      std::uint32_t& triangle = owner[Tin::triangle_of(h).index()];
      if (triangle != kNone) {
        throw Error(
            ErrorCode::Unsupported,
            "two quadrilaterals share triangle " + std::to_string(Tin::triangle_of(h).value()) +
                ", as can be under sees-3vtx and empty-quad; choose a stronger definition, such as sees-opp");
      }
      triangle = static_cast<std::uint32_t>(q);
    }
  }
  return owner;
}

double TermScan::left_on_rim(const Progress& progress) const {
  return reference_->squares_left_on_rim(faces_.tin, progress) * faces_.scale.vertical *
         faces_.scale.vertical;
}

// Rows are filled without branches where there is room to write all that is across.
TermScan::Rows TermScan::lay_out_rows(const Progress& progress) const {
  Rows rows;
  const std::size_t count = faces_.quadrilaterals.size();
  rows.first.assign(count + 1, 0);
  for_each_block(count, kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t q = begin; q < end; ++q) {
      std::uint32_t neighbours = 0;
      for (const Side& side : sides_of(faces_.tin, faces_.quadrilaterals[q])) {
        neighbours += static_cast<std::uint32_t>(faces_.owner_across(side.inner) != kNone);
      }
      rows.first[q + 1] = neighbours;
    }
  });
  std::partial_sum(rows.first.begin(), rows.first.end(), rows.first.begin());
  rows.neighbour.resize(rows.first.back());
  for_each_block(count, kBlock, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t q = begin; q < end; ++q) {
      std::array<std::uint32_t, 5> row;  // the last is written over
      std::size_t neighbours = 0;
      for (const Side& side : sides_of(faces_.tin, faces_.quadrilaterals[q])) {
        row[neighbours] = faces_.owner_across(side.inner);
        neighbours += static_cast<std::size_t>(row[neighbours] != kNone);
      }
      const bool room = rows.first[q] + 4 <= rows.first[end];
      std::copy_n(row.begin(), room ? 4 : neighbours, rows.neighbour.begin() + rows.first[q]);
    }
  });
  return rows;
}

}  // namespace thalweg
