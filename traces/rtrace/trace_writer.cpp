// Order of chunks: all tables, then the blobs that they name, in the order of the names.
#include "sim/check.hpp"
#include "traces/recording/recording_check.hpp"
#include "traces/rtrace/chunk_writer.hpp"
#include "traces/rtrace/field_codecs.hpp"
#include "traces/rtrace/number_blobs.hpp"
#include "traces/rtrace/records.hpp"
#include "traces/rtrace/scene_check.hpp"

#include <fmt/format.h>

namespace traces {

namespace {

using rtrace::ChunkWriter;
using rtrace::Document;
using rtrace::Place;

const pipeline::Resources& resources_of(const Trace& trace) {
    return trace.recording ? *trace.recording->resources : *trace.scene.resources;
}

/// @param made holds them where they are made of numbers
std::span<const std::byte> bytes_at(const Trace& trace, const Place& place, std::vector<std::byte>& made) {
    switch (place.kind) {
    case Place::Kind::buffer:
        return resources_of(trace).buffers[place.i].bytes;
    case Place::Kind::texture_level:
        return std::as_bytes(std::span(trace.scene.resources->textures[place.i].levels[place.level].rgba));
    case Place::Kind::map_level:
        return std::as_bytes(std::span(trace.scene.resources->maps[place.i].texture.levels[place.level].rgba));
    case Place::Kind::instances:
        return made = rtrace::bytes_of_matrices(trace.scene.draws[place.i].instances);
    case Place::Kind::surface_level:
        return trace.recording->surfaces[place.i].levels[place.level];
    case Place::Kind::vertex_module:
        return made = rtrace::bytes_of_words(trace.recording->programs[place.i].vertex);
    case Place::Kind::fragment_module:
        return made = rtrace::bytes_of_words(trace.recording->programs[place.i].fragment);
    case Place::Kind::uniform:
        break;
    }
    return made = rtrace::bytes_of_words(trace.recording->values[place.i][place.level].words);
}

void name_blob(Document& document, const Trace& trace, const Place& place) {
    std::vector<std::byte> made;
    const std::span<const std::byte> bytes = bytes_at(trace, place, made);
    document.blobs[place] = {rtrace::name_of(bytes), bytes.size()};
}

// Fields are visited by reference; the bytes, which may be many, are not copied for that.

pipeline::Texture described(const pipeline::Texture& texture) {
    CHECK(!texture.decode);
    pipeline::Texture one;
    one.name = texture.name;
    one.srgb = texture.srgb;
    one.wrap_u = texture.wrap_u;
    one.wrap_v = texture.wrap_v;
    one.min_filter = texture.min_filter;
    one.mag_filter = texture.mag_filter;
    one.border = texture.border;
    for (const pipeline::Texture::Level& level : texture.levels)
        one.levels.push_back({level.width, level.height, {}, 0});
    return one;
}

std::shared_ptr<pipeline::Resources> described(const pipeline::Resources& resources) {
    auto copy = std::make_shared<pipeline::Resources>();
    copy->geometries = resources.geometries;
    copy->materials = resources.materials;
    for (const pipeline::Buffer& buffer : resources.buffers) copy->buffers.push_back({buffer.name, {}, 0});
    for (const pipeline::Texture& texture : resources.textures) copy->textures.push_back(described(texture));
    for (const pipeline::LateTexture& map : resources.maps) {
        CHECK(!map.make);
        copy->maps.push_back({described(map.texture)});
    }
    return copy;
}

bool is_apart(const UniformValue& uniform) { return uniform.words.size() > rtrace::most_words_in_record; }

Recording described(const Recording& recording) {
    Recording copy;
    for (const RecordedSurface& one : recording.surfaces)
        copy.surfaces.push_back({one.name, one.kind, one.format, one.width, one.height, one.depth, one.samples,
                                 std::vector<pipeline::SharedBytes>(one.levels.size())});
    copy.samplers = recording.samplers;
    for (const RecordedProgram& one : recording.programs) copy.programs.push_back({one.name, {}, {}, one.inputs});
    for (const std::vector<UniformValue>& set : recording.values) {
        copy.values.emplace_back();
        for (const UniformValue& one : set)
            copy.values.back().push_back({one.name, is_apart(one) ? std::vector<std::uint32_t>() : one.words});
    }
    copy.bindings = recording.bindings;
    copy.states = recording.states;
    copy.targets = recording.targets;
    copy.frames = recording.frames;
    copy.not_recorded = recording.not_recorded;
    return copy;
}

void name_blobs_of_scene(Document& document, const Trace& trace) {
    const pipeline::Resources& resources = *trace.scene.resources;
    for (std::size_t i = 0; i < resources.textures.size(); ++i)
        for (std::size_t k = 0; k < resources.textures[i].levels.size(); ++k)
            name_blob(document, trace, {Place::Kind::texture_level, i, k});
    for (std::size_t i = 0; i < resources.maps.size(); ++i)
        for (std::size_t k = 0; k < resources.maps[i].texture.levels.size(); ++k)
            name_blob(document, trace, {Place::Kind::map_level, i, k});
    for (std::size_t i = 0; i < resources.materials.size(); ++i)
        if (resources.materials[i].maps != pipeline::MaterialMaps{})
            document.maps.push_back({static_cast<std::uint32_t>(i), resources.materials[i].maps});
    for (std::size_t i = 0; i < trace.scene.draws.size(); ++i) {
        const std::size_t count = trace.scene.draws[i].instances.size();
        document.instance_counts.push_back(static_cast<std::uint32_t>(count));
        if (count > rtrace::most_matrices_in_record) name_blob(document, trace, {Place::Kind::instances, i, 0});
    }
}

void name_blobs_of_recording(Document& document, const Trace& trace) {
    const Recording& recording = *trace.recording;
    for (std::size_t i = 0; i < recording.surfaces.size(); ++i)
        for (std::size_t k = 0; k < recording.surfaces[i].levels.size(); ++k)
            if (!recording.surfaces[i].levels[k].empty())
                name_blob(document, trace, {Place::Kind::surface_level, i, k});
    for (std::size_t i = 0; i < recording.programs.size(); ++i) {
        name_blob(document, trace, {Place::Kind::vertex_module, i, 0});
        if (!recording.programs[i].fragment.empty()) name_blob(document, trace, {Place::Kind::fragment_module, i, 0});
    }
    for (std::size_t i = 0; i < recording.values.size(); ++i)
        for (std::size_t k = 0; k < recording.values[i].size(); ++k)
            if (is_apart(recording.values[i][k])) name_blob(document, trace, {Place::Kind::uniform, i, k});
}

Document document_of(const Trace& trace) {
    Document document;
    document.trace.metadata = trace.metadata;
    document.trace.scene = trace.scene;
    document.trace.frame = trace.frame;
    document.trace.scene.resources = described(resources_of(trace));
    for (std::size_t i = 0; i < resources_of(trace).buffers.size(); ++i)
        name_blob(document, trace, {Place::Kind::buffer, i, 0});
    if (trace.recording) {
        document.trace.recording = described(*trace.recording);
        name_blobs_of_recording(document, trace);
    } else {
        name_blobs_of_scene(document, trace);
    }
    return document;
}

// What is written can be read.
void check_readable(const Trace& trace, const std::string& path) {
    if (trace.recording) {
        check_recording(*trace.recording, path);
        return;
    }
    trace.scene.resources->read_textures();
    for (std::uint32_t i = 0; i < trace.scene.resources->maps.size(); ++i) trace.scene.resources->read_map(i);
    rtrace::check_trace(trace);
    rtrace::check_finished(trace);
}

} // namespace

void write_trace(const Trace& trace, const std::filesystem::path& path) {
    check_readable(trace, path.string());
    Document document = document_of(trace);
    ChunkWriter file(path);
    for (const rtrace::Record& record : rtrace::records()) {
        if (!belongs(record, document)) continue;
        rtrace::Encoder encoder(fmt::format("{}: chunk {}", path.string(), record.type.text()));
        record.visit(encoder, document);
        file.add(record.type, encoder.bytes());
    }
    std::vector<std::byte> made;
    for (const auto& [place, blob] : document.blobs) file.add_blob(blob.content, bytes_at(trace, place, made));
    file.finish();
}

} // namespace traces
