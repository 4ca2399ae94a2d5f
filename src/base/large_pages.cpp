#include "base/large_pages.hpp"

#include <sys/mman.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>

namespace thalweg {

// NOLINTBEGIN(cppcoreguidelines-no-malloc): what manages memory stands on this.

void* try_allocate_pages(std::size_t bytes) noexcept {
  if (bytes < kLargePage) return std::malloc(bytes == 0 ? 1 : bytes);
  const std::size_t whole = (bytes + kLargePage - 1) / kLargePage * kLargePage;
  if (whole < bytes) return nullptr;
  void* memory = std::aligned_alloc(kLargePage, whole);
  if (memory != nullptr) madvise(memory, whole, MADV_HUGEPAGE);  // advice: no harm if it is not taken
  return memory;
}

void advise_large_pages(void* memory, std::size_t bytes) noexcept {
  if (bytes < kLargePage) return;
  // Whole pages of the smallest kind: what else lies on them does not mind.
  constexpr std::size_t kPage = 4096;
  const std::size_t before = reinterpret_cast<std::uintptr_t>(memory) % kPage;
  madvise(static_cast<std::byte*>(memory) - before, (before + bytes) / kPage * kPage, MADV_HUGEPAGE);
}

void touch_pages(void* memory, std::size_t bytes) {
  if (bytes < kLargePage || tbb::this_task_arena::max_concurrency() == 1) return;
  auto* const first = static_cast<std::byte*>(memory);
  tbb::parallel_for(std::size_t{0}, bytes / kLargePage, [first](std::size_t page) {
    // Where large pages are not to be had, this is one small page of many, which does no harm.
    new (first + page * kLargePage) std::byte{};
  });
}

void discard_pages(void* memory, std::size_t bytes) noexcept {
  auto* const begin = static_cast<std::byte*>(memory);
  const std::size_t before = (kLargePage - reinterpret_cast<std::uintptr_t>(begin) % kLargePage) % kLargePage;
  if (bytes < before + kLargePage) return;
  madvise(begin + before, (bytes - before) / kLargePage * kLargePage, MADV_DONTNEED);
}

void free_pages(void* memory) noexcept {
  std::free(memory);
}

void* allocate_pages(std::size_t bytes) {
  constexpr std::size_t kLine = 64;
  const bool small = bytes < kLargePage;
  if (void* memory =
          small ? std::aligned_alloc(kLine, (bytes / kLine + 1) * kLine) : try_allocate_pages(bytes)) {
    return memory;
  }
  throw std::bad_alloc();
}

// NOLINTEND(cppcoreguidelines-no-malloc)

}  // namespace thalweg
