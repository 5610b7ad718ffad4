// What the shader of shader.hpp would cost on a machine with one instruction per quad and clock; see README.md.
#include "pipeline/functional/shader.hpp"

namespace pipeline {

ShaderCost shader_cost(const Material& material, const Geometry& geometry, const Needs& needs) {
    const bool tests = needs.alpha_test && material.alpha_mode == AlphaMode::mask;
    ShaderCost cost{1, 0, 1}; // the result's own move and register
    const bool smooth = needs.normals && geometry.find(Semantic::normal) != nullptr;
    if (needs.fragment_normals) { // interpolated, or two derivatives and a cross product; then dot, reciprocal root,
                                  // multiply
        cost.alu += (smooth ? 1U : 4U) + 3U;
        cost.registers += smooth ? 1U : 2U;
    }
    const MaterialMaps& maps = material.maps;
    const auto has = [&](std::uint32_t set) { return geometry.find(texcoord(set)) != nullptr; };
    if (needs.map_texcoords && ((maps.read(0) && has(0)) || (maps.read(1) && has(1)))) {
        cost.alu += 1; // both sets are interpolated together
        cost.registers += 1;
        if (maps.normal.there() && has(maps.normal.texcoord)) {
            cost.alu += 1U + 4U + 2U; // position; its derivatives and those of the coordinates; their combination
            cost.registers += 1;
        }
    }
    if (!needs.colours && !tests) return cost;
    if (needs.colours && needs.fragment_colour == FragmentColour::flat) return cost;

    const bool reads_colour =
        needs.fragment_colour == FragmentColour::lit || needs.fragment_colour == FragmentColour::unlit || tests;
    if (reads_colour && needs.vertex_colours && geometry.find(Semantic::colour) != nullptr) {
        cost.alu += 2; // interpolate, multiply
        cost.registers += 1;
    }
    if (reads_colour && needs.textures && material.base_texture >= 0 &&
        geometry.find(texcoord(material.texcoord)) != nullptr) {
        cost.alu += 2; // interpolate, multiply
        cost.textures += 1;
        cost.registers += 2;
    }
    if (needs.colours && needs.fragment_colour == FragmentColour::cosine) {
        // The normal as below, and the position interpolated; then three dots, multiply, reciprocal root, multiply.
        cost.alu += (smooth ? 1U : 4U) + 1U + 6U;
        cost.registers += smooth ? 2U : 3U;
    } else if (needs.colours && needs.fragment_colour == FragmentColour::lit && !material.unlit) {
        // Interpolate, or two derivatives and a cross product of two instructions; then dot, reciprocal root, multiply,
        // ambient multiply-add, multiply.
        cost.alu += (smooth ? 1U : 4U) + 5U;
        cost.registers += smooth ? 1U : 2U;
    }
    if (tests) cost.alu += 2; // compare, discard
    return cost;
}

} // namespace pipeline
