#include "pipeline/output/rop.hpp"

#include "pipeline/functional/colour_format.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace pipeline {

namespace {

// Memory tags: the upper bits say what an answer is for.
constexpr std::uint32_t tag_tile = 1U << 28U; ///< | use << 16 | entry
constexpr std::uint32_t tag_read = 2U << 28U; ///< | job << 7 | target (64 = all targets)
constexpr std::uint32_t tag_stream = 3U << 28U;
constexpr std::uint32_t tag_kind = 15U << 28U;
constexpr std::uint32_t all_target = 64;

// Requests one step may add: a fetch and a write-back for each of three surfaces, or all targets of one read.
constexpr std::uint32_t request_room = 72;

constexpr std::uint64_t surface_span = std::uint64_t{1} << 36U;

} // namespace

Rop::Rop(sim::Context context, const RopParams& params, const PassContext& pass, const KBufferPlan& plan,
         const RopSurfaces& surfaces, const RopShape& shape)
    : Component(std::move(context)),
      params_(params),
      pass_(&pass),
      plan_(&plan),
      surfaces_(surfaces),
      depth_tiles_(shape.depth ? params.cache_tiles : 0, pass.layout.tiles()),
      colour_tiles_(shape.colour ? params.cache_tiles : 0, pass.layout.tiles()),
      kbuffer_tiles_(surfaces.kbuffer != nullptr ? params.cache_tiles : 0, pass.layout.tiles()),
      ledger_(pass.layout, *surfaces.history),
      draw_outputs_(shape.draws),
      queue_(params.queue),
      requests_(4 * request_room),
      tile_reads_(1024),
      answers_(4096),
      invalidations_(4096),
      jobs_(1024) {
    if (plan.shader.visibility == Visibility::never_until_flush) is_unpublished_.resize(pass.layout.tiles());
    if (plan.site == UpdateSite::blender && pass.program != nullptr)
        blender_ = std::make_unique<ProgrammableBlender>(plan.blender, *pass.program, rops());
    for (std::uint32_t job = static_cast<std::uint32_t>(jobs_.size()); job > 0; --job) free_jobs_.push_back(job - 1);
    port_names_.reserve(std::size_t{3} * shape.pipes);
    for (std::uint32_t pipe = 0; surfaces.payloads != nullptr && pipe < shape.pipes; ++pipe) {
        reads_in.emplace_back(*this, port_names_.emplace_back("reads" + std::to_string(pipe) + "_in"));
        reads_out.emplace_back(*this, port_names_.emplace_back("reads" + std::to_string(pipe) + "_out"));
        if (plan.shader.coherence == TextureCoherence::invalidate_on_write)
            invalidations_out.emplace_back(*this,
                                           port_names_.emplace_back("invalidations" + std::to_string(pipe) + "_out"));
    }
}

RopStats Rop::stats() const {
    RopStats stats = stats_;
    stats.depth_tiles = depth_tiles_.stats;
    stats.colour_tiles = colour_tiles_.stats;
    stats.kbuffer_tiles = kbuffer_tiles_.stats;
    return stats;
}

void Rop::begin_pass() {
    for (TileCache* tiles : {&depth_tiles_, &colour_tiles_, &kbuffer_tiles_}) tiles->forget();
}

std::uint32_t Rop::rops() const { return std::max(1U, params_.units / pass_->layout.partitions); }

std::uint32_t Rop::cycles_for(std::uint32_t bytes) const {
    const std::uint32_t per_cycle = rops() * params_.bytes_per_clk;
    return std::max(1U, (bytes + per_cycle - 1) / per_cycle);
}

TileCache& Rop::cache(Use use) {
    return use == Use::depth ? depth_tiles_ : use == Use::colour ? colour_tiles_ : kbuffer_tiles_;
}

std::uint32_t Rop::tile_bytes(Use use) const {
    switch (use) {
    case Use::depth:
        return 16 * pass_->depth_bytes;
    case Use::colour:
        return 16 * pass_->colour_bytes;
    case Use::kbuffer:
        break;
    }
    return 16 * pass_->program->bytes_per_pixel();
}

std::uint64_t Rop::tile_address(Use use, std::uint32_t tile) const {
    return surface_span * (static_cast<std::uint64_t>(use) + 1) + std::uint64_t{tile} * tile_bytes(use);
}

// Stores overwrite whole pixels under a byte mask; only what is combined with the stored value is fetched.
bool Rop::fetches(Use use) const {
    return use == Use::depth || (use == Use::colour && pass_->blend != BlendMode::replace) ||
           (use == Use::kbuffer && pass_->end == FragmentEnd::kbuffer_blend);
}

void Rop::request(std::uint64_t address, std::uint32_t bytes, std::uint32_t tag, MemoryClient client, bool write,
                  std::uint32_t draw) {
    requests_.push({address, bytes, tag, draw, client, write});
}

void Rop::publish(std::uint32_t tile) {
    if (surfaces_.kbuffer == nullptr) return;
    if (plan_->shader.visibility == Visibility::never_until_flush && !writing_back_) {
        if (!std::exchange(is_unpublished_[tile], 1)) unpublished_.push_back(tile);
        return;
    }
    surfaces_.kbuffer->publish_tile(tile);
    surfaces_.history->tile_visible(tile, cycle() + 1);
    if (!invalidations_out.empty() && plan_->shader.visibility != Visibility::rop_cache)
        for (std::uint32_t block = tile * 4; block < tile * 4 + 4; ++block) invalidations_.push(block);
}

void Rop::clean(Use use, std::uint16_t entry) {
    TileCache& tiles = cache(use);
    const std::uint32_t tile = tiles.tile(entry);
    request(tile_address(use, tile), tile_bytes(use), 0, MemoryClient::tile_write, true, draw_);
    tiles.mark_clean(entry);
    ++tiles.stats.writebacks;
    if (use == Use::kbuffer) publish(tile);
}

bool Rop::take_memory() {
    bool progress = false;
    while (memory_in.peek() != nullptr) {
        const std::uint32_t tag = memory_in.receive().tag;
        progress = true;
        if ((tag & tag_kind) == tag_tile)
            cache(static_cast<Use>(tag >> 16U & 3U)).filled(static_cast<std::uint16_t>(tag & 0xFFFFU));
        else if ((tag & tag_kind) == tag_stream)
            --stream_outstanding_;
        else {
            const std::uint32_t target = tag & 127U;
            ReadJob& job = jobs_[(tag & ~tag_kind) >> 7U];
            sample(job.read, target == all_target ? job.read.targets : std::uint64_t{1} << target);
            if (--job.outstanding != 0) continue;
            answers_.push(job.read);
            free_jobs_.push_back((tag & ~tag_kind) >> 7U);
        }
    }
    return progress;
}

void Rop::sample(const KBufferRead& read, std::uint64_t targets) {
    const bool rop_view = plan_->shader.visibility == Visibility::rop_cache;
    for (std::uint32_t pixel = 0; pixel < 4; ++pixel) {
        const float* pixel_floats = surfaces_.kbuffer->seen(read.block, pixel, rop_view);
        const PixelVersion version = surfaces_.kbuffer->seen_version(read.block, pixel, rop_view);
        for (std::uint64_t left = targets; left != 0; left &= left - 1) {
            const auto target = static_cast<std::uint32_t>(std::countr_zero(left));
            surfaces_.payloads->sample(read.slot, pixel, target, pixel_floats + std::size_t{4} * target, version,
                                       cycle());
        }
    }
}

// Takes reads of the texture units, round robin over the pipes. A tile in the cache answers at once when reads may see
// it.
bool Rop::accept_reads() {
    const auto pipes = static_cast<std::uint32_t>(reads_in.size());
    const std::uint32_t first = next_pipe_;
    std::uint32_t accepted = 0;
    for (std::uint32_t n = 0; n < pipes && accepted < params_.reads_per_clk; ++n) {
        const std::uint32_t pipe = (first + n) % pipes;
        auto& port = reads_in[pipe];
        if (port.peek() == nullptr) continue;
        if (free_jobs_.empty() || requests_.size() + 2 * request_room > requests_.capacity() || tile_reads_.full())
            break;
        const KBufferRead read = port.receive();
        const std::uint32_t tile = SurfaceLayout::tile_of_block(read.block);
        ++stats_.kbuffer_reads;
        ++accepted;
        next_pipe_ = (pipe + 1) % pipes;
        if (plan_->shader.visibility == Visibility::rop_cache && kbuffer_tiles_.resident(tile)) {
            tile_reads_.push({read, cycle() + params_.read_latency});
            ++stats_.kbuffer_reads_from_tiles;
            continue;
        }
        const std::uint32_t index = free_jobs_.back();
        const std::uint64_t address =
            tile_address(Use::kbuffer, tile) + read.block % 4 * (tile_bytes(Use::kbuffer) / 4);
        free_jobs_.pop_back();
        jobs_[index].read = read;
        if (plan_->shader.atomic_reads) {
            jobs_[index].outstanding = 1;
            request(address, 64U * static_cast<std::uint32_t>(std::popcount(read.targets)),
                    tag_read | index << 7U | all_target, MemoryClient::kbuffer_read, false, read.draw);
            continue;
        }
        jobs_[index].outstanding = static_cast<std::uint32_t>(std::popcount(read.targets));
        for (std::uint64_t left = read.targets; left != 0; left &= left - 1) {
            const auto target = static_cast<std::uint32_t>(std::countr_zero(left));
            request(address + std::uint64_t{64} * target, 64, tag_read | index << 7U | target,
                    MemoryClient::kbuffer_read, false, read.draw);
        }
    }
    return accepted != 0;
}

// Values leave the tile cache after its latency, as they are then.
bool Rop::serve_tile_reads() {
    bool progress = false;
    while (!tile_reads_.empty() && tile_reads_.front().ready <= cycle() && !answers_.full()) {
        const KBufferRead read = tile_reads_.front().read;
        tile_reads_.pop();
        sample(read, read.targets);
        answers_.push(read);
        progress = true;
    }
    if (!tile_reads_.empty()) wake_at(std::max(tile_reads_.front().ready, cycle() + 1));
    return progress;
}

// The entry that holds the tile, replacing another tile and asking for this one if need be; pinned for one more quad.
std::uint16_t Rop::secure_tile(Use use, std::uint32_t tile) {
    TileCache& tiles = cache(use);
    std::uint16_t entry = tiles.find(tile);
    ++tiles.stats.accesses;
    if (entry != no_entry) {
        ++tiles.stats.hits;
    } else {
        ++tiles.stats.misses;
        entry = tiles.victim();
        if (tiles.dirty(entry)) clean(use, entry);
        tiles.allocate(entry, tile, fetches(use));
        if (fetches(use))
            request(tile_address(use, tile), tile_bytes(use), tag_tile | static_cast<std::uint32_t>(use) << 16U | entry,
                    MemoryClient::tile_read, false, draw_);
    }
    tiles.pin(entry);
    return entry;
}

// Moves one quad into the queue: its tiles are looked up, and fetched if need be, before its turn comes.
bool Rop::admit() {
    const QuadTask* input = quads_in.peek();
    if (input == nullptr || queue_.full() || requests_.size() + request_room > requests_.capacity() ||
        invalidations_.size() + 8 > invalidations_.capacity())
        return false;
    if (input->kind != QuadKind::quad) {
        queue_.push({quads_in.receive(), {}});
        return true;
    }
    const Quad& quad = pass_->stream->quads[input->quad];
    const std::uint32_t tile = pass_->layout.tile_of(quad.x, quad.y);
    const bool kbuffer = pass_->end != FragmentEnd::depth_colour;
    draw_ = pass_->draw_of(input->quad);
    const std::array<bool, 3> wanted{!kbuffer && (pass_->depth.test || pass_->depth.write),
                                     !kbuffer && pass_->colour_write, kbuffer};
    // All or none, so that a quad that has to wait holds nothing and counts nothing.
    for (const Use use : {Use::depth, Use::colour, Use::kbuffer})
        if (wanted[static_cast<std::size_t>(use)] && cache(use).find(tile) == no_entry &&
            cache(use).victim() == no_entry)
            return false;
    Queued queued;
    for (const Use use : {Use::depth, Use::colour, Use::kbuffer})
        if (const auto at = static_cast<std::size_t>(use); wanted[at]) queued.entry[at] = secure_tile(use, tile);
    queued.task = quads_in.receive();
    queue_.push(queued);
    stats_.queue_max.note(queue_.size());
    return true;
}

std::uint32_t Rop::run_depth_colour(const Queued& queued) {
    const Quad& quad = pass_->stream->quads[queued.task.quad];
    std::uint32_t passed = 0;
    for (std::uint32_t pixel = 0; pixel < 4; ++pixel) {
        if ((queued.task.mask >> pixel & 1) == 0) continue;
        const std::size_t at = static_cast<std::size_t>(quad.y + pixel / 2) * pass_->layout.width + quad.x + pixel % 2;
        const DepthCode code = depth_code(pass_->depth_format, pass_->stream->depths[queued.task.quad][pixel]);
        if (pass_->depth.test && !depth_less(code, surfaces_.fixed->depth[at])) {
            ++stats_.depth_failed;
            continue;
        }
        ++stats_.depth_passed;
        ++passed;
        if (pass_->depth.write) surfaces_.fixed->depth[at] = code;
        surfaces_.fixed->winner[at] = queued.task.quad;
        if (pass_->colour_write && !surfaces_.fixed->colour.empty()) write_colour(queued.task.quad, pixel, at);
    }
    if (passed != 0 && pass_->depth.write) depth_tiles_.mark_dirty(queued.entry[0]);
    if (passed != 0 && pass_->colour_write) colour_tiles_.mark_dirty(queued.entry[1]);
    const auto fragments = static_cast<std::uint32_t>(std::popcount(queued.task.mask));
    const std::uint32_t blended = pass_->blend == BlendMode::replace ? 1 : 2; // reads the colour, too
    return cycles_for((pass_->depth.test ? fragments * pass_->depth_bytes : 0) +
                      (pass_->depth.write ? passed * pass_->depth_bytes : 0) +
                      (pass_->colour_write ? passed * blended * pass_->colour_bytes : 0));
}

void Rop::write_colour(QuadId quad, std::uint32_t pixel, std::size_t at) {
    glm::vec4 source = pass_->stream->colours[quad][pixel];
    if (pass_->blend != BlendMode::replace) source.a *= pass_->frame->opacity;
    glm::vec4& stored = surfaces_.fixed->colour[at];
    stored = write_through(pass_->frame->colour_format, pass_->blend, source, stored);
}

std::uint32_t Rop::run_store(const Queued& queued) {
    const Quad& quad = pass_->stream->quads[queued.task.quad];
    const std::uint32_t block = pass_->layout.block_of(quad.x, quad.y);
    const std::uint32_t tile = SurfaceLayout::tile_of_block(block);
    const std::uint32_t targets = pass_->program->targets();
    const bool rop_view = plan_->shader.visibility == Visibility::rop_cache;
    const std::uint32_t slot = queued.task.slot;
    bool hazardous = false;
    std::uint32_t fragments = 0;
    for (std::uint32_t pixel = 0; pixel < 4; ++pixel) {
        if ((queued.task.mask >> pixel & 1) == 0) continue;
        PixelVersion oldest = surfaces_.payloads->version(slot, pixel, 0);
        std::uint32_t newest = oldest.stores;
        for (std::uint32_t target = 1; target < targets; ++target) {
            const PixelVersion read = surfaces_.payloads->version(slot, pixel, target);
            newest = std::max(newest, read.stores);
            if (read.stores < oldest.stores) oldest = read;
        }
        hazardous |=
            ledger_.book(block, pixel, queued.task.quad,
                         {queued.task.order[pixel], oldest.stores, newest, (*surfaces_.payloads)[slot].last_read});
        ledger_.enter(block, pixel, queued.task.quad, queued.task.retired, cycle(),
                      rop_view ? cycle() + 1 : StoreHistory::never);
        const float* values = surfaces_.payloads->values(slot, pixel);
        std::copy(values, values + std::size_t{4} * targets, surfaces_.kbuffer->latest(block, pixel));
        PixelVersion& version = surfaces_.kbuffer->latest_version(block, pixel);
        version = {version.stores + 1, oldest.chain + 1};
        ++stats_.stores;
        ++fragments;
    }
    kbuffer_tiles_.mark_dirty(queued.entry[2]);
    if (plan_->shader.write_through) {
        request(tile_address(Use::kbuffer, tile) + block % 4 * (tile_bytes(Use::kbuffer) / 4),
                tile_bytes(Use::kbuffer) / 4, 0, MemoryClient::tile_write, true, pass_->draw_of(queued.task.quad));
        kbuffer_tiles_.mark_clean(queued.entry[2]);
        publish(tile);
    }
    if (rop_view && !invalidations_out.empty()) invalidations_.push(block);
    finish(queued, hazardous);
    return cycles_for(fragments * pass_->program->bytes_per_pixel());
}

void Rop::apply_pending_blends() {
    const std::size_t floats = surfaces_.kbuffer->floats_per_pixel();
    std::size_t done = 0;
    while (done < pending_blends_.size() && pending_blends_[done].written <= cycle()) {
        const PendingBlend& blend = pending_blends_[done];
        const float* from = pending_values_.data() + done * floats;
        std::copy(from, from + floats, surfaces_.kbuffer->latest(blend.block, blend.pixel));
        surfaces_.kbuffer->latest_version(blend.block, blend.pixel) = blend.version;
        ++done;
    }
    if (done == 0) return;
    pending_blends_.erase(pending_blends_.begin(), pending_blends_.begin() + static_cast<std::ptrdiff_t>(done));
    pending_values_.erase(pending_values_.begin(),
                          pending_values_.begin() + static_cast<std::ptrdiff_t>(done * floats));
}

std::uint32_t Rop::run_blend(const Queued& queued) {
    const Quad& quad = pass_->stream->quads[queued.task.quad];
    const std::uint32_t block = pass_->layout.block_of(quad.x, quad.y);
    const auto fragments = static_cast<std::uint32_t>(std::popcount(queued.task.mask));
    const std::uint32_t cycles = blender_->cycles_per_quad(fragments);
    const sim::Cycle written = blender_->enter(block, queued.task.mask, cycle(), cycles);
    const bool delayed = blender_->site().interlock == BlendInterlock::none;
    const ModifyProgram& program = *pass_->program;
    const std::size_t floats = program.floats_per_pixel();
    bool hazardous = false;
    for (std::uint32_t pixel = 0; pixel < 4; ++pixel) {
        if ((queued.task.mask >> pixel & 1) == 0) continue;
        float entry[4];
        const float* rgba =
            pass_->stream->colours.empty() ? nullptr : &pass_->stream->colours[queued.task.quad][pixel].x;
        program.make_entry(rgba, pass_->stream->depths[queued.task.quad][pixel], entry);
        float* stored = surfaces_.kbuffer->latest(block, pixel);
        PixelVersion& version = surfaces_.kbuffer->latest_version(block, pixel);
        const std::uint32_t order = queued.task.order[pixel];
        hazardous |= ledger_.book(block, pixel, queued.task.quad, {order, version.stores, version.stores, cycle()});
        ledger_.enter(block, pixel, queued.task.quad, queued.task.retired, cycle(), delayed ? written : cycle() + 1);
        ++stats_.program_runs;
        if (!delayed) {
            if (program.insert(stored, entry)) ++stats_.insertions;
            version = {order + 1, version.chain + 1};
            continue;
        }
        pending_blends_.push_back({block, pixel, {order + 1, version.chain + 1}, written});
        const std::size_t value = pending_values_.size();
        pending_values_.insert(pending_values_.end(), stored, stored + floats);
        if (program.insert(pending_values_.data() + value, entry)) ++stats_.insertions;
    }
    if (delayed) wake_at(written);
    stats_.program_cycles += cycles;
    kbuffer_tiles_.mark_dirty(queued.entry[2]);
    finish(queued, hazardous);
    return cycles;
}

void Rop::finish(const Queued& queued, bool hazardous) {
    draw_outputs_[pass_->draw_of(queued.task.quad)].hazards += hazardous ? 1 : 0;
    if (commits_out.connected())
        commits_out.send({queued.task.slot, queued.task.quad, queued.task.mask, QuadKind::quad});
}

// Executes the oldest quad when its tiles are there, the unit is free and no interlock holds it.
bool Rop::execute(sim::Activity& waiting) {
    if (queue_.empty()) return false;
    waiting = sim::Activity::memory;
    if (unit_free_ > cycle()) {
        wake_at(unit_free_);
        return false;
    }
    const Queued queued = queue_.front();
    if (commits_out.connected() && !commits_out.ready()) {
        waiting = sim::Activity::blocked;
        return false;
    }
    if (queued.task.kind == QuadKind::writeback) {
        queue_.pop();
        write_back_all();
        acknowledge_ = true;
        return true;
    }
    for (const Use use : {Use::depth, Use::colour, Use::kbuffer}) {
        const std::uint16_t entry = queued.entry[static_cast<std::size_t>(use)];
        if (entry != no_entry && cache(use).pending(entry)) return false;
    }
    if (requests_.full() || invalidations_.size() + 8 > invalidations_.capacity()) return false;
    const Quad& quad = pass_->stream->quads[queued.task.quad];
    if (pass_->end == FragmentEnd::kbuffer_blend) {
        const sim::Cycle at = blender_->may_enter(pass_->layout.block_of(quad.x, quad.y), queued.task.mask, cycle());
        if (at > cycle()) {
            if (!std::exchange(interlocked_, true)) ++stats_.interlock_stalls;
            waiting = sim::Activity::hazard;
            wake_at(at);
            return false;
        }
    }
    interlocked_ = false;
    queue_.pop();
    std::uint32_t cycles = 1;
    switch (pass_->end) {
    case FragmentEnd::depth_colour:
        cycles = run_depth_colour(queued);
        break;
    case FragmentEnd::kbuffer_store:
        cycles = run_store(queued);
        break;
    case FragmentEnd::kbuffer_blend:
        cycles = run_blend(queued);
        break;
    }
    unit_free_ = cycle() + cycles;
    for (const Use use : {Use::depth, Use::colour, Use::kbuffer})
        if (const std::uint16_t entry = queued.entry[static_cast<std::size_t>(use)]; entry != no_entry)
            cache(use).unpin(entry);
    const auto fragments = static_cast<std::uint64_t>(std::popcount(queued.task.mask));
    ++stats_.quads;
    stats_.fragments += fragments;
    DrawOutput& output = draw_outputs_[pass_->draw_of(queued.task.quad)];
    ++output.quads;
    output.fragments += fragments;
    output.first_cycle = std::min(output.first_cycle, cycle());
    output.last_cycle = std::max(output.last_cycle, cycle());
    return true;
}

void Rop::write_back_all() {
    writing_back_ = true;
    write_back_at_ = 0;
    if (!simulation().running()) wake_in(1);
}

// One dirty tile per cycle; then what was evicted without becoming visible; then the answer to an in-band command.
bool Rop::write_back_next() {
    if (!writing_back_) return false;
    if (requests_.size() + request_room > requests_.capacity() || invalidations_.size() + 8 > invalidations_.capacity())
        return false;
    while (write_back_at_ < 3 * params_.cache_tiles) {
        const auto use = static_cast<Use>(write_back_at_ / params_.cache_tiles);
        const auto entry = static_cast<std::uint16_t>(write_back_at_ % params_.cache_tiles);
        ++write_back_at_;
        if (entry >= cache(use).size() || !cache(use).dirty(entry)) continue;
        clean(use, entry);
        return true;
    }
    if (!unpublished_.empty()) {
        is_unpublished_[unpublished_.back()] = 0;
        publish(unpublished_.back());
        unpublished_.pop_back();
        return true;
    }
    if (acknowledge_) {
        if (!commits_out.ready()) return false;
        commits_out.send({no_slot, 0, 0, QuadKind::writeback});
        acknowledge_ = false;
    }
    writing_back_ = false;
    return true;
}

void Rop::stream(std::uint64_t read_bytes, std::uint64_t write_bytes) {
    stream_reads_ = read_bytes;
    stream_writes_ = write_bytes;
    stream_address_ = surface_span * 8;
    stats_.copies += read_bytes != 0 ? read_bytes + write_bytes : 0;
    stats_.clears += read_bytes != 0 ? 0 : write_bytes;
    wake_in(1);
}

bool Rop::stream_next() {
    if (stream_reads_ + stream_writes_ == 0 || requests_.size() + request_room > requests_.capacity()) return false;
    const bool read = stream_reads_ > 0 && stream_reads_ >= stream_writes_;
    if (read && stream_outstanding_ >= stream_window) return false;
    std::uint64_t& left = read ? stream_reads_ : stream_writes_;
    const auto bytes = static_cast<std::uint32_t>(std::min<std::uint64_t>(left, stream_chunk));
    request(stream_address_ + (read ? 0 : surface_span), bytes, tag_stream, MemoryClient::copy, !read, draw_);
    left -= bytes;
    stream_address_ += read ? 0 : bytes;
    stream_outstanding_ += read ? 1U : 0U;
    return true;
}

bool Rop::send_requests() {
    bool progress = false;
    while (!requests_.empty() && memory_out.ready()) {
        memory_out.send(requests_.front());
        requests_.pop();
        progress = true;
    }
    return progress;
}

bool Rop::send_answers() {
    bool progress = false;
    while (!answers_.empty() && reads_out[answers_.front().pipe].ready()) {
        reads_out[answers_.front().pipe].send({answers_.front().thread});
        answers_.pop();
        progress = true;
    }
    return progress;
}

bool Rop::send_invalidations() {
    bool progress = false;
    while (!invalidations_.empty()) {
        for (auto& port : invalidations_out)
            if (!port.ready()) return progress;
        for (auto& port : invalidations_out) port.send({invalidations_.front()});
        invalidations_.pop();
        progress = true;
    }
    return progress;
}

sim::Activity Rop::tick() {
    if (!pending_blends_.empty()) apply_pending_blends();
    bool progress = take_memory();
    sim::Activity waiting = sim::Activity::starved;
    progress |= serve_tile_reads();
    progress |= accept_reads();
    progress |= write_back_next();
    if (!writing_back_) {
        progress |= execute(waiting);
        progress |= admit();
    }
    progress |= stream_next();
    progress |= send_requests();
    progress |= send_answers();
    progress |= send_invalidations();
    if (progress) return sim::Activity::busy;
    if (waiting != sim::Activity::starved) return waiting;
    const bool holds = !requests_.empty() || !answers_.empty() || !tile_reads_.empty() || !invalidations_.empty() ||
                       writing_back_ || stream_reads_ + stream_writes_ + stream_outstanding_ != 0 ||
                       free_jobs_.size() != jobs_.size() || !pending_blends_.empty();
    return holds ? sim::Activity::memory : sim::Activity::starved;
}

} // namespace pipeline
