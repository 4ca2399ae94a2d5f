#pragma once

/// What has to hold of every TIN that was built, whatever it was built from.

#include <thalweg/base/error.hpp>
#include <thalweg/pipeline/build.hpp>

#include <optional>

namespace thalweg::fuzz {

/// Checks the TIN's own laws, and everything that the report claims by the plain code of thalweg/verify.
/// Throws: Finding.
void check_built(const BuiltTin& built, OrderDefinition definition);

/// Runs `work`; the code of the error that it ended with. Throws: Finding for one that is Internal.
std::optional<ErrorCode> error_of(void (*work)(void*), void* context);

template <class Work>
std::optional<ErrorCode> error_of(Work&& work) {
  return error_of([](void* context) { (*static_cast<std::remove_reference_t<Work>*>(context))(); }, &work);
}

}  // namespace thalweg::fuzz
