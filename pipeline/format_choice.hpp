// The surface formats that workloads and designs let their user choose from.
#pragma once

#include "pipeline/surface_format.hpp"

namespace pipeline {

enum class DepthChoice : std::uint8_t { d16, d24, d32f };
enum class ColourChoice : std::uint8_t { rgba8, rgba16f, rgba32f };

constexpr SurfaceFormat format_of(DepthChoice choice) {
    constexpr std::array formats{SurfaceFormat::d16, SurfaceFormat::d24, SurfaceFormat::d32f};
    return formats[static_cast<std::size_t>(choice)];
}
constexpr SurfaceFormat format_of(ColourChoice choice) {
    constexpr std::array formats{SurfaceFormat::rgba8, SurfaceFormat::rgba16f, SurfaceFormat::rgba32f};
    return formats[static_cast<std::size_t>(choice)];
}

} // namespace pipeline

template <>
struct sim::EnumNames<pipeline::DepthChoice> {
    static constexpr std::array<std::string_view, 3> names{"d16", "d24", "d32f"};
};
template <>
struct sim::EnumNames<pipeline::ColourChoice> {
    static constexpr std::array<std::string_view, 3> names{"rgba8", "rgba16f", "rgba32f"};
};
