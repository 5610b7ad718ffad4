#include "traces/pass_graph.hpp"

#include "pipeline/functional/fragment_operations.hpp"
#include "pipeline/functional/surface_texel.hpp"
#include "sim/check.hpp"
#include "traces/pass_needs.hpp"
#include "traces/screen_draw.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>
#include <set>
#include <utility>

namespace traces {

using pipeline::Frame;
using pipeline::LeftOut;
using pipeline::Pass;
using pipeline::PassKind;

namespace {

bool contains(const std::vector<std::string>& names, std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

} // namespace

bool has_colour(const pipeline::SurfaceInfo& surface) {
    return surface.program == nullptr && !has_depth(surface.format) && !has_stencil(surface.format);
}

// Walks the passes from last to first and keeps what somebody behind still reads.
class PassGraph::Culling {
  public:
    explicit Culling(const std::vector<std::string>& outputs) : live_(outputs.begin(), outputs.end()) {}

    void visit(Node node) {
        const Pass& pass = node.pass;
        if (node.mark) {
            live_.insert(node.reads.begin(), node.reads.end());
            return;
        }
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
        // Clears, kernels and passes over the screen write every pixel, so what was there before is of no use; draws
        // write some of them.
        if (pass.kind != PassKind::draw && !keeps_targets(pass))
            for (const std::string& name : node.writes) live_.erase(name);
        live_.insert(node.reads.begin(), node.reads.end());
        kept_.push_back(std::move(node));
    }

    std::vector<Node> kept() const { return reversed(kept_); }
    std::vector<LeftOut> left_out() const { return reversed(left_out_); }

  private:
    static bool keeps_targets(const Pass& pass) {
        if (pass.kind != PassKind::screen) return false;
        const pipeline::RasterState& state = pass.states.front();
        return std::any_of(state.blend.begin(), state.blend.end(), pipeline::reads_target) ||
               std::any_of(state.write_mask.begin(), state.write_mask.end(), [](unsigned mask) { return mask != 15; });
    }

    void drop_unread_writes(Node& node) {
        std::vector<std::string> writes;
        for (const std::string& name : node.writes) {
            // A pass that reads what it writes itself needs it: a depth test without depth writes is another test.
            if (live_.contains(name) || contains(node.reads, name))
                writes.push_back(name);
            else if (node.pass.writes_targets()) // else the pass that would write it is reported
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

void PassGraph::Node::check_slots() const {
    for (const std::string& name : slots)
        if (contains(writes, name) || (!depth.empty() && name == depth))
            throw sim::InputError(fmt::format("pass {}: it reads the surface {}, which it writes", pass.name, name));
}

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
    if (contains(node.reads, depth_surface) || contains(node.writes, depth_surface)) node.depth = depth_surface;
    if (contains(node.writes, colour_surface)) node.targets = {colour_surface};
    if (contains(node.writes, kbuffer_surface)) node.kbuffer = kbuffer_surface;
    if (contains(node.writes, kbuffer_surface) && !contains(node.reads, kbuffer_surface))
        node.reads.emplace_back(kbuffer_surface);
}

void PassGraph::add_surface(pipeline::SurfaceInfo info) {
    std::string name = info.name;
    surfaces_.insert_or_assign(std::move(name), Surface{std::move(info), true});
}

void PassGraph::add_surface(std::string name, pipeline::SurfaceFormat format, const glm::vec4& cleared) {
    pipeline::SurfaceInfo info{.name = name, .format = format};
    if (has_depth(format) || has_stencil(format))
        pack_depth_stencil(format, {farthest_depth(format), 0}, info.cleared.data());
    else
        pack_colour(format, cleared, info.cleared.data());
    surfaces_.insert_or_assign(std::move(name), Surface{std::move(info), false});
}

void PassGraph::add_shaded(ShadedPass added) {
    CHECK(added.shader != nullptr && (!added.screen || added.draws.empty()) && (added.timed || added.screen));
    CHECK(added.kbuffer.empty() || frame_.program != nullptr);
    Node& node = nodes_.emplace_back();
    Pass& pass = node.pass;
    pass.name = std::move(added.name);
    pass.kind = !added.screen ? PassKind::draw : added.timed ? PassKind::screen : PassKind::compose;
    pass.shader = std::move(added.shader);
    pass.draws = std::move(added.draws);
    pass.both_faces = added.both_faces;
    pass.cold = added.cold;
    pass.states = std::move(added.states);
    pass.state_of_draw = std::move(added.state_of_draw);
    CHECK(!pass.states.empty() && (pass.state_of_draw.empty() || pass.state_of_draw.size() == pass.draws.size()));
    if (added.view) {
        frame_.other_views.push_back(*added.view);
        pass.view = static_cast<std::uint32_t>(frame_.other_views.size());
    }
    for (const std::string& target : added.targets)
        if (!target.empty()) node.writes.push_back(target);
    if (pass.writes_depth() || pass.tests_stencil()) node.writes.push_back(added.depth);
    if (!added.kbuffer.empty()) node.writes.push_back(added.kbuffer);
    node.reads = added.reads;
    if (pass.tests_depth() || pass.tests_stencil()) node.reads.push_back(added.depth);
    if (!added.kbuffer.empty()) node.reads.push_back(added.kbuffer);
    node.slots = std::move(added.reads);
    node.targets = std::move(added.targets);
    if (pass.uses_depth()) node.depth = std::move(added.depth);
    node.kbuffer = std::move(added.kbuffer);
    node.check_slots();
}

void PassGraph::add_kernel(std::string name, std::shared_ptr<const pipeline::Kernel> kernel,
                           std::vector<std::string> reads, std::vector<std::string> targets) {
    CHECK(kernel != nullptr);
    Node& node = nodes_.emplace_back();
    node.pass.name = std::move(name);
    node.pass.kind = PassKind::compose;
    node.pass.kernel = std::move(kernel);
    node.reads = node.slots = std::move(reads);
    node.writes = node.targets = std::move(targets);
    node.check_slots();
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

void PassGraph::set_states(std::vector<pipeline::RasterState> states, std::vector<std::uint32_t> of_draw) {
    CHECK(!states.empty() && (of_draw.empty() || of_draw.size() == last_draw().draws.size()));
    last_draw().states = std::move(states);
    last_draw().state_of_draw = std::move(of_draw);
}

void PassGraph::use(pipeline::FragmentColour colour) { fragment_colour_ = colour; }

void PassGraph::output(std::string surface) { outputs_.push_back(std::move(surface)); }

void PassGraph::keep(std::string surface) {
    Node& node = nodes_.emplace_back();
    node.mark = true;
    node.reads = {std::move(surface)};
}

void PassGraph::leave_out(std::string unit, std::string reason) {
    left_out_.push_back({std::move(unit), std::move(reason)});
}

// Makes numbers of the names.
class PassGraph::Binding {
  public:
    Binding(const std::map<std::string, Surface>& declared, Frame& frame, std::span<const Node> nodes)
        : declared_(declared), frame_(frame) {
        for (std::size_t i = 0; i < nodes.size(); ++i)
            if (frame.passes[i].writes_targets()) bind(frame.passes[i], nodes[i]);
        for (std::size_t i = 0; i < nodes.size(); ++i)
            if (frame.passes[i].kind == PassKind::clear)
                for (const std::string& name : nodes[i].writes)
                    frame.passes[i].clears.push_back(id_of(name, frame.view));
        for (std::size_t i = 0; i < nodes.size(); ++i)
            for (const std::string& name : nodes[i].slots) frame.passes[i].reads.push_back(to_be_read(name, nodes[i]));
    }

    pipeline::SurfaceId find(const std::string& name) const {
        const auto at = ids_.find(name);
        return at == ids_.end() ? pipeline::no_surface : at->second;
    }

  private:
    void bind(Pass& pass, const Node& node) {
        pipeline::View view = frame_.view_of(pass);
        if (pass.kind != PassKind::draw) view.samples = 1; // one colour for each pixel
        if (pass.uses_depth()) pass.depth = id_of(node.depth, view);
        for (const std::string& target : node.targets)
            pass.targets.push_back(contains(node.writes, target) ? id_of(target, view) : pipeline::no_surface);
        while (!pass.targets.empty() && pass.targets.back() == pipeline::no_surface) pass.targets.pop_back();
        if (contains(node.writes, node.kbuffer)) pass.kbuffer = id_of(node.kbuffer, view);
    }

    pipeline::SurfaceId to_be_read(const std::string& name, const Node& node) {
        const pipeline::SurfaceId surface = find(name);
        if (surface != pipeline::no_surface) return surface;
        const auto declared = declared_.find(name);
        if (declared == declared_.end() || declared->second.info.contents == nullptr)
            throw sim::InputError(
                fmt::format("pass {}: it reads the surface {}, which no pass writes", node.pass.name, name));
        return id_of(name, frame_.view);
    }

    // Each surface is as large as what the first pass that draws to it sees.
    pipeline::SurfaceId id_of(const std::string& name, const pipeline::View& view) {
        const auto [at, added] = ids_.try_emplace(name, static_cast<pipeline::SurfaceId>(frame_.surfaces.size()));
        if (added) frame_.surfaces.push_back(info_of(name, view));
        return at->second;
    }

    pipeline::SurfaceInfo info_of(const std::string& name, const pipeline::View& view) const {
        const auto declared = declared_.find(name);
        if (declared != declared_.end() && declared->second.sized) return declared->second.info;
        pipeline::SurfaceInfo info;
        if (declared != declared_.end()) {
            info = declared->second.info;
        } else if (name == depth_surface) {
            info.format = frame_.depth_format;
            pack_depth_stencil(info.format, {farthest_depth(info.format), 0}, info.cleared.data());
        } else if (name == colour_surface) {
            info.format = frame_.colour_format;
            pack_colour(info.format, frame_.background, info.cleared.data());
        } else {
            CHECK_MSG(name == kbuffer_surface, fmt::format("nobody has declared the surface {}", name));
            info.program = frame_.program;
        }
        info.name = name;
        info.width = view.width;
        info.height = view.height;
        info.planes = view.samples;
        return info;
    }

    const std::map<std::string, Surface>& declared_;
    Frame& frame_;
    std::map<std::string, pipeline::SurfaceId> ids_;
};

Frame PassGraph::lower() const {
    std::vector<std::string> read = outputs_;
    for (const auto& [name, surface] : surfaces_)
        if (!surface.info.shown.empty()) read.push_back(name);
    Culling culling(read);
    for (auto node = nodes_.rbegin(); node != nodes_.rend(); ++node) culling.visit(*node);
    Frame frame = frame_;
    const std::vector<Node> kept = culling.kept();
    for (const Node& node : kept) {
        Pass& pass = frame.passes.emplace_back(node.pass);
        for (pipeline::RasterState& state : pass.states) {
            state.depth.test &= contains(node.reads, node.depth);
            state.stencil.test &= contains(node.reads, node.depth);
            state.depth.write &= contains(node.writes, node.depth);
        }
    }
    const Binding binding(surfaces_, frame, kept);
    for (const std::string& name : outputs_)
        if (const pipeline::SurfaceId surface = binding.find(name);
            surface != pipeline::no_surface && has_colour(frame.surfaces[surface]))
            frame.output = surface;
    if (std::any_of(frame.passes.begin(), frame.passes.end(),
                    [](const Pass& pass) { return pass.kind == PassKind::screen; }) &&
        !frame.screen_draw)
        add_screen_draw(frame);
    const Offers offers = offers_of(frame);
    frame.needs = needs_of(frame, offers, fragment_colour_);
    if (frame.needs.textures) frame.resources->read_textures();
    if (!frame.needs.kbuffer) frame.program = nullptr;
    frame.left_out = left_out_;
    for (LeftOut& item : culling.left_out()) frame.left_out.push_back(std::move(item));
    list_left_out(frame, offers);
    return frame;
}

} // namespace traces
