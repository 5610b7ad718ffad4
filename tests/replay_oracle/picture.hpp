// Pictures as both sides give them, and how far they are apart.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace replay_oracle {

struct Picture {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgba; ///< top row first
};

/// Share of the pixels, from 0 to 1, none of whose channels differ by more than `codes`; 0 for pictures of two sizes.
double share_within(const Picture& a, const Picture& b, int codes);

/// Writes its colours as a PPM. Throws sim::InputError where that cannot be.
void write_picture(const Picture& picture, const std::filesystem::path& file);

} // namespace replay_oracle
