#pragma once

/// Labels that some optimum does without, and the pieces that remain.

#include "optimize/label_network.hpp"

#include <thalweg/base/progress.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace thalweg {

/// For each label 1 if it stays; some optimum has only labels that stay, and each variable keeps one.
/// Dead-end elimination: a label goes if another one of its variable is never worse, whatever the labels of
/// the neighbours that stay. Complexity: near-linear for few labels a variable; runs on all threads. The
/// result does not depend on the number of threads.
template <std::size_t Criteria>
std::vector<std::uint8_t> find_useful_labels(const LabelNetwork<Criteria>& network, const Progress& progress);

/// A part of a network that shares no term with what else is open.
template <std::size_t Criteria>
struct LabelPiece {
  LabelNetwork<Criteria> network;
  std::vector<std::uint32_t> variable;  ///< for each variable the one of the whole
  std::vector<std::uint32_t>
      label;  ///< for each label the one of the whole, counted from its variable's first
};

/// Variables of which more than one label stays, in connected parts; labels of the others and terms that do
/// not couple are in the unary costs. Parts and their variables ascend.
template <std::size_t Criteria>
std::vector<LabelPiece<Criteria>> split(const LabelNetwork<Criteria>& network,
                                        std::span<const std::uint8_t> stays);

}  // namespace thalweg
