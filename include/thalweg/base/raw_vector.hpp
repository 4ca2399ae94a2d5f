#pragma once

/// Arrays that start without content, for those who write every element anyway: on several threads, which
/// then share the cost of memory that is touched for the first time.

#include <cstddef>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace thalweg {

/// Memory that starts at a large page of the system and asks for such pages, if it fills one: their page
/// tables fit the processor's cache, and fewer of them have to be made. Smaller memory starts at a cache
/// line. Throws: std::bad_alloc.
void* allocate_pages(std::size_t bytes);
void free_pages(void* memory) noexcept;

template <class T>
struct RawAllocator {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);
  using value_type = T;
  RawAllocator() = default;
  template <class U>
  explicit RawAllocator(const RawAllocator<U>& /*other*/) {}

  T* allocate(std::size_t count) { return static_cast<T*>(allocate_pages(count * sizeof(T))); }
  void deallocate(T* memory, std::size_t /*count*/) { free_pages(memory); }
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
