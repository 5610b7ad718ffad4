#include "traces/rtrace/chunk_writer.hpp"

#include "sim/check.hpp"
#include "traces/rtrace/little_endian.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <new>
#include <unistd.h>
#include <utility>
#include <zstd.h>

namespace traces::rtrace {

void ChunkWriter::FreeContext::operator()(ZSTD_CCtx_s* context) const { ZSTD_freeCCtx(context); }

ChunkWriter::ChunkWriter(const std::filesystem::path& path)
    : file_(path),
      descriptor_(::open(file_.temporary().c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)),
      zstd_(ZSTD_createCCtx()) {
    if (descriptor_ < 0) fail(errno);
    if (zstd_ == nullptr) throw std::bad_alloc();
    CHECK(ZSTD_isError(ZSTD_CCtx_setParameter(zstd_.get(), ZSTD_c_compressionLevel, compression_level)) == 0);
    std::array<std::byte, file_head_bytes> head{};
    std::memcpy(head.data(), magic.data(), magic.size());
    put_little(&head[8], format_version);
    write(head);
}

ChunkWriter::~ChunkWriter() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

void ChunkWriter::fail(int error) const {
    throw sim::InputError(fmt::format("{}: cannot be written: {}", file_.path().string(), std::strerror(error)));
}

void ChunkWriter::write(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail(errno);
        at_ += static_cast<std::uint64_t>(written);
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
}

std::span<const std::byte> ChunkWriter::compressed(std::span<const std::byte> content) {
    const std::size_t bound = ZSTD_compressBound(content.size());
    if (buffer_bytes_ < bound) {
        buffer_.reset(new std::byte[bound]); // not cleared: only what is written is touched
        buffer_bytes_ = bound;
    }
    const std::size_t bytes = ZSTD_compress2(zstd_.get(), buffer_.get(), buffer_bytes_, content.data(), content.size());
    CHECK_MSG(ZSTD_isError(bytes) == 0, ZSTD_getErrorName(bytes));
    return {buffer_.get(), bytes};
}

void ChunkWriter::add(ChunkHead head, std::span<const std::byte> content) {
    std::span<const std::byte> stored = compressed(content);
    content_bytes_ += content.size();
    head.flags = flag_required | flag_zstd;
    if (stored.size() >= content.size() || content_bytes_ > most_content(at_ + chunk_head_bytes + stored.size())) {
        head.flags = flag_required;
        stored = content;
    }
    head.offset = at_;
    head.content_bytes = content.size();
    head.stored_bytes = stored.size();
    write(bytes_of(head));
    write(stored);
    inventory_.add(head);
}

void ChunkWriter::add(ChunkType type, std::span<const std::byte> content) {
    ChunkHead head;
    head.type = type;
    head.content = name_of(content);
    add(head, content);
}

void ChunkWriter::add_blob(const ContentName& name, std::span<const std::byte> content) {
    if (!blobs_.insert(name).second) {
        repeated_bytes_ += content.size();
        return;
    }
    ChunkHead head;
    head.type = chunk::blob;
    head.content = name;
    add(head, content);
}

void ChunkWriter::finish() {
    add(chunk::done, inventory_.content());
    if (repeated_bytes_ > most_content(at_))
        throw sim::InputError(fmt::format("{}: cannot be written: {} bytes of equal buffers, textures and matrices, "
                                          "expected at most {} in a file of {} bytes",
                                          file_.path().string(), repeated_bytes_, most_content(at_), at_));
    const int closed = ::close(std::exchange(descriptor_, -1));
    if (closed != 0) fail(errno); // some file systems notice only here that the disk is full
    if (const int error = file_.commit(); error != 0) fail(error);
}

} // namespace traces::rtrace
