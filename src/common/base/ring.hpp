#pragma once
// The queue of everything that has a size in the real machine: receive buffers, planner blocks, lines in flight.

#include <cassert>
#include <cstddef>
#include <utility>
#include <vector>

namespace kerf::base {

/// First in, first out, never more than `capacity()` elements; the memory is taken once, at construction.
/// `T` needs a default value. Index 0 is the oldest element. Not for several threads.
template <typename T>
class Ring {
 public:
  explicit Ring(std::size_t capacity) : slots_(capacity) {}

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t capacity() const { return slots_.size(); }
  [[nodiscard]] std::size_t free() const { return capacity() - size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] bool full() const { return size_ == capacity(); }

  /// False, and nothing happens, when the ring is full.
  [[nodiscard]] bool push_back(T element) {
    if (full()) return false;
    slots_[slot_of(size_)] = std::move(element);
    ++size_;
    return true;
  }

  [[nodiscard]] T& front() { return (*this)[0]; }
  [[nodiscard]] const T& front() const { return (*this)[0]; }
  [[nodiscard]] T& back() { return (*this)[size_ - 1]; }
  [[nodiscard]] const T& back() const { return (*this)[size_ - 1]; }

  [[nodiscard]] T& operator[](std::size_t index) {
    assert(index < size_);
    return slots_[slot_of(index)];
  }
  [[nodiscard]] const T& operator[](std::size_t index) const {
    assert(index < size_);
    return slots_[slot_of(index)];
  }

  /// Removes the oldest element and hands it over.
  T pop_front() {
    assert(!empty());
    T element = std::exchange(slots_[first_], T{});
    first_ = slot_of(1);
    --size_;
    return element;
  }

  /// Removes the newest element and hands it over.
  T pop_back() {
    assert(!empty());
    T element = std::exchange(slots_[slot_of(size_ - 1)], T{});
    --size_;
    return element;
  }

  void clear() {
    while (!empty()) pop_front();
  }

 private:
  [[nodiscard]] std::size_t slot_of(std::size_t index) const {
    const std::size_t slot = first_ + index;
    return slot < capacity() ? slot : slot - capacity();
  }

  std::vector<T> slots_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
};

}  // namespace kerf::base
