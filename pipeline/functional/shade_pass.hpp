// The shader of a pass, run ahead for the values of all its fragments.
#pragma once

#include "pipeline/fragment_stream.hpp"
#include "pipeline/frame.hpp"

namespace pipeline {

/// What the shader is given for the group of sample quads that begins with `first`: all pixels that the triangle
/// covers, as those that an alpha test discards stay with their quad.
ShaderInput shader_input(const FragmentStream& stream, QuadId first);

/// Runs pass.shader, which must not be null, on every group of `stream`: fills its outputs and clears what the shader
/// discards. `surfaces` holds what the shader reads. The result is the same for any number of threads (0 = all cores).
void shade(const Pass& pass, FragmentStream& stream, const SurfaceStore& surfaces, unsigned threads = 0);

/// Room for what its shader makes of each quad.
void make_outputs(const ShaderShape& shape, FragmentStream& stream);
void keep_outputs(const ShaderOutput& output, QuadId quad, FragmentStream& stream);

/// Whether the pass's values can be made where its shader runs for its cost, instead of ahead: nothing asks for a quad
/// before that, and the surfaces that are read stay what they are.
bool shades_late(const Pass& pass, const FragmentStream& stream);

/// The stream as a pass sends it: `stream` itself, or, where its shader has to wait for surfaces, a shaded copy of it
/// that `kept` holds.
const FragmentStream& shade_pass(const Pass& pass, const FragmentStream& stream, const SurfaceStore& surfaces,
                                 FragmentStream& kept, unsigned threads = 0);

} // namespace pipeline
