#include "traces/pass_needs.hpp"

#include "pipeline/geometry/vertex_lines.hpp" // reads_attribute

#include <fmt/format.h>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace traces {

using pipeline::AlphaMode;
using pipeline::FragmentColour;
using pipeline::Frame;
using pipeline::LeftOut;
using pipeline::Needs;
using pipeline::Pass;
using pipeline::PassKind;
using pipeline::Semantic;

namespace {

void add_draw_to(Offers& offers, const pipeline::Resources& resources, const pipeline::Draw& draw) {
    const pipeline::Geometry& geometry = resources.geometries[draw.geometry];
    const pipeline::Material& material = resources.materials[draw.material];
    const auto* colour = geometry.find(Semantic::colour);
    const bool textured = material.base_texture >= 0 && geometry.find(pipeline::texcoord(material.texcoord)) != nullptr;
    const bool mask = material.alpha_mode == AlphaMode::mask;
    offers.indices |= geometry.index_type != pipeline::IndexType::none;
    offers.alpha_test |= mask;
    offers.alpha_in_mask |= mask && colour != nullptr && colour->components == 4;
    offers.textured_mask |= mask && textured;
    offers.normals |= !material.unlit && geometry.find(Semantic::normal) != nullptr;
    offers.any_normals |= geometry.find(Semantic::normal) != nullptr;
    offers.vertex_colours |= colour != nullptr;
    offers.textures |= textured;
    for (const auto& attribute : geometry.attributes) offers.attributes |= mask_of(attribute.semantic);
}

} // namespace

Offers offers_of(const Frame& frame) {
    Offers offers;
    for (const Pass& pass : frame.passes)
        for (const std::uint32_t draw : pass.draws) add_draw_to(offers, *frame.resources, frame.draws[draw]);
    return offers;
}

namespace {

// What the fragments of the passes are asked for.
struct Values {
    bool lit = false, cosine = false, normal = false, map_texcoords = false;
    bool textured = false; ///< texture and vertex colours, lit or not
    bool own_shaders = false;
};

/// What a pass asks its fragments for.
std::optional<FragmentColour> asked_of(const Frame& frame, const Pass& pass, FragmentColour colour) {
    if (pass.kernel != nullptr) return std::nullopt;
    if (pass.shader != nullptr) return pass.shader->shape().colour;
    if (pass.writes_colour() || (pass.runs_program() && frame.program->needs_colour())) return colour;
    return std::nullopt;
}

Values values_of(const Frame& frame, FragmentColour colour) {
    Values values;
    for (const Pass& pass : frame.passes) {
        const std::optional<FragmentColour> wanted = asked_of(frame, pass, colour);
        if (pass.shader != nullptr) {
            values.normal |= pass.shader->shape().normal;
            values.map_texcoords |= pass.shader->shape().map_texcoords;
            values.own_shaders |= pass.kind == PassKind::draw;
        }
        values.lit |= wanted == FragmentColour::lit;
        values.cosine |= wanted == FragmentColour::cosine;
        values.textured |= wanted == FragmentColour::lit || wanted == FragmentColour::unlit;
    }
    return values;
}

} // namespace

Needs needs_of(const Frame& frame, const Offers& offers, FragmentColour colour) {
    Needs needs;
    for (const Pass& pass : frame.passes) {
        needs.colours |= asked_of(frame, pass, colour).has_value();
        needs.depth |= pass.uses_depth();
        needs.early_depth |= pass.tests_depth() && !pass.writes_depth();
        needs.colour_surface |= pass.rasterizes() && pass.writes_colour();
        needs.kbuffer |= pass.runs_program();
        needs.attributes |= pass.attributes;
    }
    needs.index_buffer = offers.indices;
    needs.fragment_colour = colour;
    const Values values = values_of(frame, colour);
    if (colour == FragmentColour::flat && !values.own_shaders) return needs;
    needs.alpha_test = offers.alpha_test;
    needs.fragment_normals = values.normal;
    needs.map_texcoords = values.map_texcoords;
    needs.normals = (values.lit && offers.normals) || ((values.cosine || values.normal) && offers.any_normals);
    needs.vertex_colours = (values.textured && offers.vertex_colours) || offers.alpha_in_mask;
    needs.textures = (values.textured && offers.textures) || offers.textured_mask;
    needs.texcoords = needs.textures;
    return needs;
}

namespace {

// Attributes that are fetched for at least one draw.
std::uint32_t read_attributes(const Frame& frame) {
    std::uint32_t read = 0;
    for (const Pass& pass : frame.passes)
        for (const std::uint32_t number : pass.draws) {
            const pipeline::Draw& draw = frame.draws[number];
            const auto& material = frame.resources->materials[draw.material];
            for (const auto& attribute : frame.resources->geometries[draw.geometry].attributes)
                if (reads_attribute(frame.needs, material, attribute.semantic)) read |= mask_of(attribute.semantic);
        }
    return read;
}

constexpr std::uint32_t all_texcoords = [] {
    std::uint32_t mask = 0;
    for (std::uint32_t set = 0; set < pipeline::texcoord_sets; ++set) mask |= mask_of(pipeline::texcoord(set));
    return mask;
}();

// Attributes that only some geometries have: listed one by one where they are there and nobody reads them.
void list_further_attributes(std::vector<LeftOut>& list, const Offers& offers, std::uint32_t read) {
    constexpr const char* reason = "no vertex shader and no drawn material reads them";
    std::uint32_t unread = offers.attributes & ~read;
    if ((read & all_texcoords) == 0) unread &= ~mask_of(Semantic::texcoord0); // listed as texture coordinates
    if ((unread & mask_of(Semantic::secondary_colour)) != 0) list.push_back({"secondary colours", reason});
    for (std::uint32_t set = 0; set < pipeline::texcoord_sets; ++set)
        if ((unread & mask_of(pipeline::texcoord(set))) != 0)
            list.push_back({fmt::format("texture coordinates {}", set), reason});
    if ((unread & mask_of(Semantic::generic)) != 0) list.push_back({"generic attributes", reason});
}

} // namespace

void list_left_out(Frame& frame, const Offers& offers) {
    std::vector<LeftOut>& list = frame.left_out;
    const Needs& needs = frame.needs;
    const std::uint32_t read = read_attributes(frame);
    const auto add = [&](bool needed, const char* unit, const char* reason) {
        if (!needed) list.push_back({unit, reason});
    };
    // An attribute is missing from the scene, or it is there and nobody reads it.
    const auto unless_offered = [](bool offered, const char* missing, const char* unread) {
        return offered ? unread : missing;
    };
    constexpr const char* flat = "fragments have the base colour of their material";
    const char* no_colours = "no pass reads colours";
    const char* no_reader = "no pass reads colours and no alpha test reads it";
    if (needs.colours && needs.fragment_colour == FragmentColour::flat) no_colours = no_reader = flat;
    if (needs.colours && needs.fragment_colour == FragmentColour::cosine)
        no_reader = "fragments have the cosine to their normal for a colour, and no alpha test reads it";
    constexpr const char* no_texture = "no drawn material has a texture and coordinates for it";
    add(needs.index_buffer, "index buffer", "no drawn geometry has indices");
    add((read & mask_of(Semantic::normal)) != 0, "normals",
        unless_offered(offers.normals, "no drawn geometry with a lit material has them", no_colours));
    add((read & mask_of(Semantic::colour)) != 0, "vertex colours",
        unless_offered(offers.vertex_colours, "no drawn geometry has them", no_reader));
    add((read & all_texcoords) != 0, "texture coordinates", unless_offered(offers.textures, no_texture, no_reader));
    list_further_attributes(list, offers, read);
    add(needs.textures, "textures", unless_offered(offers.textures, no_texture, no_reader));
    add(needs.alpha_test, "alpha test", unless_offered(offers.alpha_test, "no drawn material tests alpha", flat));
    add(needs.colours, "colours", no_colours);
    add(needs.depth, "depth surface", "no pass tests or writes depth");
    add(needs.early_depth, "early depth test", "no pass tests a depth surface that it does not write");
    add(needs.colour_surface, "colour surface", "no pass writes it");
    add(needs.kbuffer, "k-buffer", "no pass runs a modify program");
}

} // namespace traces
