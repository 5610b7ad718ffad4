#include "reports/trace_info.hpp"

#include "reports/numbers.hpp"
#include "reports/recording_info.hpp"
#include "traces/trace.hpp"
#include "traces/trace_text.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <set>

namespace reports {

using nlohmann::ordered_json;

namespace {

ordered_json vertex_formats(const pipeline::Resources& resources) {
    std::set<std::string> formats;
    for (const pipeline::Geometry& geometry : resources.geometries)
        for (const pipeline::VertexAttribute& attribute : geometry.attributes)
            formats.insert(fmt::format("{} {}x{}{}", sim::enum_name(attribute.semantic), sim::enum_name(attribute.type),
                                       attribute.components, attribute.normalized ? " normalized" : ""));
    return formats;
}

ordered_json index_formats(const pipeline::Resources& resources) {
    std::set<std::string> formats;
    for (const pipeline::Geometry& geometry : resources.geometries)
        formats.insert(geometry.index_type == pipeline::IndexType::none
                           ? "none"
                           : fmt::format("u{}", 8 * pipeline::bytes_of(geometry.index_type)));
    return formats;
}

ordered_json surfaces_of(const pipeline::Frame& frame) {
    ordered_json list = ordered_json::array();
    for (const pipeline::SurfaceInfo& surface : frame.surfaces)
        list.push_back({{"name", surface.name},
                        {"format", surface.program ? "k-buffer" : sim::enum_name(surface.format)},
                        {"width", surface.width},
                        {"height", surface.height}});
    return list;
}

ordered_json chunks_of(const std::filesystem::path& path) {
    ordered_json list = ordered_json::array();
    for (const traces::TraceChunks& kind : traces::trace_chunks(path))
        list.push_back({{"type", kind.type},
                        {"chunks", kind.count},
                        {"compressed", kind.compressed},
                        {"content_bytes", kind.content_bytes},
                        {"file_bytes", kind.stored_bytes}});
    return list;
}

template <class List, class Text>
std::string joined(const List& list, Text text) {
    std::string all;
    for (const auto& one : list) all += (all.empty() ? "" : ", ") + text(one);
    return all.empty() ? "none" : all;
}

std::string joined(const ordered_json& names) {
    return joined(names, [](const ordered_json& name) { return name.get<std::string>(); });
}

} // namespace

namespace {

/// What every trace has.
ordered_json facts_of_file(const std::filesystem::path& path, const traces::Trace& trace) {
    return {{"file", path.string()},
            {"bytes", std::filesystem::file_size(path)},
            {"hash", trace.scene.hash},
            {"name", trace.metadata.name},
            {"writer", trace.metadata.writer},
            {"licence", trace.metadata.licence},
            {trace.recording ? "recorded" : "captured",
             {{"name", trace.metadata.scene}, {"hash", trace.metadata.scene_hash}}}};
}

ordered_json facts_of_frame(const traces::Trace& trace) {
    const pipeline::Frame frame = traces::frame_of(trace);
    const pipeline::Resources& resources = *trace.scene.resources;
    std::vector<std::string> passes;
    for (const pipeline::Pass& pass : frame.passes) passes.push_back(pass.name);
    return {{"workload", trace.frame.workload},
            {"options", ordered_json::parse(trace.frame.options, nullptr, false)},
            {"camera", trace.frame.camera},
            {"width", trace.frame.view.width},
            {"height", trace.frame.view.height},
            {"samples", trace.frame.view.samples},
            {"passes", passes},
            {"surfaces", surfaces_of(frame)},
            {"draws", trace.scene.draws.size()},
            {"triangles", trace.scene.triangles_drawn},
            {"vertices", trace.scene.vertices},
            {"buffers", resources.buffers.size()},
            {"geometries", resources.geometries.size()},
            {"textures", resources.textures.size()},
            {"materials", resources.materials.size()},
            {"lights", trace.scene.lights.size()}};
}

std::string captured_text(const ordered_json& info) {
    const auto number = [&](const char* key, const char* noun) {
        return counted(info[key].get<std::uint64_t>(), noun);
    };
    std::string lines = fmt::format("options: {}; camera {}; {} to a pixel\n", info["options"].dump(),
                                    info["camera"].get<std::string>(), number("samples", "sample"));
    lines += fmt::format("passes: {}\n", joined(info["passes"]));
    lines += fmt::format("surfaces: {}\n", joined(info["surfaces"], [](const ordered_json& one) {
                             return fmt::format("{} {} {} x {}", one["name"].get<std::string>(),
                                                one["format"].get<std::string>(), one["width"].get<int>(),
                                                one["height"].get<int>());
                         }));
    return lines + fmt::format("resources: {}, {}, {}, {}, {}, {}\n", number("buffers", "buffer"),
                               info["geometries"] == 1 ? "1 geometry" : info["geometries"].dump() + " geometries",
                               info["vertices"] == 1 ? "1 vertex" : with_commas(info["vertices"]) + " vertices",
                               number("textures", "texture"), number("materials", "material"),
                               number("lights", "light"));
}

std::string captured_summary(const ordered_json& info) {
    return fmt::format("{} of {}, {} at {} x {}", counted(info["draws"].get<std::uint64_t>(), "draw"),
                       counted(info["triangles"].get<std::uint64_t>(), "triangle"), info["workload"].get<std::string>(),
                       info["width"].get<int>(), info["height"].get<int>());
}

} // namespace

ordered_json trace_info(const std::filesystem::path& path) {
    const traces::Trace trace = traces::read_trace(path);
    ordered_json info = facts_of_file(path, trace);
    info.update(trace.recording ? recording_info(*trace.recording) : facts_of_frame(trace));
    const pipeline::Resources& resources = trace.recording ? *trace.recording->resources : *trace.scene.resources;
    info["vertex_formats"] = vertex_formats(resources);
    info["index_formats"] = index_formats(resources);
    info["chunks"] = chunks_of(path);
    return info;
}

std::string trace_summary(const ordered_json& info) {
    return fmt::format("{}: {}, {}\n", info["file"].get<std::string>(),
                       info.contains("recorded") ? recording_summary(info) : captured_summary(info),
                       bytes_text(info["bytes"].get<double>()));
}

std::string trace_info_text(const ordered_json& info, TerminalStyle style) {
    const auto text = [&](const char* key) { return info[key].get<std::string>(); };
    const bool recorded = info.contains("recorded");
    std::string lines = trace_summary(info);
    lines += fmt::format("name: {}\nwriter: {}\nlicence: {}\nhash: {}\n", text("name"), text("writer"),
                         text("licence").empty() ? "not stated" : text("licence"), text("hash"));
    const char* const from = recorded ? "recorded" : "captured";
    const auto hash = info[from]["hash"].get<std::string>();
    lines += fmt::format("{} from: {}{}\n", from, info[from]["name"].get<std::string>(),
                         hash.empty() ? "" : " (" + hash + ")");
    lines += recorded ? recording_info_text(info) : captured_text(info);
    lines += fmt::format("vertex formats: {}; indices: {}\n\n", joined(info["vertex_formats"]),
                         joined(info["index_formats"]));
    std::vector<std::vector<std::string>> rows;
    for (const ordered_json& kind : info["chunks"]) {
        const auto content = kind["content_bytes"].get<double>(), file = kind["file_bytes"].get<double>();
        rows.push_back({kind["type"].get<std::string>(), with_commas(kind["chunks"]), with_commas(kind["compressed"]),
                        bytes_text(content), bytes_text(file),
                        content > 0 ? fmt::format("{:.0f}", 100 * file / content) : ""});
    }
    return lines + text_table({{"chunk", "", true},
                               {"chunks", ""},
                               {"compressed", ""},
                               {"content", ""},
                               {"in the file", "with heads"},
                               {"share", "%"}},
                              rows, style);
}

} // namespace reports
