// The raster states of recorded traces.
#include "traces/rtrace/state_records.hpp"

#include "traces/rtrace/records.hpp"

#include <algorithm>

namespace traces::rtrace {

namespace {

using pipeline::BlendEquation;
using pipeline::BlendFactor;
using pipeline::FaceCulling;
using pipeline::StencilOperation;

// The codes of the file: new ones go to the end.
constexpr std::array<Code<BlendFactor>, 15> blend_factors{
    {{BlendFactor::zero, "0"},
     {BlendFactor::one, "1"},
     {BlendFactor::source_colour, "source colour"},
     {BlendFactor::one_minus_source_colour, "1 - source colour"},
     {BlendFactor::target_colour, "target colour"},
     {BlendFactor::one_minus_target_colour, "1 - target colour"},
     {BlendFactor::source_alpha, "source alpha"},
     {BlendFactor::one_minus_source_alpha, "1 - source alpha"},
     {BlendFactor::target_alpha, "target alpha"},
     {BlendFactor::one_minus_target_alpha, "1 - target alpha"},
     {BlendFactor::constant_colour, "constant colour"},
     {BlendFactor::one_minus_constant_colour, "1 - constant colour"},
     {BlendFactor::constant_alpha, "constant alpha"},
     {BlendFactor::one_minus_constant_alpha, "1 - constant alpha"},
     {BlendFactor::source_alpha_saturate, "source alpha saturate"}}};
constexpr std::array<Code<BlendEquation>, 5> blend_equations{{{BlendEquation::add, "add"},
                                                              {BlendEquation::subtract, "subtract"},
                                                              {BlendEquation::reverse_subtract, "reverse subtract"},
                                                              {BlendEquation::least, "least"},
                                                              {BlendEquation::greatest, "greatest"}}};
constexpr std::array<Code<StencilOperation>, 8> stencil_operations{
    {{StencilOperation::keep, "keep"},
     {StencilOperation::zero, "0"},
     {StencilOperation::replace, "replace"},
     {StencilOperation::increment, "increment"},
     {StencilOperation::decrement, "decrement"},
     {StencilOperation::increment_wrap, "increment and wrap"},
     {StencilOperation::decrement_wrap, "decrement and wrap"},
     {StencilOperation::invert, "invert"}}};
constexpr std::array<Code<FaceCulling>, 5> cullings{{{FaceCulling::by_material, "by material"},
                                                     {FaceCulling::none, "none"},
                                                     {FaceCulling::front, "front"},
                                                     {FaceCulling::back, "back"},
                                                     {FaceCulling::both, "both"}}};
constexpr std::array<Code<pipeline::ProvokingVertex>, 2> provoking_vertices{
    {{pipeline::ProvokingVertex::first, "first"}, {pipeline::ProvokingVertex::last, "last"}}};

/// What a state has for each target of the pass.
struct TargetState {
    pipeline::BlendState blend;
    std::uint8_t write_mask = every_channel;

    bool operator==(const TargetState&) const = default;
};

void visit_blend_part(Fields& fields, pipeline::BlendPart& blend) {
    fields.choice("source", blend.source, blend_factors);
    fields.choice("target", blend.target, blend_factors);
    fields.choice("equation", blend.equation, blend_equations);
}

void visit_target_state(Fields& fields, TargetState& target) {
    fields.flag("blend", target.blend.enabled);
    fields.part("colour", [&] { visit_blend_part(fields, target.blend.colour); });
    fields.part("alpha", [&] { visit_blend_part(fields, target.blend.alpha); });
    fields.vector("constant", target.blend.constant);
    fields.whole<std::uint8_t>("channels", target.write_mask, 0, every_channel);
}

void visit_depth_state(Fields& fields, pipeline::DepthState& depth) {
    fields.flag("test", depth.test);
    fields.flag("write", depth.write);
    fields.choice("compare", depth.compare, comparisons);
    fields.flag("clamp", depth.clamp);
    fields.number("bias slope", depth.bias_slope);
    fields.number("bias constant", depth.bias_constant);
}

void visit_stencil_face(Fields& fields, pipeline::StencilFace& face) {
    fields.choice("compare", face.compare, comparisons);
    fields.whole("reference", face.reference);
    fields.whole("compare mask", face.compare_mask);
    fields.whole("write mask", face.write_mask);
    fields.choice("stencil fails", face.stencil_fails, stencil_operations);
    fields.choice("depth fails", face.depth_fails, stencil_operations);
    fields.choice("passes", face.passes, stencil_operations);
}

bool has_depth_range(const pipeline::RasterState& state) {
    return state.depth.range_near != 0.0F || state.depth.range_far != 1.0F;
}

void visit_state(Fields& fields, pipeline::RasterState& state) {
    const auto rectangle = [&](pipeline::PixelRectangle& one) { visit_rectangle(fields, one); };
    fields.part("depth", [&] { visit_depth_state(fields, state.depth); });
    fields.flag("stencil test", state.stencil.test);
    fields.part("front", [&] { visit_stencil_face(fields, state.stencil.front); });
    fields.part("back", [&] { visit_stencil_face(fields, state.stencil.back); });
    fields.optional("viewport", state.viewport, rectangle);
    fields.optional("scissor", state.scissor, rectangle);
    fields.choice("culling", state.culling, cullings);
    fields.flag("front is clockwise", state.front_is_clockwise);
    fields.choice("provoking vertex", state.provoking, provoking_vertices);
    fields.number("point size", state.point_size);
    fields.flag("point size of vertex", state.point_size_of_vertex);
    fields.flag("point sprites", state.point_sprites);
    fields.number("line width", state.line_width);
    fields.whole("clip planes", state.clip_planes);
    std::array<TargetState, pipeline::most_targets_of_pass> targets;
    for (std::size_t i = 0; i < targets.size(); ++i) targets[i] = {state.blend[i], state.write_mask[i]};
    fields.leading("target", targets, TargetState{}, 24,
                   [&](TargetState& target, std::size_t) { visit_target_state(fields, target); });
    for (std::size_t i = 0; i < targets.size(); ++i) {
        state.blend[i] = targets[i].blend;
        state.write_mask[i] = targets[i].write_mask;
    }
    fields.leading("clip plane", state.clip_plane, glm::vec4(0.0F), 16,
                   [&](glm::vec4& plane, std::size_t) { fields.vector("plane", plane); });
}

} // namespace

void visit_rectangle(Fields& fields, pipeline::PixelRectangle& rectangle) {
    fields.integer("x", rectangle.x);
    fields.integer("y", rectangle.y);
    fields.whole("width", rectangle.width);
    fields.whole("height", rectangle.height);
}

void visit_states(Fields& fields, Document& document) {
    fields.list("state", document.trace.recording->states, 51,
                [&](pipeline::RasterState& state, std::size_t) { visit_state(fields, state); });
}

bool has_depth_ranges(const Document& document) {
    const std::vector<pipeline::RasterState>& states = document.trace.recording->states;
    return std::any_of(states.begin(), states.end(), has_depth_range);
}

// Of the states that were visited before, in which those without one have the usual range already.
void visit_depth_ranges(Fields& fields, Document& document) {
    struct Range {
        std::uint32_t state = 0;
        float near = 0.0F, far = 1.0F;
    };
    std::vector<pipeline::RasterState>& states = document.trace.recording->states;
    const auto count = static_cast<std::uint32_t>(states.size());
    std::vector<Range> ranges;
    for (std::uint32_t i = 0; i < count; ++i)
        if (has_depth_range(states[i])) ranges.push_back({i, states[i].depth.range_near, states[i].depth.range_far});
    const auto visit = [&](Range& range, std::size_t) {
        fields.whole("state", range.state, 0U, count - 1);
        fields.number("near", range.near);
        fields.number("far", range.far);
    };
    fields.list("depth range", ranges, 12, visit, count);
    for (const Range& range : ranges) {
        states[range.state].depth.range_near = range.near;
        states[range.state].depth.range_far = range.far;
    }
}

} // namespace traces::rtrace
