#pragma once

/// THALWEG_ASSERT: a law of our own code; on in dev and sanitizer builds, never reachable from input.

#ifdef THALWEG_ASSERTIONS
namespace thalweg {
[[noreturn]] void assertion_failed(const char* expression, const char* file, int line);
}
#define THALWEG_ASSERT(expression) \
  ((expression) ? static_cast<void>(0) : ::thalweg::assertion_failed(#expression, __FILE__, __LINE__))
#else
#define THALWEG_ASSERT(expression) static_cast<void>(0)
#endif
