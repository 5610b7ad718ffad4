// A first-in-first-out queue of fixed capacity; the storage of every queue inside a unit.
#pragma once

#include "sim/check.hpp"

#include <bit>
#include <cstdint>
#include <vector>

namespace pipeline {

template <class T>
class FixedQueue {
  public:
    explicit FixedQueue(std::uint32_t capacity)
        : capacity_(capacity), mask_(std::bit_ceil(capacity) - 1), ring_(mask_ + 1) {}

    bool empty() const { return head_ == tail_; }
    bool full() const { return size() >= capacity_; }
    std::uint32_t size() const { return tail_ - head_; }
    std::uint32_t capacity() const { return capacity_; }

    void push(const T& value) {
        CHECK(!full());
        ring_[tail_++ & mask_] = value;
    }
    T& front() { return ring_[head_ & mask_]; }
    const T& front() const { return ring_[head_ & mask_]; }
    T& back() { return ring_[(tail_ - 1) & mask_]; }
    void pop() { ++head_; }
    /// The i-th oldest element.
    T& operator[](std::uint32_t i) { return ring_[(head_ + i) & mask_]; }

  private:
    std::uint32_t capacity_;
    std::uint32_t mask_;
    std::uint32_t head_ = 0, tail_ = 0;
    std::vector<T> ring_;
};

} // namespace pipeline
