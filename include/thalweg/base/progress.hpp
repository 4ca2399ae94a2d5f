#pragma once

/// Progress and cancel of long work.

#include <atomic>
#include <functional>
#include <string>

namespace thalweg {

/// Where long work reports how far it is and learns that it shall stop.
/// Thread-safe to cancel and to check; reporting is for the thread that leads the work.
class Progress {
 public:
  /// Called with the phase's name and the fraction done in it, 0 to 1.
  using Report = std::function<void(const std::string& phase, double fraction)>;

  Progress() = default;
  explicit Progress(Report report) : report_(std::move(report)) {}

  /// Starts a phase; its fraction is 0.
  void start_phase(const std::string& name);
  /// Sets the fraction of the phase, and stops the work if that was asked for.
  /// Throws: Error{Cancelled}.
  void advance(double fraction);
  /// Throws: Error{Cancelled} if the work shall stop. Cheap: call it every few thousand steps.
  void check() const;
  /// Asks the work to stop; safe from any thread and from a signal handler.
  void cancel() noexcept { cancelled_.store(true, std::memory_order_relaxed); }
  [[nodiscard]] bool cancelled() const noexcept { return cancelled_.load(std::memory_order_relaxed); }

 private:
  Report report_;
  std::string phase_;
  double reported_ = -1;
  std::atomic<bool> cancelled_{false};
};

}  // namespace thalweg
