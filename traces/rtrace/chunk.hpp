// The frame of a .rtrace file: a file header, then chunks; FORMAT.md has it byte by byte.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace traces::rtrace {

inline constexpr std::uint32_t format_version = 1;
inline constexpr std::size_t file_head_bytes = 16, chunk_head_bytes = 48;
/// The byte of 8 bits and the line ends tell of a transfer as text.
inline constexpr std::array<std::uint8_t, 8> magic{0x89, 'R', 'T', 'R', 'C', '\r', '\n', 0x1A};

/// XXH3-128 of a chunk's content, in canonical (big-endian) order. A blob is known by it.
struct ContentName {
    std::array<std::uint8_t, 16> bytes{};

    bool operator==(const ContentName&) const = default;
    bool operator<(const ContentName& other) const { return bytes < other.bytes; }
    std::string hex() const;
};

ContentName name_of(std::span<const std::byte> content);

struct ChunkType {
    std::array<char, 4> letters{};

    constexpr ChunkType() = default;
    constexpr ChunkType(const char (&text)[5]) : letters{text[0], text[1], text[2], text[3]} {}
    bool operator==(const ChunkType&) const = default;
    bool operator<(const ChunkType& other) const { return letters < other.letters; }
    std::string text() const; ///< "GEOM"; letters that cannot be printed are '?'
};

namespace chunk {
inline constexpr ChunkType metadata = "META", scene = "SCEN", buffers = "BUFS", geometries = "GEOM", textures = "TEXS",
                           materials = "MATS", draws = "DRAW", cameras = "CAMS", lights = "LITE", captured = "CAPT",
                           maps = "MAPS", surfaces = "SURF", samplers = "SAMP", programs = "SHDR", values = "VARS",
                           bindings = "BIND", states = "RAST", depth_ranges = "DRNG", targets = "TARG", frames = "FRAM",
                           not_recorded = "OMIT", blob = "BLOB", done = "DONE";
} // namespace chunk

/// Bits of ChunkHead::flags; the others are 0.
inline constexpr std::uint32_t flag_required = 1U << 0U; ///< who does not know the type must not go on
inline constexpr std::uint32_t flag_zstd = 1U << 1U;     ///< stored as one zstd frame, else as it is

struct ChunkHead {
    std::uint64_t offset = 0; ///< in the file
    ChunkType type;
    std::uint32_t flags = 0;
    std::uint64_t content_bytes = 0; ///< once decompressed
    std::uint64_t stored_bytes = 0;  ///< in the file, behind the head
    ContentName content;

    std::uint64_t end() const { return offset + chunk_head_bytes + stored_bytes; }
    bool required() const { return (flags & flag_required) != 0; }
    bool compressed() const { return (flags & flag_zstd) != 0; }
};

/// The head as it lies in the file.
std::array<std::byte, chunk_head_bytes> bytes_of(const ChunkHead& head);

/// What all chunks up to a place in the file may hold together once decompressed, so that a small file cannot ask for
/// all memory: writers store uncompressed what would be more. The same bound holds for blobs that are used again.
constexpr std::uint64_t most_content(std::uint64_t file_bytes) {
    return (std::uint64_t{256} << 20U) + (file_bytes < (std::uint64_t{1} << 56U) ? 64 * file_bytes : UINT64_MAX / 2);
}

/// zstd frames may look back so far: 8 MiB, four times what level 3 does.
inline constexpr int most_window_log = 23;
inline constexpr int compression_level = 3;

/// Content of the last chunk: how many stand before it, and a name over their types and contents.
class Inventory {
  public:
    void add(const ChunkHead& head);
    std::array<std::byte, 24> content() const;

  private:
    std::vector<std::byte> heads_; ///< 20 bytes of each chunk
};

} // namespace traces::rtrace
