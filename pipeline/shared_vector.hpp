// Vectors that copies share.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

namespace pipeline {

/// A vector whose copies share its elements until one of them is written to. Threads may read at the same time, and may
/// write different elements through what own() gave before they began.
template <class T>
class SharedVector {
  public:
    SharedVector() = default;
    SharedVector(std::vector<T> elements) : elements_(std::make_shared<std::vector<T>>(std::move(elements))) {}
    SharedVector(std::initializer_list<T> elements) : SharedVector(std::vector<T>(elements)) {}

    std::size_t size() const { return elements_->size(); }
    bool empty() const { return elements_->empty(); }
    std::size_t capacity() const { return elements_->capacity(); }
    const T& operator[](std::size_t i) const { return (*elements_)[i]; }
    const T& at(std::size_t i) const { return elements_->at(i); }
    const T* data() const { return elements_->data(); }
    const T& front() const { return elements_->front(); }
    const T& back() const { return elements_->back(); }
    auto begin() const { return elements_->cbegin(); }
    auto end() const { return elements_->cend(); }

    /// The elements as this copy's alone, to be changed.
    std::vector<T>& own() {
        if (elements_.use_count() != 1) elements_ = std::make_shared<std::vector<T>>(*elements_);
        return *elements_;
    }
    bool shares(const SharedVector& other) const { return elements_ == other.elements_; }
    bool operator==(const SharedVector& other) const { return *elements_ == *other.elements_; }

  private:
    std::shared_ptr<std::vector<T>> elements_ = std::make_shared<std::vector<T>>();
};

} // namespace pipeline
