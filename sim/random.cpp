#include "sim/random.hpp"

namespace sim {

namespace {

// FNV-1a: the mapping from name to stream must be the same on every platform, which std::hash does not promise.
std::uint64_t hash_name(std::string_view name) {
    std::uint64_t hash = 14695981039346656037ULL;
    for (const char letter : name) hash = (hash ^ static_cast<unsigned char>(letter)) * 1099511628211ULL;
    return hash;
}

std::mt19937_64 make_engine(std::uint64_t seed, std::string_view name) {
    const std::uint64_t stream = hash_name(name);
    std::seed_seq words{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32U),
                        static_cast<std::uint32_t>(stream), static_cast<std::uint32_t>(stream >> 32U)};
    return std::mt19937_64(words);
}

} // namespace

Random::Random(std::uint64_t seed, std::string_view name) : engine_(make_engine(seed, name)) {}

} // namespace sim
