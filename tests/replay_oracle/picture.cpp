#include "tests/replay_oracle/picture.hpp"

#include "sim/check.hpp"

#include <algorithm>
#include <cstdlib>
#include <fmt/format.h>
#include <fstream>

namespace replay_oracle {

double share_within(const Picture& a, const Picture& b, int codes) {
    if (a.width != b.width || a.height != b.height || a.rgba.empty()) return 0.0;
    const std::size_t pixels = a.rgba.size() / 4;
    std::size_t near = 0;
    for (std::size_t i = 0; i < pixels; ++i) {
        int worst = 0;
        for (std::size_t c = 4 * i; c < 4 * i + 4; ++c) worst = std::max(worst, std::abs(a.rgba[c] - b.rgba[c]));
        if (worst <= codes) ++near;
    }
    return static_cast<double>(near) / static_cast<double>(pixels);
}

void write_picture(const Picture& picture, const std::filesystem::path& file) {
    std::ofstream stream(file, std::ios::binary);
    stream << fmt::format("P6 {} {} 255\n", picture.width, picture.height);
    for (std::size_t i = 0; i < picture.rgba.size(); i += 4)
        stream.write(reinterpret_cast<const char*>(&picture.rgba[i]), 3);
    if (!stream) throw sim::InputError(fmt::format("{}: expected a file that can be written", file.string()));
}

} // namespace replay_oracle
