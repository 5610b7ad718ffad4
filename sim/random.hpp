// Random numbers that depend on the seed of the run and on the name of their user, and on nothing else.
//
// The engine is std::mt19937_64 (its sequence is fixed by the C++ standard); the mapping to ranges is done here because
// the standard leaves that of its distributions to the library.
#pragma once

#include <cstdint>
#include <random>
#include <string_view>

namespace sim {

class Random {
  public:
    /// Two users with different names draw independent sequences from one seed.
    Random(std::uint64_t seed, std::string_view name);

    /// Uniform in [0, bound); bound >= 1.
    std::uint64_t below(std::uint64_t bound) {
        return static_cast<std::uint64_t>((static_cast<Wide>(engine_()) * bound) >> 64U);
    }
    /// Uniform in [0, 1) with 53 random bits.
    double uniform() { return static_cast<double>(engine_() >> 11U) * 0x1.0p-53; }

  private:
    __extension__ using Wide = unsigned __int128;
    std::mt19937_64 engine_;
};

} // namespace sim
