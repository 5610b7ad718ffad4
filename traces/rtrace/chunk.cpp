#include "traces/rtrace/chunk.hpp"

#include "traces/rtrace/little_endian.hpp"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <xxhash.h>

namespace traces::rtrace {

std::string ContentName::hex() const {
    std::string text;
    for (const std::uint8_t byte : bytes) text += fmt::format("{:02x}", byte);
    return text;
}

std::string ChunkType::text() const {
    std::string text(letters.data(), letters.size());
    std::replace_if(
        text.begin(), text.end(), [](char letter) { return letter < ' ' || letter > '~'; }, '?');
    return text;
}

ContentName name_of(std::span<const std::byte> content) {
    XXH128_canonical_t canonical;
    XXH128_canonicalFromHash(&canonical, XXH3_128bits(content.data(), content.size()));
    ContentName name;
    std::copy_n(canonical.digest, name.bytes.size(), name.bytes.begin());
    return name;
}

std::array<std::byte, chunk_head_bytes> bytes_of(const ChunkHead& head) {
    std::array<std::byte, chunk_head_bytes> bytes{};
    std::memcpy(bytes.data(), head.type.letters.data(), head.type.letters.size());
    put_little(&bytes[4], head.flags);
    put_little(&bytes[8], head.content_bytes);
    put_little(&bytes[16], head.stored_bytes);
    std::memcpy(&bytes[24], head.content.bytes.data(), head.content.bytes.size());
    put_little<std::uint64_t>(&bytes[40], XXH3_64bits(bytes.data(), 40));
    return bytes;
}

void Inventory::add(const ChunkHead& head) {
    const auto letters = std::as_bytes(std::span(head.type.letters));
    const auto content = std::as_bytes(std::span(head.content.bytes));
    heads_.insert(heads_.end(), letters.begin(), letters.end());
    heads_.insert(heads_.end(), content.begin(), content.end());
}

std::array<std::byte, 24> Inventory::content() const {
    constexpr std::size_t bytes_each = 20;
    std::array<std::byte, 24> bytes{};
    put_little<std::uint64_t>(bytes.data(), heads_.size() / bytes_each);
    const ContentName all = name_of(heads_);
    std::memcpy(&bytes[8], all.bytes.data(), all.bytes.size());
    return bytes;
}

} // namespace traces::rtrace
