// The published measurements of depth peeling, their stand-ins and what they calibrate, from reports/published.
#pragma once

#include "reports/validation/choices.hpp"
#include "reports/validation/printed_number.hpp"

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

struct PeelingMeasurement {
    std::string dataset, buffer; ///< "Dragon", "4 RGBZ"
    std::uint32_t k = 4;
    std::string entry; ///< of the workload
    std::array<PrintedNumber, peeling_columns> fps;
};

/// Of one number of the table: why the model misses it, or why it is another number again.
struct PeelingNote {
    std::string dataset, buffer, column, text;
};

/// The number of the table that decides a parameter of the GPU.
struct PeelingStep {
    std::string dataset, buffer;
    PeelingColumn column{};
    std::string parameter;
    double low = 0, high = 0; ///< between which the parameter is looked for
    std::string reason;
};

struct PublishedPeeling {
    std::string source, gpu;
    std::vector<PeelingDataset> datasets;
    std::vector<PeelingMeasurement> rows;
    std::vector<PeelingStep> calibrated; ///< in the order in which they are solved
    std::vector<PeelingNote> repeats;    ///< printed more than once: counted once
    std::vector<PeelingNote> explanations;
    std::vector<Choice> choices; ///< made with numbers of the table in view

    const PeelingDataset& dataset(const std::string& name) const;
    const PeelingMeasurement& row(const std::string& dataset, const std::string& buffer) const;
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
