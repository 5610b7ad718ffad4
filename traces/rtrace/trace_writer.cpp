// Order of chunks: all tables, then the blobs that they name, in the order of the names.
#include "sim/check.hpp"
#include "traces/rtrace/chunk_writer.hpp"
#include "traces/rtrace/field_codecs.hpp"
#include "traces/rtrace/matrices.hpp"
#include "traces/rtrace/records.hpp"
#include "traces/rtrace/scene_check.hpp"

#include <fmt/format.h>

namespace traces {

namespace {

using rtrace::BlobName;
using rtrace::ChunkWriter;
using rtrace::Document;

BlobName blob_of(std::span<const std::byte> content) { return {rtrace::name_of(content), content.size()}; }

Document document_of(const Trace& trace) {
    Document document{trace, {}, {}, {}, {}};
    const pipeline::Resources& resources = *trace.scene.resources;
    // Fields are visited by reference; the bytes, which may be many, are not copied for that.
    auto& copy = document.trace.scene.resources = std::make_shared<pipeline::Resources>();
    copy->geometries = resources.geometries;
    copy->materials = resources.materials;
    for (const pipeline::Buffer& buffer : resources.buffers) {
        copy->buffers.push_back({buffer.name, {}, 0});
        document.buffers.push_back(blob_of(buffer.bytes));
    }
    for (const pipeline::Texture& texture : resources.textures) {
        CHECK(!texture.decode);
        pipeline::Texture& described = copy->textures.emplace_back();
        described.name = texture.name;
        described.srgb = texture.srgb;
        described.wrap_u = texture.wrap_u;
        described.wrap_v = texture.wrap_v;
        described.min_filter = texture.min_filter;
        described.mag_filter = texture.mag_filter;
        described.border = texture.border;
        auto& names = document.levels.emplace_back();
        for (const pipeline::Texture::Level& level : texture.levels) {
            described.levels.push_back({level.width, level.height, {}, 0});
            names.push_back(blob_of(std::as_bytes(std::span(level.rgba))));
        }
    }
    for (const pipeline::Draw& draw : trace.scene.draws) {
        document.instance_counts.push_back(static_cast<std::uint32_t>(draw.instances.size()));
        document.instances.emplace_back();
        if (draw.instances.size() > rtrace::most_matrices_in_record)
            document.instances.back() = blob_of(rtrace::bytes_of_matrices(draw.instances));
    }
    return document;
}

void write_blobs(const Trace& trace, const Document& document, ChunkWriter& file) {
    const pipeline::Resources& resources = *trace.scene.resources;
    for (std::size_t i = 0; i < resources.buffers.size(); ++i)
        file.add_blob(document.buffers[i].content, resources.buffers[i].bytes);
    for (std::size_t i = 0; i < resources.textures.size(); ++i)
        for (std::size_t k = 0; k < resources.textures[i].levels.size(); ++k)
            file.add_blob(document.levels[i][k].content,
                          std::as_bytes(std::span(resources.textures[i].levels[k].rgba)));
    for (std::size_t i = 0; i < trace.scene.draws.size(); ++i)
        if (document.instance_counts[i] > rtrace::most_matrices_in_record)
            file.add_blob(document.instances[i].content, rtrace::bytes_of_matrices(trace.scene.draws[i].instances));
}

} // namespace

void write_trace(const Trace& trace, const std::filesystem::path& path) {
    trace.scene.resources->read_textures();
    rtrace::check_trace(trace); // what is written can be read
    rtrace::check_finished(trace);
    Document document = document_of(trace);
    ChunkWriter file(path);
    for (const rtrace::Record& record : rtrace::records()) {
        rtrace::Encoder encoder(fmt::format("{}: chunk {}", path.string(), record.type.text()));
        record.visit(encoder, document);
        file.add(record.type, encoder.bytes());
    }
    write_blobs(trace, document, file);
    file.finish();
}

} // namespace traces
