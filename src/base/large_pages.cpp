#include "base/large_pages.hpp"

#include <thalweg/base/raw_vector.hpp>

#include <sys/mman.h>

#include <new>

namespace thalweg {

void* allocate_pages(std::size_t bytes) {
  if (bytes < kLargePage) return ::operator new(bytes);
  const std::size_t size = (bytes + kLargePage - 1) / kLargePage * kLargePage;
  void* memory = ::operator new (size, std::align_val_t{kLargePage});
  madvise(memory, size, MADV_HUGEPAGE);  // advice: no harm if it is not taken
  return memory;
}

void free_pages(void* memory, std::size_t bytes) {
  if (bytes < kLargePage) {
    ::operator delete(memory);
  } else {
    ::operator delete (memory, std::align_val_t{kLargePage});
  }
}

void* detail::allocate_raw(std::size_t bytes) {
  return allocate_pages(bytes);
}

void detail::free_raw(void* memory, std::size_t bytes) {
  free_pages(memory, bytes);
}

}  // namespace thalweg
