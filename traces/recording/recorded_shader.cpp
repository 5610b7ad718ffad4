#include "traces/recording/recorded_shader.hpp"

#include <algorithm>
#include <bit>

namespace traces {

namespace {

using pipeline::Lanes;
using pipeline::ShaderInput;
using pipeline::ShaderOutput;
using spirv::InterfaceVariable;
using spirv::LaneWords;

void set_vector(spirv::Quad& quad, const InterfaceVariable& variable, std::uint32_t first, std::uint32_t components,
                const pipeline::QuadTexels& values) {
    for (std::uint32_t i = 0; i < components; ++i) {
        LaneWords words;
        for (std::size_t lane = 0; lane < 4; ++lane)
            words[lane] = std::bit_cast<std::uint32_t>(values[lane][static_cast<int>(i)]);
        quad.set_words(variable, first + i, words);
    }
}

// Pixel centres, y upwards in clip space; 1/w.
pipeline::QuadTexels window_places(const FragmentUse& use, const ShaderInput& input) {
    pipeline::QuadTexels places;
    for (std::size_t lane = 0; lane < 4; ++lane) {
        const auto row = static_cast<float>(input.y + (lane >> 1U)) + 0.5F;
        places[lane] = {static_cast<float>(input.x + (lane & 1U)) + 0.5F,
                        use.top_row_first ? static_cast<float>(use.height) - row : row, input.depth[lane],
                        1.0F / input.varyings[0][lane].x};
    }
    return places;
}

// From the upper left corner of what is drawn.
pipeline::QuadTexels point_places(const FragmentUse& use, const ShaderInput& input) {
    pipeline::QuadTexels places{};
    for (std::size_t lane = 0; lane < 4; ++lane) {
        const glm::vec4& given = input.varyings[0][lane];
        places[lane] = {given.y, use.top_row_first ? given.z : 1.0F - given.z, 0.0F, 0.0F};
    }
    return places;
}

void set_inputs(spirv::Quad& quad, const FragmentUse& use, const ShaderInput& input) {
    const spirv::Program& program = use.program->fragment->program;
    const std::vector<LinkedVarying>& varyings = use.program->varyings;
    for (std::size_t i = 0; i < varyings.size(); ++i)
        set_vector(quad, *varyings[i].input, varyings[i].first, varyings[i].components, input.varyings[i + 1]);
    for (const InterfaceVariable& variable : program.inputs) {
        if (!variable.decorations.built_in) continue;
        switch (*variable.decorations.built_in) {
        case built_in::frag_coord:
            set_vector(quad, variable, 0, 4, window_places(use, input));
            break;
        case built_in::point_coord:
            set_vector(quad, variable, 0, 2, point_places(use, input));
            break;
        case built_in::front_facing: {
            const std::uint32_t word = input.front != use.front_is_clockwise ? ~0U : 0U;
            quad.set_words(variable, 0, {word, word, word, word});
            break;
        }
        default:
            break;
        }
    }
}

glm::vec4 vector_of(const spirv::Quad& quad, const InterfaceVariable& output, std::uint32_t first, std::size_t lane) {
    glm::vec4 value(0.0F, 0.0F, 0.0F, 1.0F);
    for (std::uint32_t i = 0; i < output.components; ++i)
        value[static_cast<int>(i)] = quad.get(output, first + i)[lane];
    return value;
}

// An output without a location goes to all targets (GLSL 1.20's gl_FragColor).
void take_outputs(const spirv::Quad& quad, const spirv::Program& program, std::uint32_t outputs, ShaderOutput& output) {
    for (const InterfaceVariable& variable : program.outputs) {
        if (variable.decorations.built_in) continue;
        const bool everywhere = variable.name == "gl_FragColor";
        const std::uint32_t first = everywhere ? 0 : variable.decorations.location.value_or(0);
        const std::uint32_t count = everywhere ? outputs : variable.elements;
        for (std::uint32_t i = 0; i < count && first + i < outputs; ++i)
            for (std::size_t lane = 0; lane < 4; ++lane)
                output.colours[first + i][lane] =
                    vector_of(quad, variable, everywhere ? 0 : i * variable.components, lane);
    }
    if (const InterfaceVariable* depth = program.output("gl_FragDepth"); depth != nullptr && program.entry.sets_depth)
        output.depth = quad.get(*depth, 0);
}

void test_alpha(const FragmentUse& use, ShaderOutput& output) {
    for (std::size_t lane = 0; lane < 4; ++lane)
        if (!passes(use.alpha_test, in_alpha_steps(output.colours[0][lane].a, use.alpha_steps), use.alpha_reference))
            output.alive &= ~(1U << lane);
}

/// Along one axis of a copy: where on the source the centre of a pixel lies, as a fraction of whole numbers.
struct SourcePlace {
    std::int64_t parts = 0, of_texel = 1;

    SourcePlace(std::int32_t pixel, std::int32_t first_pixel, std::uint32_t pixels, std::int32_t first_texel,
                std::uint32_t texels, bool mirrored)
        : of_texel(std::int64_t{2} * pixels) {
        const std::int64_t along = (std::int64_t{2} * (std::int64_t{pixel} - first_pixel) + 1) * texels;
        parts = first_texel * of_texel + (mirrored ? of_texel * texels - along : along);
    }
    /// Rounded down.
    std::int32_t texel() const { return static_cast<std::int32_t>(parts / of_texel - (parts % of_texel < 0 ? 1 : 0)); }
    float share_of(std::uint32_t size) const {
        return static_cast<float>(static_cast<double>(parts) / static_cast<double>(of_texel * size));
    }
};

void copy_texels(const CopiedTexels& copied, const ShaderInput& input, pipeline::SurfaceAccess& surfaces,
                 ShaderOutput& output) {
    const pipeline::QuadPlaces at(input);
    const pipeline::SurfaceInfo& info = surfaces.info(copied.slot);
    const std::uint32_t width = info.width_of(copied.level), height = info.height_of(copied.level);
    pipeline::LaneIndices x{}, row{};
    Lanes u{}, v{};
    unsigned inside = 0;
    for (std::size_t lane = 0; lane < 4; ++lane) {
        const SourcePlace across(at.x[lane], copied.destination.x, copied.destination.width, copied.source.x,
                                 copied.source.width, copied.mirrored_x);
        const SourcePlace down(at.y[lane], copied.destination.y, copied.destination.height, copied.source.y,
                               copied.source.height, copied.mirrored_y);
        x[lane] = across.texel();
        row[lane] = down.texel();
        u[lane] = across.share_of(width);
        v[lane] = down.share_of(height);
        const bool on_surface = x[lane] >= 0 && row[lane] >= 0 && static_cast<std::uint32_t>(x[lane]) < width &&
                                static_cast<std::uint32_t>(row[lane]) < height;
        if (on_surface) inside |= 1U << lane;
    }
    output.alive &= inside;
    surfaces.issue(1, input.pixels);
    const pipeline::QuadTexels texels =
        copied.linear ? surfaces.sample_level(copied.slot, {.linear = true}, u, v, input.pixels,
                                              static_cast<float>(copied.level), copied.plane)
                      : surfaces.fetch(copied.slot, x, row, input.pixels, copied.plane, copied.level);
    if (!copied.depths) output.colours[0] = texels;
    for (std::size_t lane = 0; copied.depths && lane < 4; ++lane) output.depth[lane] = texels[lane].r;
}

} // namespace

std::unique_ptr<spirv::Quad> QuadPool::take(const spirv::Program& program, const std::vector<std::uint32_t>& uniforms) {
    {
        const std::lock_guard lock(mutex_);
        if (!idle_.empty()) {
            std::unique_ptr<spirv::Quad> quad = std::move(idle_.back());
            idle_.pop_back();
            return quad;
        }
    }
    auto quad = std::make_unique<spirv::Quad>(program);
    quad->set_uniforms(uniforms);
    return quad;
}

void QuadPool::give_back(std::unique_ptr<spirv::Quad> quad) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(quad));
}

RecordedShader::RecordedShader(std::uint32_t outputs, std::uint32_t reads, std::uint32_t first_draw,
                               std::vector<FragmentUse> uses)
    : first_draw_(first_draw), uses_(std::move(uses)) {
    shape_.outputs = std::max(1U, outputs);
    shape_.reads = reads;
    shape_.registers = 1;
    for (const FragmentUse& use : uses_) {
        shape_.sets_depth |= use.copied && use.copied->depths;
        if (use.program == nullptr || !use.program->fragment) continue;
        shape_.registers = std::max(shape_.registers, use.program->fragment->registers);
        shape_.sets_depth |= use.program->fragment->program.entry.sets_depth;
    }
}

void RecordedShader::run(const FragmentUse& use, const ShaderInput& input, pipeline::SurfaceAccess& surfaces,
                         ShaderOutput& output) const {
    const spirv::Program& program = use.program->fragment->program;
    std::unique_ptr<spirv::Quad> quad = use.pool->take(program, *use.uniforms);
    set_inputs(*quad, use, input);
    BoundTextures textures(surfaces, *use.textures);
    quad->run(textures, input.pixels);
    for (std::uint32_t lane = 0; lane < 4; ++lane)
        if ((input.pixels >> lane & 1U) != 0) surfaces.issue(quad->instructions()[lane], 1U << lane);
    output.alive &= quad->alive();
    take_outputs(*quad, program, shape_.outputs, output);
    use.pool->give_back(std::move(quad));
}

void RecordedShader::shade(const ShaderInput& input, pipeline::SurfaceAccess& surfaces, ShaderOutput& output) const {
    const FragmentUse& use = uses_[input.draw - first_draw_];
    if (use.program != nullptr && use.program->fragment) {
        run(use, input, surfaces, output);
        if (use.alpha_test != pipeline::Compare::always) test_alpha(use, output);
        if (use.node)
            for (glm::vec4& colour : output.colours[0]) colour = use.node->node(colour);
    } else if (use.copied) {
        copy_texels(*use.copied, input, surfaces, output);
    } else {
        for (auto& colours : output.colours) colours.fill(use.colour);
    }
}

} // namespace traces
