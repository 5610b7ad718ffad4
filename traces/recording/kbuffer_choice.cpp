#include "traces/recording/kbuffer_choice.hpp"

#include "models/programs/mlab.hpp"
#include "sim/check.hpp"

#include <charconv>
#include <fmt/format.h>

namespace traces {

namespace {

using pipeline::BlendFactor;

bool parse(std::string_view text, std::uint32_t& number) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc() && end == text.data() + text.size() && !text.empty();
}

bool of_the_fragment(BlendFactor factor) {
    return factor == BlendFactor::zero || factor == BlendFactor::one || factor == BlendFactor::source_alpha ||
           factor == BlendFactor::one_minus_source_alpha;
}

float value(BlendFactor factor, float alpha) {
    switch (factor) {
    case BlendFactor::zero:
        return 0.0F;
    case BlendFactor::source_alpha:
        return alpha;
    case BlendFactor::one_minus_source_alpha:
        return 1.0F - alpha;
    default:
        return 1.0F;
    }
}

} // namespace

bool parse_range(std::string_view text, std::uint32_t& first, std::uint32_t& last) {
    const std::size_t colon = text.find(':');
    if (colon == std::string_view::npos) return parse(text, first) && parse(text, last);
    std::uint32_t end = 0;
    if (!parse(text.substr(0, colon), first) || !parse(text.substr(colon + 1), end) || end <= first) return false;
    last = end - 1;
    return true;
}

KBufferChoice KBufferChoice::of(const std::string& text, std::uint32_t k) {
    KBufferChoice choice;
    choice.k = k;
    const std::string_view whole = text;
    constexpr std::string_view draws = "draws=", pass = "pass=";
    bool good = whole == "blended" || whole == "blended draws";
    if (whole.starts_with(draws)) {
        choice.kind = Kind::draws;
        good = parse_range(whole.substr(draws.size()), choice.first, choice.last);
    } else if (whole.starts_with(pass)) {
        choice.kind = Kind::pass;
        good = parse(whole.substr(pass.size()), choice.first);
        choice.last = choice.first;
    }
    if (!good)
        throw sim::InputError(
            fmt::format("--kbuffer: expected blended, draws=FIRST:END, draws=NUMBER or pass=NUMBER, got '{}'", text));
    if (k < 1 || k > models::most_mlab_nodes)
        throw sim::InputError(fmt::format("--k: expected 1 to {} nodes, got {}", models::most_mlab_nodes, k));
    return choice;
}

glm::vec4 NodeBlend::node(const glm::vec4& colour) const {
    const float weight = value(source, colour.a);
    return {colour.r * weight, colour.g * weight, colour.b * weight, value(target, colour.a)};
}

std::string not_for_nodes(const pipeline::RasterState& state) {
    const pipeline::BlendState& blend = state.blend[0];
    if (state.depth.write) return "it writes depth";
    if (state.stencil.test) return "it tests the stencil";
    if ((state.write_mask[0] & 7U) != 7U) return "it does not write all colours";
    if (!blend.enabled) return "it is not blended";
    if (blend.colour.equation != pipeline::BlendEquation::add) return "its blend equation is not the sum";
    if (!of_the_fragment(blend.colour.source) || !of_the_fragment(blend.colour.target))
        return "its blend factors depend on more than the fragment's alpha";
    return "";
}

} // namespace traces
