// What the chunks of a .rtrace file say, field by field: FORMAT.md in code.
#pragma once

#include "traces/rtrace/fields.hpp"
#include "traces/trace.hpp"

namespace traces::rtrace {

/// A trace whose bytes are still, or again, blobs: names in the order of what they belong to.
struct Document {
    Trace trace;
    std::vector<BlobName> buffers;             ///< of each buffer
    std::vector<std::vector<BlobName>> levels; ///< of each texture and level
    std::vector<BlobName> instances;           ///< of each draw; unused where its matrices stand in the record
    std::vector<std::uint32_t> instance_counts;
};

/// A draw's matrices are a blob where there are more of them.
inline constexpr std::uint32_t most_matrices_in_record = 4;
inline constexpr std::uint64_t matrix_bytes = 64;

/// A kind of chunk that a trace has exactly one of.
struct Record {
    ChunkType type;
    void (*visit)(Fields&, Document&);
};

/// All of them, in the order in which they are written.
std::span<const Record> records();

} // namespace traces::rtrace
