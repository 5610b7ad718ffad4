#include "traces/generators/vertex_format.hpp"

#include "pipeline/functional/number_formats.hpp"
#include "sim/check.hpp"
#include "sim/suggest.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <limits>

namespace traces {

using pipeline::ComponentType;
using pipeline::Semantic;

namespace {

constexpr std::array<std::string_view, 5> attribute_names{"normal", "colour", "secondary_colour", "texcoord",
                                                          "generic"};
constexpr std::array<Semantic, 5> attribute_semantics{Semantic::normal, Semantic::colour, Semantic::secondary_colour,
                                                      Semantic::texcoord0, Semantic::generic};

/// One attribute of the text; errors name it.
class AttributeText {
  public:
    AttributeText(std::string_view text, std::string_view place) : text_(text), place_(place) {}

    AttributeFormat format() const {
        const std::size_t colon = std::min(text_.find(':'), text_.size());
        const std::string_view name = text_.substr(0, colon);
        const auto found = std::find(attribute_names.begin(), attribute_names.end(), name);
        if (found == attribute_names.end())
            fail(fmt::format("one of {}{}", fmt::join(attribute_names, ", "),
                             sim::did_you_mean(std::string(name), {attribute_names.begin(), attribute_names.end()})));
        AttributeFormat format;
        format.semantic = attribute_semantics[static_cast<std::size_t>(found - attribute_names.begin())];
        const std::string_view rest = text_.substr(std::min(colon + 1, text_.size()));
        const std::string_view element = rest.substr(0, rest.find('*'));
        if (element.empty() || element[0] < '1' || element[0] > '4') fail("1 to 4 components behind ':'");
        format.components = static_cast<std::uint8_t>(element[0] - '0');
        format.type = type_of(element.substr(1));
        if (pipeline::is_packed(format.type) && format.components != 4) fail("4 components of a packed type");
        return format;
    }
    /// How many sets; 1 for what is no texture coordinate.
    std::uint32_t count() const {
        const std::size_t star = text_.find('*');
        if (star == std::string_view::npos) return 1;
        if (!text_.starts_with("texcoord:")) fail("'*' behind texture coordinates only");
        std::uint32_t count = 0;
        const char* const end = text_.data() + text_.size();
        const auto [stop, error] = std::from_chars(text_.data() + star + 1, end, count);
        if (error != std::errc() || stop != end || count < 1 || count > pipeline::texcoord_sets)
            fail(fmt::format("1 to {} sets behind '*'", pipeline::texcoord_sets));
        return count;
    }
    [[noreturn]] void fail(const std::string& expected) const {
        throw sim::InputError(fmt::format("{}: expected {}, got '{}'", place_, expected, text_));
    }

  private:
    ComponentType type_of(std::string_view name) const {
        const auto& names = sim::EnumNames<ComponentType>::names;
        const auto found = std::find(names.begin(), names.end(), name);
        if (found == names.end()) fail(fmt::format("one of the types {}", fmt::join(names, ", ")));
        return static_cast<ComponentType>(found - names.begin());
    }

    std::string_view text_;
    std::string_view place_;
};

template <class Integer>
void write_integers(std::byte* target, std::uint32_t components, bool normalized, const glm::dvec4& value) {
    constexpr double largest = std::numeric_limits<Integer>::max();
    constexpr double least = std::numeric_limits<Integer>::min();
    for (std::uint32_t i = 0; i < components; ++i) {
        const double scaled = value[static_cast<int>(i)] * (normalized ? largest : 1.0);
        const auto code = static_cast<Integer>(std::clamp(std::nearbyint(scaled), least, largest));
        std::memcpy(target + i * sizeof(Integer), &code, sizeof(Integer));
    }
}

void write_packed(std::byte* target, bool is_signed, bool normalized, const glm::dvec4& value) {
    constexpr std::array<std::uint32_t, 4> widths{10, 10, 10, 2};
    std::uint32_t word = 0;
    std::uint32_t first = 0;
    for (std::size_t i = 0; i < widths.size(); first += widths[i++]) {
        const std::uint32_t mask = (1U << widths[i]) - 1;
        const double largest = is_signed ? mask >> 1U : mask;
        const double least = is_signed ? -largest - 1.0 : 0.0;
        const double scaled = value[static_cast<int>(i)] * (normalized ? largest : 1.0);
        const auto code = static_cast<std::int32_t>(std::clamp(std::nearbyint(scaled), least, largest));
        word |= (static_cast<std::uint32_t>(code) & mask) << first;
    }
    std::memcpy(target, &word, sizeof(word));
}

template <class Stored, class Convert>
void write_floats(std::byte* target, std::uint32_t components, const glm::dvec4& value, Convert convert) {
    for (std::uint32_t i = 0; i < components; ++i) {
        const Stored stored = convert(static_cast<float>(value[static_cast<int>(i)]));
        std::memcpy(target + i * sizeof(Stored), &stored, sizeof(Stored));
    }
}

} // namespace

std::vector<AttributeFormat> read_attribute_formats(std::string_view text, std::string_view place) {
    std::vector<AttributeFormat> formats;
    if (text == "none") return formats;
    std::uint32_t sets = 0;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find('+', begin), text.size());
        const AttributeText one(text.substr(begin, end - begin), place);
        AttributeFormat format = one.format();
        const bool coordinates = format.semantic == Semantic::texcoord0;
        for (std::uint32_t i = 0; i < one.count(); ++i) {
            if (coordinates && sets == pipeline::texcoord_sets)
                one.fail(fmt::format("at most {} sets of texture coordinates", pipeline::texcoord_sets));
            if (coordinates) format.semantic = pipeline::texcoord(sets++);
            if (std::any_of(formats.begin(), formats.end(),
                            [&](const AttributeFormat& other) { return other.semantic == format.semantic; }))
                one.fail("each attribute but texcoord once");
            formats.push_back(format);
        }
        begin = end + 1;
    }
    return formats;
}

void check_align(std::uint32_t align, std::string_view place) {
    if (align != 1 && align != 2 && align != 4)
        throw sim::InputError(fmt::format("{}: align: expected 1, 2 or 4, got {}", place, align));
}

void write_element(std::byte* target, ComponentType type, std::uint32_t components, bool normalized,
                   const glm::dvec4& value) {
    switch (type) {
    case ComponentType::f32:
        return write_floats<float>(target, components, value, [](float f) { return f; });
    case ComponentType::f16:
        return write_floats<std::uint16_t>(target, components, value, pipeline::float_to_half);
    case ComponentType::s8:
        return write_integers<std::int8_t>(target, components, normalized, value);
    case ComponentType::u8:
        return write_integers<std::uint8_t>(target, components, normalized, value);
    case ComponentType::s16:
        return write_integers<std::int16_t>(target, components, normalized, value);
    case ComponentType::u16:
        return write_integers<std::uint16_t>(target, components, normalized, value);
    case ComponentType::u32:
        return write_integers<std::uint32_t>(target, components, normalized, value);
    case ComponentType::s10_10_10_2:
    case ComponentType::u10_10_10_2:
        return write_packed(target, type == ComponentType::s10_10_10_2, normalized, value);
    }
}

PositionGrid::PositionGrid(const glm::dvec3& lo, const glm::dvec3& hi) : centre((lo + hi) / 2.0) {
    constexpr double largest = std::numeric_limits<std::int16_t>::max();
    const glm::dvec3 extent = hi - lo;
    // An axis without extent gets the step of another one, so that the grid is not stretched more than it has to be.
    const double widest = std::max({extent.x, extent.y, extent.z});
    if (!(widest > 0.0)) return;
    for (int axis = 0; axis < 3; ++axis) step[axis] = (extent[axis] > 0.0 ? extent[axis] : widest) / (2.0 * largest);
}

glm::dvec3 PositionGrid::code(const glm::dvec3& position) const {
    glm::dvec3 code;
    for (int axis = 0; axis < 3; ++axis) code[axis] = std::nearbyint((position[axis] - centre[axis]) / step[axis]);
    return code;
}

glm::mat4 PositionGrid::to_model() const {
    glm::mat4 matrix(1.0F);
    for (int axis = 0; axis < 3; ++axis) matrix[axis][axis] = static_cast<float>(step[axis]);
    matrix[3] = glm::vec4(glm::vec3(centre), 1.0F);
    return matrix;
}

} // namespace traces
