#include "traces/rtrace/trace_reader.hpp"

#include "sim/check.hpp"
#include "traces/hash.hpp"
#include "traces/recording/recording_check.hpp"
#include "traces/rtrace/field_codecs.hpp"
#include "traces/rtrace/number_blobs.hpp"
#include "traces/rtrace/scene_check.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>

namespace traces {

namespace rtrace {

Document TraceReader::empty_document() {
    Document document;
    document.trace.scene.resources = std::make_shared<pipeline::Resources>();
    return document;
}

bool TraceReader::next() {
    const auto head = file_.next();
    if (head) heads_.push_back(*head);
    return head.has_value();
}

void TraceReader::read() {
    const ChunkHead& head = heads_.back();
    const auto records = rtrace::records();
    const auto record =
        std::find_if(records.begin(), records.end(), [&](const Record& one) { return one.type == head.type; });
    if (record != records.end()) {
        read_record(*record);
    } else if (head.type == chunk::blob) {
        read_blob();
    } else {
        const bool known = head.type == chunk::done;
        file_.require(known || !head.required(), head.offset,
                      "chunks that version {} has, got a required '{}': a later version of ropsim may read it",
                      format_version, head.type.text());
        file_.check_content();
    }
}

void TraceReader::read_record(const Record& record) {
    const ChunkHead& head = heads_.back();
    file_.require(seen_.insert(record.type).second, head.offset, "one chunk {}, got a second", record.type.text());
    expect_kind(record);
    const std::vector<std::byte> content = file_.content();
    Decoder decoder(content, fmt::format("{}: byte {}: chunk {}", file_.name(), head.offset, record.type.text()));
    record.visit(decoder, document_);
    decoder.finish();
    await_blobs(record.type);
}

void TraceReader::expect_kind(const Record& record) {
    if (record.of == Record::Of::both) return;
    const bool recorded = record.of == Record::Of::recorded;
    file_.require(recorded_.value_or(recorded) == recorded, heads_.back().offset,
                  "chunks of a {} trace, as before, got {}", recorded ? "captured" : "recorded", record.type.text());
    recorded_ = recorded;
    if (recorded && !document_.trace.recording) document_.trace.recording.emplace();
}

void TraceReader::await_blobs(ChunkType type) {
    for (const auto& [place, blob] : document_.blobs) {
        if (place.named_in() != type) continue;
        check_size(blob, place);
        await(blob, place);
    }
}

void TraceReader::check_size(const BlobName& blob, const Place& place) const {
    const std::uint64_t here = heads_.back().offset;
    if (place.kind == Place::Kind::instances) {
        const std::uint64_t expected = matrix_bytes * document_.instance_counts[place.i];
        file_.require(blob.bytes == expected, here, "a blob of {} bytes for the {} matrices of draw {}, got {}",
                      expected, document_.instance_counts[place.i], place.i, blob.bytes);
    }
    if (place.kind >= Place::Kind::vertex_module)
        file_.require(blob.bytes % 4 == 0, here, "whole words of 4 bytes for {}, got {} bytes", place.text(),
                      blob.bytes);
}

void TraceReader::await(const BlobName& blob, const Place& place) {
    const std::uint64_t here = heads_.back().offset;
    file_.require(!blobs_.contains(blob.content), here, "blob {}, which {} names, behind this chunk",
                  blob.content.hex(), place.text());
    Awaited& awaited = awaited_[blob.content];
    if (awaited.places.empty()) {
        awaited.bytes = blob.bytes;
        awaited.named_at = here;
        if (place.kind == Place::Kind::surface_level) shared_left_ += blob.bytes;
    } else {
        file_.repeat(blob.bytes, place.text());
    }
    file_.require(awaited.bytes == blob.bytes, here, "{} bytes in blob {}, as before, got {} for {}", awaited.bytes,
                  blob.content.hex(), blob.bytes, place.text());
    awaited.places.push_back(place);
}

void TraceReader::read_blob() {
    const ChunkHead head = heads_.back();
    file_.require(blobs_.insert(head.content).second, head.offset, "each blob once, got {} again", head.content.hex());
    const auto found = awaited_.find(head.content);
    if (found == awaited_.end()) {
        file_.check_content(); // of a chunk of a kind that was left out
        return;
    }
    const Awaited awaited = std::move(found->second);
    awaited_.erase(found);
    file_.require(awaited.bytes == head.content_bytes, head.offset, "a blob of {} bytes for {}, got {}", awaited.bytes,
                  awaited.places.front().text(), head.content_bytes);
    const bool is_shared = std::any_of(awaited.places.begin(), awaited.places.end(),
                                       [](const Place& place) { return place.kind == Place::Kind::surface_level; });
    if (is_shared) return share(awaited.places, awaited.bytes);
    std::vector<std::byte> bytes = file_.content();
    for (std::size_t i = 1; i < awaited.places.size(); ++i) fill(awaited.places[i], bytes);
    fill(awaited.places.front(), std::move(bytes));
}

// Surfaces hold the bytes together.
void TraceReader::share(const std::vector<Place>& places, std::uint64_t bytes) {
    const std::shared_ptr<std::byte[]> memory = blocks_.take(bytes, shared_left_);
    shared_left_ -= std::min(shared_left_, bytes);
    const std::span<std::byte> content(memory.get(), bytes);
    file_.read_content(content);
    for (const Place& place : places) {
        if (place.kind == Place::Kind::surface_level)
            document_.trace.recording->surfaces[place.i].levels[place.level] = {memory, bytes};
        else
            fill(place, {content.begin(), content.end()});
    }
}

void TraceReader::fill(const Place& place, std::vector<std::byte> bytes) {
    Trace& trace = document_.trace;
    switch (place.kind) {
    case Place::Kind::buffer:
        trace.scene.resources->buffers[place.i].bytes = std::move(bytes);
        break;
    case Place::Kind::texture_level:
    case Place::Kind::map_level: {
        pipeline::Resources& resources = *trace.scene.resources;
        pipeline::Texture& texture =
            place.kind == Place::Kind::map_level ? resources.maps[place.i].texture : resources.textures[place.i];
        std::vector<std::uint8_t>& rgba = texture.levels[place.level].rgba;
        rgba.resize(bytes.size());
        if (!bytes.empty()) std::memcpy(rgba.data(), bytes.data(), bytes.size());
        break;
    }
    case Place::Kind::instances:
        fill_instances(place.i, bytes);
        break;
    case Place::Kind::surface_level:
        break; // see share()
    case Place::Kind::vertex_module:
        trace.recording->programs[place.i].vertex = words_of(bytes);
        break;
    case Place::Kind::fragment_module:
        trace.recording->programs[place.i].fragment = words_of(bytes);
        break;
    case Place::Kind::uniform:
        trace.recording->values[place.i][place.level].words = words_of(bytes);
        break;
    }
}

void TraceReader::fill_instances(std::size_t draw, std::span<const std::byte> bytes) {
    std::vector<glm::mat4>& instances = document_.trace.scene.draws[draw].instances;
    instances = matrices_of(bytes);
    for (std::size_t i = 0; i < instances.size(); ++i)
        for (int k = 0; k < 16; ++k)
            file_.require(std::isfinite(instances[i][k / 4][k % 4]), heads_.back().offset,
                          "finite numbers in matrix {} of draw {}", i, draw);
}

std::vector<std::string> TraceReader::missing() const {
    std::vector<std::string> lines;
    for (const Record& record : records())
        if (record.is_needed == nullptr && belongs(record, recorded_.value_or(false)) && !seen_.contains(record.type))
            lines.push_back(
                fmt::format("{}: byte {}: expected a chunk {}", file_.name(), file_.file_bytes(), record.type.text()));
    for (const auto& [content, awaited] : awaited_)
        lines.push_back(fmt::format("{}: byte {}: expected blob {}, which {} names, got the end of the file",
                                    file_.name(), awaited.named_at, content.hex(), awaited.places.front().text()));
    return lines;
}

Trace TraceReader::finish() {
    if (const auto lines = missing(); !lines.empty()) throw sim::InputError(lines.front());
    Trace trace = std::move(document_.trace);
    trace.scene.name = file_.name(); // with its folders, for errors
    ContentHash hash;
    hash.add(std::as_bytes(std::span(heads_.back().content.bytes)));
    trace.scene.hash = hash.hex();
    if (trace.recording) {
        trace.recording->resources = std::move(trace.scene.resources);
        trace.recording->resources->find_runs();
        check_recording(*trace.recording, trace.scene.name);
        return trace;
    }
    std::uint64_t next = 0;
    for (const NumberedMaps& of : document_.maps) {
        auto& materials = trace.scene.resources->materials;
        if (of.material >= materials.size() || of.material < next)
            throw sim::InputError(
                fmt::format("{}: chunk MAPS: expected numbers of {} materials, the least first, got {}", file_.name(),
                            materials.size(), of.material));
        materials[of.material].maps = of.maps;
        next = std::uint64_t{of.material} + 1;
    }
    check_trace(trace);
    trace.scene.resources->find_runs();
    finish_scene(trace.scene);
    check_finished(trace);
    return trace;
}

} // namespace rtrace

bool is_trace_file(const std::filesystem::path& path) { return path.extension() == ".rtrace"; }

Trace read_trace(const std::filesystem::path& path) {
    rtrace::TraceReader reader(path);
    while (reader.next()) reader.read();
    Trace trace = reader.finish();
    trace.scene.name = path.filename().string();
    return trace;
}

} // namespace traces
