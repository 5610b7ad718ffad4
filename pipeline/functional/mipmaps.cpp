// Texture::make_mips: levels 1.. of a texture by averaging 2x2 texels, in linear light for sRGB-encoded images.
//
// An odd size is halved rounding down, as OpenGL and Direct3D do; the last row or column then has no share in the next
// level. Alpha is never sRGB-encoded.
#include "pipeline/draw.hpp"
#include "pipeline/functional/number_formats.hpp"

#include <algorithm>
#include <utility>

namespace pipeline {

namespace {

using Level = Texture::Level;

class BoxFilter {
  public:
    explicit BoxFilter(bool srgb) : srgb_(srgb), decode_(srgb ? srgb_decode_table() : unorm8_decode_table()) {}

    Level halved(const Level& source) const {
        Level target;
        target.width = std::max(1U, source.width / 2);
        target.height = std::max(1U, source.height / 2);
        target.rgba.resize(std::size_t{target.width} * target.height * 4);
        std::uint8_t* texel = target.rgba.data();
        for (std::uint32_t y = 0; y < target.height; ++y)
            for (std::uint32_t x = 0; x < target.width; ++x, texel += 4) average(source, x, y, texel);
        return target;
    }

  private:
    void average(const Level& source, std::uint32_t x, std::uint32_t y, std::uint8_t* texel) const {
        const std::uint32_t x0 = std::min(2 * x, source.width - 1);
        const std::uint32_t x1 = std::min(2 * x + 1, source.width - 1);
        const std::uint32_t y0 = std::min(2 * y, source.height - 1);
        const std::uint32_t y1 = std::min(2 * y + 1, source.height - 1);
        const auto at = [&](std::uint32_t column, std::uint32_t row) {
            return source.rgba.data() + (std::size_t{row} * source.width + column) * 4;
        };
        const std::uint8_t* corners[4] = {at(x0, y0), at(x1, y0), at(x0, y1), at(x1, y1)};
        for (std::size_t channel = 0; channel < 3; ++channel) {
            float sum = 0.0F;
            for (const std::uint8_t* corner : corners) sum += decode_[corner[channel]];
            texel[channel] = srgb_ ? srgb_encode(sum / 4.0F) : float_to_unorm8(sum / 4.0F);
        }
        std::uint32_t alpha = 0;
        for (const std::uint8_t* corner : corners) alpha += corner[3];
        texel[3] = static_cast<std::uint8_t>((alpha + 2) / 4);
    }

    bool srgb_;
    const std::array<float, 256>& decode_;
};

} // namespace

void Texture::make_mips() {
    if (levels.empty()) return;
    levels.resize(1);
    const BoxFilter filter(srgb);
    while (levels.back().width > 1 || levels.back().height > 1) {
        Level next = filter.halved(levels.back());
        levels.push_back(std::move(next));
    }
}

} // namespace pipeline
