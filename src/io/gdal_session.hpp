#pragma once

/// The edge to GDAL: registration of its drivers, and its messages turned into ours.

#include <thalweg/base/error.hpp>

#include <memory>
#include <string>
#include <vector>

namespace thalweg {

/// Registers GDAL's drivers (once) and collects the messages of this thread while it lives, so that none is
/// printed. Objects nest; they are made and destroyed on one thread, in stack order.
class GdalSession {
 public:
  GdalSession();
  ~GdalSession();
  GdalSession(const GdalSession&) = delete;
  GdalSession& operator=(const GdalSession&) = delete;

  /// True if an error was reported since the last `reset`.
  [[nodiscard]] bool failed() const;
  /// The errors reported since the last `reset`, in GDAL's words, on one line, as " (words)"; empty if there
  /// are none.
  [[nodiscard]] std::string reason() const;
  /// Throws: Error{WriteFailed} with `what` could not be done, GDAL's words, and the `remedy`;
  /// Error{OutOfMemory} if memory is what GDAL lacked.
  [[noreturn]] void fail_to_write(const std::string& what, const char* remedy) const;
  /// Forgets errors; warnings stay.
  void reset();
  /// All warnings so far, each once; forgets them.
  std::vector<std::string> take_warnings();

 private:
  struct Messages;
  std::unique_ptr<Messages> messages_;
};

}  // namespace thalweg
