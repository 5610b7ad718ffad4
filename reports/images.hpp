// Pictures as files: PNG for looking, EXR for measuring.
//
// OpenImageIO costs a process 0.26 s and 131 MiB, so it is loaded by the first call below and by nothing else.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace reports {

/// What a display shows: sRGB-encoded, 8 bits a channel.
using Colour = std::array<std::uint8_t, 3>;

struct Picture {
    std::uint32_t width = 0, height = 0; ///< pixels
    std::vector<Colour> pixels;          ///< row by row from the top

    Picture() = default;
    Picture(std::uint32_t columns, std::uint32_t rows, Colour colour = {0, 0, 0})
        : width(columns), height(rows), pixels(std::size_t{columns} * rows, colour) {}
    Colour& at(std::uint32_t x, std::uint32_t y) { return pixels[std::size_t{y} * width + x]; }
    const Colour& at(std::uint32_t x, std::uint32_t y) const { return pixels[std::size_t{y} * width + x]; }
};

/// Numbers per pixel, as the simulator computed them.
struct Measurement {
    std::uint32_t width = 0, height = 0; ///< pixels
    std::vector<std::string> channels;   ///< "R", "layer0.Z"; order as in `values`
    std::vector<float> values;           ///< width * height * channels, row by row from the top
};

/// Throws sim::InputError when pictures cannot be written here. Call it before a long run.
void require_images();

/// Both write under a temporary name first; they throw sim::InputError "PATH: cannot be written: REASON".
void write_png(const std::filesystem::path& path, const Picture& picture);
/// Equal pixels give equal bytes.
void write_exr(const std::filesystem::path& path, const Measurement& measurement);

/// The pixels of a file as floats (integers are divided by their maximum); throws sim::InputError. Channel names are
/// not read.
Measurement read_image(const std::filesystem::path& path);

} // namespace reports
