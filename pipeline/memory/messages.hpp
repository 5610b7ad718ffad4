// What travels between units and the memory system.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace pipeline {

/// Who asked; every byte on a memory link is booked to one of these.
enum class MemoryClient : std::uint8_t { index, vertex, texture, kbuffer_read, tile_read, tile_write, copy };
inline constexpr std::size_t memory_client_count = 7;
inline constexpr std::array<std::string_view, memory_client_count> memory_client_names = {
    "index", "vertex", "texture", "kbuffer_read", "tile_read", "tile_write", "copy"};

struct MemoryRequest {
    std::uint64_t address = 0;
    std::uint32_t bytes = 0; ///< 1 to 4096
    std::uint32_t tag = 0;   ///< comes back in the response; chosen by the client
    std::uint32_t draw = 0;  ///< draw the bytes are booked to: index into Frame::draws
    MemoryClient client = MemoryClient::index;
    bool write = false;  ///< writes are posted: no response but to whom `notify` asks for one
    bool notify = false; ///< of a write by a ROP partition: a response when the array has taken it
};

/// Answer to a unit behind the crossbar: the data are there. Answer to a ROP partition: the array took the request, in
/// the order in which bursts crossed the bus; the data of a read are `delay` cycles away still.
struct MemoryResponse {
    std::uint32_t tag = 0;
    std::uint32_t delay = 0; ///< cycles of the core clock
};

} // namespace pipeline
