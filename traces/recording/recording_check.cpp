#include "traces/recording/recording_check.hpp"

#include "pipeline/functional/sample_pattern.hpp"
#include "pipeline/functional/vertex_fetch.hpp"
#include "pipeline/functional/vertex_transform.hpp"
#include "sim/check.hpp"
#include "traces/spirv/program.hpp"

#include <algorithm>
#include <bit>
#include <fmt/format.h>
#include <string_view>

namespace traces {

namespace {

/// A part of a recording, for what is said about it.
class RecordedPart {
  public:
    RecordedPart(const std::string& where, std::string_view kind, std::size_t i) : where_(where), kind_(kind), i_(i) {}
    RecordedPart inside(std::string_view kind, std::size_t i) const {
        RecordedPart part = *this;
        part.inner_ = kind;
        part.k_ = i;
        return part;
    }

    template <class... Arguments>
    void require(bool good, fmt::format_string<Arguments...> expected, Arguments&&... arguments) const {
        if (good) return;
        const std::string inner = inner_.empty() ? "" : fmt::format(" {} {}", inner_, k_);
        throw sim::InputError(fmt::format("{}: {} {}{}: expected {}", where_, kind_, i_, inner,
                                          fmt::format(expected, std::forward<Arguments>(arguments)...)));
    }
    /// That a number names one of so many.
    void names(std::string_view kind, std::uint64_t number, std::size_t count) const {
        require(number < count, "one of {} {}, got {}", count, kind, number);
    }

  private:
    const std::string& where_;
    std::string_view kind_, inner_;
    std::size_t i_, k_ = 0;
};

std::uint32_t most_levels(const RecordedSurface& surface) {
    if (surface.kind == SurfaceKind::buffer || surface.samples > 1) return 1;
    const std::uint32_t depth = surface.kind == SurfaceKind::volume ? surface.depth : 1;
    return static_cast<std::uint32_t>(std::bit_width(std::max({surface.width, surface.height, depth})));
}

void check_extent(const RecordedSurface& surface, const RecordedPart& part) {
    const bool buffer = surface.kind == SurfaceKind::buffer;
    const bool deep = surface.kind == SurfaceKind::layers || surface.kind == SurfaceKind::volume;
    const std::uint32_t widest = buffer ? limits::longest_buffer : limits::largest_surface;
    const std::uint32_t highest = buffer ? 1 : limits::largest_surface, deepest = deep ? limits::most_layers : 1;
    part.require(surface.width >= 1 && surface.width <= widest && surface.height >= 1 && surface.height <= highest &&
                     surface.depth >= 1 && surface.depth <= deepest,
                 "1 to {} x {} x {} texels, got {} x {} x {}", widest, highest, deepest, surface.width, surface.height,
                 surface.depth);
    part.require(surface.kind != SurfaceKind::cube || surface.width == surface.height,
                 "square faces of a cube, got {} x {}", surface.width, surface.height);
    const bool flat = surface.kind == SurfaceKind::plane || surface.kind == SurfaceKind::layers;
    part.require(pipeline::is_sample_count(surface.samples) && (surface.samples == 1 || flat),
                 "1 sample, or of planes and layers 4 or 8, got {}", surface.samples);
}

void check_surface(const RecordedSurface& surface, const RecordedPart& part) {
    check_extent(surface, part);
    const std::size_t levels = surface.levels.size();
    part.require(levels >= 1 && levels <= most_levels(surface), "1 to {} levels, got {}", most_levels(surface), levels);
    for (std::uint32_t level = 0; level < levels; ++level) {
        const std::uint64_t bytes = surface.levels[level].size();
        if (bytes == 0) continue;
        part.require(surface.samples == 1, "no contents with several samples, got {} bytes", bytes);
        part.require(bytes == level_bytes(surface, level), "{} bytes in level {}, got {}", level_bytes(surface, level),
                     level, bytes);
    }
}

void check_sampler(const RecordedSampler& sampler, const RecordedPart& part) {
    part.require(sampler.mag_filter <= pipeline::Filter::linear, "magnification that is nearest or linear");
    part.require(sampler.anisotropy >= 1.0F, "an anisotropy of 1 or more, got {}", sampler.anisotropy);
}

void check_program(const RecordedProgram& program, const RecordedPart& part) {
    constexpr std::size_t least = 5; // the head of a module
    const auto good = [](std::size_t words) { return words >= least && words <= limits::most_module_words; };
    part.require(good(program.vertex.size()), "{} to {} words of a vertex shader, got {}", least,
                 limits::most_module_words, program.vertex.size());
    part.require(program.fragment.empty() || good(program.fragment.size()),
                 "{} to {} words of a fragment shader, or none, got {}", least, limits::most_module_words,
                 program.fragment.size());
    for (const ShaderInputSource& input : program.inputs) part.names("attributes", input.first, pipeline::semantics);
}

void check_state(const pipeline::RasterState& state, const RecordedPart& part) {
    part.require(!state.viewport || pipeline::is_usable(*state.viewport),
                 "a viewport of 1 to {} pixels a side, at most {} away", pipeline::largest_viewport,
                 pipeline::farthest_viewport);
    part.require(pipeline::is_usable(state.depth), "a depth range within 0 to 1, got {} to {}", state.depth.range_near,
                 state.depth.range_far);
    for (const std::uint8_t mask : state.write_mask) part.require(mask < 16, "a write mask below 16, got {}", mask);
}

/// Everything that names something else.
class NumberCheck {
  public:
    NumberCheck(const Recording& recording, const std::string& where) : recording_(recording), where_(where) {}

    void check() const {
        check_each("bindings", recording_.bindings, &NumberCheck::check_bindings);
        check_each("targets", recording_.targets, &NumberCheck::check_targets);
        check_each("geometry", recording_.resources->geometries, &NumberCheck::check_geometry);
        check_each("frame", recording_.frames, &NumberCheck::check_frame);
        std::size_t commands = 0;
        for (std::size_t i = 0; i < recording_.frames.size(); ++i) {
            const RecordedPart part(where_, "frame", i);
            commands += recording_.frames[i].commands.size();
            part.require(commands <= limits::most_commands, "at most {} commands up to here, got {}",
                         limits::most_commands, commands);
            part.require(i == 0 || recording_.frames[i].number > recording_.frames[i - 1].number,
                         "numbers of frames that grow, got {}", recording_.frames[i].number);
        }
    }

  private:
    template <class T>
    void check_each(std::string_view kind, const std::vector<T>& parts,
                    void (NumberCheck::*check)(const T&, const RecordedPart&) const) const {
        for (std::size_t i = 0; i < parts.size(); ++i) (this->*check)(parts[i], RecordedPart(where_, kind, i));
    }

    void check_bindings(const std::vector<TextureBinding>& set, const RecordedPart& part) const {
        for (std::size_t i = 0; i < set.size(); ++i) {
            const RecordedPart texture = part.inside("texture", i);
            texture.names("surfaces", set[i].surface, recording_.surfaces.size());
            texture.names("samplers", set[i].sampler, recording_.samplers.size());
            const std::size_t levels = recording_.surfaces[set[i].surface].levels.size();
            texture.require(set[i].base_level < levels && set[i].base_level <= set[i].last_level,
                            "a base level of {} levels, and a last one that is not before it, got {} and {}", levels,
                            set[i].base_level, set[i].last_level);
        }
    }

    const RecordedSurface& check_target(const TargetSet::Target& target, const RecordedPart& part) const {
        part.names("surfaces", target.surface, recording_.surfaces.size());
        const RecordedSurface& surface = recording_.surfaces[target.surface];
        part.require(surface.kind != SurfaceKind::buffer, "a surface that is no buffer, got {}", target.surface);
        part.names("levels", target.level, surface.levels.size());
        part.names("planes", target.plane, level_size(surface, target.level).planes);
        return surface;
    }

    void check_targets(const TargetSet& set, const RecordedPart& part) const {
        part.require(set.width >= 1 && set.width <= limits::largest_surface && set.height >= 1 &&
                         set.height <= limits::largest_surface,
                     "1 to {} x {} pixels, got {} x {}", limits::largest_surface, limits::largest_surface, set.width,
                     set.height);
        part.require(set.colours.size() <= pipeline::most_targets_of_pass, "at most {} colours, got {}",
                     pipeline::most_targets_of_pass, set.colours.size());
        std::uint32_t samples = 0;
        const auto check_one = [&](const TargetSet::Target& target, bool colour) {
            const RecordedSurface& surface = check_target(target, part);
            const LevelSize size = level_size(surface, target.level);
            part.require(pipeline::is_colour(surface.format) == colour, "{} in surface {}, got {}",
                         colour ? "colours" : "depths or stencil", target.surface,
                         pipeline::info_of(surface.format).name);
            part.require(set.width <= size.width && set.height <= size.height,
                         "at most the {} x {} texels of surface {}, got {} x {}", size.width, size.height,
                         target.surface, set.width, set.height);
            part.require(samples == 0 || surface.samples == samples,
                         "{} samples as in the others, got {} in surface {}", samples, surface.samples, target.surface);
            samples = surface.samples;
        };
        for (const auto& colour : set.colours)
            if (colour) check_one(*colour, true);
        if (set.depth) check_one(*set.depth, false);
    }

    void check_geometry(const pipeline::Geometry& geometry, const RecordedPart& part) const {
        const bool bounded = std::any_of(geometry.attributes.begin(), geometry.attributes.end(),
                                         [](const pipeline::VertexAttribute& one) { return one.divisor == 0; });
        part.require(bounded || geometry.vertex_count <= limits::most_vertices,
                     "at most {} vertices without an attribute, got {}", limits::most_vertices, geometry.vertex_count);
    }

    void check_frame(const RecordedFrame& frame, const RecordedPart& part) const {
        part.names("targets", frame.shown, recording_.targets.size());
        const TargetSet& shown = recording_.targets[frame.shown];
        part.require(!shown.colours.empty() && shown.colours[0], "a first colour in targets {}, which it shows",
                     frame.shown);
        for (std::size_t i = 0; i < frame.commands.size(); ++i)
            std::visit([&](const auto& command) { check_command(command, part.inside("command", i)); },
                       frame.commands[i]);
    }

    void check_command(const RecordedDraw& draw, const RecordedPart& part) const {
        const pipeline::Resources& resources = *recording_.resources;
        part.names("targets", draw.targets, recording_.targets.size());
        part.names("geometries", draw.geometry, resources.geometries.size());
        part.names("programs", draw.program, recording_.programs.size());
        part.names("sets of values", draw.vertex_values, recording_.values.size());
        part.names("sets of values", draw.fragment_values, recording_.values.size());
        part.names("sets of bindings", draw.bindings, recording_.bindings.size());
        part.names("states", draw.state, recording_.states.size());
        part.require(draw.instances >= 1 && draw.instances <= limits::most_instances, "1 to {} instances, got {}",
                     limits::most_instances, draw.instances);
        for (const pipeline::VertexAttribute& attribute : resources.geometries[draw.geometry].attributes)
            part.require(pipeline::has_elements_for(resources, attribute, draw.instances),
                         "{} elements of an attribute with divisor {}",
                         (draw.instances - 1) / std::max(1U, attribute.divisor) + 1, attribute.divisor);
    }

    void check_command(const RecordedClear& clear, const RecordedPart& part) const {
        part.names("targets", clear.targets, recording_.targets.size());
        const TargetSet& set = recording_.targets[clear.targets];
        for (std::uint32_t i = 0; i < pipeline::most_targets_of_pass; ++i) {
            part.require(clear.write_mask[i] < 16, "a write mask below 16, got {}", clear.write_mask[i]);
            part.require((clear.colours >> i & 1U) == 0 || (i < set.colours.size() && set.colours[i]),
                         "a colour {} in targets {}", i, clear.targets);
        }
        const auto format = set.depth ? std::optional(recording_.surfaces[set.depth->surface].format) : std::nullopt;
        part.require(!clear.depth || (format && pipeline::has_depth(*format)), "a depth in targets {}", clear.targets);
        part.require(!clear.stencil || (format && pipeline::has_stencil(*format)), "a stencil in targets {}",
                     clear.targets);
    }

    void check_command(const RecordedCopy& copy, const RecordedPart& part) const {
        const RecordedSurface &from = check_target(copy.from, part), &to = check_target(copy.to, part);
        check_inside(copy.rectangle, from, copy.from.level, part);
        check_inside({copy.to_x, copy.to_y, copy.rectangle.width, copy.rectangle.height}, to, copy.to.level, part);
        part.require(pipeline::is_colour(from.format) == pipeline::is_colour(to.format),
                     "colours to colours, or depths to depths, got {} to {}", pipeline::info_of(from.format).name,
                     pipeline::info_of(to.format).name);
    }

    void check_command(const RecordedBlit& blit, const RecordedPart& part) const {
        const RecordedSurface &from = check_target(blit.from, part), &to = check_target(blit.to, part);
        const auto good = [](std::int32_t begin, std::uint32_t size) {
            constexpr std::int64_t largest = limits::largest_blit;
            return size >= 1 && size <= largest && begin >= -largest && begin <= largest;
        };
        for (const pipeline::PixelRectangle& one : {blit.source, blit.destination})
            part.require(good(one.x, one.width) && good(one.y, one.height),
                         "rectangles of 1 to {0} texels a side, at most {0} away, got {1} x {2} at ({3}, {4})",
                         limits::largest_blit, one.width, one.height, one.x, one.y);
        part.require(pipeline::is_colour(from.format) == pipeline::is_colour(to.format) &&
                         (pipeline::is_colour(to.format) || !blit.linear),
                     "colours to colours, or unfiltered depths to depths, got {} to {}",
                     pipeline::info_of(from.format).name, pipeline::info_of(to.format).name);
    }

    static void check_inside(const pipeline::PixelRectangle& texels, const RecordedSurface& surface,
                             std::uint32_t level, const RecordedPart& part) {
        const LevelSize size = level_size(surface, level);
        part.require(
            texels.x >= 0 && std::uint64_t{texels.width} + static_cast<std::uint32_t>(texels.x) <= size.width &&
                texels.y >= 0 && std::uint64_t{texels.height} + static_cast<std::uint32_t>(texels.y) <= size.height,
            "a rectangle within {} x {} texels, got {} x {} at ({}, {})", size.width, size.height, texels.width,
            texels.height, texels.x, texels.y);
    }

    const Recording& recording_;
    const std::string& where_;
};

} // namespace

void check_recording(const Recording& recording, const std::string& where) {
    CHECK(recording.resources && recording.resources->textures.empty() && recording.resources->materials.empty());
    const auto check_each = [&where](std::string_view kind, const auto& parts, auto check) {
        for (std::size_t i = 0; i < parts.size(); ++i) check(parts[i], RecordedPart(where, kind, i));
    };
    check_each("surface", recording.surfaces, check_surface);
    check_each("sampler", recording.samplers, check_sampler);
    check_each("program", recording.programs, check_program);
    check_each("state", recording.states, check_state);
    recording.resources->validate(where, pipeline::Positions::computed);
    NumberCheck(recording, where).check();
}

std::vector<std::string> module_faults(const Recording& recording, const std::string& where) {
    std::vector<std::string> faults;
    for (std::size_t i = 0; i < recording.programs.size(); ++i) {
        const RecordedProgram& program = recording.programs[i];
        const auto check = [&](std::string_view stage, std::span<const std::uint32_t> words) {
            try {
                const spirv::Module module(words);
                const spirv::Program resolved(module);
            } catch (const sim::InputError& error) {
                faults.push_back(
                    fmt::format("{}: program {} \"{}\": {} shader: {}", where, i, program.name, stage, error.what()));
            }
        };
        check("vertex", program.vertex);
        if (!program.fragment.empty()) check("fragment", program.fragment);
    }
    return faults;
}

} // namespace traces
