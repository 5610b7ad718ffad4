// Makes a trace of the chunks of a file, one after the other: no chunk is held longer than it takes to read it.
#pragma once

#include "traces/rtrace/chunk_reader.hpp"
#include "traces/rtrace/content_blocks.hpp"
#include "traces/rtrace/records.hpp"

#include <map>
#include <set>

namespace traces::rtrace {

/// Errors are sim::InputError of one line: file, byte, what was expected.
class TraceReader {
  public:
    explicit TraceReader(const std::filesystem::path& path) : file_(path) {}

    /// Finds the next chunk; false at the end of the file.
    bool next();
    /// Reads it. When this throws, next() may still be called.
    void read();
    /// Once there is no next one: nothing is missing, and everything that one part says of another holds. The scene is
    /// finished and has the trace's hash.
    Trace finish();

    /// As far as it was read; finish() takes it.
    Document& document() { return document_; }
    const std::vector<ChunkHead>& heads() const { return heads_; }
    const ChunkReader& file() const { return file_; }
    /// Blobs that something names and that are not there, one line each.
    std::vector<std::string> missing() const;

  private:
    void read_record(const Record& record);
    void read_blob();
    void expect_kind(const Record& record);
    void await(const BlobName& blob, const Place& place);
    void await_blobs(ChunkType type);
    void check_size(const BlobName& blob, const Place& place) const;
    void share(const std::vector<Place>& places, std::uint64_t bytes);
    void fill(const Place& place, std::vector<std::byte> bytes);
    void fill_instances(std::size_t draw, std::span<const std::byte> bytes);

    ChunkReader file_;
    std::vector<ChunkHead> heads_;
    Document document_ = empty_document();
    std::set<ChunkType> seen_;
    std::optional<bool> recorded_; ///< once a chunk told which kind of trace it is
    struct Awaited {
        std::uint64_t bytes = 0, named_at = 0; ///< size, and the chunk that names it
        std::vector<Place> places;
    };
    std::map<ContentName, Awaited> awaited_;
    std::set<ContentName> blobs_; ///< that were there
    ContentBlocks blocks_;
    std::uint64_t shared_left_ = 0; ///< bytes of awaited blobs that share() reads

    static Document empty_document();
};

} // namespace traces::rtrace
