#include "reports/recording_info.hpp"

#include "reports/numbers.hpp"

#include <fmt/format.h>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

namespace reports {

using nlohmann::ordered_json;

namespace {

struct FrameCounts {
    std::uint64_t draws = 0, clears = 0, copies = 0;
    std::uint64_t passes = 0; ///< runs of draws and clears with one set of targets
    std::uint64_t vertices = 0, primitives = 0;
};

FrameCounts recorded_counts(const traces::RecordedFrame& frame, const pipeline::Resources& resources) {
    FrameCounts counts;
    std::optional<std::uint32_t> targets;
    const auto draw_to = [&](std::uint32_t next) {
        if (targets != next) ++counts.passes;
        targets = next;
    };
    for (const traces::RecordedCommand& command : frame.commands)
        if (const auto* const draw = std::get_if<traces::RecordedDraw>(&command)) {
            const pipeline::Geometry& geometry = resources.geometries[draw->geometry];
            draw_to(draw->targets);
            ++counts.draws;
            counts.vertices += std::uint64_t{geometry.index_count} * draw->instances;
            counts.primitives += std::uint64_t{geometry.primitive_count()} * draw->instances;
        } else if (const auto* const clear = std::get_if<traces::RecordedClear>(&command)) {
            draw_to(clear->targets);
            ++counts.clears;
        } else {
            ++counts.copies;
        }
    return counts;
}

ordered_json recorded_frames(const traces::Recording& recording) {
    ordered_json list = ordered_json::array();
    for (const traces::RecordedFrame& frame : recording.frames) {
        const FrameCounts counts = recorded_counts(frame, *recording.resources);
        const traces::TargetSet& shown = recording.targets[frame.shown];
        list.push_back({{"number", frame.number},
                        {"width", shown.width},
                        {"height", shown.height},
                        {"commands", frame.commands.size()},
                        {"draws", counts.draws},
                        {"clears", counts.clears},
                        {"copies", counts.copies},
                        {"passes", counts.passes},
                        {"vertices", counts.vertices},
                        {"primitives", counts.primitives}});
    }
    return list;
}

/// By format, in the order of formats. Bytes are those of all levels, whether the recording has their contents or not.
ordered_json surface_formats_of(const traces::Recording& recording) {
    struct Sum {
        std::uint64_t surfaces = 0, bytes = 0, contents = 0;
    };
    std::map<pipeline::SurfaceFormat, Sum> sums;
    for (const traces::RecordedSurface& surface : recording.surfaces) {
        Sum& sum = sums[surface.format];
        ++sum.surfaces;
        for (std::uint32_t level = 0; level < surface.levels.size(); ++level) {
            sum.bytes += traces::level_bytes(surface, level) * surface.samples;
            sum.contents += surface.levels[level].size();
        }
    }
    ordered_json list = ordered_json::array();
    for (const auto& [format, sum] : sums)
        list.push_back({{"format", pipeline::info_of(format).name},
                        {"surfaces", sum.surfaces},
                        {"bytes", sum.bytes},
                        {"recorded_bytes", sum.contents}});
    return list;
}

std::size_t textures_in(const traces::Recording& recording) {
    std::set<std::uint32_t> sampled;
    for (const auto& set : recording.bindings)
        for (const traces::TextureBinding& texture : set) sampled.insert(texture.surface);
    return sampled.size();
}

std::uint64_t sum_over(const ordered_json& list, const char* key) {
    std::uint64_t sum = 0;
    for (const ordered_json& one : list) sum += one[key].get<std::uint64_t>();
    return sum;
}

} // namespace

ordered_json recording_info(const traces::Recording& recording) {
    const ordered_json frames = recorded_frames(recording);
    ordered_json not_recorded = ordered_json::array();
    for (const traces::NotRecorded& one : recording.not_recorded)
        not_recorded.push_back({{"call", one.call}, {"times", one.times}});
    ordered_json info;
    info["frames"] = frames;
    for (const char* key : {"commands", "draws", "clears", "copies", "passes", "vertices", "primitives"})
        info[key] = sum_over(frames, key);
    info["surfaces"] = surface_formats_of(recording);
    info["textures"] = textures_in(recording);
    info["samplers"] = recording.samplers.size();
    info["programs"] = recording.programs.size();
    info["values"] = recording.values.size();
    info["bindings"] = recording.bindings.size();
    info["states"] = recording.states.size();
    info["targets"] = recording.targets.size();
    info["buffers"] = recording.resources->buffers.size();
    info["geometries"] = recording.resources->geometries.size();
    info["not_recorded"] = not_recorded;
    return info;
}

std::string recording_summary(const ordered_json& info) {
    return fmt::format("{} of {}, {}", counted(info["frames"].size(), "frame"),
                       counted(info["draws"].get<std::uint64_t>(), "draw"),
                       counted(info["primitives"].get<std::uint64_t>(), "primitive"));
}

std::string recording_info_text(const ordered_json& info) {
    const auto number = [&](const char* key, const char* noun) {
        return counted(info[key].get<std::uint64_t>(), noun);
    };
    std::string lines;
    for (const ordered_json& frame : info["frames"]) {
        const auto of = [&](const char* key, const char* noun) {
            return counted(frame[key].get<std::uint64_t>(), noun);
        };
        lines +=
            fmt::format("frame {}: {} x {}, {} in {}, {}, {}, {} vertices, {}\n", frame["number"].get<int>(),
                        frame["width"].get<int>(), frame["height"].get<int>(), of("draws", "draw"),
                        frame["passes"] == 1 ? "1 pass" : frame["passes"].dump() + " passes", of("clears", "clear"),
                        frame["copies"] == 1 ? "1 copy" : frame["copies"].dump() + " copies",
                        with_commas(frame["vertices"]), of("primitives", "primitive"));
    }
    for (const ordered_json& one : info["surfaces"])
        lines += fmt::format("surfaces {}: {}, {} in all levels, contents of {}\n", one["format"].get<std::string>(),
                             with_commas(one["surfaces"]), bytes_text(one["bytes"].get<double>()),
                             bytes_text(one["recorded_bytes"].get<double>()));
    lines += fmt::format("resources: {}, {}, {}, {}, {}, {}, {}, {}, {}\n", number("programs", "program"),
                         number("textures", "texture"), number("samplers", "sampler"), number("states", "state"),
                         number("targets", "target set"), number("values", "value set"),
                         number("bindings", "binding set"), number("buffers", "buffer"),
                         info["geometries"] == 1 ? "1 geometry" : info["geometries"].dump() + " geometries");
    for (const ordered_json& one : info["not_recorded"])
        lines += fmt::format("not recorded: {} ({})\n", one["call"].get<std::string>(),
                             counted(one["times"].get<std::uint64_t>(), "time"));
    return lines;
}

} // namespace reports
