#include "tests/support/random_states.hpp"

namespace tests {

namespace {

using pipeline::BlendEquation;
using pipeline::BlendFactor;
using pipeline::BlendPart;
using pipeline::BlendState;
using pipeline::Compare;
using pipeline::RasterState;
using pipeline::StencilFace;
using pipeline::StencilOperation;

template <class E>
E any_of(sim::Random& random, std::uint64_t count) {
    return static_cast<E>(random.below(count));
}

std::uint8_t any_byte(sim::Random& random) { return static_cast<std::uint8_t>(random.below(256)); }

float any_code(sim::Random& random) { return static_cast<float>(random.below(256)) / 255.0F; }

bool happens(sim::Random& random, double probability) { return random.uniform() < probability; }

Compare any_compare(sim::Random& random) {
    return happens(random, 0.25) ? Compare::always : any_of<Compare>(random, 8);
}

BlendPart any_part(sim::Random& random) {
    return {any_of<BlendFactor>(random, 15), any_of<BlendFactor>(random, 15), any_of<BlendEquation>(random, 5)};
}

StencilFace any_face(sim::Random& random) {
    StencilFace face;
    face.compare = any_compare(random);
    face.reference = happens(random, 0.5) ? static_cast<std::uint8_t>(random.below(4)) : any_byte(random);
    face.compare_mask = happens(random, 0.5) ? std::uint8_t{0xFF} : any_byte(random);
    face.write_mask = happens(random, 0.5) ? std::uint8_t{0xFF} : any_byte(random);
    face.stencil_fails = any_of<StencilOperation>(random, 8);
    face.depth_fails = any_of<StencilOperation>(random, 8);
    face.passes = any_of<StencilOperation>(random, 8);
    return face;
}

} // namespace

pipeline::RasterState random_state(sim::Random& random) {
    RasterState state;
    BlendState& blend = state.blend[0];
    blend.enabled = happens(random, 0.75);
    blend.colour = any_part(random);
    blend.alpha = any_part(random);
    for (int i = 0; i < 4; ++i) blend.constant[i] = any_code(random);
    if (happens(random, 0.4)) state.write_mask[0] = static_cast<std::uint8_t>(random.below(16));
    state.depth.test = happens(random, 0.7);
    state.depth.write = happens(random, 0.5);
    state.depth.compare = any_compare(random);
    state.stencil.test = happens(random, 0.7);
    state.stencil.front = any_face(random);
    state.stencil.back = any_face(random);
    state.front_is_clockwise = happens(random, 0.5);
    return state;
}

std::vector<LevelTriangle> level_triangles(std::uint32_t count, std::uint32_t width, std::uint32_t height, double size,
                                           std::uint32_t levels, sim::Random& random) {
    std::vector<LevelTriangle> triangles(count);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        LevelTriangle& triangle = triangles[i];
        const glm::dvec2 centre(random.uniform() * width, random.uniform() * height);
        for (glm::vec2& corner : triangle.corners) {
            const glm::dvec2 at = centre + size * glm::dvec2(random.uniform() - 0.5, random.uniform() - 0.5) * 2.0;
            corner = glm::clamp(at, glm::dvec2(0.0), glm::dvec2(width, height));
        }
        if (i > 0 && happens(random, 0.2)) triangle.corners = triangles[random.below(i)].corners;
        triangle.depth = static_cast<float>(1 + random.below(levels)) / static_cast<float>(levels + 1);
        for (int channel = 0; channel < 4; ++channel) triangle.colour[channel] = any_code(random);
    }
    return triangles;
}

} // namespace tests
