#include "traces/recording/cut.hpp"

#include "sim/check.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <map>
#include <set>
#include <span>

namespace traces {

namespace {

/// Surface, level, plane.
using SurfacePlane = std::array<std::uint32_t, 3>;
SurfacePlane plane_of(const TargetSet::Target& target) { return {target.surface, target.level, target.plane}; }

/// Whether a rectangle, or none, covers so many texels.
bool covers(const std::optional<pipeline::PixelRectangle>& texels, std::uint32_t width, std::uint32_t height) {
    return !texels || (texels->x <= 0 && texels->y <= 0 && std::int64_t{texels->x} + texels->width >= width &&
                       std::int64_t{texels->y} + texels->height >= height);
}

/// Going backwards through commands: of which planes it matters what they hold. Those that no command writes are left
/// out: they hold what they held.
class NeededPlanes {
  public:
    explicit NeededPlanes(const Recording& recording) : recording_(recording) {
        for (const RecordedFrame& frame : recording.frames)
            for (const RecordedCommand& command : frame.commands) {
                const std::vector<SurfacePlane> planes = written_by(command);
                written_.insert(planes.begin(), planes.end());
                std::visit([&](const auto& one) { note_channels(one); }, command);
            }
    }

    /// Whether a command makes something that is needed behind it.
    bool needs(const RecordedCommand& command) const {
        const std::vector<SurfacePlane> planes = written_by(command);
        return std::any_of(planes.begin(), planes.end(),
                           [&](const SurfacePlane& one) { return needed_.contains(one); });
    }
    void show(const RecordedFrame& frame) {
        const TargetSet& shown = recording_.targets.at(frame.shown);
        if (!shown.colours.empty() && shown.colours[0]) needed_.insert(plane_of(*shown.colours[0]));
    }
    /// From what is needed behind a command to what is needed before it.
    void go_before(const RecordedCommand& command) {
        std::visit([&](const auto& one) { before(one); }, command);
    }
    /// Contents that are set before anything sees them go; channels that nothing writes keep theirs.
    void forget_contents(std::vector<RecordedSurface>& surfaces) const {
        for (const SurfacePlane& plane : written_)
            if (!needed_.contains(plane)) forget(surfaces.at(plane[0]), plane);
    }

  private:
    const TargetSet& targets(std::uint32_t number) const { return recording_.targets.at(number); }

    std::vector<SurfacePlane> written_by(const RecordedCommand& command) const {
        return std::visit([&](const auto& one) { return written(one); }, command);
    }
    std::vector<SurfacePlane> written(const RecordedDraw& draw) const {
        std::vector<SurfacePlane> planes;
        for (const auto& colour : targets(draw.targets).colours)
            if (colour) planes.push_back(plane_of(*colour));
        if (const auto& depth = targets(draw.targets).depth) planes.push_back(plane_of(*depth));
        return planes;
    }
    std::vector<SurfacePlane> written(const RecordedClear& clear) const {
        std::vector<SurfacePlane> planes;
        const TargetSet& set = targets(clear.targets);
        for (std::size_t i = 0; i < set.colours.size(); ++i)
            if (set.colours[i] && (clear.colours >> i & 1U) != 0) planes.push_back(plane_of(*set.colours[i]));
        if (set.depth && (clear.depth || clear.stencil)) planes.push_back(plane_of(*set.depth));
        return planes;
    }
    static std::vector<SurfacePlane> written(const RecordedCopy& copy) { return {plane_of(copy.to)}; }
    static std::vector<SurfacePlane> written(const RecordedBlit& blit) { return {plane_of(blit.to)}; }

    // Which channels of a plane anything writes: a window without alpha is wholly set by a clear of three channels.
    void note_channels(const RecordedDraw& draw) {
        const TargetSet& set = targets(draw.targets);
        for (std::size_t i = 0; i < set.colours.size(); ++i)
            if (set.colours[i])
                channels_[plane_of(*set.colours[i])] |= recording_.states.at(draw.state).write_mask.at(i);
    }
    void note_channels(const RecordedClear& clear) {
        const TargetSet& set = targets(clear.targets);
        for (std::size_t i = 0; i < set.colours.size(); ++i)
            if (set.colours[i] && (clear.colours >> i & 1U) != 0)
                channels_[plane_of(*set.colours[i])] |= clear.write_mask.at(i);
    }
    void note_channels(const auto& copy) { channels_[plane_of(copy.to)] = every_channel; }

    /// The bytes of a plane become 0, but for those of channels that nothing writes.
    void forget(RecordedSurface& surface, const SurfacePlane& plane) const {
        pipeline::SharedBytes& held = surface.levels.at(plane[1]);
        std::vector<std::byte> level(held.begin(), held.end());
        const std::size_t bytes = level.size() / level_size(surface, plane[1]).planes;
        const std::span<std::byte> own = std::span(level).subspan(plane[2] * bytes, bytes);
        const auto channels = channels_.find(plane);
        if (!pipeline::is_colour(surface.format) || channels == channels_.end() || channels->second == every_channel)
            std::fill(own.begin(), own.end(), std::byte{0});
        else if (surface.format == pipeline::SurfaceFormat::rgba8)
            for (std::size_t i = 0; i < own.size(); ++i)
                if ((channels->second >> i % 4 & 1U) != 0) own[i] = std::byte{0};
        // A level without bytes is 0.
        if (std::all_of(level.begin(), level.end(), [](std::byte one) { return one == std::byte{0}; })) level.clear();
        held = std::move(level);
    }

    // A draw leaves pixels as they are, blends and compares: it needs its targets.
    void before(const RecordedDraw& draw) {
        for (const SurfacePlane& plane : written(draw)) needed_.insert(plane);
        for (const TextureBinding& texture : recording_.bindings.at(draw.bindings))
            for (auto plane = written_.lower_bound({texture.surface, 0, 0});
                 plane != written_.end() && (*plane)[0] == texture.surface; ++plane)
                needed_.insert(*plane);
    }
    void before(const RecordedClear& clear) {
        const TargetSet& set = targets(clear.targets);
        const auto whole = [&](const TargetSet::Target& target) {
            const LevelSize size = level_size(recording_.surfaces.at(target.surface), target.level);
            return set.width == size.width && set.height == size.height && covers(clear.scissor, set.width, set.height);
        };
        const auto every_channel_that_is_written = [&](std::size_t i) {
            return (channels_.at(plane_of(*set.colours[i])) & ~clear.write_mask.at(i)) == 0;
        };
        constexpr std::uint8_t every_bit = 255;
        for (std::size_t i = 0; i < set.colours.size(); ++i)
            if (set.colours[i] && (clear.colours >> i & 1U) != 0 && every_channel_that_is_written(i) &&
                whole(*set.colours[i]))
                needed_.erase(plane_of(*set.colours[i]));
        if (!set.depth) return;
        const pipeline::SurfaceFormat format = recording_.surfaces.at(set.depth->surface).format;
        const bool depths = clear.depth || !pipeline::has_depth(format);
        const bool stencil = (clear.stencil && clear.stencil_mask == every_bit) || !pipeline::has_stencil(format);
        if (depths && stencil && whole(*set.depth)) needed_.erase(plane_of(*set.depth));
    }
    void before(const RecordedCopy& copy) {
        const LevelSize size = level_size(recording_.surfaces.at(copy.to.surface), copy.to.level);
        const pipeline::PixelRectangle to{copy.to_x, copy.to_y, copy.rectangle.width, copy.rectangle.height};
        if (covers(to, size.width, size.height)) needed_.erase(plane_of(copy.to));
        needed_.insert(plane_of(copy.from));
    }
    void before(const RecordedBlit& blit) {
        const auto size = [&](const TargetSet::Target& target) {
            return level_size(recording_.surfaces.at(target.surface), target.level);
        };
        const LevelSize from = size(blit.from), to = size(blit.to);
        const pipeline::PixelRectangle& source = blit.source;
        const bool within = source.x >= 0 && source.y >= 0 && std::int64_t{source.x} + source.width <= from.width &&
                            std::int64_t{source.y} + source.height <= from.height;
        if (within && covers(blit.destination, to.width, to.height) && covers(blit.scissor, to.width, to.height))
            needed_.erase(plane_of(blit.to));
        needed_.insert(plane_of(blit.from));
    }

    static constexpr std::uint8_t every_channel = 15;

    const Recording& recording_;
    std::set<SurfacePlane> written_, needed_;
    std::map<SurfacePlane, std::uint8_t> channels_; ///< of colours that are written: bit 0 is red
};

std::size_t draws_in(const RecordedFrame& frame) {
    return static_cast<std::size_t>(
        std::count_if(frame.commands.begin(), frame.commands.end(),
                      [](const RecordedCommand& one) { return std::holds_alternative<RecordedDraw>(one); }));
}

void keep_draws(RecordedFrame& frame, const CutRange& range, const Recording& recording) {
    if (const std::size_t draws = draws_in(frame); range.first >= range.end || range.end > draws)
        throw sim::InputError(fmt::format("expected draws within 0:{} of frame {}, at least one, got {}:{}", draws,
                                          frame.number, range.first, range.end));
    std::vector<RecordedCommand> kept;
    std::uint32_t number = 0;
    for (const RecordedCommand& command : frame.commands) {
        const auto* const draw = std::get_if<RecordedDraw>(&command);
        if (draw == nullptr || number >= range.first) kept.push_back(command);
        if (draw == nullptr || ++number < range.end) continue;
        const TargetSet& targets = recording.targets.at(draw->targets);
        if (!targets.colours.empty() && targets.colours[0]) frame.shown = draw->targets;
        break;
    }
    frame.commands = std::move(kept);
}

} // namespace

Recording cut(const Recording& recording, const Cut& what) {
    const auto number_below = [](const RecordedFrame& frame, std::uint32_t number) { return frame.number < number; };
    const auto& all = recording.frames;
    auto first = all.begin(), end = all.end();
    if (what.frames) {
        first = std::lower_bound(all.begin(), all.end(), what.frames->first, number_below);
        end = std::lower_bound(first, all.end(), std::max(what.frames->first, what.frames->end), number_below);
    }
    if (first == end)
        throw sim::InputError(fmt::format("expected frames within {}:{}, at least one, got {}:{}",
                                          all.empty() ? 0 : all.front().number,
                                          all.empty() ? 0 : std::uint64_t{all.back().number} + 1,
                                          what.frames ? what.frames->first : 0, what.frames ? what.frames->end : 0));
    std::vector<RecordedFrame> kept(first, end);
    if (what.draws) {
        if (kept.size() != 1)
            throw sim::InputError(fmt::format("expected draws of one frame, got a range of {} frames", kept.size()));
        keep_draws(kept.front(), *what.draws, recording);
    }

    NeededPlanes needed(recording);
    for (auto frame = kept.rbegin(); frame != kept.rend(); ++frame) {
        needed.show(*frame);
        for (auto command = frame->commands.rbegin(); command != frame->commands.rend(); ++command)
            needed.go_before(*command);
    }
    std::vector<RecordedCommand> earlier; // the last one first
    for (auto frame = first; frame != all.begin();) {
        --frame;
        for (auto command = frame->commands.rbegin(); command != frame->commands.rend(); ++command) {
            if (!needed.needs(*command)) continue;
            needed.go_before(*command);
            earlier.push_back(*command);
        }
    }
    kept.front().commands.insert(kept.front().commands.begin(), earlier.rbegin(), earlier.rend());

    Recording result = recording;
    result.frames = std::move(kept);
    needed.forget_contents(result.surfaces);
    return compact(std::move(result));
}

} // namespace traces
