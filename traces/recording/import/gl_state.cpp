#include "traces/recording/import/gl_state.hpp"

#include <cmath>

namespace traces::recorded {

using pipeline::BlendEquation;
using pipeline::BlendFactor;
using pipeline::Compare;
using pipeline::Filter;
using pipeline::StencilOperation;
using pipeline::Wrap;
using record_stream::State;

namespace {

std::uint32_t name_in(const State& state, GLenum name) {
    return static_cast<std::uint32_t>(static_cast<std::int64_t>(value_in(state, name)));
}

/// Masks are given as -1 or as the largest number of 32 bits.
std::uint8_t low_byte(const State& state, GLenum name) { return static_cast<std::uint8_t>(name_in(state, name)); }

BlendFactor factor_of(std::uint32_t name, const Count& count) {
    switch (name) {
    case GL_ZERO:
        return BlendFactor::zero;
    case GL_ONE:
        return BlendFactor::one;
    case GL_SRC_COLOR:
        return BlendFactor::source_colour;
    case GL_ONE_MINUS_SRC_COLOR:
        return BlendFactor::one_minus_source_colour;
    case GL_DST_COLOR:
        return BlendFactor::target_colour;
    case GL_ONE_MINUS_DST_COLOR:
        return BlendFactor::one_minus_target_colour;
    case GL_SRC_ALPHA:
        return BlendFactor::source_alpha;
    case GL_ONE_MINUS_SRC_ALPHA:
        return BlendFactor::one_minus_source_alpha;
    case GL_DST_ALPHA:
        return BlendFactor::target_alpha;
    case GL_ONE_MINUS_DST_ALPHA:
        return BlendFactor::one_minus_target_alpha;
    case GL_CONSTANT_COLOR:
        return BlendFactor::constant_colour;
    case GL_ONE_MINUS_CONSTANT_COLOR:
        return BlendFactor::one_minus_constant_colour;
    case GL_CONSTANT_ALPHA:
        return BlendFactor::constant_alpha;
    case GL_ONE_MINUS_CONSTANT_ALPHA:
        return BlendFactor::one_minus_constant_alpha;
    case GL_SRC_ALPHA_SATURATE:
        return BlendFactor::source_alpha_saturate;
    default:
        count("blending with a second source");
        return BlendFactor::one;
    }
}

BlendEquation equation_of(std::uint32_t name) {
    switch (name) {
    case GL_FUNC_SUBTRACT:
        return BlendEquation::subtract;
    case GL_FUNC_REVERSE_SUBTRACT:
        return BlendEquation::reverse_subtract;
    case GL_MIN:
        return BlendEquation::least;
    case GL_MAX:
        return BlendEquation::greatest;
    default:
        return BlendEquation::add;
    }
}

StencilOperation operation_of(std::uint32_t name) {
    switch (name) {
    case GL_ZERO:
        return StencilOperation::zero;
    case GL_REPLACE:
        return StencilOperation::replace;
    case GL_INCR:
        return StencilOperation::increment;
    case GL_DECR:
        return StencilOperation::decrement;
    case GL_INCR_WRAP:
        return StencilOperation::increment_wrap;
    case GL_DECR_WRAP:
        return StencilOperation::decrement_wrap;
    case GL_INVERT:
        return StencilOperation::invert;
    default:
        return StencilOperation::keep;
    }
}

Wrap wrap_of(std::uint32_t name) {
    switch (name) {
    case GL_CLAMP_TO_EDGE:
    case GL_CLAMP: // half the border's colour at the edge, which no hardware of the last decades has
        return Wrap::clamp;
    case GL_MIRRORED_REPEAT:
        return Wrap::mirror;
    case GL_CLAMP_TO_BORDER:
        return Wrap::border;
    default:
        return Wrap::repeat;
    }
}

Filter filter_of(std::uint32_t name) {
    switch (name) {
    case GL_NEAREST:
        return Filter::nearest;
    case GL_NEAREST_MIPMAP_NEAREST:
        return Filter::nearest_mip_nearest;
    case GL_LINEAR_MIPMAP_NEAREST:
        return Filter::linear_mip_nearest;
    case GL_NEAREST_MIPMAP_LINEAR:
        return Filter::nearest_mip_linear;
    case GL_LINEAR_MIPMAP_LINEAR:
        return Filter::linear_mip_linear;
    default:
        return Filter::linear;
    }
}

struct FaceNames {
    GLenum compare, reference, compare_mask, write_mask, stencil_fails, depth_fails, passes;
};
constexpr FaceNames front_names{GL_STENCIL_FUNC,           GL_STENCIL_REF,  GL_STENCIL_VALUE_MASK,
                                GL_STENCIL_WRITEMASK,      GL_STENCIL_FAIL, GL_STENCIL_PASS_DEPTH_FAIL,
                                GL_STENCIL_PASS_DEPTH_PASS};
constexpr FaceNames back_names{GL_STENCIL_BACK_FUNC,           GL_STENCIL_BACK_REF,  GL_STENCIL_BACK_VALUE_MASK,
                               GL_STENCIL_BACK_WRITEMASK,      GL_STENCIL_BACK_FAIL, GL_STENCIL_BACK_PASS_DEPTH_FAIL,
                               GL_STENCIL_BACK_PASS_DEPTH_PASS};

pipeline::StencilFace face_of(const State& state, const FaceNames& names) {
    return {compare_of(name_in(state, names.compare)),
            low_byte(state, names.reference),
            low_byte(state, names.compare_mask),
            low_byte(state, names.write_mask),
            operation_of(name_in(state, names.stencil_fails)),
            operation_of(name_in(state, names.depth_fails)),
            operation_of(name_in(state, names.passes))};
}

void set_blending(pipeline::RasterState& raster, const State& state, const Count& count) {
    for (std::size_t i = 0; i < raster.blend.size(); ++i) {
        const record_stream::TargetState& target = state.targets.at(i);
        raster.write_mask.at(i) = static_cast<std::uint8_t>(target.write_mask);
        pipeline::BlendState& blend = raster.blend.at(i);
        blend.enabled = target.blend;
        if (!blend.enabled) continue; // factors that do nothing would tell equal states apart
        blend.colour = {factor_of(target.source_colour, count), factor_of(target.target_colour, count),
                        equation_of(target.equation_colour)};
        blend.alpha = {factor_of(target.source_alpha, count), factor_of(target.target_alpha, count),
                       equation_of(target.equation_alpha)};
        for (int channel = 0; channel < 4; ++channel)
            blend.constant[channel] =
                static_cast<float>(value_in(state, GL_BLEND_COLOR, static_cast<std::size_t>(channel)));
    }
}

bool draws_points(GLenum mode) { return mode == GL_POINTS; }
bool draws_lines(GLenum mode) { return mode == GL_LINES || mode == GL_LINE_STRIP || mode == GL_LINE_LOOP; }

void set_depth(pipeline::RasterState& raster, const State& state, GLenum mode) {
    raster.depth.test = is_on(state, GL_DEPTH_TEST);
    raster.depth.clamp = is_on(state, GL_DEPTH_CLAMP);
    raster.depth.range_near = static_cast<float>(value_in(state, GL_DEPTH_RANGE, 0));
    raster.depth.range_far = static_cast<float>(value_in(state, GL_DEPTH_RANGE, 1));
    if (raster.depth.test) {
        raster.depth.write = value_in(state, GL_DEPTH_WRITEMASK) != 0;
        raster.depth.compare = compare_of(name_in(state, GL_DEPTH_FUNC));
    }
    if (draws_points(mode) || draws_lines(mode) || !is_on(state, GL_POLYGON_OFFSET_FILL)) return;
    raster.depth.bias_slope = static_cast<float>(value_in(state, GL_POLYGON_OFFSET_FACTOR));
    raster.depth.bias_constant = static_cast<float>(value_in(state, GL_POLYGON_OFFSET_UNITS));
}

void count_missing(const State& state, GLenum mode, const Count& count) {
    const auto on = [&](GLenum name, const char* call) {
        if (is_on(state, name)) count(call);
    };
    on(GL_COLOR_LOGIC_OP, "logic operations");
    on(GL_SAMPLE_ALPHA_TO_COVERAGE, "alpha to coverage");
    on(GL_SAMPLE_COVERAGE, "glSampleCoverage");
    on(GL_SAMPLE_MASK, "glSampleMaski");
    if (name_in(state, GL_CLIP_ORIGIN) != GL_LOWER_LEFT || name_in(state, GL_CLIP_DEPTH_MODE) != GL_NEGATIVE_ONE_TO_ONE)
        count("glClipControl");
    if (draws_lines(mode)) on(GL_LINE_SMOOTH, "smooth lines");
    if (draws_lines(mode) && state.compatibility) on(GL_LINE_STIPPLE, "glLineStipple");
    if (draws_points(mode) && state.compatibility) on(GL_POINT_SMOOTH, "smooth points");
    if (draws_points(mode) || draws_lines(mode)) return;
    if (name_in(state, GL_POLYGON_MODE) != GL_FILL) count("glPolygonMode");
    on(GL_POLYGON_SMOOTH, "smooth polygons");
    if (state.compatibility) on(GL_POLYGON_STIPPLE, "glPolygonStipple");
}

} // namespace

double value_in(const State& state, GLenum name, std::size_t i) {
    return state.values.at(record_stream::place_of(record_stream::state_names, name) + i);
}

bool is_on(const State& state, GLenum name) { return value_in(state, name) != 0.0; }

Compare compare_of(std::uint32_t name) {
    // The names are numbered in the order of the enumeration.
    return name >= GL_NEVER && name <= GL_ALWAYS
               ? std::array{Compare::never,   Compare::less,      Compare::equal,         Compare::less_equal,
                            Compare::greater, Compare::not_equal, Compare::greater_equal, Compare::always}
                     .at(name - GL_NEVER)
               : Compare::always;
}

RecordedSampler sampler_of(const record_stream::Sampler& sampler, bool seamless) {
    RecordedSampler result;
    result.wrap_u = wrap_of(sampler.wrap[0]);
    result.wrap_v = wrap_of(sampler.wrap[1]);
    result.wrap_w = wrap_of(sampler.wrap[2]);
    result.min_filter = filter_of(sampler.min_filter);
    result.mag_filter = filter_of(sampler.mag_filter);
    result.border = {sampler.border[0], sampler.border[1], sampler.border[2], sampler.border[3]};
    result.lod_bias = sampler.lod_bias;
    result.least_lod = sampler.least_lod;
    result.most_lod = sampler.most_lod;
    result.anisotropy = std::max(sampler.anisotropy, 1.0F);
    result.compares = sampler.compare_mode == GL_COMPARE_REF_TO_TEXTURE;
    result.compare = compare_of(sampler.compare_func);
    result.seamless = seamless;
    return result;
}

pipeline::PixelRectangle rectangle_of(const State& state, GLenum name, const StateContext& context) {
    const auto at = [&](std::size_t i) { return static_cast<std::int32_t>(std::lround(value_in(state, name, i))); };
    const std::int32_t height = std::max(at(3), 0);
    const std::int32_t y = context.top_row_first ? static_cast<std::int32_t>(context.height) - at(1) - height : at(1);
    return {at(0), y, static_cast<std::uint32_t>(std::max(at(2), 0)), static_cast<std::uint32_t>(height)};
}

pipeline::RasterState raster_state_of(const State& state, const StateContext& context, const Count& count) {
    pipeline::RasterState raster;
    set_blending(raster, state, count);
    set_depth(raster, state, context.mode);
    raster.stencil.test = is_on(state, GL_STENCIL_TEST);
    if (raster.stencil.test) {
        raster.stencil.front = face_of(state, front_names);
        raster.stencil.back = face_of(state, back_names);
    }
    raster.viewport = rectangle_of(state, GL_VIEWPORT, context);
    if (is_on(state, GL_SCISSOR_TEST)) raster.scissor = rectangle_of(state, GL_SCISSOR_BOX, context);
    const std::uint32_t faces = name_in(state, GL_CULL_FACE_MODE);
    raster.culling = !is_on(state, GL_CULL_FACE) ? pipeline::FaceCulling::none
                     : faces == GL_FRONT         ? pipeline::FaceCulling::front
                     : faces == GL_BACK          ? pipeline::FaceCulling::back
                                                 : pipeline::FaceCulling::both;
    raster.front_is_clockwise = name_in(state, GL_FRONT_FACE) == GL_CW;
    raster.provoking = name_in(state, GL_PROVOKING_VERTEX) == GL_FIRST_VERTEX_CONVENTION
                           ? pipeline::ProvokingVertex::first
                           : pipeline::ProvokingVertex::last;
    if (draws_points(context.mode)) {
        raster.point_size = static_cast<float>(value_in(state, GL_POINT_SIZE));
        raster.point_size_of_vertex = is_on(state, GL_PROGRAM_POINT_SIZE);
        raster.point_sprites = !state.compatibility || is_on(state, GL_POINT_SPRITE);
        if (raster.point_sprites && name_in(state, GL_POINT_SPRITE_COORD_ORIGIN) == GL_LOWER_LEFT)
            count("point sprites whose coordinates begin at the bottom");
    }
    if (draws_lines(context.mode)) raster.line_width = static_cast<float>(value_in(state, GL_LINE_WIDTH));
    for (unsigned i = 0; i < pipeline::most_clip_distances; ++i)
        if (is_on(state, GL_CLIP_DISTANCE0 + i)) raster.clip_planes |= static_cast<std::uint8_t>(1U << i);
    count_missing(state, context.mode, count);
    return raster;
}

} // namespace traces::recorded
