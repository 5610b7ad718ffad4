#include "traces/hash.hpp"

#include "sim/check.hpp"

#include <fmt/format.h>
#include <new>
#include <xxhash.h>

namespace traces {

struct ContentHash::State {
    struct Free {
        void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
    };
    std::unique_ptr<XXH3_state_t, Free> xxh{XXH3_createState()};
};

ContentHash::ContentHash() : state_(std::make_unique<State>()) {
    if (state_->xxh == nullptr) throw std::bad_alloc();
    CHECK(XXH3_64bits_reset(state_->xxh.get()) == XXH_OK);
}

ContentHash::~ContentHash() = default;

void ContentHash::add(std::span<const std::byte> bytes) {
    CHECK(XXH3_64bits_update(state_->xxh.get(), bytes.data(), bytes.size()) == XXH_OK);
}

std::string ContentHash::hex() const { return fmt::format("{:016x}", XXH3_64bits_digest(state_->xxh.get())); }

} // namespace traces
