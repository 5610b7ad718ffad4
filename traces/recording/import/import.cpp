#include "traces/recording/import/import.hpp"

#include "sim/check.hpp"
#include "traces/record_module/writer.hpp"
#include "traces/recording/cut.hpp"
#include "traces/recording/import/stream_import.hpp"

#include <fmt/format.h>
#include <set>

namespace traces::recorded {

using record_stream::Tag;
using record_stream::Writer;

ImportedStream StreamImport::run() {
    window_top_first_ = !copies_touch_the_window();
    StreamReader reader(bytes_);
    while (const auto tag = reader.next()) take(*tag, reader);
    for (const auto& [call, times] : not_recorded_) recording_.not_recorded.push_back({call, times});
    recording_.resources->find_runs();
    return {compact(std::move(recording_)), context_, finished_};
}

bool StreamImport::copies_touch_the_window() const {
    std::set<std::int32_t> windows;
    std::int32_t surfaces = 0;
    StreamReader reader(bytes_);
    while (const auto tag = reader.next()) {
        if (*tag == Tag::surface) {
            if (reader.record<record_stream::Surface>().target == GL_FRAMEBUFFER_DEFAULT) windows.insert(surfaces);
            ++surfaces;
        } else if (*tag == Tag::copy) {
            const auto copy = reader.record<record_stream::Copy>();
            if (windows.contains(copy.from.surface) || windows.contains(copy.to.surface)) return true;
        } else if (*tag == Tag::blit) {
            const auto blit = reader.record<record_stream::Blit>();
            if (windows.contains(blit.from.surface) || windows.contains(blit.to.surface)) return true;
        }
    }
    return false;
}

void StreamImport::take(Tag tag, const StreamReader& reader) {
    switch (tag) {
    case Tag::context: {
        const auto context = reader.record<record_stream::Context>();
        if (context.stream_version != record_stream::version)
            throw sim::InputError("the recorded stream: expected one of this version of ropsim");
        context_ = fmt::format("{}, {}", context.gl_version, context.renderer);
        break;
    }
    case Tag::blob:
        blobs_.push_back(reader.record<record_stream::Blob>().bytes);
        break;
    case Tag::surface:
        take_surface(reader.record<record_stream::Surface>());
        break;
    case Tag::program:
        programs_.push_back(reader.record<record_stream::Program>());
        break;
    case Tag::draw:
        take_draw(reader.record<record_stream::Draw>());
        break;
    case Tag::clear:
        take_clear(reader.record<record_stream::Clear>());
        break;
    case Tag::copy:
        take_copy(reader.record<record_stream::Copy>());
        break;
    case Tag::blit:
        take_blit(reader.record<record_stream::Blit>());
        break;
    case Tag::frame:
        end_frame(reader.record<record_stream::Frame>());
        break;
    case Tag::not_recorded: {
        const auto record = reader.record<record_stream::NotRecorded>();
        not_recorded_[record.call] += record.times;
        break;
    }
    case Tag::finished:
        finished_ = true;
        break;
    }
}

void StreamImport::take_surface(const record_stream::Surface& record) {
    auto imported = import_surface(record, blobs_, window_top_first_, count_);
    std::int32_t number = -1;
    if (imported) {
        number = static_cast<std::int32_t>(recording_.surfaces.size());
        recording_.surfaces.push_back(imported->surface);
        imported->surface.levels.clear(); // its bytes are in one place
    }
    surfaces_.push_back({number, imported.value_or(ImportedSurface{}), record});
}

const StreamImport::KnownSurface* StreamImport::surface(std::int32_t record) const {
    if (record < 0 || static_cast<std::size_t>(record) >= surfaces_.size()) return nullptr;
    const KnownSurface& known = surfaces_[static_cast<std::size_t>(record)];
    return known.number < 0 ? nullptr : &known;
}

std::optional<TargetSet::Target> StreamImport::target_of(const record_stream::Target& target) const {
    const KnownSurface* const known = surface(target.surface);
    if (known == nullptr) return std::nullopt;
    return TargetSet::Target{static_cast<std::uint32_t>(known->number), target.level, target.layer};
}

std::optional<std::uint32_t> StreamImport::targets_of(const record_stream::Targets& targets) {
    TargetSet set;
    set.width = targets.width;
    set.height = targets.height;
    set.top_row_first = top_row_first(targets);
    for (std::size_t i = 0; i < targets.colours.size(); ++i)
        if (const auto colour = target_of(targets.colours.at(i))) {
            set.colours.resize(i + 1);
            set.colours[i] = colour;
        }
    set.depth = target_of(targets.depth.surface >= 0 ? targets.depth : targets.stencil);
    if (targets.depth.surface >= 0 && targets.stencil.surface >= 0 && targets.depth.surface != targets.stencil.surface)
        count_("stencils in a surface of their own");
    if ((set.colours.empty() && !set.depth) || set.width == 0 || set.height == 0) return std::nullopt;
    return targets_.number(Writer::key(record_stream::Targets(targets)), [&] { return set; });
}

bool StreamImport::lacks_alpha(const record_stream::Target& target) const {
    const KnownSurface* const known = surface(target.surface);
    return known != nullptr && !known->imported.has_alpha;
}

void StreamImport::end_frame(const record_stream::Frame& frame) {
    const auto shown = targets_of(frame.shown);
    if (shown && surface(frame.shown.colours[0].surface) != nullptr) {
        frame_.number = frame.number;
        frame_.shown = *shown;
        recording_.frames.push_back(std::move(frame_));
    }
    frame_ = {};
    draws_ = 0;
}

ImportedStream import_stream(std::span<const std::byte> bytes) { return StreamImport(bytes).run(); }

} // namespace traces::recorded
