#include "traces/recording/cut.hpp"

#include <utility>

namespace traces {

namespace {

/// A table of which some entries stay.
class KeptEntries {
  public:
    explicit KeptEntries(std::size_t entries) : kept_(entries, false) {}

    void keep(std::uint32_t entry) { kept_.at(entry) = true; }
    bool keeps(std::size_t entry) const { return kept_[entry]; }
    /// Entries have their new numbers from here on.
    void number() {
        numbers_.resize(kept_.size());
        std::uint32_t next = 0;
        for (std::size_t i = 0; i < kept_.size(); ++i) numbers_[i] = kept_[i] ? next++ : next;
    }
    std::uint32_t number_of(std::uint32_t entry) const { return numbers_.at(entry); }

    template <class T>
    void reduce(std::vector<T>& table) const {
        std::size_t next = 0;
        for (std::size_t i = 0; i < table.size(); ++i) {
            if (!kept_[i]) continue;
            if (next != i) table[next] = std::move(table[i]);
            ++next;
        }
        table.resize(next);
    }

  private:
    std::vector<bool> kept_;
    std::vector<std::uint32_t> numbers_;
};

struct KeptTables {
    explicit KeptTables(const Recording& all)
        : surfaces(all.surfaces.size()),
          samplers(all.samplers.size()),
          programs(all.programs.size()),
          values(all.values.size()),
          bindings(all.bindings.size()),
          states(all.states.size()),
          targets(all.targets.size()),
          geometries(all.resources->geometries.size()),
          buffers(all.resources->buffers.size()) {}

    KeptEntries surfaces, samplers, programs, values, bindings, states, targets, geometries, buffers;
};

// Each hands every number that it has to `visit`, with the table that the number is of.

template <class Visit>
void visit_numbers(KeptTables& tables, RecordedDraw& draw, Visit visit) {
    visit(tables.targets, draw.targets);
    visit(tables.geometries, draw.geometry);
    visit(tables.programs, draw.program);
    visit(tables.values, draw.vertex_values);
    visit(tables.values, draw.fragment_values);
    visit(tables.bindings, draw.bindings);
    visit(tables.states, draw.state);
}

template <class Visit>
void visit_numbers(KeptTables& tables, RecordedClear& clear, Visit visit) {
    visit(tables.targets, clear.targets);
}

template <class Visit>
void visit_numbers(KeptTables& tables, RecordedCopy& copy, Visit visit) {
    visit(tables.surfaces, copy.from.surface);
    visit(tables.surfaces, copy.to.surface);
}

template <class Visit>
void visit_numbers(KeptTables& tables, RecordedBlit& blit, Visit visit) {
    visit(tables.surfaces, blit.from.surface);
    visit(tables.surfaces, blit.to.surface);
}

template <class Visit>
void visit_numbers(KeptTables& tables, TargetSet& set, Visit visit) {
    for (auto& colour : set.colours)
        if (colour) visit(tables.surfaces, colour->surface);
    if (set.depth) visit(tables.surfaces, set.depth->surface);
}

template <class Visit>
void visit_numbers(KeptTables& tables, std::vector<TextureBinding>& set, Visit visit) {
    for (TextureBinding& texture : set) {
        visit(tables.surfaces, texture.surface);
        visit(tables.samplers, texture.sampler);
    }
}

template <class Visit>
void visit_numbers(KeptTables& tables, pipeline::Geometry& geometry, Visit visit) {
    for (pipeline::VertexAttribute& attribute : geometry.attributes) visit(tables.buffers, attribute.buffer);
    if (geometry.index_type != pipeline::IndexType::none) visit(tables.buffers, geometry.index_buffer);
    if (geometry.index_type == pipeline::IndexType::none) geometry.index_buffer = 0;
}

template <class Visit>
void visit_numbers(KeptTables& tables, RecordedFrame& frame, Visit visit) {
    visit(tables.targets, frame.shown);
    for (RecordedCommand& command : frame.commands)
        std::visit([&](auto& one) { visit_numbers(tables, one, visit); }, command);
}

/// Of the entries of a table that stay.
template <class T, class Visit>
void visit_kept(KeptTables& tables, const KeptEntries& kept, std::vector<T>& table, Visit visit) {
    for (std::size_t i = 0; i < table.size(); ++i)
        if (kept.keeps(i)) visit_numbers(tables, table[i], visit);
}

void keep_what_is_there(const Recording& recording, RecordedClear& clear) {
    const TargetSet& set = recording.targets.at(clear.targets);
    std::uint32_t there = 0;
    for (std::size_t i = 0; i < set.colours.size(); ++i) there |= set.colours[i] ? 1U << i : 0U;
    clear.colours = static_cast<std::uint8_t>(clear.colours & there);
    const auto format = set.depth ? std::optional(recording.surfaces.at(set.depth->surface).format) : std::nullopt;
    if (!format || !pipeline::has_depth(*format)) clear.depth.reset();
    if (!format || !pipeline::has_stencil(*format)) clear.stencil.reset();
}

bool clears_nothing(const RecordedCommand& command) {
    const auto* const clear = std::get_if<RecordedClear>(&command);
    return clear != nullptr && clear->colours == 0 && !clear->depth && !clear->stencil;
}

} // namespace

Recording compact(Recording recording) {
    // Resources may have other owners.
    auto resources = std::make_shared<pipeline::Resources>();
    resources->geometries = recording.resources->geometries;
    for (RecordedFrame& frame : recording.frames) {
        for (RecordedCommand& command : frame.commands)
            if (auto* const clear = std::get_if<RecordedClear>(&command)) keep_what_is_there(recording, *clear);
        std::erase_if(frame.commands, clears_nothing);
    }

    KeptTables kept(recording);
    const auto keep = [](KeptEntries& table, std::uint32_t& number) { table.keep(number); };
    for (RecordedFrame& frame : recording.frames) visit_numbers(kept, frame, keep);
    visit_kept(kept, kept.targets, recording.targets, keep);
    visit_kept(kept, kept.bindings, recording.bindings, keep);
    visit_kept(kept, kept.geometries, resources->geometries, keep);

    for (KeptEntries* table : {&kept.surfaces, &kept.samplers, &kept.programs, &kept.values, &kept.bindings,
                               &kept.states, &kept.targets, &kept.geometries, &kept.buffers})
        table->number();
    const auto renumber = [](KeptEntries& table, std::uint32_t& number) { number = table.number_of(number); };
    for (RecordedFrame& frame : recording.frames) visit_numbers(kept, frame, renumber);
    visit_kept(kept, kept.targets, recording.targets, renumber);
    visit_kept(kept, kept.bindings, recording.bindings, renumber);
    visit_kept(kept, kept.geometries, resources->geometries, renumber);

    kept.surfaces.reduce(recording.surfaces);
    kept.samplers.reduce(recording.samplers);
    kept.programs.reduce(recording.programs);
    kept.values.reduce(recording.values);
    kept.bindings.reduce(recording.bindings);
    kept.states.reduce(recording.states);
    kept.targets.reduce(recording.targets);
    kept.geometries.reduce(resources->geometries);
    for (std::size_t i = 0; i < recording.resources->buffers.size(); ++i)
        if (kept.buffers.keeps(i)) resources->buffers.push_back(recording.resources->buffers[i]);
    recording.resources = std::move(resources);
    return recording;
}

} // namespace traces
