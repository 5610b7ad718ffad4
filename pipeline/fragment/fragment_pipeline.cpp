#include "pipeline/fragment/fragment_pipeline.hpp"

#include "pipeline/functional/shade_pass.hpp"

#include <algorithm>
#include <bit>

namespace pipeline {

namespace {

constexpr std::uint32_t ceil_div(std::uint32_t value, std::uint32_t by) { return (value + by - 1) / by; }

} // namespace

FragmentPipeline::FragmentPipeline(sim::Context context, std::uint16_t pipe, const FragmentParams& params,
                                   const TextureParams& texture, const PassContext& pass, std::uint32_t partitions,
                                   const ShaderSite* site, QuadPayloads* payloads)
    : Component(std::move(context)),
      pipe_(pipe),
      params_(params),
      texture_(texture),
      pass_(&pass),
      site_(site),
      payloads_(payloads),
      program_targets_(site != nullptr ? pass.program->targets() : 0),
      line_targets_(site == nullptr      ? 0
                    : site->atomic_reads ? program_targets_
                                         : 1),
      l1_(texture, site != nullptr && !site->bypass_l1 ? line_targets_ : 0),
      threads_(params.quads_in_flight),
      work_(params.quads_in_flight),
      block_chain_(site != nullptr ? pass.layout.blocks() : 0),
      line_chain_(texture.l1_bytes / TextureParams::line_bytes + 1),
      shading_(params.quads_in_flight),
      locked_(params.quads_in_flight),
      hits_(params.quads_in_flight),
      returned_(params.quads_in_flight),
      programs_(params.quads_in_flight),
      finished_(params.quads_in_flight),
      unsent_(params.quads_in_flight) {
    for (std::uint32_t thread = params.quads_in_flight; thread > 0; --thread)
        free_threads_.push_back(static_cast<std::uint16_t>(thread - 1));
    thread_limit_ = params.quads_in_flight;
    port_names_.reserve(std::size_t{3} * partitions);
    for (std::uint32_t rop = 0; site != nullptr && rop < partitions; ++rop) {
        reads_out.emplace_back(*this, port_names_.emplace_back("reads" + std::to_string(rop) + "_out"));
        reads_in.emplace_back(*this, port_names_.emplace_back("reads" + std::to_string(rop) + "_in"));
        if (site->coherence == TextureCoherence::invalidate_on_write)
            invalidations_in.emplace_back(*this,
                                          port_names_.emplace_back("invalidations" + std::to_string(rop) + "_in"));
    }
}

void FragmentPipeline::begin_pass(std::uint32_t registers_per_fragment) {
    l1_.drop_kbuffer_lines();
    call_ = ~std::uint32_t{0};
    thread_limit_ = std::clamp(params_.registers / std::max(registers_per_fragment, 1U), 1U, params_.quads_in_flight);
}

void FragmentPipeline::drop_surface(std::uint64_t begin, std::uint64_t end) {
    l1_.drop_texture_lines(begin / TextureParams::line_bytes,
                           end / TextureParams::line_bytes + (end % TextureParams::line_bytes != 0 ? 1 : 0));
}

// A10; the exact rule breaks ties of depth by submission order, so that no layer is lost and none is repeated.
bool FragmentPipeline::is_behind(float depth, QuadId quad, std::size_t pixel) const {
    const DepthCode captured = pass_->behind->depth[pixel];
    if (pass_->peel.rule == PeelRule::eps)
        return static_cast<double>(depth) >=
               static_cast<double>(depth_value(pass_->depth_format, captured)) + pass_->peel.eps;
    const DepthCode code = depth_code(pass_->depth_format, depth);
    return code > captured || (code == captured && quad > pass_->behind->order[pixel]);
}

bool FragmentPipeline::is_before(float depth, QuadId quad, std::size_t pixel) const {
    if (pass_->before->order[pixel] == ~QuadId{0}) return true;
    const DepthCode captured = pass_->before->depth[pixel];
    const DepthCode code = depth_code(pass_->depth_format, depth);
    return code < captured || (code == captured && quad < pass_->before->order[pixel]);
}

bool FragmentPipeline::is_captured(float depth, QuadId quad, std::size_t pixel) const {
    if (pass_->range && !(depth >= pass_->range->near && depth < pass_->range->far)) return false;
    if (pass_->before != nullptr && !is_before(depth, quad, pixel)) return false;
    return pass_->behind == nullptr || is_behind(depth, quad, pixel);
}

std::uint32_t FragmentPipeline::captured_samples(const QuadTask& task) const {
    if (pass_->behind == nullptr && !pass_->range) return task.mask;
    return kept_samples(task, [this](QuadId id, std::uint32_t pixel) {
        return is_captured(pass_->stream->depths[id][pixel], id, pass_->place(pass_->stream->quads[id], pixel));
    });
}

// Reserves the ALUs for what the thread executes until it waits again.
void FragmentPipeline::issue(std::uint16_t thread, std::uint32_t cycles) {
    issue_free_ = cycle() + cycles;
    threads_[thread].alu = cycles;
    stats_.issue_cycles += cycles;
}

void FragmentPipeline::start(const QuadTask& task) {
    const std::uint16_t index = free_threads_.back();
    free_threads_.pop_back();
    Thread& thread = threads_[index];
    thread = {};
    thread.task = task;
    const std::uint32_t draw = pass_->draw_of(task.quad);
    if (site_ != nullptr && site_->coherence == TextureCoherence::invalidate_on_draw) {
        const std::uint32_t call = pass_->call_of(pass_->stream->quads[task.quad].triangle);
        if (call != call_ && call_ != ~0U) {
            l1_.drop_kbuffer_lines();
            ++stats_.l1.invalidations;
        }
        call_ = call;
    }
    thread.task.mask = captured_samples(task);
    stats_.peel_rejects += static_cast<std::uint64_t>(std::popcount(task.mask) - std::popcount(thread.task.mask));
    std::uint32_t instructions = pass_->shader_costs[draw].alu;
    thread.fetches = thread.fixed_fetches = fetches_before_surfaces(thread.task);
    if (pass_->runs_shader()) {
        run_shader(index);
        thread.fetches += static_cast<std::uint32_t>(work_[index].lines().size());
        instructions += work_[index].instructions();
    }
    if (pass_->screen != nullptr) {
        const Quad& quad = pass_->stream->quads[task.quad];
        instructions = pass_->screen->shader->alu(quad.x, quad.y);
        thread.fetches = thread.fixed_fetches = pass_->screen->shader->fetches(quad.x, quad.y);
        thread.steps = pass_->screen->shader->steps(quad.x, quad.y);
    }
    issue(index, ceil_div(std::max(instructions, 1U), params_.alu_per_clk));
    ++stats_.quads;
    stats_.fragments += static_cast<std::uint64_t>(std::popcount(task.pixels()));
    stats_.in_flight_max.note(params_.quads_in_flight - free_threads_.size());
    fetch_textures(index);
}

// Fetches that touch nothing but the border take their time, too.
void FragmentPipeline::run_shader(std::uint16_t index) {
    QuadWork& work = work_[index];
    work.clear();
    SurfaceAccess access(*pass_->surfaces, pass_->pass->reads, &work);
    const QuadId quad = threads_[index].task.quad;
    const ShaderInput input = shader_input(*pass_->stream, quad);
    ShaderOutput output;
    output.alive = input.pixels;
    pass_->pass->shader->shade(input, access, output);
    if (pass_->late != nullptr) {
        CHECK_MSG(output.alive == input.pixels, "a shader discards pixels, though its shape says that it does not");
        keep_outputs(output, quad, *pass_->late);
    }
    for (const QuadWork::Fetch& fetch : work.fetches())
        if (fetch.count == 0) use_texture_unit(filter_cycles(fetch.texel_bytes));
}

bool FragmentPipeline::reads_texture(const QuadTask& task) const {
    return pass_->textures && !pass_->stream->texture_lines.empty() &&
           pass_->stream->texture_lines[task.quad] != ~std::uint32_t{0};
}

std::uint32_t FragmentPipeline::fetches_before_surfaces(const QuadTask& task) const {
    return (reads_texture(task) ? 1U : 0U) + (pass_->behind != nullptr ? pass_->sample_quads(task.quad) : 0U);
}

// The 64-byte line of the quad's next read-only fetch: first the material's texture, then the peeled layer, at one
// sample after the other, then the surfaces that its shader reads.
std::uint64_t FragmentPipeline::fetch_line(std::uint16_t index) const {
    const Thread& thread = threads_[index];
    if (thread.fetch >= thread.fixed_fetches) return work_[index].lines()[thread.fetch - thread.fixed_fetches];
    if (pass_->screen != nullptr) {
        const Quad& quad = pass_->stream->quads[thread.task.quad];
        return pass_->screen->shader->line(quad.x, quad.y, thread.fetch);
    }
    const bool textured = reads_texture(thread.task);
    if (thread.fetch == 0 && textured) return pass_->stream->texture_lines[thread.task.quad];
    const Quad& quad = pass_->stream->quads[thread.task.quad + thread.fetch - (textured ? 1U : 0U)];
    const std::uint64_t block = pass_->layout.block_of(quad.x, quad.y);
    return (pass_->behind_address + block * 4 * pass_->depth.pixel_bytes) / TextureParams::line_bytes;
}

std::uint32_t FragmentPipeline::fetch_cycles(std::uint16_t index) const {
    if (pass_->screen != nullptr) return filter_cycles(pass_->screen->texel_bytes);
    const Thread& thread = threads_[index];
    if (thread.fetch < thread.fixed_fetches) return texture_.cycles_per_fetch;
    const std::uint32_t texel_bytes = work_[index].bytes_begun_with(thread.fetch - thread.fixed_fetches);
    return texel_bytes != 0 ? filter_cycles(texel_bytes) : 1;
}

// Texels of 4 and of 16 bytes take the times of the unit's parameters, those between a time between.
std::uint32_t FragmentPipeline::filter_cycles(std::uint32_t texel_bytes) const {
    const std::uint32_t narrow = texture_.cycles_per_fetch, wide = std::max(narrow, texture_.cycles_per_rgba32f);
    return narrow + ceil_div((wide - narrow) * (std::clamp(texel_bytes, 4U, 16U) - 4), 12);
}

// Fetches one after the other; each costs texture unit time, and a miss the way to memory.
void FragmentPipeline::fetch_textures(std::uint16_t index) {
    Thread& thread = threads_[index];
    while (thread.fetch < thread.fetches) {
        const std::uint64_t line = fetch_line(index);
        use_texture_unit(fetch_cycles(index));
        const std::uint32_t found = l1_.find_texture(line);
        if (found != TextureCache::none && !l1_.pending(found)) {
            ++stats_.l1.texture_hits;
            ++thread.fetch;
            continue;
        }
        if (found != TextureCache::none) { // joins the pending miss
            ++stats_.l1.texture_hits;
            append(line_chain_[found], index);
            return;
        }
        ++stats_.l1.texture_misses;
        thread.line = l1_.reserve_texture(line);
        unsent_.push(index);
        return;
    }
    if (!take_steps(index)) shaded(index);
}

void FragmentPipeline::use_texture_unit(sim::Cycle cycles) {
    texture_free_ = std::max(texture_free_, cycle()) + cycles;
    stats_.texture_cycles += cycles;
}

void FragmentPipeline::append(Chain& chain, std::uint16_t thread) {
    (chain.first == nobody ? chain.first : threads_[chain.last].next) = thread;
    chain.last = thread;
    threads_[thread].next = nobody;
}

void FragmentPipeline::texture_arrived(std::uint16_t index) {
    Chain waiting;
    const std::uint32_t line = std::exchange(threads_[index].line, TextureCache::none);
    if (line != TextureCache::none) {
        l1_.filled(line);
        waiting = std::exchange(line_chain_[line], {});
    }
    fetched(index);
    for (std::uint16_t thread = waiting.first; thread != nobody;) {
        const std::uint16_t next = threads_[thread].next;
        fetched(thread);
        thread = next;
    }
}

void FragmentPipeline::fetched(std::uint16_t index) {
    ++threads_[index].fetch;
    fetch_textures(index);
}

// All read-only fetches are there: the ALU part follows, in order of arrival.
void FragmentPipeline::shaded(std::uint16_t index) {
    const Thread& thread = threads_[index];
    const bool filtered = thread.fetch > 0;
    sim::Cycle ready = filtered ? std::max(cycle(), texture_free_) + texture_.hit_latency : cycle();
    ready += params_.latency + thread.alu - 1 + pass_->atomic_latency;
    if (!shading_.empty()) ready = std::max(ready, shading_.back().ready);
    shading_.push({index, ready});
}

void FragmentPipeline::after_values(std::uint16_t index) {
    (threads_[index].task.slot != no_slot ? returned_ : finished_).push(index);
}

// The shader goes on behind its read, before a new quad starts.
bool FragmentPipeline::issue_program() {
    if (returned_.empty() || issue_free_ > cycle()) return false;
    const std::uint16_t index = returned_.front();
    returned_.pop();
    const ShaderCost& cost = pass_->shader_costs[pass_->draw_of(threads_[index].task.quad)];
    issue(index, ceil_div(std::max(cost.behind_read, 1U), params_.alu_per_clk));
    sim::Cycle ready = cycle() + params_.latency + threads_[index].alu - 1;
    if (!programs_.empty()) ready = std::max(ready, programs_.back().ready);
    programs_.push({index, ready});
    return true;
}

bool FragmentPipeline::take_programs() {
    bool progress = false;
    for (; !programs_.empty() && programs_.front().ready <= cycle(); progress = true) {
        const std::uint16_t index = programs_.front().thread;
        programs_.pop();
        run_program(threads_[index].task);
        finished_.push(index);
    }
    return progress;
}

bool FragmentPipeline::finish_one() {
    if (finished_.empty() || !done_out.ready()) return false;
    const std::uint16_t index = finished_.front();
    finished_.pop();
    done_out.send({threads_[index].task.sequence, threads_[index].task.mask});
    free_threads_.push_back(index);
    return true;
}

bool FragmentPipeline::take_answers() {
    bool progress = false;
    if (textures_in.connected())
        while (textures_in.peek() != nullptr) {
            const std::uint32_t tag = textures_in.receive().tag;
            const auto thread = static_cast<std::uint16_t>(tag);
            (tag & uncached_tag) != 0 ? load_arrived(thread) : texture_arrived(thread);
            progress = true;
        }
    for (auto& port : reads_in)
        while (port.peek() != nullptr) {
            kbuffer_arrived(port.receive().thread);
            progress = true;
        }
    if (locks_in.connected())
        while (locks_in.peek() != nullptr) {
            locked_.push(locks_in.receive().thread);
            progress = true;
        }
    for (auto& port : invalidations_in)
        while (port.peek() != nullptr) {
            invalidate(port.receive().block);
            progress = true;
        }
    return progress;
}

bool FragmentPipeline::issue_next() {
    const QuadTask* input = quads_in.peek();
    if (input == nullptr) return false;
    if (input->kind == QuadKind::invalidate) {
        l1_.drop_kbuffer_lines();
        ++stats_.l1.invalidations;
        quads_in.pop();
        return true;
    }
    if (issue_free_ > cycle() || params_.quads_in_flight - free_threads_.size() >= thread_limit_) return false;
    start(quads_in.receive());
    return true;
}

bool FragmentPipeline::send_texture_request() {
    if ((uncached_.empty() && unsent_.empty()) || !textures_out.ready()) return false;
    if (!uncached_.empty()) { // whoever asks for them holds its place the longer
        textures_out.send(uncached_.front());
        uncached_.pop_front();
        return true;
    }
    const Thread& thread = threads_[unsent_.front()];
    textures_out.send({fetch_line(unsent_.front()) * TextureParams::line_bytes, TextureParams::line_bytes,
                       unsent_.front(), pass_->draw_of(thread.task.quad), MemoryClient::texture, false});
    unsent_.pop();
    return true;
}

// The next edge at which time alone lets something happen.
sim::Cycle FragmentPipeline::next_event() {
    sim::Cycle next = ~sim::Cycle{0};
    auto note = [&next, this](sim::Cycle at) {
        if (at > cycle()) next = std::min(next, at);
    };
    if (!hits_.empty()) note(hits_.front().ready);
    if (!programs_.empty()) note(programs_.front().ready);
    if (!returned_.empty()) note(issue_free_);
    if (!locked_.empty() && !read_in_hand_) note(texture_free_);
    if (!shading_.empty() && (locks() || !read_in_hand_)) {
        const bool reads = !locks() && threads_[shading_.front().thread].task.slot != no_slot;
        note(reads ? std::max(shading_.front().ready, texture_free_) : shading_.front().ready);
    }
    if (quads_in.peek() != nullptr) note(issue_free_);
    return next;
}

sim::Activity FragmentPipeline::tick() {
    bool progress = take_answers();
    progress |= take_hits();
    progress |= take_programs();
    progress |= issue_program();
    progress |= read_kbuffer_of_next();
    progress |= finish_one();
    progress |= issue_next();
    progress |= send_texture_request();
    if (progress) return sim::Activity::busy;
    if (const sim::Cycle next = next_event(); next != ~sim::Cycle{0}) wake_at(next);
    if (free_threads_.size() == params_.quads_in_flight) return sim::Activity::starved;
    return read_in_hand_ || !finished_.empty() || !unsent_.empty() || !uncached_.empty() ? sim::Activity::blocked
                                                                                         : sim::Activity::memory;
}

} // namespace pipeline
