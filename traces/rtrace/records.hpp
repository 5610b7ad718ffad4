// What the chunks of a .rtrace file say, field by field: FORMAT.md in code.
#pragma once

#include "traces/rtrace/fields.hpp"
#include "traces/trace.hpp"

#include <map>

namespace traces::rtrace {

/// What a blob is; in the order in which blobs are written.
struct Place {
    enum class Kind : std::uint8_t {
        buffer,
        texture_level,
        map_level,
        instances, ///< matrices of a draw
        surface_level,
        vertex_module,
        fragment_module,
        uniform
    } kind{};
    std::size_t i = 0;     ///< buffer, texture, map, draw, surface, program, set of values
    std::size_t level = 0; ///< of a texture, map or surface; uniform of a set

    auto operator<=>(const Place&) const = default; // NOLINT(modernize-use-nullptr): it means the 0 of <=>
    std::string text() const;
    ChunkType named_in() const;
};

/// What a material states beside its colour.
struct NumberedMaps {
    std::uint32_t material = 0;
    pipeline::MaterialMaps maps{};
};

/// A trace whose bytes are still, or again, blobs. Buffers and geometries are those of the scene in either kind of
/// trace.
struct Document {
    Trace trace;
    std::map<Place, BlobName> blobs;
    std::vector<std::uint32_t> instance_counts; ///< of each draw of the scene
    std::vector<NumberedMaps> maps{};           ///< of materials that state something
};

/// A draw's matrices are a blob where there are more of them.
inline constexpr std::uint32_t most_matrices_in_record = 4;
inline constexpr std::uint64_t matrix_bytes = 64;
/// A uniform's words are a blob where there are more of them.
inline constexpr std::size_t most_words_in_record = 64;

/// A kind of chunk that a trace has exactly one of, or at most one.
struct Record {
    enum class Of : std::uint8_t { both, captured, recorded } of{};
    ChunkType type;
    void (*visit)(Fields&, Document&) = nullptr;
    /// Whether there is anything to say in it; null: traces have it whatever it says.
    bool (*is_needed)(const Document&) = nullptr;
};

/// All of them, in the order in which they are written.
std::span<const Record> records();

/// Whether traces of frames that an application drew have it, or those of a captured frame.
inline bool belongs(const Record& record, bool recorded) {
    return record.of == Record::Of::both || (record.of == Record::Of::recorded) == recorded;
}

/// Whether this trace has it.
inline bool belongs(const Record& record, const Document& document) {
    return belongs(record, document.trace.recording.has_value()) &&
           (record.is_needed == nullptr || record.is_needed(document));
}

/// Of the chunks that only recorded traces have.
void visit_surfaces(Fields& fields, Document& document);
void visit_samplers(Fields& fields, Document& document);
void visit_programs(Fields& fields, Document& document);
void visit_values(Fields& fields, Document& document);
void visit_bindings(Fields& fields, Document& document);
void visit_states(Fields& fields, Document& document);
bool has_depth_ranges(const Document& document);
void visit_depth_ranges(Fields& fields, Document& document);
void visit_targets(Fields& fields, Document& document);
void visit_frames(Fields& fields, Document& document);
void visit_not_recorded(Fields& fields, Document& document);

} // namespace traces::rtrace
