// What is recorded of a program: frames that are wanted, written to the file that ROPSIM_RECORD names.
//
// ROPSIM_RECORD_FRAMES is "first:last"; frames count from 0, one ends at each swap of buffers. Behind the last one the
// program ends.
#pragma once

#include "traces/record_module/stream.hpp"

#include <cstdint>
#include <map>
#include <mutex>
#include <span>
#include <string>

namespace record {

class Recorder {
  public:
    Recorder();
    /// Whether the program runs under ropsim at all.
    bool active() const { return descriptor_ >= 0; }
    /// Whether what is drawn now belongs to a frame that is wanted.
    bool wanted() const { return active() && frame_ >= first_ && frame_ <= last_ && !failed_; }
    bool isotropic() const { return isotropic_; }

    /// The number of these bytes; they are written once.
    std::int32_t blob(std::span<const std::byte> bytes);
    std::int32_t surface(const record_stream::Surface& surface);
    std::int32_t program(const record_stream::Program& program);
    void context(const std::string& version, const std::string& renderer);
    void draw(const record_stream::Draw& draw);
    void clear(const record_stream::Clear& clear);
    void copy(const record_stream::Copy& copy);
    void blit(const record_stream::Blit& blit);
    /// Something that happened in a wanted frame and is not recorded.
    void count(const std::string& call);
    /// Buffers were swapped; `shown` is what they showed, where the frame is wanted.
    void end_frame(const record_stream::Targets& shown);

  private:
    using Hash = std::array<std::uint64_t, 2>;

    void write(const std::vector<std::byte>& record);

    int descriptor_ = -1;
    std::uint32_t first_ = 0, last_ = 0, frame_ = 0;
    bool isotropic_ = false, failed_ = false, said_ = false;
    std::int32_t surfaces_ = 0, programs_ = 0;
    std::map<Hash, std::int32_t> blobs_;
    std::map<std::string, std::uint64_t> not_recorded_;
};

/// The one of this process; lives until its end.
Recorder& recorder();

/// Held while anything here is used: programs call OpenGL from several threads.
class Lock {
  public:
    Lock();
    ~Lock();
    Lock(const Lock&) = delete;
    Lock& operator=(const Lock&) = delete;
};

} // namespace record
