#include "traces/recording/fixed_function/fragment_text.hpp"

#include "traces/recording/fixed_function/environment.hpp"

#include <cmath>
#include <fmt/format.h>

namespace traces::fixed_function {

namespace {

enum class Channels : std::uint8_t { all, colour, alpha };

class FragmentWriter {
  public:
    explicit FragmentWriter(const FixedFunctionState& state) : state_(state) {}

    FragmentText write() {
        apply_textures();
        if (adds_secondary(state_)) add_secondary();
        if (state_.fog.mode != FogMode::none) apply_fog();
        if (state_.points.drawn && fades(state_.points))
            colour_ =
                text_.local("vec4", "faded",
                            fmt::format("vec4({0}.rgb, {0}.a * {1})", colour_, text_.input("float", "point_fade")));
        if (state_.clamp_fragment_colours && !state_.clamp_vertex_colours)
            colour_ = text_.local("vec4", "clamped", fmt::format("clamp({}, 0.0, 1.0)", colour_));
        test_alpha();
        text_.statement("gl_FragColor = " + colour_);
        return {std::move(text_), std::move(units_)};
    }

  private:
    std::string of_side(bool secondary) {
        const std::string type = secondary ? "vec3" : "vec4";
        std::string front = text_.input(type, colour_name(true, secondary), state_.flat);
        if (!two_sided(state_)) return front;
        const std::string back = text_.input(type, colour_name(false, secondary), state_.flat);
        return text_.local(type, secondary ? "secondary" : "primary",
                           fmt::format("gl_FrontFacing ? {} : {}", front, back));
    }

    std::string texel(std::uint32_t unit);
    std::string value(const CombineArgument& argument, std::uint32_t unit);
    std::string term(const CombineArgument& argument, std::uint32_t unit, Channels channels);
    std::string combined(const Combiner& combiner, std::uint32_t unit, Channels channels);
    std::string stage(const Environment& environment, std::uint32_t unit);
    void apply_textures();
    void add_secondary();
    void apply_fog();
    void test_alpha();

    glm::vec4 clamped(const glm::vec4& colour) const {
        return state_.clamp_fragment_colours ? glm::clamp(colour, 0.0F, 1.0F) : colour;
    }

    const FixedFunctionState& state_;
    ShaderText text_;
    std::vector<std::uint32_t> units_;
    std::string colour_; ///< what holds the colour so far; "" for the primary colour while nothing has read it
};

std::string compared(BaseFormat format, const std::string& result) {
    if (format == BaseFormat::alpha) return fmt::format("vec4(vec3(0.0), {})", result);
    if (format == BaseFormat::intensity) return fmt::format("vec4({})", result);
    if (format == BaseFormat::red) return fmt::format("vec4({}, 0.0, 0.0, 1.0)", result);
    return fmt::format("vec4(vec3({}), 1.0)", result);
}

// Coordinates are divided by q (section 3.8.7), but for cubes, where it does not change the direction.
std::string FragmentWriter::texel(std::uint32_t unit) {
    const FixedTextureUnit& from = state_.units.at(unit);
    if (from.target == UnitTarget::none) return "vec4(0.0)"; // undefined in the specification
    const std::string texture = fmt::format("texture{}", unit);
    if (!text_.declares(texture)) units_.push_back(unit);
    const std::string place = takes_sprite_place(state_, unit)
                                  ? text_.local("vec4", coordinate_name(unit), "vec4(gl_PointCoord, 0.0, 1.0)")
                                  : text_.input("vec4", coordinate_name(unit));
    const bool compares = from.compares && from.target != UnitTarget::three_dimensional;
    std::string type = "sampler2D", coordinates = place;
    if (from.target == UnitTarget::one_dimensional)
        coordinates = compares ? fmt::format("vec4({0}.x, 0.5 * {0}.w, {0}.zw)", place)
                               : fmt::format("vec3({0}.x, 0.5 * {0}.w, {0}.w)", place);
    else if (from.target == UnitTarget::rectangle)
        type = "sampler2DRect";
    else if (from.target == UnitTarget::three_dimensional)
        type = "sampler3D";
    else if (from.target == UnitTarget::cube)
        type = "samplerCube", coordinates += compares ? "" : ".xyz";
    const std::string result = fmt::format("{}({}, {})", from.target == UnitTarget::cube ? "texture" : "textureProj",
                                           text_.sampler(type + (compares ? "Shadow" : ""), texture), coordinates);
    return text_.local("vec4", fmt::format("texel{}", unit), compares ? compared(from.format, result) : result);
}

std::string FragmentWriter::value(const CombineArgument& argument, std::uint32_t unit) {
    switch (argument.source) {
    case CombineSource::texture:
        return texel(unit);
    case CombineSource::texture_of_unit:
        return texel(argument.unit);
    case CombineSource::constant:
        return text_.uniform(fmt::format("environment{}", unit), clamped(state_.units[unit].constant));
    case CombineSource::primary_colour:
        return of_side(false);
    case CombineSource::previous:
        break;
    }
    return colour_.empty() ? of_side(false) : colour_;
}

std::string FragmentWriter::term(const CombineArgument& argument, std::uint32_t unit, Channels channels) {
    const CombineOperand operand = argument.operand;
    const bool alpha =
        channels == Channels::alpha || operand == CombineOperand::alpha || operand == CombineOperand::one_minus_alpha;
    std::string text = value(argument, unit);
    if (channels != Channels::all) text += alpha ? ".a" : ".rgb";
    if (operand == CombineOperand::one_minus_colour || operand == CombineOperand::one_minus_alpha)
        text = fmt::format("(1.0 - {})", text);
    return channels == Channels::colour && alpha ? fmt::format("vec3({})", text) : text;
}

// Table 3.24. Sums, differences and multiples are clamped; all else stays between 0 and 1.
std::string FragmentWriter::combined(const Combiner& combiner, std::uint32_t unit, Channels channels) {
    std::array<std::string, 3> terms;
    for (std::uint32_t i = 0; i < arguments_of(combiner.function); ++i)
        terms[i] = term(combiner.arguments[i], unit, channels);
    const auto& [a, b, c] = terms;
    std::string text;
    bool bounded = combiner.scale == 1;
    switch (combiner.function) {
    case CombineFunction::replace:
        text = a;
        break;
    case CombineFunction::modulate:
        text = fmt::format("{} * {}", a, b);
        break;
    case CombineFunction::interpolate:
        text = fmt::format("mix({}, {}, {})", b, a, c);
        break;
    case CombineFunction::add:
        text = fmt::format("{} + {}", a, b);
        bounded = false;
        break;
    case CombineFunction::add_signed:
        text = fmt::format("{} + {} - 0.5", a, b);
        bounded = false;
        break;
    case CombineFunction::subtract:
        text = fmt::format("{} - {}", a, b);
        bounded = false;
        break;
    case CombineFunction::dot3_rgb:
    case CombineFunction::dot3_rgba:
        text = fmt::format("4.0 * dot({} - 0.5, {} - 0.5)", a, b);
        bounded = false;
        break;
    }
    if (combiner.scale != 1) text = fmt::format("{}.0 * ({})", combiner.scale, text);
    return bounded ? text : fmt::format("clamp({}, 0.0, 1.0)", text);
}

std::string FragmentWriter::stage(const Environment& environment, std::uint32_t unit) {
    if (same_for_all_channels(environment)) return combined(environment.colour, unit, Channels::all);
    std::string colour = combined(environment.colour, unit, Channels::colour);
    if (environment.colour.function == CombineFunction::dot3_rgba) {
        Combiner alpha = environment.colour;
        alpha.scale = environment.alpha.scale;
        return fmt::format("vec4(vec3({}), {})", colour, combined(alpha, unit, Channels::colour));
    }
    if (environment.colour.function == CombineFunction::dot3_rgb) colour = fmt::format("vec3({})", colour);
    return fmt::format("vec4({}, {})", colour, combined(environment.alpha, unit, Channels::alpha));
}

// Units whose result a later one ignores are left out, with the texture that they alone read.
void FragmentWriter::apply_textures() {
    std::uint32_t first = 0;
    for (std::uint32_t unit = fixed_function_units; unit-- > 0;)
        if (state_.units[unit].target != UnitTarget::none && !reads_previous(environment_of(state_.units[unit]))) {
            first = unit;
            break;
        }
    for (std::uint32_t unit = first; unit < fixed_function_units; ++unit)
        if (state_.units[unit].target != UnitTarget::none)
            colour_ =
                text_.local("vec4", fmt::format("stage{}", unit), stage(environment_of(state_.units[unit]), unit));
    if (colour_.empty()) colour_ = of_side(false);
}

void FragmentWriter::add_secondary() {
    std::string sum = fmt::format("{}.rgb + {}", colour_, of_side(true));
    if (state_.clamp_fragment_colours) sum = fmt::format("clamp({}, 0.0, 1.0)", sum);
    colour_ = text_.local("vec4", "summed", fmt::format("vec4({}, {}.a)", sum, colour_));
}

// Section 3.10. Without a distance from start to end the factor is that of a distance of 1.
void FragmentWriter::apply_fog() {
    const FixedFog& fog = state_.fog;
    const std::string distance = text_.input("float", "fog_distance");
    std::string factor;
    if (fog.mode == FogMode::linear) {
        const std::string end = text_.uniform("fog_end", fog.end);
        const std::string scale =
            text_.uniform("fog_scale", fog.end == fog.start ? 1.0F : 1.0F / (fog.end - fog.start));
        factor = fmt::format("({} - {}) * {}", end, distance, scale);
    } else {
        const std::string depth =
            text_.local("float", "fog_depth", text_.uniform("fog_density", fog.density) + " * " + distance);
        factor =
            fog.mode == FogMode::exponential ? fmt::format("exp(-{})", depth) : fmt::format("exp(-{0} * {0})", depth);
    }
    factor = text_.local("float", "fog_factor", fmt::format("clamp({}, 0.0, 1.0)", factor));
    const std::string colour = text_.uniform("fog_colour", glm::vec3(clamped(fog.colour)));
    colour_ =
        text_.local("vec4", "fogged", fmt::format("vec4(mix({}, {}.rgb, {}), {}.a)", colour, colour_, factor, colour_));
}

// Section 4.1.4: both sides are rounded as the target's alpha is.
void FragmentWriter::test_alpha() {
    using pipeline::Compare;
    if (state_.alpha_test == Compare::always) return;
    if (state_.alpha_test == Compare::never) {
        text_.statement("discard");
        return;
    }
    constexpr std::array<const char*, 8> operators{"", "<", "==", "<=", ">", "!=", ">=", ""};
    float reference = clamped(glm::vec4(state_.alpha_reference)).a;
    std::string alpha = colour_ + ".a";
    if (const float steps = state_.alpha_steps; steps > 0.0F) {
        reference = std::floor(reference * steps + 0.5F);
        alpha = fmt::format("floor({} * {} + 0.5)", alpha, text_.uniform("alpha_steps", steps));
    }
    text_.statement(fmt::format("if (!({} {} {})) discard", alpha,
                                operators.at(static_cast<std::size_t>(state_.alpha_test)),
                                text_.uniform("alpha_reference", reference)));
}

} // namespace

std::string colour_name(bool front, bool secondary) {
    return std::string(front ? "front" : "back") + (secondary ? "_secondary" : "_colour");
}

std::string coordinate_name(std::uint32_t unit) { return fmt::format("coordinate{}", unit); }

bool two_sided(const FixedFunctionState& state) { return state.lighting.enabled && state.lighting.two_sided; }

bool adds_secondary(const FixedFunctionState& state) {
    return state.lighting.enabled ? state.lighting.separate_specular : state.colour_sum;
}

bool takes_sprite_place(const FixedFunctionState& state, std::uint32_t unit) {
    return state.points.drawn && state.points.sprites && state.units.at(unit).replaced_in_sprites;
}

bool fades(const FixedPoints& points) { return points.fades && points.fade_threshold > 0.0F; }

FragmentText fragment_text(const FixedFunctionState& state) { return FragmentWriter(state).write(); }

} // namespace traces::fixed_function
