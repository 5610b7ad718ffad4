#include "traces/recording/recorded_passes.hpp"

#include "models/programs/mlab.hpp"
#include "models/programs/pictures.hpp"
#include "sim/check.hpp"
#include "sim/counted.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <utility>

namespace traces {

namespace {

using pipeline::RasterState;

} // namespace

std::shared_ptr<const LinkedProgram> RecordedPrograms::program(std::uint32_t number) {
    auto& program = programs_[number];
    if (program == nullptr) program = std::make_shared<const LinkedProgram>(recording_.programs.at(number));
    return program;
}

RecordedPrograms::Words RecordedPrograms::words(const ShaderStage& stage, std::uint32_t values) {
    Words& words = words_[{&stage, values}];
    if (words == nullptr)
        words = std::make_shared<const std::vector<std::uint32_t>>(stage.uniform_words(recording_.values.at(values)));
    return words;
}

std::vector<std::string> RecordedPrograms::notes() const {
    std::vector<std::string> notes;
    for (const auto& [number, program] : programs_)
        notes.insert(notes.end(), program->notes.begin(), program->notes.end());
    return notes;
}

RecordedPasses::RecordedPasses(const Recording& recording, std::shared_ptr<const pipeline::Resources> resources,
                               std::uint32_t screen_geometry, const std::optional<KBufferChoice>& kbuffer)
    : recording_(recording),
      drawn_parts_(recording),
      resources_(std::move(resources)),
      screen_geometry_(screen_geometry),
      programs_(recording),
      kbuffer_(kbuffer) {
    if (kbuffer) program_ = models::make_nodes(kbuffer->k);
    surfaces = drawn_parts_.surfaces();
    for (const TargetSet& set : recording.targets) targets_.push_back(drawn_parts_.of(set));
    for (const RecordedFrame& frame : recording.frames)
        for (const RecordedCommand& command : frame.commands)
            if (const auto* draw = std::get_if<RecordedDraw>(&command))
                if (const auto& depth = targets_.at(draw->targets).depth;
                    depth && recording.states.at(draw->state).stencil.test)
                    stencil_tested_.insert(depth->surface);
}

void RecordedPasses::add(const RecordedFrame& frame) {
    frame_ = recording_.frames.size() == 1 ? std::string() : fmt::format("frame {} ", frame.number);
    run_ = draws_ = 0;
    run_targets_.reset();
    for (const RecordedCommand& command : frame.commands) std::visit([this](const auto& one) { add(one); }, command);
    close();
    const auto& colours = targets_.at(frame.shown).colours;
    if (!colours.empty() && colours.front()) steps.push_back({{}, {}, name_of(colours.front()->surface)});
}

void RecordedPasses::enter_run(std::uint32_t targets) {
    if (run_targets_ == targets) return;
    if (run_targets_) ++run_;
    run_targets_ = targets;
    parts_ = 0;
}

std::string RecordedPasses::pass_name() {
    const std::string name = fmt::format("{}pass {}", frame_, run_);
    return parts_++ == 0 ? name : fmt::format("{} part {}", name, parts_);
}

void RecordedPasses::open(std::uint32_t targets, bool kbuffer) {
    if (open_ != nullptr && open_->number == targets && open_->kbuffer == kbuffer) return;
    open(targets_.at(targets), kbuffer);
    open_->number = targets;
}

void RecordedPasses::open(const TargetSet& targets, bool kbuffer) {
    close();
    const auto check = [this](const TargetSet::Target& target) {
        if (surfaces[target.surface].planes != 1)
            throw sim::InputError(
                fmt::format("surface \"{}\": expected to be drawn to with one sample", name_of(target.surface)));
    };
    open_ = std::make_shared<Open>();
    open_->targets = targets;
    open_->kbuffer = kbuffer;
    open_->first_draw = static_cast<std::uint32_t>(draws.size());
    ShadedPass& pass = open_->pass;
    pass.name = pass_name();
    pass.states.clear();
    if (kbuffer) pass.kbuffer = kbuffer_surface;
    for (const auto& target : targets.colours) {
        if (target) check(*target);
        if (target) expect_size_of(targets, target->surface);
        if (target) written_.insert(target->surface);
        if (!kbuffer) pass.targets.push_back(target ? name_of(target->surface) : std::string());
    }
    if (targets.depth) {
        check(*targets.depth);
        written_.insert(targets.depth->surface);
        pass.depth = name_of(targets.depth->surface);
    }
    pass.view.emplace();
    pass.view->width = targets.width;
    pass.view->height = targets.height;
}

// Smaller ones draw to a part of others, which the pipeline's surfaces do not have.
void RecordedPasses::expect_size_of(const TargetSet& targets, std::uint32_t surface) const {
    const pipeline::SurfaceInfo& info = surfaces[surface];
    if (info.width != targets.width || info.height != targets.height)
        throw sim::InputError(
            fmt::format("surface \"{}\": expected to be drawn to with others of its {} x {} pixels, got "
                        "targets of {} x {}",
                        info.name, info.width, info.height, targets.width, targets.height));
}

void RecordedPasses::close() {
    const std::shared_ptr<Open> open = std::exchange(open_, nullptr);
    if (open == nullptr || open->uses.empty()) return;
    if (std::any_of(open->pass.states.begin(), open->pass.states.end(),
                    [](const RasterState& state) { return state.depth.used() || state.stencil.test; }))
        expect_size_of(open->targets, open->targets.depth.value().surface);
    for (const std::uint32_t surface : open->reads) open->pass.reads.push_back(name_of(surface));
    open->pass.shader = std::make_shared<const RecordedShader>(static_cast<std::uint32_t>(open->targets.colours.size()),
                                                               static_cast<std::uint32_t>(open->reads.size()),
                                                               open->first_draw, std::move(open->uses));
    if (open->kbuffer) steps.push_back({{kbuffer_surface}, {}, {}});
    steps.push_back({{}, std::move(open->pass), {}});
    if (open->kbuffer) lay_nodes(*open);
}

// C + T * what is there, which the fixed blending of the ROP does.
void RecordedPasses::lay_nodes(const Open& open) {
    const glm::uvec2 size(open.targets.width, open.targets.height);
    if (std::exchange(kbuffer_used_, true) && kbuffer_size_ != size)
        throw sim::InputError("--kbuffer: expected draws to targets of one size");
    kbuffer_size_ = size;
    ShadedPass pass;
    pass.name = pass_name();
    pass.shader = models::nodes_shader(program_);
    pass.screen = true;
    pass.reads = {kbuffer_surface};
    pass.targets = {name_of(open.targets.colours[0]->surface)};
    pass.view.emplace();
    pass.view->width = size.x;
    pass.view->height = size.y;
    constexpr pipeline::BlendPart colour{pipeline::BlendFactor::one, pipeline::BlendFactor::source_alpha};
    constexpr pipeline::BlendPart alpha{pipeline::BlendFactor::zero, pipeline::BlendFactor::one};
    pass.states[0].blend[0] = pipeline::blends::of(colour, alpha);
    steps.push_back({{}, std::move(pass), {}});
}

bool RecordedPasses::chosen(const RecordedDraw& draw) {
    const std::uint32_t number = draws_++;
    if (!kbuffer_) return false;
    const auto& colours = targets_.at(draw.targets).colours;
    const RasterState& state = recording_.states.at(draw.state);
    std::string reason = not_for_nodes(state);
    if (reason.empty() && (colours.size() != 1 || !colours[0])) reason = "it has more or fewer targets than one";
    if (kbuffer_->kind == KBufferChoice::Kind::blended) {
        if (!reason.empty() && state.blend[0].enabled) ++not_kept_[reason];
        return reason.empty();
    }
    const std::uint32_t place = kbuffer_->kind == KBufferChoice::Kind::pass ? run_ : number;
    if (place < kbuffer_->first || place > kbuffer_->last) return false;
    if (!reason.empty()) throw sim::InputError(fmt::format("--kbuffer: draw {} \"{}\": {}", number, draw.name, reason));
    return true;
}

std::uint32_t RecordedPasses::slot_of(std::uint32_t surface) {
    std::vector<std::uint32_t>& reads = open_->reads;
    const auto found = std::find(reads.begin(), reads.end(), surface);
    if (found != reads.end()) return static_cast<std::uint32_t>(found - reads.begin());
    reads.push_back(surface);
    return static_cast<std::uint32_t>(reads.size() - 1);
}

void RecordedPasses::push(pipeline::Draw draw, std::uint32_t state, FragmentUse use) {
    use.height = open_->targets.height;
    use.top_row_first = open_->targets.top_row_first;
    use.front_is_clockwise = open_->pass.states[state].front_is_clockwise;
    open_->pass.draws.push_back(static_cast<std::uint32_t>(draws.size()));
    open_->pass.state_of_draw.push_back(state);
    open_->uses.push_back(std::move(use));
    draws.push_back(std::move(draw));
}

std::uint32_t RecordedPasses::state_of(const RecordedDraw& draw) {
    const auto [known, added] =
        open_->states.try_emplace(draw.state, static_cast<std::uint32_t>(open_->pass.states.size()));
    if (!added) return known->second;
    RasterState state = recording_.states.at(draw.state);
    if (state.culling == pipeline::FaceCulling::by_material) state.culling = pipeline::FaceCulling::none;
    state.front_is_clockwise ^= !open_->targets.top_row_first;
    const bool depth = open_->targets.depth.has_value();
    const auto format = depth ? surfaces[open_->targets.depth->surface].format : pipeline::SurfaceFormat::rgba8;
    if (!depth || !has_depth(format)) state.depth.test = state.depth.write = false;
    if (!depth || !has_stencil(format)) state.stencil = {};
    state.depth.write &= state.depth.test;
    open_->pass.states.push_back(state);
    return known->second;
}

void RecordedPasses::note_unbound(const RecordedDraw& draw, const TextureTable& table) {
    if (!table.unbound().empty())
        notes_.push_back(fmt::format("program {}: no texture for {}: it reads black",
                                     recording_.programs[draw.program].name, fmt::join(table.unbound(), ", ")));
}

std::vector<TextureBinding> RecordedPasses::bindings_of(const RecordedDraw& draw, const spirv::Program& program) const {
    std::vector<TextureBinding> bindings = recording_.bindings.at(draw.bindings);
    std::erase_if(bindings, [&program](const TextureBinding& binding) {
        return std::none_of(program.textures.begin(), program.textures.end(),
                            [&](const spirv::TextureVariable& variable) { return variable.name == binding.variable; });
    });
    return bindings;
}

// What the draw writes itself has no value to be read: of a surface that is no part of another.
std::shared_ptr<const TextureTable> RecordedPasses::fragment_textures(const RecordedDraw& draw,
                                                                      const spirv::Program& program) {
    std::vector<TextureBinding> bindings = bindings_of(draw, program);
    std::erase_if(bindings, [this](const TextureBinding& binding) { return open_->writes(binding.surface); });
    std::vector<std::uint32_t> slots;
    std::vector<std::vector<pipeline::TexturePart>> parts;
    for (const TextureBinding& binding : bindings) {
        slots.push_back(slot_of(binding.surface));
        std::vector<pipeline::TexturePart>& of_binding = parts.emplace_back();
        for (const DrawnPart& part : drawn_parts_.parts_of(binding.surface))
            if (part.level >= binding.base_level && part.level <= binding.last_level && !open_->writes(part.surface))
                of_binding.push_back({part.level, part.plane, slot_of(part.surface)});
    }
    auto table = std::make_shared<const TextureTable>(program, bindings, recording_.samplers, slots, parts);
    note_unbound(draw, *table);
    return table;
}

// Vertices are made before the passes, so they see what surfaces hold at first.
std::shared_ptr<const VertexTextures> RecordedPasses::vertex_textures(const RecordedDraw& draw,
                                                                      const spirv::Program& program) {
    const std::vector<TextureBinding> bindings = bindings_of(draw, program);
    std::vector<pipeline::SurfaceInfo> infos;
    std::vector<std::uint32_t> slots;
    const auto expect_unwritten = [&](std::uint32_t surface) {
        if (written_.contains(surface))
            throw sim::InputError(
                fmt::format("{}: expected a vertex shader that reads no surface that was drawn to, got {}", draw.name,
                            name_of(surface)));
    };
    for (const TextureBinding& binding : bindings) {
        expect_unwritten(binding.surface);
        for (const DrawnPart& part : drawn_parts_.parts_of(binding.surface)) expect_unwritten(part.surface);
        slots.push_back(static_cast<std::uint32_t>(infos.size()));
        infos.push_back(surfaces[binding.surface]);
    }
    std::vector<pipeline::SurfaceId> ids(slots.begin(), slots.end());
    auto textures = std::make_shared<const VertexTextures>(VertexTextures{
        pipeline::SurfaceStore(infos), std::move(ids), TextureTable(program, bindings, recording_.samplers, slots)});
    note_unbound(draw, textures->table);
    return textures;
}

void RecordedPasses::add(const RecordedDraw& draw) {
    enter_run(draw.targets);
    const bool kept = chosen(draw);
    open(draw.targets, kept);
    const RecordedProgram& recorded = recording_.programs.at(draw.program);
    const auto program = programs_.program(draw.program);
    FragmentUse use;
    use.program = program;
    use.alpha_test = draw.alpha_test;
    if (const auto& colours = open_->targets.colours; !colours.empty() && colours[0])
        use.alpha_steps = pipeline::alpha_steps(surfaces[colours[0]->surface].format);
    use.alpha_reference = in_alpha_steps(draw.alpha_reference, use.alpha_steps);
    if (kept) {
        const pipeline::BlendPart& blend = recording_.states[draw.state].blend[0].colour;
        use.node = NodeBlend{blend.source, blend.target};
    }
    if (program->fragment) {
        use.uniforms = programs_.words(*program->fragment, draw.fragment_values);
        use.textures = fragment_textures(draw, program->fragment->program);
    }
    pipeline::Draw lowered;
    lowered.name = draw.name;
    lowered.geometry = draw.geometry;
    lowered.instances.resize(draw.instances, glm::mat4(1.0F));
    lowered.program = std::make_shared<const RecordedVertices>(
        program, recorded, programs_.words(*program->vertex, draw.vertex_values), draw, resources_,
        vertex_textures(draw, program->vertex->program), !open_->targets.top_row_first);
    push(std::move(lowered), state_of(draw), std::move(use));
}

std::vector<std::string> RecordedPasses::notes() const {
    std::vector<std::string> notes = programs_.notes();
    notes.insert(notes.end(), notes_.begin(), notes_.end());
    for (const auto& [reason, times] : not_kept_)
        notes.push_back(fmt::format("not kept in the k-buffer: {}: {}", sim::counted(times, "blended draw"), reason));
    return notes;
}

} // namespace traces
