// Fingerprint of a scene's input.
#pragma once

#include <memory>
#include <span>
#include <string>

namespace traces {

/// XXH3-64 over everything that is added, in order.
class ContentHash {
  public:
    ContentHash();
    ~ContentHash();
    ContentHash(const ContentHash&) = delete;
    ContentHash& operator=(const ContentHash&) = delete;

    void add(std::span<const std::byte> bytes);
    template <class T>
    void add_values(std::span<const T> values) {
        add(std::as_bytes(values));
    }
    std::string hex() const; ///< 16 digits

  private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace traces
