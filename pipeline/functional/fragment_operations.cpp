#include "pipeline/functional/fragment_operations.hpp"

#include "pipeline/functional/number_formats.hpp"

#include <algorithm>
#include <cmath>

namespace pipeline {

namespace {

struct CodeArithmetic {
    using Value = std::uint8_t;
    using Colour = glm::tvec4<std::uint8_t>;

    static constexpr Value one = 255;
    static Value rest(Value value) { return static_cast<Value>(255 - value); }
    static Value product(std::uint32_t a, std::uint32_t b) {
        const std::uint32_t t = a * b + 128U;
        return static_cast<Value>((t + (t >> 8U)) >> 8U);
    }
    static Value sum(std::uint32_t a, std::uint32_t b) { return static_cast<Value>(std::min(a + b, 255U)); }
    static Value difference(Value a, Value b) { return a > b ? static_cast<Value>(a - b) : Value{0}; }
};

struct FloatArithmetic {
    using Value = float;
    using Colour = glm::vec4;

    static constexpr Value one = 1.0F;
    static Value rest(Value value) { return 1.0F - value; }
    static Value product(Value a, Value b) { return a * b; }
    static Value sum(Value a, Value b) { return a + b; }
    static Value difference(Value a, Value b) { return a - b; }
};

template <class Arithmetic>
class Blender {
    using Value = typename Arithmetic::Value;
    using Colour = typename Arithmetic::Colour;

  public:
    Blender(const Colour& source, const Colour& target, const Colour& constant)
        : source_(source), target_(target), constant_(constant) {}

    Colour run(const BlendState& blend) const {
        Colour result = source_;
        if (!blend.enabled) return result;
        for (int i = 0; i < 3; ++i) result[i] = combined(blend.colour, i);
        result.a = combined(blend.alpha, 3);
        return result;
    }

  private:
    Value factor(BlendFactor factor, int channel) const {
        switch (factor) {
        case BlendFactor::zero:
            return Value{0};
        case BlendFactor::one:
            return Arithmetic::one;
        case BlendFactor::source_colour:
            return source_[channel];
        case BlendFactor::one_minus_source_colour:
            return Arithmetic::rest(source_[channel]);
        case BlendFactor::target_colour:
            return target_[channel];
        case BlendFactor::one_minus_target_colour:
            return Arithmetic::rest(target_[channel]);
        case BlendFactor::source_alpha:
            return source_.a;
        case BlendFactor::one_minus_source_alpha:
            return Arithmetic::rest(source_.a);
        case BlendFactor::target_alpha:
            return target_.a;
        case BlendFactor::one_minus_target_alpha:
            return Arithmetic::rest(target_.a);
        case BlendFactor::constant_colour:
            return constant_[channel];
        case BlendFactor::one_minus_constant_colour:
            return Arithmetic::rest(constant_[channel]);
        case BlendFactor::constant_alpha:
            return constant_.a;
        case BlendFactor::one_minus_constant_alpha:
            return Arithmetic::rest(constant_.a);
        case BlendFactor::source_alpha_saturate:
            break;
        }
        return channel == 3 ? Arithmetic::one : std::min(source_.a, Arithmetic::rest(target_.a));
    }

    Value combined(const BlendPart& part, int channel) const {
        const Value source = source_[channel], target = target_[channel];
        if (part.equation == BlendEquation::least) return std::min(source, target);
        if (part.equation == BlendEquation::greatest) return std::max(source, target);
        const Value s = Arithmetic::product(source, factor(part.source, channel));
        const Value t = Arithmetic::product(target, factor(part.target, channel));
        if (part.equation == BlendEquation::subtract) return Arithmetic::difference(s, t);
        if (part.equation == BlendEquation::reverse_subtract) return Arithmetic::difference(t, s);
        return Arithmetic::sum(s, t);
    }

    const Colour& source_;
    const Colour& target_;
    const Colour& constant_;
};

using Codes = CodeArithmetic::Colour;

Codes codes_of(const glm::vec4& colour) {
    Codes codes;
    for (int i = 0; i < 4; ++i) codes[i] = float_to_unorm8(colour[i]);
    return codes;
}

bool is_8_bit_unorm(SurfaceFormat format) {
    return format == SurfaceFormat::rgba8 || format == SurfaceFormat::r8 || format == SurfaceFormat::rg8;
}

bool is_fixed_point(SurfaceFormat format) {
    return info_of(format).kind == ChannelKind::unorm || info_of(format).kind == ChannelKind::srgb;
}

bool has_halves(SurfaceFormat format) {
    return format == SurfaceFormat::r16f || format == SurfaceFormat::rg16f || format == SurfaceFormat::rgba16f;
}

std::uint64_t channels_beyond_half(SurfaceFormat format, std::uint8_t write_mask, const glm::vec4& colour) {
    std::uint64_t channels = 0;
    for (int i = 0; has_halves(format) && i < info_of(format).channels; ++i)
        channels += (write_mask >> i & 1) != 0 && std::fabs(colour[i]) >= infinite_half ? 1 : 0;
    return channels;
}

// NaN becomes 0, as in every fixed-point format.
glm::vec4 clamped(const glm::vec4& colour) {
    glm::vec4 result(0.0F);
    for (int i = 0; i < 4; ++i)
        if (colour[i] > 0.0F) result[i] = std::min(colour[i], 1.0F);
    return result;
}

// Of formats in fixed point.
glm::vec4 blended_through(SurfaceFormat format, const BlendState& blend, const glm::vec4& source,
                          const glm::vec4& stored) {
    if (is_8_bit_unorm(format)) {
        const Codes codes = blended(blend, codes_of(source), codes_of(stored));
        glm::vec4 colour(0.0F, 0.0F, 0.0F, 1.0F);
        for (int i = 0; i < info_of(format).channels; ++i) colour[i] = unorm8_to_float(codes[i]);
        return colour;
    }
    BlendState in_range = blend;
    in_range.constant = clamped(blend.constant);
    return through_format(format, blended(in_range, clamped(source), stored));
}

bool reads_target(const BlendPart& part) {
    if (part.equation == BlendEquation::least || part.equation == BlendEquation::greatest) return true;
    if (part.target != BlendFactor::zero) return true;
    return part.source == BlendFactor::target_colour || part.source == BlendFactor::one_minus_target_colour ||
           part.source == BlendFactor::target_alpha || part.source == BlendFactor::one_minus_target_alpha ||
           part.source == BlendFactor::source_alpha_saturate;
}

} // namespace

glm::vec4 blended(const BlendState& blend, const glm::vec4& source, const glm::vec4& target) {
    return Blender<FloatArithmetic>(source, target, blend.constant).run(blend);
}

Codes blended(const BlendState& blend, const Codes& source, const Codes& target) {
    const Codes constant = codes_of(blend.constant);
    return Blender<CodeArithmetic>(source, target, constant).run(blend);
}

glm::vec4 write_colour(SurfaceFormat format, const BlendState& blend, std::uint8_t write_mask, const glm::vec4& source,
                       const glm::vec4& stored, Fp16Overflow overflow, std::uint64_t* overflowed) {
    glm::vec4 result;
    if (is_fixed_point(format)) {
        result = blend.enabled ? blended_through(format, blend, source, stored) : through_format(format, source);
    } else {
        result = blended(blend, source, stored);
        if (overflowed != nullptr) *overflowed += channels_beyond_half(format, write_mask, result);
        result = through_format(format, result, overflow);
    }
    for (int i = 0; i < 4; ++i)
        if ((write_mask >> i & 1) == 0) result[i] = stored[i];
    return result;
}

bool reads_target(const BlendState& blend) {
    return blend.enabled && (reads_target(blend.colour) || reads_target(blend.alpha));
}

std::uint8_t stencil_after(const StencilFace& face, StencilOperation operation, std::uint8_t stored) {
    unsigned value = stored;
    switch (operation) {
    case StencilOperation::keep:
        return stored;
    case StencilOperation::zero:
        value = 0;
        break;
    case StencilOperation::replace:
        value = face.reference;
        break;
    case StencilOperation::increment:
        value = std::min(value + 1U, 255U);
        break;
    case StencilOperation::decrement:
        value -= value > 0 ? 1U : 0U;
        break;
    case StencilOperation::increment_wrap:
        ++value;
        break;
    case StencilOperation::decrement_wrap:
        --value;
        break;
    case StencilOperation::invert:
        value = ~value;
        break;
    }
    return static_cast<std::uint8_t>((stored & ~face.write_mask) | (value & face.write_mask));
}

FragmentTest test_fragment(const RasterState& state, bool front, DepthCode incoming, DepthCode* depth,
                           std::uint8_t* stencil) {
    FragmentTest test;
    const StencilFace* face = nullptr;
    if (state.stencil.test && stencil != nullptr) {
        face = front ? &state.stencil.front : &state.stencil.back;
        test.stencil_failed =
            !passes<unsigned>(face->compare, face->reference & face->compare_mask, *stencil & face->compare_mask);
    }
    if (!test.stencil_failed && depth != nullptr) {
        test.depth_failed = state.depth.test && !passes(state.depth.compare, incoming, *depth);
        if (state.depth.write && !test.depth_failed) {
            *depth = incoming;
            test.written = true;
        }
    }
    if (face != nullptr) {
        const StencilOperation operation = test.stencil_failed ? face->stencil_fails
                                           : test.depth_failed ? face->depth_fails
                                                               : face->passes;
        *stencil = stencil_after(*face, operation, *stencil);
        test.written |= operation != StencilOperation::keep && face->write_mask != 0;
    }
    return test;
}

SurfaceUse use_of(const RasterState& state, SurfaceFormat depth_format,
                  std::span<const std::optional<SurfaceFormat>> targets) {
    SurfaceUse use;
    const bool depth = has_depth(depth_format), stencil = has_stencil(depth_format) && state.stencil.test;
    const bool writes_depth = depth && state.depth.write;
    const bool writes_a_part = depth && has_stencil(depth_format) && writes_depth;
    use.reads_depth = (depth && state.depth.test) || stencil;
    use.depth = use.reads_depth || writes_depth;
    use.keeps_depth = use.reads_depth || writes_a_part;
    for (std::size_t i = 0; i < targets.size(); ++i) {
        if (!targets[i]) continue;
        const unsigned channels = (1U << info_of(*targets[i]).channels) - 1U;
        const unsigned written = state.write_mask[i] & channels;
        use.colour |= written != 0;
        use.keeps_colour |= written != 0 && (reads_target(state.blend[i]) || written != channels);
    }
    return use;
}

} // namespace pipeline
