#pragma once

/// A map from numbers to bytes that is emptied in constant time: the memory of a flood.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace thalweg::detail {

/// Open addressing with linear probing, at most half full; an entry is alive while it bears the current
/// stamp.
template <class Key>
class StampedMapOf {
 public:
  StampedMapOf() : entries_(kFirstSize) {}

  void clear() {
    size_ = 0;
    if (++stamp_ == 0) {
      entries_.assign(entries_.size(), {});
      stamp_ = 1;
    }
  }
  /// Inserts the key with `value`; false, and no change, if it is there.
  bool insert(Key key, std::uint8_t value = 0) {
    if (2 * (size_ + 1) > entries_.size()) grow();
    Entry& entry = entries_[slot(key)];
    if (entry.stamp == stamp_) return false;
    entry = {key, stamp_, value};
    ++size_;
    return true;
  }
  /// The value of a key, or nullptr.
  [[nodiscard]] std::uint8_t* find(Key key) {
    Entry& entry = entries_[slot(key)];
    return entry.stamp == stamp_ ? &entry.value : nullptr;
  }

  [[nodiscard]] bool contains(Key key) const { return entries_[slot(key)].stamp == stamp_; }

 private:
  struct Entry {
    Key key = 0;
    std::uint32_t stamp = 0;
    std::uint8_t value = 0;
  };
  static constexpr std::size_t kFirstSize = 128;

  // Multiplicative hashing (Knuth, The Art of Computer Programming 3, 6.4).
  [[nodiscard]] std::size_t slot(Key key) const {
    const std::size_t mask = entries_.size() - 1;
    std::size_t i = (static_cast<std::uint64_t>(key) * 0x9e3779b97f4a7c15ULL >> 32) & mask;
    while (entries_[i].stamp == stamp_ && entries_[i].key != key) i = (i + 1) & mask;
    return i;
  }
  void grow() {
    std::vector<Entry> old(2 * entries_.size());
    old.swap(entries_);
    for (const Entry& entry : old) {
      if (entry.stamp == stamp_) entries_[slot(entry.key)] = entry;
    }
  }

  std::vector<Entry> entries_;
  std::size_t size_ = 0;
  std::uint32_t stamp_ = 1;
};

using StampedMap = StampedMapOf<std::uint32_t>;

}  // namespace thalweg::detail
