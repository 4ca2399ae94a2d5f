// Progress: reports in steps of at least one per cent, so that callers may report often.
#include <thalweg/base/error.hpp>
#include <thalweg/base/progress.hpp>

#include <string>

namespace thalweg {

void Progress::start_phase(const std::string& name) {
  phase_ = name;
  reported_ = -1;
  advance(0);
}

void Progress::advance(double fraction) {
  check();
  constexpr double kStep = 0.01;
  if (!report_ || (fraction < reported_ + kStep && fraction < 1)) return;
  reported_ = fraction;
  report_(phase_, fraction);
  check();  // whoever was told may have asked to stop
}

void Progress::check() const {
  if (cancelled()) throw Error(ErrorCode::Cancelled, "stopped on request; nothing was written");
}

}  // namespace thalweg
