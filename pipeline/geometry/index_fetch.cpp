#include "pipeline/geometry/index_fetch.hpp"

#include <algorithm>
#include <bit>
#include <fmt/format.h>

namespace pipeline {

namespace {

constexpr std::uint64_t parts_of_a_byte = 1024;
constexpr std::size_t draws_ahead = 4; ///< draws whose lines may be requested while an earlier one is sent
constexpr std::uint32_t largest_read = 3 * bytes_of(IndexType::u32);

void book(std::vector<std::uint64_t>& by_draw, std::uint32_t draw, std::uint64_t amount) {
    if (draw >= by_draw.size()) by_draw.resize(draw + 1);
    by_draw[draw] += amount;
}

} // namespace

IndexFetch::IndexFetch(sim::Context context, const Params& params, const GeometryPass& pass)
    : Component(std::move(context)),
      params_(params),
      pass_(&pass),
      here_(std::bit_ceil(params.lines_in_flight)),
      rate_(static_cast<std::uint64_t>(params.bytes_per_clk * parts_of_a_byte + 0.5)) {
    if (!std::has_single_bit(params.line))
        throw sim::InputError(fmt::format("geometry.index_fetch.line: expected a power of two, got {}", params.line));
}

IndexFetch::Work IndexFetch::work_of(std::uint32_t range_number) {
    const DrawRange& range = pass_->range(range_number);
    const Geometry& geometry = pass_->geometry(range_number);
    CHECK(range.primitives <= geometry.primitive_count());
    Work work{.reader = PrimitiveReader(*pass_->resources, geometry, range.first_triangle),
              .first_primitive = range.first_primitive,
              .range = range_number,
              .index_bytes = bytes_of(geometry.index_type),
              .primitives = range.primitives,
              .first_line = lines_,
              .end_line = lines_};
    if (work.index_bytes == 0) return work;
    if (geometry.primitive_restart && range.primitives == geometry.primitive_count())
        work.end_index = geometry.index_count;
    else if (work.primitives > 0)
        work.end_index = work.reader.indices_needed(work.primitives - 1);
    if (work.end_index == 0) return work;
    const std::uint64_t first = pass_->resources->buffers[geometry.index_buffer].address + geometry.index_offset +
                                std::uint64_t{3} * range.first_triangle * work.index_bytes;
    const std::uint64_t bytes = std::uint64_t{work.index_bytes} * work.end_index;
    work.address = first / params_.line * params_.line;
    work.skip = static_cast<std::uint32_t>(first % params_.line);
    work.end_line += (work.skip + bytes + params_.line - 1) / params_.line;
    return work;
}

bool IndexFetch::take_draw() {
    const DrawCommand* command = draws_in.peek();
    if (command == nullptr || work_.size() >= draws_ahead) return false;
    work_.push_back(work_of(command->range));
    lines_ = work_.back().end_line;
    draws_in.pop();
    ++stats_.draws;
    return true;
}

bool IndexFetch::take_lines() {
    bool progress = false;
    while (const MemoryResponse* response = responses_in.peek()) {
        here_[response->tag & (here_.size() - 1)] = true;
        responses_in.pop();
        progress = true;
    }
    while (arrived_ < requested_ && here_[arrived_ & (here_.size() - 1)]) {
        here_[arrived_ & (here_.size() - 1)] = false;
        ++arrived_;
    }
    return progress;
}

bool IndexFetch::request_lines() {
    bool progress = false;
    while (requested_ < lines_ && requested_ - used_up_ < params_.lines_in_flight && requests_out.ready()) {
        while (work_[requesting_].end_line <= requested_) ++requesting_;
        const Work& work = work_[requesting_];
        const std::uint32_t draw = pass_->range(work.range).draw;
        requests_out.send({.address = work.address + (requested_ - work.first_line) * params_.line,
                           .bytes = params_.line,
                           .tag = static_cast<std::uint32_t>(requested_),
                           .draw = draw,
                           .client = MemoryClient::index,
                           .write = false});
        ++requested_;
        ++stats_.lines;
        stats_.bytes += params_.line;
        book(draw_bytes_, draw, params_.line);
        progress = true;
    }
    return progress;
}

// Number of the line in which an index begins.
std::uint64_t IndexFetch::line_of(const Work& work, std::uint32_t index) const {
    return work.first_line + (work.skip + std::uint64_t{index} * work.index_bytes) / params_.line;
}

// True when the line in which an index ends is there.
bool IndexFetch::arrived(const Work& work, std::uint32_t index) const {
    const std::uint64_t last_byte = work.skip + (std::uint64_t{index} + 1) * work.index_bytes - 1;
    return work.first_line + last_byte / params_.line < arrived_;
}

bool IndexFetch::spend(std::uint32_t bytes) {
    const std::uint64_t cost = bytes * parts_of_a_byte;
    credit_ = std::min(rate_ + largest_read * parts_of_a_byte, credit_ + (cycle() - credited_) * rate_);
    credited_ = cycle();
    if (credit_ < cost) {
        wake_in((cost - credit_ + rate_ - 1) / rate_);
        return false;
    }
    credit_ -= cost;
    return true;
}

void IndexFetch::finish_draw() {
    used_up_ = work_.front().end_line;
    if (requesting_ > 0) --requesting_;
    work_.pop_front();
}

sim::Activity IndexFetch::pass_over(Work& work, std::uint32_t end) {
    while (work.read < end) {
        if (!arrived(work, work.read) || !spend(work.index_bytes)) return sim::Activity::memory;
        ++work.read;
        ++stats_.indices;
        used_up_ = line_of(work, work.read);
    }
    return sim::Activity::busy;
}

sim::Activity IndexFetch::send_primitive() {
    Work& work = work_.front();
    if (work.index_bytes != 0) {
        const std::uint32_t needed = work.reader.indices_needed(work.next);
        const sim::Activity activity = pass_over(work, needed - work.reader.new_indices(work.next));
        if (activity != sim::Activity::busy) return activity;
        if (!arrived(work, needed - 1)) return sim::Activity::memory;
    }
    if (!primitives_out.ready()) return sim::Activity::blocked;
    std::uint32_t bytes = 0;
    if (work.index_bytes != 0) {
        const std::uint32_t indices = work.reader.new_indices(work.next);
        if (!spend(indices * work.index_bytes)) return sim::Activity::memory;
        stats_.indices += indices;
        work.read += indices;
        bytes = (work.read - work.reported) * work.index_bytes;
        work.reported = work.read;
        used_up_ = line_of(work, work.reader.first_index_after(work.next));
    }
    primitives_out.send({work.first_primitive + work.next, work.range, work.reader(work.next), bytes});
    ++work.next;
    ++stats_.primitives;
    return sim::Activity::busy;
}

sim::Activity IndexFetch::tick() {
    bool progress = take_lines();
    progress |= take_draw();
    progress |= request_lines();
    const std::uint64_t indices = stats_.indices.value;
    sim::Activity activity = sim::Activity::starved;
    while (!work_.empty()) {
        Work& work = work_.front();
        const bool all_sent = work.next == work.primitives;
        activity = all_sent ? pass_over(work, work.end_index) : send_primitive();
        if (activity != sim::Activity::busy) break;
        if (all_sent) finish_draw();
        progress = true;
    }
    progress |= stats_.indices.value != indices;
    if (progress) return sim::Activity::busy;
    return work_.empty() ? sim::Activity::starved : activity;
}

sim::Activity PrimitiveCounter::tick() {
    bool progress = false;
    while (const DrawCommand* command = draws_in.peek()) {
        const DrawRange& range = pass_->range(command->range);
        if (next_ == range.primitives) {
            draws_in.pop();
            ++stats_.draws;
            next_ = 0;
        } else {
            if (!primitives_out.ready()) return progress ? sim::Activity::busy : sim::Activity::blocked;
            const PrimitiveReader reader(*pass_->resources, pass_->geometry(command->range), range.first_triangle);
            primitives_out.send({range.first_primitive + next_, command->range, reader(next_), 0});
            ++stats_.primitives;
            ++next_;
        }
        progress = true;
    }
    return progress ? sim::Activity::busy : sim::Activity::starved;
}

} // namespace pipeline
