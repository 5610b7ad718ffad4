// The published measurements of deferred shading, what follows from them, and why the model misses some, from
// reports/published.
#pragma once

#include "reports/validation/printed_number.hpp"
#include "sim/field.hpp"

#include <array>
#include <compare>
#include <cstdint>
#include <string>
#include <vector>

namespace reports {

/// A frame that was measured.
struct DeferredFrame {
    std::string gpu, method, shadows;
    bool refraction = true;
    std::uint32_t transparent = 0; ///< triangles
    std::uint32_t lights = 0;

    auto operator<=>(const DeferredFrame&) const = default; // NOLINT(modernize-use-nullptr): it means the 0 of <=>
};

/// Frames that differ in their number of lights.
struct DeferredColumn {
    std::string name; ///< "T4.2 off": its table first
    DeferredFrame frame;
    std::vector<std::uint32_t> lights;
    std::vector<PrintedNumber> fps;
    std::string repeats; ///< the column that it prints again; "" of most

    /// nullptr where that number of lights was not measured.
    const PrintedNumber* measured(std::uint32_t count) const;
    DeferredFrame with(std::uint32_t count) const;
};

/// Render targets of a frame without those of shadows.
struct DeferredTargets {
    std::string method;
    PrintedNumber count, megabytes;
};

enum class DeferredKind : std::uint8_t {
    difference, ///< of the milliseconds of a and b
    per_light,  ///< that over the lights
    ratio,      ///< of the frames/s of a to those of b
    slope,      ///< of a: milliseconds a light, from each number of lights to the next
    slope_ratio ///< of a to that of b
};

/// What follows from one column or two.
struct DeferredDerived {
    std::string name; ///< its table, or number of check, first
    DeferredKind kind{};
    std::string a, b;
    std::vector<std::uint32_t> lights; ///< empty: all of them
    bool spread = false;               ///< the largest less the smallest, over the mean
    double low = 0, high = 0;          ///< a band that is asked for; both 0: what was published
};

struct DeferredNote {
    std::vector<std::string> rows; ///< beginnings of the keys of rows
    std::string text;
};

struct PublishedDeferred {
    std::string source, scene;
    std::uint32_t width = 0, height = 0, map_size = 0;
    std::vector<DeferredTargets> targets;
    std::vector<DeferredColumn> columns;
    std::vector<DeferredDerived> derived;
    std::vector<DeferredNote> explanations;
    struct {
        std::string column, parameter;
        std::uint32_t lights = 0;
    } calibrated;

    const DeferredColumn& column(const std::string& name) const;
    std::string scene_with(std::uint32_t transparent) const;
    std::vector<std::string> gpus() const;     ///< in the order in which they occur
    std::vector<std::uint32_t> lights() const; ///< every number that was measured, in growing order
};

/// Throws sim::InputError naming file and place when it is not as expected.
PublishedDeferred load_published_deferred();

} // namespace reports

template <>
struct sim::EnumNames<reports::DeferredKind> {
    static constexpr std::array<std::string_view, 5> names{"difference", "per_light", "ratio", "slope", "slope_ratio"};
};
