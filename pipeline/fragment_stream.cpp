#include "pipeline/fragment_stream.hpp"

#include <algorithm>

namespace pipeline {

namespace {

template <class Vector>
std::uint64_t held(const Vector& vector) {
    return std::uint64_t{vector.capacity()} * sizeof(vector[0]);
}

} // namespace

std::uint32_t FragmentStream::range_of(std::uint32_t primitive) const {
    const auto after =
        std::upper_bound(draws.begin(), draws.end(), primitive,
                         [](std::uint32_t p, const DrawRange& range) { return p < range.first_primitive; });
    return static_cast<std::uint32_t>(after - draws.begin()) - 1;
}

std::span<const std::array<glm::vec4, 4>> FragmentStream::varyings_of(QuadId quad) const {
    if (varying_runs.empty()) return {};
    const auto after = std::upper_bound(varying_runs.begin(), varying_runs.end(), quad,
                                        [](QuadId q, const VaryingRun& run) { return q < run.first_quad; });
    const VaryingRun& run = *(after - 1);
    return {given_varyings.data() + run.first + std::size_t{quad - run.first_quad} * run.each, run.each};
}

std::uint64_t FragmentStream::bytes() const {
    std::uint64_t outputs = held(colours);
    for (const auto& output : more_outputs) outputs += held(output);
    return held(draws) + held(primitives) + held(triangles) + held(quads) + held(depths) + outputs +
           held(given_colours) + held(given_normals) + held(given_texcoords) + held(given_tangents) +
           held(given_varyings) + held(varying_runs) + held(texture_lines);
}

} // namespace pipeline
