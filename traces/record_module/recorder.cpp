#include "traces/record_module/recorder.hpp"

#include "traces/record_module/writer.hpp"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace record {

using namespace record_stream;

namespace {

std::recursive_mutex& mutex() {
    static auto* const one = new std::recursive_mutex; // used by threads that outlive static objects
    return *one;
}

} // namespace

Lock::Lock() { mutex().lock(); }
Lock::~Lock() { mutex().unlock(); }

Recorder& recorder() {
    static auto* const one = new Recorder;
    return *one;
}

Recorder::Recorder() {
    const char* const path = std::getenv("ROPSIM_RECORD");
    const char* const frames = std::getenv("ROPSIM_RECORD_FRAMES");
    if (path == nullptr || frames == nullptr || std::sscanf(frames, "%u:%u", &first_, &last_) != 2) return;
    isotropic_ = std::getenv("ROPSIM_RECORD_ISOTROPIC") != nullptr;
    descriptor_ = ::open(path, O_WRONLY | O_APPEND | O_CLOEXEC);
}

void Recorder::write(const std::vector<std::byte>& record) {
    // Of several processes that draw, the first one is recorded.
    if (!said_ && ::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) failed_ = true;
    said_ = true;
    for (std::size_t done = 0; done < record.size() && !failed_;) {
        const ssize_t written = ::write(descriptor_, record.data() + done, record.size() - done);
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) {
            std::fprintf(stderr, "ropsim: cannot write the recording: %s\n", std::strerror(errno));
            ::_exit(status_no_room); // else it would run on, with ropsim waiting for frames
        }
        done += static_cast<std::size_t>(written);
    }
}

std::int32_t Recorder::blob(std::span<const std::byte> bytes) {
    const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
    const auto [place, is_new] =
        blobs_.try_emplace(Hash{hash.low64, hash.high64}, static_cast<std::int32_t>(blobs_.size()));
    if (is_new) write(Writer::record(Tag::blob, Blob{{bytes.begin(), bytes.end()}}));
    return place->second;
}

std::int32_t Recorder::surface(const Surface& surface) {
    write(Writer::record(Tag::surface, surface));
    return surfaces_++;
}

std::int32_t Recorder::program(const Program& program) {
    write(Writer::record(Tag::program, program));
    return programs_++;
}

void Recorder::context(const std::string& gl_version, const std::string& renderer) {
    write(Writer::record(Tag::context, Context{version, gl_version, renderer}));
}

void Recorder::draw(const Draw& draw) { write(Writer::record(Tag::draw, draw)); }
void Recorder::clear(const Clear& clear) { write(Writer::record(Tag::clear, clear)); }
void Recorder::copy(const Copy& copy) { write(Writer::record(Tag::copy, copy)); }
void Recorder::blit(const Blit& blit) { write(Writer::record(Tag::blit, blit)); }

void Recorder::count(const std::string& call) {
    if (wanted()) ++not_recorded_[call];
}

void Recorder::end_frame(const Targets& shown) {
    if (wanted()) {
        for (const auto& [call, times] : not_recorded_)
            write(Writer::record(Tag::not_recorded, NotRecorded{call, times}));
        not_recorded_.clear();
        write(Writer::record(Tag::frame, Frame{frame_, shown}));
        if (frame_ == last_) {
            write(Writer::record(Tag::finished, Finished{}));
            ::_exit(0);
        }
    }
    ++frame_;
}

} // namespace record
