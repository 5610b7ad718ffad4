#include "traces/rtrace/chunk_reader.hpp"

#include "sim/check.hpp"
#include "sim/large_pages.hpp"
#include "traces/rtrace/little_endian.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <new>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>
#include <zstd.h>

namespace traces::rtrace {

namespace {

/// A chunk is read, decompressed and hashed in pieces that stay in the host's cache.
constexpr std::size_t piece_bytes = std::size_t{1} << 18U;

struct FreeHash {
    void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
};

} // namespace

void ChunkReader::FreeContext::operator()(ZSTD_DCtx_s* context) const { ZSTD_freeDCtx(context); }

ChunkReader::ChunkReader(const std::filesystem::path& path)
    : name_(path.string()),
      descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)),
      zstd_(ZSTD_createDCtx()),
      stored_(piece_bytes),
      piece_(piece_bytes) {
    struct stat facts {};
    if (descriptor_ < 0 || ::fstat(descriptor_, &facts) != 0 || !S_ISREG(facts.st_mode)) {
        if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
        throw sim::InputError(fmt::format("{}: expected a file that can be read", name_));
    }
    if (zstd_ == nullptr) throw std::bad_alloc();
    CHECK(ZSTD_isError(ZSTD_DCtx_setParameter(zstd_.get(), ZSTD_d_windowLogMax, most_window_log)) == 0);
    file_bytes_ = static_cast<std::uint64_t>(facts.st_size);
    require(file_bytes_ >= file_head_bytes, file_bytes_, "a file head of {} bytes, got the end of the file",
            file_head_bytes);
    std::array<std::byte, file_head_bytes> head;
    read(0, head);
    require(std::memcmp(head.data(), magic.data(), magic.size()) == 0, 0, "the magic of a draw trace (\\x89RTRC)");
    const auto version = get_little<std::uint32_t>(&head[8]);
    require(version == format_version, 8, "version {}, got {}", format_version, version);
    require(get_little<std::uint32_t>(&head[12]) == 0, 12, "4 bytes of 0");
}

ChunkReader::~ChunkReader() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

void ChunkReader::fail(std::uint64_t byte, std::string_view expected) const {
    throw sim::InputError(fmt::format("{}: byte {}: expected {}", name_, byte, expected));
}

void ChunkReader::read(std::uint64_t at, std::span<std::byte> bytes) const {
    while (!bytes.empty()) {
        const ssize_t got = ::pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(at));
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) throw sim::InputError(fmt::format("{}: cannot be read: {}", name_, std::strerror(errno)));
        require(got != 0, at, "{} more bytes, got the end of the file", bytes.size());
        at += static_cast<std::uint64_t>(got);
        bytes = bytes.subspan(static_cast<std::size_t>(got));
    }
}

std::optional<ChunkHead> ChunkReader::next() {
    if (done_) {
        require(next_ == file_bytes_, next_, "the end of the file behind the last chunk, got {} more bytes",
                file_bytes_ - next_);
        return std::nullopt;
    }
    require(file_bytes_ - next_ >= chunk_head_bytes, next_,
            "the head of a chunk ({} bytes; the last one is DONE), got the end of the file", chunk_head_bytes);
    std::array<std::byte, chunk_head_bytes> bytes;
    read(next_, bytes);
    ChunkHead head;
    head.offset = next_;
    std::memcpy(head.type.letters.data(), bytes.data(), head.type.letters.size());
    head.flags = get_little<std::uint32_t>(&bytes[4]);
    head.content_bytes = get_little<std::uint64_t>(&bytes[8]);
    head.stored_bytes = get_little<std::uint64_t>(&bytes[16]);
    std::memcpy(head.content.bytes.data(), &bytes[24], head.content.bytes.size());
    require(bytes == bytes_of(head), next_, "the head of a chunk whose check holds");
    require((head.flags & ~(flag_required | flag_zstd)) == 0, next_ + 4, "flags below 4, got {}", head.flags);
    const std::uint64_t left = file_bytes_ - next_ - chunk_head_bytes;
    require(head.stored_bytes <= left, next_ + 16, "at most the {} bytes that are left of the file, got {}", left,
            head.stored_bytes);
    require(head.compressed() || head.content_bytes == head.stored_bytes, next_ + 8,
            "{} bytes of content, as many as are stored, got {}", head.stored_bytes, head.content_bytes);
    const std::uint64_t most = most_content(head.end());
    require(head.content_bytes <= most - std::min(most, content_bytes_), next_ + 8,
            "at most {} bytes of content in the first {} of the file, got {} more than the {} before", most, head.end(),
            head.content_bytes, content_bytes_);
    content_bytes_ += head.content_bytes;
    next_ = head.end();
    head_ = head;
    if (head.type == chunk::done) {
        const auto inventory = inventory_.content();
        require(head.content == name_of(inventory), head.offset, "the number and names of all chunks before it");
        done_ = true;
    }
    inventory_.add(head);
    return head;
}

void ChunkReader::repeat(std::uint64_t bytes, std::string_view what) {
    const std::uint64_t most = most_content(file_bytes_);
    require(bytes <= most - repeated_bytes_, head_.offset,
            "at most {} bytes in blobs that are used again, got {} more for {}", most, bytes, what);
    repeated_bytes_ += bytes;
}

// Decompresses into `room(made, bytes)`, memory for what follows the first `made` bytes; hands each piece to `take`.
template <class Room, class Take>
void ChunkReader::decompress(Room room, Take take) {
    const std::uint64_t begin = head_.offset + chunk_head_bytes;
    CHECK(ZSTD_isError(ZSTD_DCtx_reset(zstd_.get(), ZSTD_reset_session_only)) == 0);
    std::uint64_t at = begin, made = 0;
    ZSTD_inBuffer in{stored_.data(), 0, 0};
    for (std::size_t hint = 1; hint != 0;) {
        if (in.pos == in.size) {
            in.size = std::min<std::uint64_t>(piece_bytes, head_.end() - at);
            in.pos = 0;
            read(at, std::span(stored_).first(in.size));
            at += in.size;
        }
        const std::span<std::byte> to = room(made, std::min<std::uint64_t>(piece_bytes, head_.content_bytes - made));
        ZSTD_outBuffer out{to.data(), to.size(), 0};
        const std::size_t before = in.pos;
        hint = ZSTD_decompressStream(zstd_.get(), &out, &in);
        require(ZSTD_isError(hint) == 0, begin, "one zstd frame of {} bytes of content, got: {}", head_.content_bytes,
                ZSTD_getErrorName(hint));
        made += out.pos;
        take(to.first(out.pos));
        const bool stuck = out.pos == 0 && in.pos == before && (in.pos < in.size || at == head_.end());
        require(hint == 0 || !stuck, begin, "one zstd frame of {} bytes of content in {} bytes", head_.content_bytes,
                head_.stored_bytes);
    }
    require(made == head_.content_bytes && at == head_.end() && in.pos == in.size, begin,
            "one zstd frame of {} bytes of content in {} bytes", head_.content_bytes, head_.stored_bytes);
}

template <class Room>
void ChunkReader::decode(Room room) {
    const std::unique_ptr<XXH3_state_t, FreeHash> hash(XXH3_createState());
    if (hash == nullptr) throw std::bad_alloc();
    CHECK(XXH3_128bits_reset(hash.get()) == XXH_OK);
    const auto take = [&](std::span<const std::byte> piece) {
        if (piece.empty()) return;
        CHECK(XXH3_128bits_update(hash.get(), piece.data(), piece.size()) == XXH_OK);
    };
    const std::uint64_t begin = head_.offset + chunk_head_bytes;
    if (head_.compressed()) {
        decompress(room, take);
    } else {
        for (std::uint64_t at = begin; at < head_.end();) {
            const std::span<std::byte> piece = room(at - begin, std::min<std::uint64_t>(piece_bytes, head_.end() - at));
            read(at, piece);
            take(piece);
            at += piece.size();
        }
    }
    XXH128_canonical_t canonical;
    XXH128_canonicalFromHash(&canonical, XXH3_128bits_digest(hash.get()));
    require(std::equal(head_.content.bytes.begin(), head_.content.bytes.end(), canonical.digest), begin,
            "content whose hash is {} in chunk {}", head_.content.hex(), head_.type.text());
}

std::vector<std::byte> ChunkReader::content() {
    std::vector<std::byte> bytes;
    bytes.reserve(head_.content_bytes); // not touched before there is something to write
    sim::prefer_large_pages(bytes.data(), head_.content_bytes);
    decode([&](std::uint64_t made, std::size_t more) {
        bytes.resize(made + more);
        return std::span(bytes).subspan(made);
    });
    return bytes;
}

void ChunkReader::read_content(std::span<std::byte> to) {
    CHECK(to.size() == head_.content_bytes);
    decode([&](std::uint64_t made, std::size_t more) { return to.subspan(made, more); });
}

void ChunkReader::check_content() {
    decode([&](std::uint64_t, std::size_t more) { return std::span(piece_).first(more); });
}

} // namespace traces::rtrace
