// Bytes that several owners hold and nobody changes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace pipeline {

class SharedBytes {
  public:
    SharedBytes() = default;
    /// Takes them over.
    SharedBytes(std::vector<std::byte> bytes) : size_(bytes.size()) {
        const auto owner = std::make_shared<const std::vector<std::byte>>(std::move(bytes));
        bytes_ = {owner, owner->data()};
    }
    /// The first `size` of them.
    SharedBytes(std::shared_ptr<const std::byte[]> bytes, std::size_t size) : bytes_(std::move(bytes)), size_(size) {}

    const std::byte* data() const { return bytes_.get(); }
    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    const std::byte* begin() const { return data(); }
    const std::byte* end() const { return data() + size_; }
    const std::byte& operator[](std::size_t i) const { return data()[i]; }
    bool operator==(const SharedBytes& other) const { return std::equal(begin(), end(), other.begin(), other.end()); }

  private:
    std::shared_ptr<const std::byte[]> bytes_;
    std::size_t size_ = 0;
};

} // namespace pipeline
