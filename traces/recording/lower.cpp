#include "traces/recording/lower.hpp"

#include "sim/check.hpp"
#include "traces/recording/recorded_passes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <utility>

namespace traces {

namespace {

pipeline::Frame lower_frames(const Recording& recording, const LowerOptions& options) {
    auto resources = std::make_shared<pipeline::Resources>(*recording.resources);
    const auto screen = static_cast<std::uint32_t>(resources->geometries.size());
    pipeline::Geometry& corners = resources->geometries.emplace_back();
    corners.name = "screen";
    corners.vertex_count = corners.index_count = 3;
    resources->materials.resize(1);
    resources->find_runs();
    resources->place();
    RecordedPasses passes(recording, resources, screen, options.kbuffer);
    for (std::uint32_t i = 0; i <= options.last_frame; ++i) passes.add(recording.frames[i]);

    pipeline::Frame frame;
    frame.workload = "recorded";
    frame.resources = resources;
    frame.draws = std::move(passes.draws);
    const TargetSet& shown = recording.targets.at(recording.frames[options.last_frame].shown);
    frame.view.width = shown.width;
    frame.view.height = shown.height;
    frame.notes = passes.notes();
    frame.output_is_encoded = true;
    for (const auto& target : shown.colours)
        if (target)
            frame.output_is_encoded &= recording.surfaces[target->surface].format != pipeline::SurfaceFormat::srgb8a8;
    frame.program = passes.program();
    if (options.kbuffer && frame.program == nullptr)
        throw sim::InputError(
            fmt::format("--kbuffer: expected a draw that can go through it, found none{}",
                        frame.notes.empty() ? " that blends" : fmt::format(" ({})", fmt::join(frame.notes, "; "))));
    PassGraph graph(std::move(frame));
    for (pipeline::SurfaceInfo& surface : passes.surfaces) graph.add_surface(std::move(surface));
    std::uint32_t number = 0;
    bool begins = true;
    for (RecordedStep& step : passes.steps) {
        if (!step.cleared.empty()) {
            graph.add_clear(fmt::format("clear {}", fmt::join(step.cleared, ", ")), step.cleared);
        } else if (!step.shown.empty()) {
            if (number++ >= options.first_frame) graph.keep(step.shown);
            graph.output(step.shown);
            begins = true;
        } else {
            step.pass.cold = options.cold && std::exchange(begins, false);
            const bool draws = !step.pass.screen;
            graph.add_shaded(std::move(step.pass));
            if (draws) graph.vertex_shader_reads((1U << pipeline::semantics) - 1);
        }
    }
    return graph.lower();
}

} // namespace

LowerOptions LowerOptions::of(const Recording& recording, const std::string& frames, const std::string& kbuffer,
                              std::uint32_t k) {
    LowerOptions options;
    if (frames.empty())
        options.first_frame = options.last_frame = static_cast<std::uint32_t>(recording.frames.size() - 1);
    else if (!parse_range(frames, options.first_frame, options.last_frame))
        throw sim::InputError(fmt::format("--frames: expected FIRST:END or NUMBER, got '{}'", frames));
    if (!kbuffer.empty()) options.kbuffer = KBufferChoice::of(kbuffer, k);
    return options;
}

pipeline::Frame lower(const Recording& recording, const LowerOptions& options, const std::string& where) {
    try {
        if (options.first_frame > options.last_frame || options.last_frame >= recording.frames.size())
            throw sim::InputError(fmt::format("expected frames within 0 to {}, got {} to {}",
                                              recording.frames.size() - 1, options.first_frame, options.last_frame));
        return lower_frames(recording, options);
    } catch (const sim::InputError& error) {
        throw sim::InputError(fmt::format("{}: {}", where, error.what()));
    }
}

} // namespace traces
