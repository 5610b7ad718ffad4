// Writes a .rtrace file chunk by chunk.
#pragma once

#include "sim/unfinished_file.hpp"
#include "traces/rtrace/chunk.hpp"

#include <memory>
#include <set>

struct ZSTD_CCtx_s;

namespace traces::rtrace {

/// The file appears under its name with finish(). Throws sim::InputError "PATH: cannot be written: REASON".
class ChunkWriter {
  public:
    explicit ChunkWriter(const std::filesystem::path& path);
    ~ChunkWriter();
    ChunkWriter(const ChunkWriter&) = delete;
    ChunkWriter& operator=(const ChunkWriter&) = delete;

    void add(ChunkType type, std::span<const std::byte> content);
    /// A blob that is there already is not written again.
    void add_blob(const ContentName& name, std::span<const std::byte> content);
    void finish();

  private:
    void add(ChunkHead head, std::span<const std::byte> content);
    std::span<const std::byte> compressed(std::span<const std::byte> content);
    void write(std::span<const std::byte> bytes);
    [[noreturn]] void fail(int error) const;

    struct FreeContext {
        void operator()(ZSTD_CCtx_s* context) const;
    };
    sim::UnfinishedFile file_;
    int descriptor_;
    std::uint64_t at_ = 0, content_bytes_ = 0, repeated_bytes_ = 0;
    std::unique_ptr<ZSTD_CCtx_s, FreeContext> zstd_;
    std::unique_ptr<std::byte[]> buffer_;
    std::size_t buffer_bytes_ = 0;
    std::set<ContentName> blobs_;
    Inventory inventory_;
};

} // namespace traces::rtrace
