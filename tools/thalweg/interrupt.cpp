// A thread of its own waits for the signals, which are blocked in all others, so that it may do what a signal
// handler may not.
#include "interrupt.hpp"

#include "command.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/io/pending_outputs.hpp>

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <string>
#include <thread>

namespace thalweg::cli {

namespace {

std::atomic_flag claimed = ATOMIC_FLAG_INIT;
std::atomic<Progress*> watched = nullptr;

[[noreturn]] void end_process() {
  claim_interruption();
  try {
    Progress stopped;
    stopped.cancel();
    stopped.check();
  } catch (const Error& error) {
    end_progress_line();
    const std::string line = "ERROR " + std::string(error_name(error.code())) + ": " + error.what() + "\n";
    // Whether or not anyone reads it, the process ends.
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, line.data(), line.size());
  }
  ::_exit(kInterrupted);
}

}  // namespace

void claim_interruption() {
  while (claimed.test_and_set()) ::pause();
}

void watch_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    const auto before = std::signal(number, SIG_DFL);  // a shell lets its background jobs ignore SIGINT
    const bool outlives_terminal = number == SIGHUP && before == SIG_IGN;  // as nohup asks for
    if (outlives_terminal) std::signal(number, SIG_IGN);
    if (!outlives_terminal) sigaddset(&signals, number);
  }
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::thread([signals] {
    int number = 0;
    while (sigwait(&signals, &number) != 0) {
    }
    if (Progress* progress = watched.load()) {
      progress->cancel();
      constexpr std::chrono::milliseconds kGrace{500};
      std::this_thread::sleep_for(kGrace);
    }
    if (abandon_pending_outputs()) end_process();
  }).detach();
}

void cancel_on_signal(Progress& progress) {
  watched = &progress;
}

}  // namespace thalweg::cli
