// Draws, clears and copies.
#include "traces/record_module/writer.hpp"
#include "traces/recording/import/fixed_state.hpp"
#include "traces/recording/import/stream_import.hpp"
#include "traces/recording/recording_check.hpp"

#include <algorithm>
#include <cstdlib>
#include <fmt/format.h>
#include <iterator>

namespace traces::recorded {

using record_stream::Writer;

namespace {

std::uint32_t size_kind(GLenum mode) {
    return mode == GL_POINTS ? 0 : mode == GL_LINES || mode == GL_LINE_STRIP || mode == GL_LINE_LOOP ? 1 : 2;
}

std::vector<UniformValue> uniforms_of(const record_stream::Draw& draw) {
    std::vector<UniformValue> values;
    for (const record_stream::Value& value : draw.values) values.push_back({value.name, value.words});
    for (const record_stream::Value& block : draw.blocks) values.push_back({block.name, block.words});
    if (!draw.fixed.empty()) {
        std::vector<UniformValue> old = built_in_uniforms(draw.fixed.front(), draw.state);
        values.insert(values.end(), std::move_iterator(old.begin()), std::move_iterator(old.end()));
    }
    return values;
}

} // namespace

std::uint32_t StreamImport::state_of(const record_stream::Draw& draw, bool sizes_points) {
    record_stream::State state = draw.state;
    for (std::size_t i = 0; i < state.targets.size(); ++i) {
        const KnownSurface* const known = surface(draw.targets.colours.at(i).surface);
        if (known == nullptr) continue;
        if (!known->imported.has_alpha) state.targets.at(i).write_mask &= 7U;
        if (known->record.srgb && !is_on(state, GL_FRAMEBUFFER_SRGB))
            count_("sRGB surfaces that are drawn to as linear ones");
    }
    const StateContext context{draw.targets.height, top_row_first(draw.targets), draw.geometry.mode};
    // What is missing counts for each draw, and equal states are made once.
    pipeline::RasterState raster = raster_state_of(state, context, count_);
    if (draw.program < 0 && draw.geometry.mode == GL_POINTS) raster.point_size_of_vertex = sizes_points;
    return states_.number(
        Writer::key(state, context.height, context.top_row_first, size_kind(context.mode), sizes_points),
        [&] { return raster; });
}

std::uint32_t StreamImport::values_of(std::vector<UniformValue> values) {
    std::string key;
    for (const UniformValue& value : values) key += Writer::key(value.name, value.words);
    return values_.number(std::move(key), [&] { return std::move(values); });
}

std::uint32_t StreamImport::bindings_of(const record_stream::Draw& draw) {
    const bool seamless = is_on(draw.state, GL_TEXTURE_CUBE_MAP_SEAMLESS);
    std::vector<TextureBinding> set;
    std::string key;
    for (const record_stream::Binding& binding : draw.bindings) {
        const KnownSurface* const known = surface(binding.surface);
        if (known == nullptr) continue;
        TextureBinding& result = set.emplace_back();
        const bool unit = binding.variable.empty();
        result.variable = unit ? fmt::format("texture{}", binding.element) : binding.variable;
        result.element = unit ? 0 : binding.element;
        result.surface = static_cast<std::uint32_t>(known->number);
        result.sampler = samplers_.number(Writer::key(record_stream::Sampler(binding.sampler), seamless),
                                          [&] { return sampler_of(binding.sampler, seamless); });
        result.swizzle = swizzle_of(binding, known->imported);
        const auto levels = static_cast<std::uint32_t>(recording_.surfaces[result.surface].levels.size());
        result.base_level = std::min(binding.base_level, levels - 1);
        result.last_level = std::max(binding.last_level, result.base_level);
        key += Writer::key(record_stream::Binding(binding), seamless);
    }
    return bindings_.number(std::move(key), [&] { return set; });
}

FixedFunctionProgram StreamImport::fixed_function_of(const record_stream::Draw& draw) {
    std::array<UnitTexture, fixed_function_units> textures;
    for (const record_stream::Binding& binding : draw.bindings)
        if (const KnownSurface* known = surface(binding.surface); known != nullptr && binding.element < textures.size())
            textures.at(binding.element) = unit_texture_of(binding, known->record);
    FixedFunctionState state = fixed_function_state_of(draw.fixed.at(0), draw.state, textures, draw.geometry.mode);
    if (const KnownSurface* const target = surface(draw.targets.colours.at(0).surface); target != nullptr)
        state.alpha_steps = static_cast<float>(pipeline::alpha_steps(target->imported.surface.format));
    return fixed_function_program(state);
}

StreamImport::Shading StreamImport::without_program(const record_stream::Draw& draw) {
    const FixedFunctionProgram program = fixed_function_of(draw);
    Shading shading;
    shading.program = programs_import_.number_of(program);
    shading.vertex_values = values_of(program.vertex_values);
    shading.fragment_values = values_of(program.fragment_values);
    shading.sizes_points = program.sizes_points;
    shading.request.flat = value_in(draw.state, GL_SHADE_MODEL) == GL_FLAT;
    shading.request.fog = fog_of_fixed_function();
    for (std::uint32_t slot = 0; slot < record_stream::slot_generic; ++slot)
        for (const ShaderInputSource& input : program.inputs)
            if (input.first == semantic_of(slot, shading.request.fog)) shading.variables[slot] = input.variable;
    return shading;
}

std::optional<StreamImport::Shading> StreamImport::with_program(const record_stream::Draw& draw) {
    const ImportedProgram& program =
        programs_import_.program_of(programs_.at(static_cast<std::size_t>(draw.program)), draw.program);
    if (!program.problem.empty()) {
        count_(fmt::format("{} with {}", draw.call, program.problem));
        return std::nullopt;
    }
    Shading shading;
    shading.program = program.number;
    shading.vertex_values = shading.fragment_values = values_of(uniforms_of(draw));
    shading.variables = program.variables;
    shading.request = {program.flat, program.numbers, fog_of_programs()};
    return shading;
}

void StreamImport::take_draw(const record_stream::Draw& draw) {
    const auto targets = targets_of(draw.targets);
    if (!targets) {
        count_(draw.call + " to nothing");
        return;
    }
    const auto shading = draw.program < 0 ? std::optional(without_program(draw)) : with_program(draw);
    if (!shading) return;
    record_stream::Geometry read = draw.geometry;
    std::erase_if(read.arrays,
                  [&](const record_stream::Array& array) { return !shading->variables.contains(array.slot); });
    const auto geometry = geometries_.number_of(read, shading->request);
    if (!geometry) return;
    RecordedDraw result;
    result.name = fmt::format("{} {}", draw.call, draws_++);
    result.targets = *targets;
    result.geometry = *geometry;
    result.instances = draw.geometry.instances;
    result.first_instance = draw.geometry.base_instance;
    result.base_vertex = draw.geometry.base_vertex;
    result.program = shading->program;
    result.vertex_values = shading->vertex_values;
    result.fragment_values = shading->fragment_values;
    result.bindings = bindings_of(draw);
    result.state = state_of(draw, shading->sizes_points);
    for (const record_stream::Array& array : read.arrays)
        if (array.blob < 0)
            result.constants.push_back({shading->variables.at(array.slot),
                                        {array.current[0], array.current[1], array.current[2], array.current[3]}});
    if (draw.program >= 0 && is_on(draw.state, GL_ALPHA_TEST)) {
        result.alpha_test = compare_of(static_cast<std::uint32_t>(value_in(draw.state, GL_ALPHA_TEST_FUNC)));
        result.alpha_reference = static_cast<float>(value_in(draw.state, GL_ALPHA_TEST_REF));
    }
    frame_.commands.emplace_back(std::move(result));
}

void StreamImport::take_clear(const record_stream::Clear& clear) {
    const auto targets = targets_of(clear.targets);
    if (!targets) return;
    RecordedClear result;
    result.name = clear.call;
    result.targets = *targets;
    const StateContext context{clear.targets.height, top_row_first(clear.targets), 0};
    for (unsigned i = 0; i < record_stream::most_targets; ++i) {
        const record_stream::Target& target = clear.targets.colours.at(i);
        if ((clear.colours >> i & 1U) == 0 || surface(target.surface) == nullptr) continue;
        result.colours |= static_cast<std::uint8_t>(1U << i);
        const std::uint32_t mask = clear.state.targets.at(i).write_mask;
        result.write_mask.at(i) = static_cast<std::uint8_t>(lacks_alpha(target) ? mask & 7U : mask);
    }
    result.colour = {clear.colour[0], clear.colour[1], clear.colour[2], clear.colour[3]};
    if (clear.depth && surface(clear.targets.depth.surface) != nullptr &&
        value_in(clear.state, GL_DEPTH_WRITEMASK) != 0.0)
        result.depth = std::clamp(clear.depth_value, 0.0F, 1.0F);
    if (clear.stencil && surface(clear.targets.stencil.surface) != nullptr)
        result.stencil = static_cast<std::uint8_t>(clear.stencil_value);
    result.stencil_mask =
        static_cast<std::uint8_t>(static_cast<std::int64_t>(value_in(clear.state, GL_STENCIL_WRITEMASK)));
    if (is_on(clear.state, GL_SCISSOR_TEST)) result.scissor = rectangle_of(clear.state, GL_SCISSOR_BOX, context);
    frame_.commands.emplace_back(std::move(result));
}

void StreamImport::take_copy(const record_stream::Copy& copy) {
    const auto from = target_of(copy.from), to = target_of(copy.to);
    if (!from || !to) {
        count_(copy.call);
        return;
    }
    const LevelSize source = level_size(recording_.surfaces[from->surface], from->level);
    const LevelSize target = level_size(recording_.surfaces[to->surface], to->level);
    const auto overlap = [](std::int64_t at, std::int64_t to_at, std::int64_t size, std::int64_t room,
                            std::int64_t to_room) {
        const std::int64_t begin = std::max({std::int64_t{0}, -at, -to_at});
        const std::int64_t end = std::min({size, room - at, to_room - to_at});
        return std::pair(begin, std::max(end, begin));
    };
    const auto [left, right] = overlap(copy.x, copy.to_x, copy.width, source.width, target.width);
    const auto [low, high] = overlap(copy.y, copy.to_y, copy.height, source.height, target.height);
    if (left == right || low == high) return;
    RecordedCopy result{copy.call,
                        *from,
                        *to,
                        {},
                        static_cast<std::int32_t>(copy.to_x + left),
                        static_cast<std::int32_t>(copy.to_y + low)};
    result.rectangle = {static_cast<std::int32_t>(copy.x + left), static_cast<std::int32_t>(copy.y + low),
                        static_cast<std::uint32_t>(right - left), static_cast<std::uint32_t>(high - low)};
    frame_.commands.emplace_back(std::move(result));
}

// Windows that are copied from or to have their bottom row first, as textures do.
void StreamImport::take_blit(const record_stream::Blit& blit) {
    const auto from = target_of(blit.from), to = target_of(blit.to);
    if (!from || !to) {
        count_(blit.call);
        return;
    }
    const auto side = [](const std::array<std::int32_t, 4>& corners, std::size_t axis) {
        const std::int64_t from_corner = corners.at(axis), to_corner = corners.at(axis + 2);
        return std::pair(std::min(from_corner, to_corner), std::abs(to_corner - from_corner));
    };
    const auto rectangle = [&](const std::array<std::int32_t, 4>& corners) -> std::optional<pipeline::PixelRectangle> {
        const auto [x, width] = side(corners, 0);
        const auto [y, height] = side(corners, 1);
        constexpr std::int64_t most = limits::largest_blit;
        if (std::max({width, height, std::abs(x), std::abs(y)}) > most) return std::nullopt;
        return pipeline::PixelRectangle{static_cast<std::int32_t>(x), static_cast<std::int32_t>(y),
                                        static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
    };
    const auto source = rectangle(blit.source), destination = rectangle(blit.destination);
    if (!source || !destination) {
        count_(fmt::format("{} of more than {} pixels a side", blit.call, limits::largest_blit));
        return;
    }
    if (std::min({source->width, source->height, destination->width, destination->height}) == 0) return;
    const auto backwards = [](const std::array<std::int32_t, 4>& corners, std::size_t axis) {
        return corners.at(axis + 2) < corners.at(axis);
    };
    RecordedBlit result{blit.call, *from, *to, *source, *destination};
    result.mirrored_x = backwards(blit.source, 0) != backwards(blit.destination, 0);
    result.mirrored_y = backwards(blit.source, 1) != backwards(blit.destination, 1);
    result.linear = blit.linear;
    if (blit.scissor_test)
        result.scissor = pipeline::PixelRectangle{blit.scissor[0], blit.scissor[1],
                                                  static_cast<std::uint32_t>(std::max(blit.scissor[2], 0)),
                                                  static_cast<std::uint32_t>(std::max(blit.scissor[3], 0))};
    frame_.commands.emplace_back(std::move(result));
}

} // namespace traces::recorded
