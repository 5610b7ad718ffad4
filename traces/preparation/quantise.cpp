#include "traces/preparation/quantise.hpp"

#include "sim/check.hpp"
#include "traces/preparation/conservation.hpp"
#include "traces/preparation/formats.hpp"
#include "traces/preparation/rebuild.hpp"
#include "traces/preparation/table.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <limits>

namespace traces {

using pipeline::ComponentType;
using pipeline::Semantic;

namespace {

constexpr double largest = 32767.0;
constexpr double rounding = 1e-9; ///< of the bound: what binary64 adds to an error

struct QuantiseParams {
    QuantiseBox box = QuantiseBox::axes;
    NormalFormat normals = NormalFormat::floats;
    std::uint32_t align = 4;

    static constexpr auto fields() {
        using P = QuantiseParams;
        return std::tuple(
            sim::field<&P::box>("extents of the grid: for each axis its own, or the largest for all (normals stay)"),
            sim::field<&P::normals>("format of normals: floats, or normalised integers"),
            sim::field<&P::align>("attributes and vertices begin at multiples of this").unit("bytes").range(1, 64));
    }
};
static_assert(sim::fully_described<QuantiseParams>);

Column* find(Columns& columns, Semantic semantic) {
    const auto found = std::find_if(columns.begin(), columns.end(),
                                    [&](const Column& column) { return column.format.semantic == semantic; });
    return found == columns.end() ? nullptr : &*found;
}

void quantise_positions(Column& column, const std::vector<glm::vec3>& positions, const QuantiseGrid& grid,
                        QuantiseErrors& errors) {
    column.format = with_format(column.format, ComponentType::s16, 3, false);
    column.elements.resize(positions.size() * 6);
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const std::array<std::int16_t, 3> quantised = grid.quantise(positions[i]);
        const glm::dvec3 error = grid.error(positions[i], quantised);
        for (int axis = 0; axis < 3; ++axis) {
            if (grid.extent[axis] == 0.0) continue;
            const double of_bound = error[axis] / (grid.extent[axis] / (4.0 * largest));
            CHECK(of_bound <= 1.0 + rounding);
            errors.of_bound = std::max(errors.of_bound, of_bound);
        }
        std::memcpy(column.elements.data() + i * 6, quantised.data(), 6);
    }
}

double angle_between(const glm::dvec3& a, const glm::dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/// The restoring matrix multiplies normals by its cofactors, which divides them by the steps (and by a common factor):
/// what is stored is the normal times the steps. Lengths keep their ratios, because normals are interpolated before
/// they are made unit vectors; the largest component is 1, as integers need.
std::vector<glm::vec4> bent(const std::vector<glm::vec4>& normals, const glm::dvec3& step) {
    double longest = 0.0;
    for (const glm::vec4& normal : normals)
        for (int axis = 0; axis < 3; ++axis)
            longest = std::max(longest, std::fabs(static_cast<double>(normal[axis]) * step[axis]));
    std::vector<glm::vec4> result(normals.size(), glm::vec4(0.0F));
    if (!(longest > 0.0) || !std::isfinite(longest)) return result;
    for (std::size_t i = 0; i < normals.size(); ++i)
        result[i] = glm::vec4(glm::dvec4(glm::dvec3(glm::vec3(normals[i])) * step / longest, 0.0));
    return result;
}

void bend_normals(Column& column, const glm::dvec3& step, NormalFormat format, QuantiseErrors& errors) {
    const std::vector<glm::vec4> normals = values_of(column);
    const ComponentType type = format == NormalFormat::s8    ? ComponentType::s8
                               : format == NormalFormat::s16 ? ComponentType::s16
                                                             : ComponentType::f32;
    column = column_from(with_format(column.format, type, 3, type != ComponentType::f32), bent(normals, step));
    const std::vector<glm::vec4> stored = values_of(column);
    for (std::size_t i = 0; i < normals.size(); ++i) {
        const glm::dvec3 before{glm::vec3(normals[i])}, after = glm::dvec3(glm::vec3(stored[i])) / step;
        if (glm::length(before) > 0.0)
            errors.normal_angle = std::max(errors.normal_angle, angle_between(before, after));
    }
}

/// Integers keep little of a normal that a flat box has bent; what shading needs: specification 004, section 3.1, A3.
const char* advice(const QuantiseParams& params, const QuantiseErrors& errors) {
    const bool too_coarse = errors.normal_angle > 0.01 && params.box == QuantiseBox::axes;
    return too_coarse ? ", more than the 0.01 that shading needs: box=cube does not bend them" : "";
}

Applied apply(Scene scene, const QuantiseParams& params) {
    const Scene before = scene;
    std::size_t left_alone = 0, geometries = 0;
    QuantiseErrors errors;
    Applied applied;
    applied.scene = rebuild_scene(std::move(scene), TopologyWanted::as_it_is, [&](TriangleMesh mesh) {
        const auto restore = quantise_mesh(mesh, params.box, params.normals, params.align, errors);
        ++geometries;
        left_alone += restore ? 0U : 1U;
        std::vector<PreparedPart> parts(1);
        parts.front() = {std::move(mesh), restore.value_or(glm::dmat4(1.0))};
        return parts;
    });
    const std::array changed{Semantic::position, Semantic::normal};
    applied.position_error = check_same_order(before, applied.scene, changed);
    applied.notes.push_back(
        fmt::format("coordinates: largest error {:.4f} of the bound extent / 131068", errors.of_bound));
    if (errors.normal_angle > 0.0)
        applied.notes.push_back(
            fmt::format("normals: largest error {:.2g} rad{}", errors.normal_angle, advice(params, errors)));
    if (left_alone > 0)
        applied.notes.push_back(fmt::format("{} of {} geometries are too small to be restored by a matrix of floats, "
                                            "and stay as they are",
                                            left_alone, geometries));
    return applied;
}

} // namespace

QuantiseGrid QuantiseGrid::around(std::span<const glm::vec3> positions, QuantiseBox box) {
    QuantiseGrid grid;
    if (positions.empty()) return grid;
    glm::vec3 lo = positions.front(), hi = lo;
    for (const glm::vec3& position : positions) {
        lo = glm::min(lo, position);
        hi = glm::max(hi, position);
    }
    grid.lo = glm::dvec3(lo);
    grid.extent = glm::dvec3(hi) - glm::dvec3(lo);
    if (box == QuantiseBox::axes) return grid;
    const double all = std::max({grid.extent.x, grid.extent.y, grid.extent.z});
    for (int axis = 0; axis < 3; ++axis) grid.lo[axis] -= (all - grid.extent[axis]) / 2.0;
    grid.extent = glm::dvec3(all);
    return grid;
}

std::array<std::int16_t, 3> QuantiseGrid::quantise(const glm::vec3& position) const {
    std::array<std::int16_t, 3> result{};
    for (int axis = 0; axis < 3; ++axis) {
        if (extent[axis] == 0.0) continue;
        const double place = 2.0 * (static_cast<double>(position[axis]) - lo[axis]) / extent[axis] - 1.0;
        result[static_cast<std::size_t>(axis)] =
            static_cast<std::int16_t>(std::clamp(std::round(largest * place), -largest, largest));
    }
    return result;
}

glm::dvec3 QuantiseGrid::error(const glm::vec3& position, const std::array<std::int16_t, 3>& quantised) const {
    glm::dvec3 result(0.0);
    for (int axis = 0; axis < 3; ++axis) { // from the low corner, where nothing cancels
        const double steps = quantised[static_cast<std::size_t>(axis)] + largest;
        const double restored = extent[axis] == 0.0 ? 0.0 : steps * extent[axis] / (2.0 * largest);
        result[axis] = std::fabs(restored - (static_cast<double>(position[axis]) - lo[axis]));
    }
    return result;
}

glm::dvec3 QuantiseGrid::step() const {
    glm::dvec3 step = extent / (2.0 * largest);
    const double longest = std::max({step.x, step.y, step.z});
    for (int axis = 0; axis < 3; ++axis)
        if (step[axis] == 0.0) step[axis] = longest > 0.0 ? longest : 1.0;
    return step;
}

glm::dmat4 QuantiseGrid::restore() const {
    const glm::dvec3 diagonal = step();
    glm::dmat4 matrix(1.0);
    for (int axis = 0; axis < 3; ++axis) matrix[axis][axis] = diagonal[axis];
    matrix[3] = glm::dvec4(lo + extent / 2.0, 1.0);
    return matrix;
}

bool QuantiseGrid::representable() const {
    const glm::dvec3 diagonal = step();
    return std::min({diagonal.x, diagonal.y, diagonal.z}) >= static_cast<double>(std::numeric_limits<float>::min());
}

std::optional<glm::dmat4> quantise_mesh(TriangleMesh& mesh, QuantiseBox box, NormalFormat normals, std::uint32_t align,
                                        QuantiseErrors& errors) {
    Columns columns = columns_of(mesh);
    Column* position = find(columns, Semantic::position);
    CHECK(position != nullptr);
    std::vector<glm::vec3> positions;
    for (const glm::vec4& value : values_of(*position)) positions.emplace_back(value);
    const QuantiseGrid grid = QuantiseGrid::around(positions, box);
    if (!grid.representable()) return std::nullopt;
    quantise_positions(*position, positions, grid, errors);
    const bool bends = box == QuantiseBox::axes;
    if (Column* normal = find(columns, Semantic::normal); normal && (bends || normals != NormalFormat::floats))
        bend_normals(*normal, grid.step(), normals, errors);
    lay_out(mesh, columns, grouping_of(mesh), align);
    return grid.restore();
}

Preparation quantise_preparation() {
    return make_preparation<QuantiseParams>("quantise",
                                            "positions as 16-bit integers in the box of their geometry (A3)", apply);
}

} // namespace traces
