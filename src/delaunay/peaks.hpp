#pragma once

/// A queue of cells by their largest errors, made for errors that mostly fall.

#include <thalweg/geometry/point.hpp>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace thalweg::detail {

struct Peak {
  double error = 0;
  std::uint32_t vertex = 0, cell = 0;
};

/// Peaks wait in buckets, sixteen to each power of two; only the highest bucket is a heap. So a peak that is
/// out of date before its bucket is the highest, as most are, costs next to nothing.
class Peaks {
 public:
  /// Of equal errors that at the first position is the highest.
  explicit Peaks(std::span<const Point2> xy) : xy_(xy), buckets_(kBuckets) {}

  /// Pre: the error is above zero.
  void push(const Peak& peak) {
    const std::size_t bucket = std::bit_cast<std::uint64_t>(peak.error) >> kDropped;
    if (bucket < heap_from_) {
      buckets_[bucket].push_back(peak);
      return;
    }
    heap_.push_back(peak);
    std::push_heap(heap_.begin(), heap_.end(), lower());
  }
  /// The highest peak; none: nullptr. Stays where it is until `pop`.
  const Peak* highest() {
    while (heap_.empty()) {
      if (heap_from_ == 0) return nullptr;
      heap_.swap(buckets_[--heap_from_]);
      std::make_heap(heap_.begin(), heap_.end(), lower());
    }
    return &heap_.front();
  }
  /// Pre: `highest` found one.
  void pop() {
    std::pop_heap(heap_.begin(), heap_.end(), lower());
    heap_.pop_back();
  }

 private:
  static constexpr unsigned kDropped = 48;  ///< bits of an error that do not tell its bucket
  static constexpr std::size_t kBuckets = std::size_t{1} << (63 - kDropped);

  struct Lower {
    std::span<const Point2> xy;
    bool operator()(const Peak& a, const Peak& b) const {
      return a.error != b.error ? a.error < b.error : xy[b.vertex] < xy[a.vertex];
    }
  };
  [[nodiscard]] Lower lower() const { return {xy_}; }

  std::span<const Point2> xy_;
  std::vector<Peak> heap_;  ///< of all buckets from `heap_from_` on
  std::size_t heap_from_ = kBuckets;
  std::vector<std::vector<Peak>> buckets_;
};

}  // namespace thalweg::detail
