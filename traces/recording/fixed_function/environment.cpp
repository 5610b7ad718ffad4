#include "traces/recording/fixed_function/environment.hpp"

namespace traces::fixed_function {

namespace {

constexpr CombineArgument from_texture{CombineSource::texture}, from_previous{CombineSource::previous},
    from_constant{CombineSource::constant}, from_texture_alpha{CombineSource::texture, CombineOperand::alpha};

Combiner combiner(CombineFunction function, const CombineArgument& first, const CombineArgument& second = from_previous,
                  const CombineArgument& third = from_previous) {
    return {function, {first, second, third}};
}

bool has_alpha(BaseFormat format) {
    return format == BaseFormat::alpha || format == BaseFormat::luminance_alpha || format == BaseFormat::intensity ||
           format == BaseFormat::rgba;
}

bool inverted(CombineOperand operand) {
    return operand == CombineOperand::one_minus_colour || operand == CombineOperand::one_minus_alpha;
}

} // namespace

// Tables 3.22 and 3.23. What is undefined there (decals without red, green and blue) is what it is for RGB and RGBA.
Environment environment_of(const FixedTextureUnit& unit) {
    const Combiner kept = combiner(CombineFunction::replace, from_previous);
    const Combiner product = combiner(CombineFunction::modulate, from_texture, from_previous);
    const bool colours = unit.format != BaseFormat::alpha, alphas = has_alpha(unit.format);
    const bool intensity = unit.format == BaseFormat::intensity;
    const auto channels = [&](const Combiner& colour, const Combiner& alpha) {
        return Environment{colours ? colour : kept, alphas ? alpha : kept};
    };
    switch (unit.environment) {
    case TextureEnvironment::replace: {
        const Combiner replaced = combiner(CombineFunction::replace, from_texture);
        return channels(replaced, replaced);
    }
    case TextureEnvironment::modulate:
        return channels(product, product);
    case TextureEnvironment::decal:
        return {alphas ? combiner(CombineFunction::interpolate, from_texture, from_previous, from_texture_alpha)
                       : combiner(CombineFunction::replace, from_texture),
                kept};
    case TextureEnvironment::blend: {
        const Combiner blended = combiner(CombineFunction::interpolate, from_constant, from_previous, from_texture);
        return channels(blended, intensity ? blended : product);
    }
    case TextureEnvironment::add: {
        const Combiner sum = combiner(CombineFunction::add, from_texture, from_previous);
        return channels(sum, intensity ? sum : product);
    }
    case TextureEnvironment::combine:
        break;
    }
    return {unit.colour, unit.alpha};
}

std::uint32_t arguments_of(CombineFunction function) {
    if (function == CombineFunction::replace) return 1;
    return function == CombineFunction::interpolate ? 3 : 2;
}

bool reads_previous(const Environment& environment) {
    const auto reads = [](const Combiner& combiner) {
        for (std::uint32_t i = 0; i < arguments_of(combiner.function); ++i)
            if (combiner.arguments[i].source == CombineSource::previous) return true;
        return false;
    };
    return reads(environment.colour) ||
           (environment.colour.function != CombineFunction::dot3_rgba && reads(environment.alpha));
}

bool same_for_all_channels(const Environment& environment) {
    const Combiner& colour = environment.colour;
    const Combiner& alpha = environment.alpha;
    if (colour.function != alpha.function || colour.scale != alpha.scale) return false;
    for (std::uint32_t i = 0; i < arguments_of(colour.function); ++i) {
        const CombineArgument& c = colour.arguments[i];
        const CombineArgument& a = alpha.arguments[i];
        const bool of_alpha = c.operand == CombineOperand::alpha || c.operand == CombineOperand::one_minus_alpha;
        const bool same_texture = c.source != CombineSource::texture_of_unit || c.unit == a.unit;
        if (c.source != a.source || !same_texture || of_alpha || inverted(c.operand) != inverted(a.operand))
            return false;
    }
    return true;
}

} // namespace traces::fixed_function
