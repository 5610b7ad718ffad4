// What a draw trace says, as text; what is wrong with one; where two differ.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace traces {

/// A record of the file.
struct TraceLine {
    std::string place; ///< "geometry 0 attribute 1"
    std::vector<std::pair<std::string, std::string>> fields;

    std::string text() const; ///< "geometry 0 attribute 1: semantic=normal ..."
};

/// Everything, in the order of the format; of blobs their names and sizes. Throws as read_trace() does.
std::vector<TraceLine> dump_trace(const std::filesystem::path& path);

/// One line for each fault, with its place: of every chunk, of what one says of another, and of the frame. Empty: none.
std::vector<std::string> trace_faults(const std::filesystem::path& path);

/// One line for each record that one of them lacks and each field that differs, by place. Throws as read_trace() does.
std::vector<std::string> trace_differences(const std::filesystem::path& a, const std::filesystem::path& b);

/// Chunks of one kind.
struct TraceChunks {
    std::string type;
    std::uint64_t count = 0, compressed = 0, content_bytes = 0, stored_bytes = 0;
};

/// By kind, in the order of their first. Throws as read_trace() does.
std::vector<TraceChunks> trace_chunks(const std::filesystem::path& path);

} // namespace traces
