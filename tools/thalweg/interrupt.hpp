#pragma once

/// SIGINT and SIGTERM: the work stops within a second and leaves nothing behind.

#include <thalweg/base/progress.hpp>

namespace thalweg::cli {

constexpr int kInterrupted = 130;

/// From now on a signal cancels the progress that is watched. Work that has not ended half a second later,
/// because it is in a place that does not ask (a library's), is ended with the process: temporary outputs are
/// removed, the same error line is printed, the status is kInterrupted.
/// Pre: called once, before other threads are started, so that they inherit the blocked signals.
void watch_signals();

/// Pre: `progress` lives until the process ends.
void cancel_on_signal(Progress& progress);

/// Before the process says that it was cancelled: does not return where it is being ended already.
void claim_interruption();

}  // namespace thalweg::cli
