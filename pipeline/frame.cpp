#include "pipeline/frame.hpp"

#include "sim/check.hpp"

#include <fmt/format.h>

namespace pipeline {

// A pass that shades no colour wants colours, normals and textures only as far as an alpha test may read them.
Needs Frame::needs_of(const Pass& pass) const {
    Needs own = needs;
    if (pass.kind == PassKind::screen) own = {};
    own.colours &= pass.writes_colour() || (pass.runs_program() && program->needs_colour());
    own.fragment_normals = own.map_texcoords = false;
    if (pass.shader != nullptr) {
        const ShaderShape shape = pass.shader->shape();
        own.colours = shape.colour.has_value();
        own.fragment_colour = shape.colour.value_or(FragmentColour::unlit);
        own.fragment_normals = shape.normal;
        own.map_texcoords = shape.map_texcoords;
    }
    const bool of_material = own.colours && own.fragment_colour != FragmentColour::flat;
    const bool coloured = own.alpha_test || (of_material && own.fragment_colour != FragmentColour::cosine);
    own.normals &= own.fragment_normals || (of_material && own.fragment_colour != FragmentColour::unlit);
    own.vertex_colours &= coloured;
    own.textures &= coloured;
    own.texcoords &= coloured;
    return own;
}

void Frame::check_targets() const {
    for (const Pass& pass : passes) {
        if (!pass.writes_targets()) continue;
        for (const SurfaceId target : pass.targets)
            if (target != no_surface && surfaces[target].compressed())
                throw sim::InputError(fmt::format("pass '{}': surface '{}' is of format {}, which is read only",
                                                  pass.name, surfaces[target].name,
                                                  info_of(surfaces[target].format).name));
    }
}

} // namespace pipeline
