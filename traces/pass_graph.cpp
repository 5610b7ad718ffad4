#include "traces/pass_graph.hpp"

#include "pipeline/functional/surface_texel.hpp"
#include "pipeline/geometry/vertex_fetch.hpp" // reads_attribute
#include "sim/check.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>
#include <set>
#include <utility>

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

bool contains(const std::vector<std::string>& names, std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

// What the draws of the remaining passes offer to be used.
struct Offers {
    bool indices = false;
    bool alpha_test = false;
    bool alpha_in_mask = false; ///< a tested alpha comes from vertex colours, too
    bool textured_mask = false;
    bool normals = false;     ///< of lit materials
    bool any_normals = false; ///< of any material
    bool vertex_colours = false;
    bool textures = false;        ///< with coordinates to read them at
    std::uint32_t attributes = 0; ///< all that the geometries have: bits as in mask_of(Semantic)
};

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

Offers offers_of(const Frame& frame) {
    Offers offers;
    for (const Pass& pass : frame.passes)
        for (const std::uint32_t draw : pass.draws) add_draw_to(offers, *frame.resources, frame.draws[draw]);
    return offers;
}

Needs needs_of(const Frame& frame, const Offers& offers, FragmentColour colour) {
    Needs needs;
    for (const Pass& pass : frame.passes) {
        needs.colours |= pass.writes_colour() || (pass.runs_program() && frame.program->needs_colour());
        needs.depth |= pass.uses_depth();
        needs.early_depth |= pass.tests_depth() && !pass.writes_depth();
        needs.colour_surface |= pass.writes_colour();
        needs.kbuffer |= pass.runs_program();
        needs.attributes |= pass.attributes;
    }
    needs.index_buffer = offers.indices;
    needs.fragment_colour = colour;
    if (colour == FragmentColour::flat) return needs;
    const bool lit = needs.colours && colour == FragmentColour::lit;
    needs.alpha_test = offers.alpha_test;
    needs.normals = lit ? offers.normals : needs.colours && offers.any_normals;
    needs.vertex_colours = (lit && offers.vertex_colours) || offers.alpha_in_mask;
    needs.textures = (lit && offers.textures) || offers.textured_mask;
    needs.texcoords = needs.textures;
    return needs;
}

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

void list_left_out(std::vector<LeftOut>& list, const Needs& needs, const Offers& offers, std::uint32_t read) {
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

} // namespace

// Walks the passes from last to first and keeps what somebody behind still reads.
class PassGraph::Culling {
  public:
    explicit Culling(const std::vector<std::string>& outputs) : live_(outputs.begin(), outputs.end()) {}

    void visit(Node node) {
        const Pass& pass = node.pass;
        if (pass.kind == PassKind::draw && pass.draws.empty()) {
            note(fmt::format("pass {}", pass.name), "it draws nothing");
            return;
        }
        if (std::none_of(node.writes.begin(), node.writes.end(),
                         [&](const auto& name) { return live_.contains(name); })) {
            note(fmt::format("pass {}", pass.name), fmt::format("nobody reads {}", fmt::join(node.writes, ", ")));
            return;
        }
        drop_unread_writes(node);
        // Clears and resolves write every pixel, so what was there before is of no use; draws write some of them.
        if (pass.kind != PassKind::draw)
            for (const std::string& name : node.writes) live_.erase(name);
        live_.insert(node.reads.begin(), node.reads.end());
        kept_.push_back(std::move(node));
    }

    std::vector<Node> kept() const { return reversed(kept_); }
    std::vector<LeftOut> left_out() const { return reversed(left_out_); }

  private:
    void drop_unread_writes(Node& node) {
        std::vector<std::string> writes;
        for (const std::string& name : node.writes) {
            // A pass that reads what it writes itself needs it: a depth test without depth writes is another test.
            if (live_.contains(name) || contains(node.reads, name))
                writes.push_back(name);
            else if (node.pass.kind == PassKind::draw) // else the pass that would write it is reported
                note(fmt::format("{} of pass {}", name, node.pass.name), "nobody reads it");
        }
        node.writes = std::move(writes);
    }

    void note(std::string unit, std::string reason) { left_out_.push_back({std::move(unit), std::move(reason)}); }

    template <class T>
    static std::vector<T> reversed(std::vector<T> list) {
        std::reverse(list.begin(), list.end());
        return list;
    }

    std::set<std::string> live_;
    std::vector<Node> kept_;
    std::vector<LeftOut> left_out_;
};

PassGraph::PassGraph(Frame frame) : frame_(std::move(frame)) {
    CHECK(frame_.resources != nullptr);
    frame_.passes.clear();
}

void PassGraph::add_clear(std::string name, std::vector<std::string> writes) {
    Node& node = nodes_.emplace_back();
    node.pass.name = std::move(name);
    node.pass.kind = PassKind::clear;
    node.writes = std::move(writes);
}

void PassGraph::add_draw(std::string name, std::vector<std::string> reads, std::vector<std::string> writes,
                         std::vector<std::uint32_t> draws, bool both_faces, const pipeline::BlendState& blend) {
    for (const std::uint32_t draw : draws) CHECK(draw < frame_.draws.size());
    CHECK(!contains(writes, kbuffer_surface) || frame_.program != nullptr);
    Node& node = nodes_.emplace_back();
    node.reads = std::move(reads);
    node.writes = std::move(writes);
    Pass& pass = node.pass;
    pass.name = std::move(name);
    pass.draws = std::move(draws);
    pass.both_faces = both_faces;
    pass.states[0].blend[0] = blend;
    pass.states[0].depth.test = contains(node.reads, depth_surface);
    pass.states[0].depth.write = contains(node.writes, depth_surface);
    if (contains(node.writes, kbuffer_surface) && !contains(node.reads, kbuffer_surface))
        node.reads.emplace_back(kbuffer_surface);
}

Pass& PassGraph::last_draw() {
    CHECK(!nodes_.empty() && nodes_.back().pass.kind == PassKind::draw);
    return nodes_.back().pass;
}

void PassGraph::vertex_shader_reads(std::uint32_t attributes) { last_draw().attributes = attributes; }

void PassGraph::see_from(const pipeline::View& view) {
    frame_.other_views.push_back(view);
    last_draw().view = static_cast<std::uint32_t>(frame_.other_views.size());
}

void PassGraph::write_targets(std::uint32_t targets) {
    CHECK(targets >= 1);
    last_draw().written_targets = targets;
}

void PassGraph::set_states(std::vector<pipeline::RasterState> states, std::vector<std::uint32_t> of_draw) {
    CHECK(!states.empty() && (of_draw.empty() || of_draw.size() == last_draw().draws.size()));
    last_draw().states = std::move(states);
    last_draw().state_of_draw = std::move(of_draw);
}

void PassGraph::use(pipeline::FragmentColour colour) { fragment_colour_ = colour; }

void PassGraph::add_resolve(std::string name, std::vector<std::string> reads, std::vector<std::string> writes) {
    Node& node = nodes_.emplace_back();
    node.pass.name = std::move(name);
    node.pass.kind = PassKind::resolve;
    node.reads = std::move(reads);
    node.writes = std::move(writes);
}

void PassGraph::output(std::string surface) { outputs_.push_back(std::move(surface)); }

void PassGraph::leave_out(std::string unit, std::string reason) {
    left_out_.push_back({std::move(unit), std::move(reason)});
}

// Each surface is as large as what the first pass that draws to it sees.
void PassGraph::bind_surfaces(Frame& frame, std::span<const Node> nodes) {
    const auto info_of = [&frame](const std::string& name, const pipeline::View& view) {
        pipeline::SurfaceInfo info{.name = name, .width = view.width, .height = view.height, .planes = view.samples};
        if (name == depth_surface) {
            info.format = frame.depth_format;
            pack_depth_stencil(info.format, {farthest_depth(info.format), 0}, info.cleared.data());
        } else if (name == colour_surface) {
            info.format = frame.colour_format;
            pack_colour(info.format, frame.background, info.cleared.data());
        } else {
            info.program = frame.program;
        }
        return info;
    };
    std::map<std::string, pipeline::SurfaceId> ids;
    const auto id_of = [&](const std::string& name, const pipeline::View& view) {
        const auto [at, added] = ids.try_emplace(name, static_cast<pipeline::SurfaceId>(frame.surfaces.size()));
        if (added) frame.surfaces.push_back(info_of(name, view));
        return at->second;
    };
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        Pass& pass = frame.passes[i];
        if (pass.kind != PassKind::draw) continue;
        const pipeline::View& view = frame.view_of(pass);
        if (pass.uses_depth()) pass.depth = id_of(depth_surface, view);
        if (contains(nodes[i].writes, colour_surface)) pass.targets = {id_of(colour_surface, view)};
        if (contains(nodes[i].writes, kbuffer_surface)) pass.kbuffer = id_of(kbuffer_surface, view);
    }
    for (std::size_t i = 0; i < nodes.size(); ++i)
        if (frame.passes[i].kind == PassKind::clear)
            for (const std::string& name : nodes[i].writes) frame.passes[i].clears.push_back(id_of(name, frame.view));
}

Frame PassGraph::lower() const {
    Culling culling(outputs_);
    for (auto node = nodes_.rbegin(); node != nodes_.rend(); ++node) culling.visit(*node);
    Frame frame = frame_;
    const std::vector<Node> kept = culling.kept();
    for (const Node& node : kept) {
        Pass& pass = frame.passes.emplace_back(node.pass);
        if (pass.kind != PassKind::draw) continue;
        for (pipeline::RasterState& state : pass.states) {
            state.depth.test &= contains(node.reads, depth_surface);
            state.stencil.test &= contains(node.reads, depth_surface);
            state.depth.write &= contains(node.writes, depth_surface);
        }
    }
    bind_surfaces(frame, kept);
    const Offers offers = offers_of(frame);
    frame.needs = needs_of(frame, offers, fragment_colour_);
    if (frame.needs.textures) frame.resources->read_textures();
    if (!frame.needs.kbuffer) {
        frame.program = nullptr;
        frame.resolve = nullptr;
    }
    frame.left_out = left_out_;
    for (LeftOut& item : culling.left_out()) frame.left_out.push_back(std::move(item));
    list_left_out(frame.left_out, frame.needs, offers, read_attributes(frame));
    return frame;
}

} // namespace traces
