#pragma once

/// A value that is made when it is first asked for.

#include <atomic>
#include <memory>
#include <mutex>

namespace thalweg {

/// Made once, whichever threads ask for it; copies share it. Pre: not moved from.
template <class Value>
class Lazy {
 public:
  /// The value; the first caller makes it, while others wait. What `make` throws goes to that caller, and the
  /// next one tries again. Pre: `make` runs no task of other work, which might ask too.
  template <class Make>
  const Value& get(const Make& make) const {
    if (!state_->made.load(std::memory_order_acquire)) ask(make);
    return state_->value;
  }

 private:
  struct State {
    std::atomic<bool> made{false};
    std::mutex mutex;
    Value value;
  };

  template <class Make>
  void ask(const Make& make) const {
    const std::scoped_lock lock(state_->mutex);
    if (state_->made.load(std::memory_order_relaxed)) return;
    state_->value = make();
    state_->made.store(true, std::memory_order_release);
  }

  std::shared_ptr<State> state_ = std::make_shared<State>();
};

}  // namespace thalweg
