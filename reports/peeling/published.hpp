// The published measurements of depth peeling, their stand-ins and what they calibrate, from reports/published.
#pragma once

#include "reports/geometry/validation.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace reports {

/// The columns of the table.
enum class PeelingColumn : std::uint8_t { mp, sp, spwh };
constexpr std::size_t peeling_columns = 3;

/// The design that runs a column.
std::string design_of(PeelingColumn column);

/// How a stand-in with fewer triangles of the same size on the screen differs from the whole mesh.
enum class MeshGrowth : std::uint8_t {
    surface, ///< it fills less of the picture
    volume   ///< it is a part of it, seen by the same camera
};

struct PeelingDataset {
    std::string name;
    std::uint64_t triangles = 0; ///< of the whole mesh
    std::string scene;           ///< with {triangles} or {boxes} for how many
    std::string eye, target;     ///< "x,y,z"
    double fovy = 45;            ///< degrees, of the whole mesh
    MeshGrowth grows = MeshGrowth::surface;
    std::vector<std::uint64_t> sizes; ///< triangles of the stand-ins
    bool detailed = false;            ///< the whole mesh can be run

    /// Of a stand-in: as traces::load_scene() and traces::make_view() take them.
    std::string scene_of(std::uint64_t size) const;
    std::string camera_of(std::uint64_t size) const;
};

/// A number as it was printed.
struct PrintedNumber {
    double value = 0;
    double half_digit = 0; ///< half a unit of the last digit that was printed

    double low() const { return value - half_digit; }
    double high() const { return value + half_digit; }
};

/// "41.4": 41.4 +- 0.05. Throws sim::InputError for what is no number above 0.
PrintedNumber printed_number(const std::string& text);

struct PeelingMeasurement {
    std::string dataset, buffer; ///< "Dragon", "4 RGBZ"
    std::uint32_t k = 4;
    std::string entry; ///< of the workload
    std::array<PrintedNumber, peeling_columns> fps;
};

/// Of one number of the table: the parameter that it decides, or why the model misses it.
struct PeelingNote {
    std::string dataset, buffer, column, parameter, text;
};

struct PublishedPeeling {
    std::string source, gpu;
    std::vector<PeelingDataset> datasets;
    std::vector<PeelingMeasurement> rows;
    std::vector<PeelingNote> calibrated;
    std::vector<PeelingNote> explanations;

    const PeelingDataset& dataset(const std::string& name) const;
};

/// Throws sim::InputError naming file and place when it is not as expected.
PublishedPeeling load_published_peeling();

} // namespace reports

template <>
struct sim::EnumNames<reports::PeelingColumn> {
    static constexpr std::array<std::string_view, 3> names{"MP", "SP", "SPwH"};
};
template <>
struct sim::EnumNames<reports::MeshGrowth> {
    static constexpr std::array<std::string_view, 2> names{"surface", "volume"};
};
