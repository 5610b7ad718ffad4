// First-in-first-out queues in rings: of fixed capacity, the storage of every queue inside a unit; and one that grows,
// for what is on a wire, which is as much as its latency holds.
#pragma once

#include "sim/check.hpp"

#include <bit>
#include <cstdint>
#include <utility>
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

template <class T>
class GrowingQueue {
  public:
    bool empty() const { return head_ == tail_; }
    void push(const T& value) {
        if (tail_ - head_ == ring_.size()) grow();
        ring_[tail_++ & (ring_.size() - 1)] = value;
    }
    const T& front() const { return ring_[head_ & (ring_.size() - 1)]; }
    void pop() { ++head_; }

  private:
    void grow() {
        std::vector<T> wider(2 * ring_.size());
        for (std::size_t i = 0; i < ring_.size(); ++i) wider[i] = ring_[(head_ + i) & (ring_.size() - 1)];
        head_ = 0;
        tail_ = ring_.size();
        ring_ = std::move(wider);
    }
    std::size_t head_ = 0, tail_ = 0;
    std::vector<T> ring_ = std::vector<T>(16); ///< a power of two
};

} // namespace pipeline
