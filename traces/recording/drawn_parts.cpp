#include "traces/recording/drawn_parts.hpp"

#include "traces/recording/textures.hpp"

#include <fmt/format.h>
#include <set>

namespace traces {

namespace {

// What no pass writes can be read, too: it holds 0.
pipeline::SurfaceInfo named_info_of(const RecordedSurface& recorded, std::string name) {
    pipeline::SurfaceInfo info = surface_of(recorded);
    info.name = std::move(name);
    if (info.contents == nullptr) info.contents = pipeline::make_contents(info, recorded.levels);
    return info;
}

std::string name_of_surface(const Recording& recording, std::uint32_t surface) {
    const std::string& name = recording.surfaces[surface].name;
    return fmt::format("{} {}", name.empty() ? "surface" : name, surface);
}

RecordedSurface part_of(const RecordedSurface& whole, std::uint32_t level, std::uint32_t plane) {
    const LevelSize size = level_size(whole, level);
    RecordedSurface part;
    part.format = whole.format;
    part.width = size.width;
    part.height = size.height;
    const pipeline::SharedBytes& bytes = whole.levels.at(level);
    if (bytes.empty()) return part;
    const auto each = static_cast<std::size_t>(level_bytes(part, 0));
    const std::byte* const first = bytes.data() + each * plane;
    part.levels[0] = std::vector(first, first + each);
    return part;
}

bool has_several_planes(const RecordedSurface& surface) {
    return surface.kind == SurfaceKind::cube || surface.depth > 1;
}

std::vector<TargetSet::Target> drawn_to(const Recording& recording) {
    std::vector<TargetSet::Target> drawn;
    for (const TargetSet& set : recording.targets) {
        for (const auto& colour : set.colours)
            if (colour) drawn.push_back(*colour);
        if (set.depth) drawn.push_back(*set.depth);
    }
    for (const RecordedFrame& frame : recording.frames)
        for (const RecordedCommand& command : frame.commands)
            if (const auto* copy = std::get_if<RecordedCopy>(&command))
                drawn.push_back(copy->to);
            else if (const auto* blit = std::get_if<RecordedBlit>(&command))
                drawn.push_back(blit->to);
    return drawn;
}

} // namespace

DrawnParts::DrawnParts(const Recording& recording) : recording_(recording) {
    const std::vector<TargetSet::Target> drawn = drawn_to(recording);
    std::set<std::uint32_t> split;
    for (const TargetSet::Target& target : drawn) {
        const RecordedSurface& surface = recording.surfaces.at(target.surface);
        if (surface.samples == 1 && (target.level != 0 || has_several_planes(surface))) split.insert(target.surface);
    }
    for (const TargetSet::Target& target : drawn)
        if (split.contains(target.surface)) add(target);
}

void DrawnParts::add(const TargetSet::Target& target) {
    const auto next = static_cast<std::uint32_t>(recording_.surfaces.size() + parts_.size());
    parts_.try_emplace({target.surface, target.level, target.plane}, next);
}

std::vector<pipeline::SurfaceInfo> DrawnParts::surfaces() const {
    std::vector<pipeline::SurfaceInfo> surfaces(recording_.surfaces.size() + parts_.size());
    for (std::uint32_t i = 0; i < recording_.surfaces.size(); ++i)
        surfaces[i] = named_info_of(recording_.surfaces[i], name_of_surface(recording_, i));
    for (const auto& [place, number] : parts_) {
        const auto& [surface, level, plane] = place;
        surfaces[number] =
            named_info_of(part_of(recording_.surfaces[surface], level, plane),
                          fmt::format("{} level {} plane {}", name_of_surface(recording_, surface), level, plane));
    }
    return surfaces;
}

TargetSet::Target DrawnParts::of(const TargetSet::Target& target) const {
    const auto part = parts_.find({target.surface, target.level, target.plane});
    return part == parts_.end() ? target : TargetSet::Target{part->second, 0, 0};
}

TargetSet DrawnParts::of(TargetSet targets) const {
    for (auto& colour : targets.colours)
        if (colour) colour = of(*colour);
    if (targets.depth) targets.depth = of(*targets.depth);
    return targets;
}

std::vector<DrawnPart> DrawnParts::parts_of(std::uint32_t surface) const {
    std::vector<DrawnPart> parts;
    for (auto part = parts_.lower_bound({surface, 0, 0}); part != parts_.end() && std::get<0>(part->first) == surface;
         ++part)
        parts.push_back({std::get<1>(part->first), std::get<2>(part->first), part->second});
    return parts;
}

} // namespace traces
