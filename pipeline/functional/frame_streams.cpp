#include "pipeline/functional/frame_streams.hpp"

#include "pipeline/functional/screen_stream.hpp"
#include "pipeline/functional/shade_pass.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <utility>

namespace pipeline {

namespace {

// The state of each part, which is that of the draw it belongs to.
std::vector<std::uint32_t> states_of_parts(const Pass& pass) {
    std::vector<std::uint32_t> states;
    if (pass.state_of_draw.empty()) return states;
    for (const DrawPart& part : pass.parts) {
        const auto draw = std::find(pass.draws.begin(), pass.draws.end(), part.draw) - pass.draws.begin();
        states.push_back(pass.state_of_draw.at(static_cast<std::size_t>(draw)));
    }
    return states;
}

/// Without what the fixed functions behind the shader do with a fragment.
std::vector<RasterState> until_shading(std::vector<RasterState> states) {
    for (RasterState& state : states) {
        const DepthState depth = state.depth;
        state.blend = {};
        state.write_mask = {};
        state.stencil = {};
        state.depth = {};
        state.depth.clamp = depth.clamp;
        state.depth.bias_slope = depth.bias_slope;
        state.depth.bias_constant = depth.bias_constant;
        state.depth.range_near = depth.range_near;
        state.depth.range_far = depth.range_far;
    }
    return states;
}

SurfaceFormat depth_format(const Frame& frame, const Pass& pass) {
    return pass.depth == no_surface ? frame.depth_format : frame.surfaces.at(pass.depth).format;
}

/// Fragments are the same, and so is what the shader of the pass is given; both have one.
bool draw_alike(const Frame& frame, const Pass& a, const Pass& b) {
    const Needs of_a = frame.needs_of(a), of_b = frame.needs_of(b);
    return a.kind == PassKind::draw && b.kind == PassKind::draw && a.shader != nullptr && b.shader != nullptr &&
           a.view == b.view && a.draws == b.draws && a.parts.empty() && b.parts.empty() &&
           a.both_faces == b.both_faces && a.state_of_draw == b.state_of_draw && of_a.colours == of_b.colours &&
           of_a.fragment_normals == of_b.fragment_normals && of_a.fragment_colour == of_b.fragment_colour &&
           of_a.map_texcoords == of_b.map_texcoords && of_a.textures == of_b.textures &&
           of_a.alpha_test == of_b.alpha_test &&
           depth_step(depth_format(frame, a)) == depth_step(depth_format(frame, b)) &&
           until_shading(a.states) == until_shading(b.states);
}

FragmentStream rasterize_pass(const Frame& frame, const Pass& pass, FrontEndOptions options) {
    const Needs needs = frame.needs_of(pass);
    options.colours = needs.colours;
    options.normals = needs.fragment_normals;
    options.map_texcoords = needs.map_texcoords;
    options.fragment_colour = needs.fragment_colour;
    options.textures = needs.textures;
    options.alpha_test = needs.alpha_test;
    options.both_faces = pass.both_faces;
    options.depth_step = depth_step(depth_format(frame, pass));
    options.states = pass.states;
    const std::vector<std::uint32_t> of_parts = states_of_parts(pass);
    options.state_of_draw = pass.parts.empty() ? pass.state_of_draw : of_parts;
    return pass.parts.empty()
               ? rasterize(*frame.resources, frame.draws, pass.draws, frame.view_of(pass), options)
               : rasterize_parts(*frame.resources, frame.draws, pass.parts, frame.view_of(pass), options);
}

// Every pixel of the first target; the others are as large.
FragmentStream cover_screen(const Frame& frame, const Pass& pass) {
    CHECK(frame.screen_draw.has_value() && pass.writes_colour());
    const SurfaceInfo& target = frame.surfaces.at(pass.first_target());
    return screen_stream(target.width, target.height, *frame.screen_draw);
}

/// Counts what streams hold together, and refuses more than they may.
class StreamBudget {
  public:
    explicit StreamBudget(const StreamLimit& limit) : limit_(limit) {}

    void add(std::uint64_t bytes) { held_ += bytes; }
    /// Of the outputs of a pass's shader, where they are made at once.
    static std::uint64_t outputs_of(const Pass& pass, const FragmentStream& stream) {
        if (pass.shader == nullptr || pass.reads_surfaces()) return 0;
        return stream.quads.size() * pass.shader->shape().outputs * sizeof(std::array<glm::vec4, 4>);
    }
    void check(const Pass& pass, const FragmentStream& stream, std::uint64_t bytes) const {
        constexpr std::uint64_t mib = std::uint64_t{1} << 20U;
        const std::uint64_t needed = held_ + bytes + outputs_of(pass, stream);
        if (needed <= limit_.bytes) return;
        throw sim::InputError(fmt::format("pass {}: {}x{} pixels: with its {} quads the fragments of the frame need at "
                                          "least {} MiB of memory, {} {} MiB",
                                          pass.name, stream.width, stream.height, stream.quads.size(), needed / mib,
                                          limit_.whose, limit_.bytes / mib));
    }

  private:
    StreamLimit limit_;
    std::uint64_t held_ = 0;
};

} // namespace

std::vector<FragmentStream> rasterize_frame(const Frame& frame, const FrontEndOptions& asked,
                                            const StreamLimit& limit) {
    std::vector<FragmentStream> streams;
    std::vector<std::pair<const Pass*, FragmentStream>> unshaded; // what the shaders of passes are given
    StreamBudget budget(limit);
    FrontEndOptions options = asked;
    for (const Pass& pass : frame.passes) {
        if (!pass.rasterizes()) continue;
        options.about_to_shade = [&](const FragmentStream& stream, std::uint64_t bytes) {
            budget.check(pass, stream, bytes);
        };
        if (pass.kind == PassKind::screen || pass.shader == nullptr) {
            streams.push_back(pass.shader == nullptr ? rasterize_pass(frame, pass, options)
                                                     : cover_screen(frame, pass));
            budget.add(streams.back().bytes());
        } else {
            auto alike = std::find_if(unshaded.begin(), unshaded.end(),
                                      [&](const auto& before) { return draw_alike(frame, *before.first, pass); });
            if (alike == unshaded.end()) {
                alike = unshaded.emplace(unshaded.end(), &pass, rasterize_pass(frame, pass, options));
                alike->second.given_colours = std::exchange(alike->second.colours, {});
                budget.add(alike->second.bytes());
            }
            streams.push_back(alike->second);
        }
        budget.add(StreamBudget::outputs_of(pass, streams.back()));
        if (pass.shader != nullptr && !pass.reads_surfaces()) shade(pass, streams.back(), {}, options.threads);
    }
    return streams;
}

} // namespace pipeline
