// Reads a .rtrace file chunk by chunk. Nothing of it is trusted: a size is held against the file's length and
// most_content() before anything is allocated for it.
#pragma once

#include "traces/rtrace/chunk.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <optional>
#include <utility>

struct ZSTD_DCtx_s;

namespace traces::rtrace {

/// Errors are sim::InputError of one line: file, byte, what was expected.
class ChunkReader {
  public:
    explicit ChunkReader(const std::filesystem::path& path);
    ~ChunkReader();
    ChunkReader(const ChunkReader&) = delete;
    ChunkReader& operator=(const ChunkReader&) = delete;

    const std::string& name() const { return name_; }
    std::uint64_t file_bytes() const { return file_bytes_; }

    /// The next chunk's head; nothing behind the last one, which has to be chunk::done.
    std::optional<ChunkHead> next();
    /// The content of the chunk that next() gave, decompressed and held against its name.
    std::vector<std::byte> content();
    /// The same, into ChunkHead::content_bytes of memory.
    void read_content(std::span<std::byte> to);
    /// The same, kept nowhere.
    void check_content();
    /// So many bytes are wanted a second time, for `what`.
    void repeat(std::uint64_t bytes, std::string_view what);

    [[noreturn]] void fail(std::uint64_t byte, std::string_view expected) const;
    template <class... Arguments>
    void require(bool good, std::uint64_t byte, fmt::format_string<Arguments...> expected,
                 Arguments&&... arguments) const {
        if (!good) fail(byte, fmt::format(expected, std::forward<Arguments>(arguments)...));
    }

  private:
    void read(std::uint64_t at, std::span<std::byte> bytes) const;
    template <class Room>
    void decode(Room room);
    template <class Room, class Take>
    void decompress(Room room, Take take);

    std::string name_;
    int descriptor_ = -1;
    std::uint64_t file_bytes_ = 0;
    std::uint64_t content_bytes_ = 0;  ///< of all chunks so far
    std::uint64_t repeated_bytes_ = 0; ///< of repeat()
    ChunkHead head_;                   ///< of the present chunk
    std::uint64_t next_ = file_head_bytes;
    bool done_ = false;
    Inventory inventory_;
    struct FreeContext {
        void operator()(ZSTD_DCtx_s* context) const;
    };
    std::unique_ptr<ZSTD_DCtx_s, FreeContext> zstd_;
    std::vector<std::byte> stored_, piece_;
};

} // namespace traces::rtrace
