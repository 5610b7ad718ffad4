// The chunks of recorded traces: what is drawn with, and what is done. States are in state_records.cpp.
#include "traces/rtrace/codes.hpp"
#include "traces/rtrace/records.hpp"
#include "traces/rtrace/state_records.hpp"

#include "traces/recording/recording_check.hpp"

#include <type_traits>

namespace traces::rtrace {

namespace {

// The codes of the file: new ones go to the end.
constexpr std::array<Code<SurfaceKind>, 5> surface_kinds{{{SurfaceKind::plane, "plane"},
                                                          {SurfaceKind::layers, "layers"},
                                                          {SurfaceKind::cube, "cube"},
                                                          {SurfaceKind::volume, "volume"},
                                                          {SurfaceKind::buffer, "buffer"}}};
constexpr auto surface_format_codes = [] {
    std::array<Code<pipeline::SurfaceFormat>, pipeline::surface_formats.size()> codes{};
    for (std::size_t i = 0; i < codes.size(); ++i)
        codes[i] = {static_cast<pipeline::SurfaceFormat>(i), pipeline::surface_formats[i].name};
    return codes;
}();
static_assert(surface_format_codes[0].name == "r8" && surface_format_codes[18].name == "s8",
              "surface_format.hpp and FORMAT.md have formats in one order: new ones go to the end");
constexpr std::array<Code<Swizzle>, 6> swizzles{{{Swizzle::red, "red"},
                                                 {Swizzle::green, "green"},
                                                 {Swizzle::blue, "blue"},
                                                 {Swizzle::alpha, "alpha"},
                                                 {Swizzle::zero, "0"},
                                                 {Swizzle::one, "1"}}};
constexpr std::array<std::string_view, 4> commands{"draw", "clear", "copy", "blit"};
static_assert(std::is_same_v<RecordedCommand, std::variant<RecordedDraw, RecordedClear, RecordedCopy, RecordedBlit>>,
              "commands have their codes in this order: new ones go to the end");

constexpr std::size_t least_command_bytes = 34; ///< of a clear without a name

/// A flag says whether there are bytes.
void visit_blob_if_any(Fields& fields, std::string_view name, Document& document, const Place& place) {
    bool any = document.blobs.contains(place);
    fields.flag(name, any);
    if (any) fields.part(name, [&] { fields.blob("bytes", document.blobs[place]); });
}

std::uint64_t instructions_in(std::span<const std::uint32_t> module) {
    std::uint64_t instructions = 0;
    constexpr std::size_t head_words = 5;
    for (std::size_t at = head_words; at < module.size() && module[at] >> 16U != 0; at += module[at] >> 16U)
        ++instructions;
    return instructions;
}

void visit_target(Fields& fields, TargetSet::Target& target) {
    fields.whole("surface", target.surface);
    fields.whole("level", target.level);
    fields.whole("plane", target.plane);
}

void visit_draw(Fields& fields, RecordedDraw& draw) {
    fields.text("name", draw.name);
    fields.whole("targets", draw.targets);
    fields.whole("geometry", draw.geometry);
    fields.whole("instances", draw.instances);
    fields.whole("first instance", draw.first_instance);
    fields.integer("base vertex", draw.base_vertex);
    fields.whole("program", draw.program);
    fields.whole("vertex values", draw.vertex_values);
    fields.whole("fragment values", draw.fragment_values);
    fields.whole("bindings", draw.bindings);
    fields.whole("state", draw.state);
    fields.choice("alpha test", draw.alpha_test, comparisons);
    fields.number("alpha reference", draw.alpha_reference);
    fields.list("constant", draw.constants, 20, [&](ConstantInput& constant, std::size_t) {
        fields.text("variable", constant.variable);
        fields.vector("value", constant.value);
    });
}

void visit_clear(Fields& fields, RecordedClear& clear) {
    fields.text("name", clear.name);
    fields.whole("targets", clear.targets);
    fields.whole("colours", clear.colours);
    fields.vector("colour", clear.colour);
    fields.optional("depth", clear.depth, [&](float& depth) { fields.number("value", depth); });
    fields.optional("stencil", clear.stencil, [&](std::uint8_t& stencil) { fields.whole("value", stencil); });
    fields.whole("stencil mask", clear.stencil_mask);
    fields.optional("scissor", clear.scissor,
                    [&](pipeline::PixelRectangle& scissor) { visit_rectangle(fields, scissor); });
    fields.leading("write mask", clear.write_mask, every_channel, 1, [&](std::uint8_t& mask, std::size_t) {
        fields.whole<std::uint8_t>("channels", mask, 0, every_channel);
    });
}

void visit_copy(Fields& fields, RecordedCopy& copy) {
    fields.text("name", copy.name);
    fields.part("from", [&] { visit_target(fields, copy.from); });
    fields.part("to", [&] { visit_target(fields, copy.to); });
    fields.part("rectangle", [&] { visit_rectangle(fields, copy.rectangle); });
    fields.integer("to x", copy.to_x);
    fields.integer("to y", copy.to_y);
    fields.flag("mirrored", copy.mirrored);
}

void visit_blit(Fields& fields, RecordedBlit& blit) {
    fields.text("name", blit.name);
    fields.part("from", [&] { visit_target(fields, blit.from); });
    fields.part("to", [&] { visit_target(fields, blit.to); });
    fields.part("source", [&] { visit_rectangle(fields, blit.source); });
    fields.part("destination", [&] { visit_rectangle(fields, blit.destination); });
    fields.flag("mirrored x", blit.mirrored_x);
    fields.flag("mirrored y", blit.mirrored_y);
    fields.flag("linear", blit.linear);
    fields.optional("scissor", blit.scissor,
                    [&](pipeline::PixelRectangle& scissor) { visit_rectangle(fields, scissor); });
}

struct CommandFields {
    Fields& fields;
    void operator()(RecordedDraw& draw) const { visit_draw(fields, draw); }
    void operator()(RecordedClear& clear) const { visit_clear(fields, clear); }
    void operator()(RecordedCopy& copy) const { visit_copy(fields, copy); }
    void operator()(RecordedBlit& blit) const { visit_blit(fields, blit); }
};

} // namespace

void visit_surfaces(Fields& fields, Document& document) {
    auto& surfaces = document.trace.recording->surfaces;
    fields.list("surface", surfaces, 26, [&](RecordedSurface& surface, std::size_t i) {
        fields.text("name", surface.name);
        fields.choice("kind", surface.kind, surface_kinds);
        fields.choice("format", surface.format, surface_format_codes);
        fields.whole("width", surface.width);
        fields.whole("height", surface.height);
        fields.whole("depth", surface.depth);
        fields.whole("samples", surface.samples);
        fields.list("level", surface.levels, 1, [&](pipeline::SharedBytes&, std::size_t k) {
            visit_blob_if_any(fields, "contents", document, {Place::Kind::surface_level, i, k});
        });
    });
}

void visit_samplers(Fields& fields, Document& document) {
    fields.list("sampler", document.trace.recording->samplers, 40, [&](RecordedSampler& sampler, std::size_t) {
        fields.choice("wrap u", sampler.wrap_u, wraps);
        fields.choice("wrap v", sampler.wrap_v, wraps);
        fields.choice("wrap w", sampler.wrap_w, wraps);
        fields.choice("minification", sampler.min_filter, filters);
        fields.choice("magnification", sampler.mag_filter, filters);
        fields.vector("border", sampler.border);
        fields.number("LOD bias", sampler.lod_bias);
        fields.number("least LOD", sampler.least_lod);
        fields.number("most LOD", sampler.most_lod);
        fields.number("anisotropy", sampler.anisotropy);
        fields.flag("compares", sampler.compares);
        fields.choice("compare", sampler.compare, comparisons);
        fields.flag("seamless", sampler.seamless);
    });
}

void visit_programs(Fields& fields, Document& document) {
    fields.list("program", document.trace.recording->programs, 10, [&](RecordedProgram& program, std::size_t i) {
        fields.text("name", program.name);
        visit_blob_if_any(fields, "vertex shader", document, {Place::Kind::vertex_module, i, 0});
        fields.derived("vertex instructions", instructions_in(program.vertex));
        visit_blob_if_any(fields, "fragment shader", document, {Place::Kind::fragment_module, i, 0});
        fields.derived("fragment instructions", instructions_in(program.fragment));
        fields.list("input", program.inputs, 5, [&](ShaderInputSource& input, std::size_t) {
            auto first = static_cast<pipeline::Semantic>(input.first);
            fields.text("variable", input.variable);
            fields.choice("first", first, attribute_semantics);
            input.first = static_cast<std::uint32_t>(first);
        });
    });
}

void visit_values(Fields& fields, Document& document) {
    fields.list("values", document.trace.recording->values, 4, [&](std::vector<UniformValue>& set, std::size_t i) {
        fields.list("uniform", set, 9, [&](UniformValue& uniform, std::size_t k) {
            const Place place{Place::Kind::uniform, i, k};
            fields.text("name", uniform.name);
            visit_blob_if_any(fields, "blob", document, place);
            if (!document.blobs.contains(place)) fields.words("words", uniform.words);
        });
    });
}

void visit_bindings(Fields& fields, Document& document) {
    fields.list("bindings", document.trace.recording->bindings, 4, [&](std::vector<TextureBinding>& set, std::size_t) {
        fields.list("texture", set, 28, [&](TextureBinding& texture, std::size_t) {
            constexpr std::array<std::string_view, 4> channels{"red", "green", "blue", "alpha"};
            fields.text("variable", texture.variable);
            fields.whole("element", texture.element);
            fields.whole("surface", texture.surface);
            fields.whole("sampler", texture.sampler);
            for (std::size_t i = 0; i < channels.size(); ++i) fields.choice(channels[i], texture.swizzle[i], swizzles);
            fields.whole("base level", texture.base_level);
            fields.whole("last level", texture.last_level);
        });
    });
}

void visit_targets(Fields& fields, Document& document) {
    fields.list("targets", document.trace.recording->targets, 14, [&](TargetSet& set, std::size_t) {
        fields.whole("width", set.width);
        fields.whole("height", set.height);
        fields.flag("top row first", set.top_row_first);
        fields.optional("depth", set.depth, [&](TargetSet::Target& target) { visit_target(fields, target); });
        const auto visit = [&](std::optional<TargetSet::Target>& colour, std::size_t) {
            fields.optional("target", colour, [&](TargetSet::Target& target) { visit_target(fields, target); });
        };
        fields.list("colour", set.colours, 1, visit, pipeline::most_targets_of_pass);
    });
}

void visit_frames(Fields& fields, Document& document) {
    fields.list("frame", document.trace.recording->frames, 12, [&](RecordedFrame& frame, std::size_t) {
        fields.whole("number", frame.number);
        fields.whole("shown", frame.shown);
        const auto visit = [&](RecordedCommand& command, std::size_t) {
            fields.variant("kind", command, commands, CommandFields{fields});
        };
        fields.list("command", frame.commands, least_command_bytes, visit, limits::most_commands);
    });
}

void visit_not_recorded(Fields& fields, Document& document) {
    fields.list("call", document.trace.recording->not_recorded, 12, [&](NotRecorded& call, std::size_t) {
        fields.text("name", call.call);
        fields.whole("times", call.times);
    });
}

} // namespace traces::rtrace
