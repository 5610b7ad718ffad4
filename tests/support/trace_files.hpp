// Draw traces for tests: a scene that has something of everything, and files made of any chunks.
#pragma once

#include "traces/rtrace/chunk.hpp"
#include "traces/trace.hpp"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace support {

using Bytes = std::vector<std::byte>;

/// Textures with levels, equal buffers, packed and strided attributes, primitive restart, many instances, cameras,
/// lights, and names that are not ASCII. What depends on the program's version is left out.
traces::Trace rich_trace();

/// A file as its chunks, uncompressed.
struct Chunk {
    traces::rtrace::ChunkType type;
    Bytes content;
    std::uint32_t flags = traces::rtrace::flag_required;
};

/// Of a good file, without the last.
std::vector<Chunk> chunks_in(const std::filesystem::path& file);

/// A whole file of them: heads, checks and the last chunk are right.
Bytes file_of(const std::vector<Chunk>& chunks);

Bytes bytes_in(const std::filesystem::path& file);
void write_bytes(const std::filesystem::path& file, const Bytes& bytes);

/// What reading the bytes as a trace says; empty: nothing is wrong with them.
std::string refusal_of(const Bytes& bytes);

} // namespace support
