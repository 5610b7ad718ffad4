// Clears, copies and blits of a recording: a whole surface to the value that it is always cleared to stays a clear; the
// others are drawn, as a triangle around the screen.
#include "pipeline/functional/surface_texel.hpp"
#include "pipeline/vertex_program.hpp"
#include "sim/check.hpp"
#include "traces/recording/recorded_passes.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <utility>

namespace traces {

namespace {

using pipeline::RasterState;

/// A triangle around all of clip space, at one depth.
class ScreenTriangle final : public pipeline::VertexProgram {
  public:
    explicit ScreenTriangle(float depth) : z_(depth * 2.0F - 1.0F) {}
    pipeline::VertexProgramShape shape() const override { return {}; }
    void run(std::uint32_t, std::uint32_t first, const pipeline::ProgramVertices& vertices) const override {
        for (std::size_t i = 0; i < vertices.positions.size(); ++i) {
            const std::uint32_t corner = first + static_cast<std::uint32_t>(i);
            vertices.positions[i] = {corner == 1 ? 3.0F : -1.0F, corner == 2 ? 3.0F : -1.0F, z_, 1.0F};
        }
    }

  private:
    float z_;
};

bool covers_view(const std::optional<pipeline::PixelRectangle>& scissor, std::uint32_t width, std::uint32_t height) {
    return !scissor || (scissor->x <= 0 && scissor->y <= 0 && std::int64_t{scissor->x} + scissor->width >= width &&
                        std::int64_t{scissor->y} + scissor->height >= height);
}

/// What lies in both; of width or height 0: nothing.
pipeline::PixelRectangle common_part(const pipeline::PixelRectangle& a, const pipeline::PixelRectangle& b) {
    const auto overlap = [](std::int32_t at_a, std::uint32_t size_a, std::int32_t at_b, std::uint32_t size_b) {
        const std::int64_t first = std::max(at_a, at_b);
        const std::int64_t end = std::min(std::int64_t{at_a} + size_a, std::int64_t{at_b} + size_b);
        return std::pair(static_cast<std::int32_t>(first),
                         static_cast<std::uint32_t>(std::max<std::int64_t>(end - first, 0)));
    };
    const auto [x, width] = overlap(a.x, a.width, b.x, b.width);
    const auto [y, height] = overlap(a.y, a.height, b.y, b.height);
    return {x, y, width, height};
}

} // namespace

void RecordedPasses::add_screen_draw(const std::string& name, const RasterState& state, float depth, FragmentUse use) {
    pipeline::Draw draw;
    draw.name = name;
    draw.geometry = screen_geometry_;
    draw.instances.resize(1, glm::mat4(1.0F));
    draw.program = std::make_shared<const ScreenTriangle>(depth);
    open_->pass.states.push_back(state);
    push(std::move(draw), static_cast<std::uint32_t>(open_->pass.states.size() - 1), std::move(use));
}

// What is stored into each target that is cleared as a whole. Stencil that nobody tests may hold anything.
std::map<std::uint32_t, RecordedPasses::Texel> RecordedPasses::whole_clears(const RecordedClear& clear) const {
    const TargetSet& targets = targets_.at(clear.targets);
    std::map<std::uint32_t, Texel> values;
    if (!covers_view(clear.scissor, targets.width, targets.height)) return values;
    for (std::size_t i = 0; i < targets.colours.size(); ++i) {
        if ((clear.colours >> i & 1U) == 0 || !targets.colours[i] || clear.write_mask[i] != 15) continue;
        const std::uint32_t surface = targets.colours[i]->surface;
        pack_colour(surfaces[surface].format, clear.colour, values[surface].data());
    }
    if (targets.depth && (clear.depth || clear.stencil)) {
        const std::uint32_t surface = targets.depth->surface;
        const pipeline::SurfaceFormat format = surfaces[surface].format;
        const bool all_stencil = clear.stencil && clear.stencil_mask == 0xFF;
        if ((!has_depth(format) || clear.depth) &&
            (!has_stencil(format) || all_stencil || !stencil_tested_.contains(surface))) {
            const auto depth = pipeline::depth_code(format, std::clamp(clear.depth.value_or(1.0F), 0.0F, 1.0F));
            pack_depth_stencil(format, {depth, clear.stencil.value_or(0)}, values[surface].data());
        }
    }
    std::erase_if(values, [&](const auto& one) {
        const pipeline::SurfaceInfo& info = surfaces[one.first];
        return info.width != targets.width || info.height != targets.height || info.planes != 1 || info.levels != 1 ||
               (cleared_.contains(one.first) && info.cleared != one.second);
    });
    return values;
}

// A surface is cleared as a whole where it gets the value that it always gets; what is left of the clear is drawn.
RecordedClear RecordedPasses::clear_whole(const RecordedClear& clear) {
    const TargetSet& targets = targets_.at(clear.targets);
    RecordedClear left = clear;
    RecordedStep step;
    for (const auto& [surface, value] : whole_clears(clear)) {
        surfaces[surface].cleared = value;
        cleared_.insert(surface);
        step.cleared.push_back(name_of(surface));
        for (std::size_t i = 0; i < targets.colours.size(); ++i)
            if (targets.colours[i] && targets.colours[i]->surface == surface)
                left.colours = static_cast<std::uint8_t>(left.colours & ~(1U << i));
        if (targets.depth && targets.depth->surface == surface) {
            left.depth.reset();
            left.stencil.reset();
        }
    }
    if (step.cleared.empty()) return left;
    close();
    steps.push_back(std::move(step));
    return left;
}

void RecordedPasses::add(const RecordedClear& all) {
    enter_run(all.targets);
    const RecordedClear clear = clear_whole(all);
    if (clear.colours == 0 && !clear.depth && !clear.stencil) return;
    open(clear.targets);
    RasterState state;
    state.culling = pipeline::FaceCulling::none;
    state.scissor = clear.scissor;
    for (std::size_t i = 0; i < pipeline::most_targets_of_pass; ++i)
        state.write_mask[i] = (clear.colours >> i & 1U) != 0 ? clear.write_mask[i] : 0;
    const auto format =
        open_->targets.depth ? surfaces[open_->targets.depth->surface].format : pipeline::SurfaceFormat::rgba8;
    if (clear.depth && has_depth(format)) {
        state.depth.test = state.depth.write = true;
        state.depth.compare = pipeline::Compare::always;
    }
    if (clear.stencil && has_stencil(format)) {
        constexpr auto replace = pipeline::StencilOperation::replace;
        state.stencil.test = true;
        state.stencil.front = {
            pipeline::Compare::always, *clear.stencil, 0xFF, clear.stencil_mask, replace, replace, replace};
        state.stencil.back = state.stencil.front;
    }
    FragmentUse use;
    use.colour = clear.colour;
    add_screen_draw(clear.name, state, std::clamp(clear.depth.value_or(0.0F), 0.0F, 1.0F), std::move(use));
}

void RecordedPasses::add(const RecordedCopy& copy) {
    const pipeline::PixelRectangle& from = copy.rectangle;
    RecordedBlit blit;
    blit.name = copy.name;
    blit.from = copy.from;
    blit.to = copy.to;
    blit.source = from;
    blit.destination = {copy.to_x, copy.to_y, from.width, from.height};
    blit.mirrored_y = copy.mirrored;
    add(blit);
}

void RecordedPasses::add(const RecordedBlit& blit) {
    const TargetSet::Target source = drawn_parts_.of(blit.from), target = drawn_parts_.of(blit.to);
    const pipeline::SurfaceInfo &from = surfaces[source.surface], &to = surfaces[target.surface];
    const bool depths = has_depth(to.format);
    if (depths != has_depth(from.format) || is_colour(to.format) != is_colour(from.format) ||
        source.surface == target.surface)
        throw sim::InputError(
            fmt::format("{}: expected a copy of colours or depths from one surface to another", blit.name));
    RasterState state;
    state.scissor = common_part(blit.destination, blit.scissor.value_or(blit.destination));
    if (state.scissor->width == 0 || state.scissor->height == 0) return;
    TargetSet targets;
    if (depths)
        targets.depth = target;
    else
        targets.colours = {target};
    targets.width = to.width;
    targets.height = to.height;
    enter_run(~0U - copies_++); // one of its own
    open(targets, false);
    state.culling = pipeline::FaceCulling::none;
    if (depths) state.depth = {.test = true, .write = true, .compare = pipeline::Compare::always};
    FragmentUse use;
    use.copied = CopiedTexels{.slot = slot_of(source.surface),
                              .level = source.level,
                              .plane = source.plane,
                              .source = blit.source,
                              .destination = blit.destination,
                              .mirrored_x = blit.mirrored_x,
                              .mirrored_y = blit.mirrored_y,
                              .linear = blit.linear,
                              .depths = depths};
    add_screen_draw(blit.name, state, 0.0F, std::move(use));
    close();
}

} // namespace traces
