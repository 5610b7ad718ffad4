#include "traces/recording/cut.hpp"

#include "sim/check.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <set>

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
        constexpr std::uint8_t every_channel = 15, every_bit = 255;
        for (std::size_t i = 0; i < set.colours.size(); ++i)
            if (set.colours[i] && (clear.colours >> i & 1U) != 0 && clear.write_mask.at(i) == every_channel &&
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

    const Recording& recording_;
    std::set<SurfacePlane> written_, needed_;
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
    return compact(std::move(result));
}

} // namespace traces
