#pragma once

/// Arrays that start without content, for those who write every element anyway: on several threads, which
/// then share the cost of memory that is touched for the first time.

#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace thalweg {

template <class T>
struct RawAllocator {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);
  using value_type = T;
  RawAllocator() = default;
  template <class U>
  explicit RawAllocator(const RawAllocator<U>& /*other*/) {}

  T* allocate(std::size_t count) { return std::allocator<T>().allocate(count); }
  void deallocate(T* memory, std::size_t count) { std::allocator<T>().deallocate(memory, count); }
  template <class U>
  void construct(U* /*place*/) {}
  template <class U, class... Arguments>
  void construct(U* place, Arguments&&... arguments) {
    ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
  }
  friend bool operator==(const RawAllocator&, const RawAllocator&) { return true; }
};

/// A std::vector, but `RawVector<T>(n)` and `resize(n)` leave new elements as they are in memory.
template <class T>
using RawVector = std::vector<T, RawAllocator<T>>;

}  // namespace thalweg
