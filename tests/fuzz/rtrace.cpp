// The reader of draw traces, with what is said of a faulty one, and the frame of what it read, or what a recording
// names. Hashes and checks would
// stop nearly every input at once, so the bytes are the contents of chunks: type, length (3 bytes), content, and so on.
#include "tests/fuzz/expect_input_error.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "traces/recording/cut.hpp"
#include "traces/recording/recording_check.hpp"
#include "traces/rtrace/chunk.hpp"
#include "traces/rtrace/little_endian.hpp"
#include "traces/trace.hpp"
#include "traces/trace_text.hpp"

#include <algorithm>
#include <cstring>

namespace {

namespace rtrace = traces::rtrace;

class File {
  public:
    File() : bytes_(rtrace::file_head_bytes) {
        std::memcpy(bytes_.data(), rtrace::magic.data(), rtrace::magic.size());
        rtrace::put_little(&bytes_[8], rtrace::format_version);
    }
    void add(rtrace::ChunkType type, std::span<const std::byte> content) {
        rtrace::ChunkHead head;
        head.type = type;
        head.flags = rtrace::flag_required;
        head.content_bytes = head.stored_bytes = content.size();
        head.content = rtrace::name_of(content);
        const auto bytes = rtrace::bytes_of(head);
        bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
        bytes_.insert(bytes_.end(), content.begin(), content.end());
        inventory_.add(head);
    }
    const std::vector<std::byte>& finished() {
        const auto content = inventory_.content();
        add(rtrace::chunk::done, content);
        return bytes_;
    }

  private:
    std::vector<std::byte> bytes_;
    rtrace::Inventory inventory_;
};

void read(const std::uint8_t* bytes, std::size_t size) {
    const fuzz::MemoryFile file(bytes, size);
    fuzz::expect_result_or_input_error([&] {
        const traces::Trace trace = traces::read_trace(file.path());
        if (trace.recording)
            traces::check_recording(traces::compact(*trace.recording), "compacted");
        else
            traces::frame_of(trace);
    });
    fuzz::expect_result_or_input_error([&] { traces::trace_faults(file.path()); });
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    if (size >= rtrace::magic.size() && std::equal(rtrace::magic.begin(), rtrace::magic.end(), bytes)) {
        read(bytes, size);
        return 0;
    }
    File file;
    const auto all = std::as_bytes(std::span(bytes, size));
    for (std::size_t at = 0; at + 7 <= size;) {
        rtrace::ChunkType type;
        std::memcpy(type.letters.data(), &all[at], type.letters.size());
        const std::size_t length = std::min<std::size_t>(std::to_integer<std::size_t>(all[at + 4]) |
                                                             std::to_integer<std::size_t>(all[at + 5]) << 8U |
                                                             std::to_integer<std::size_t>(all[at + 6]) << 16U,
                                                         size - at - 7);
        file.add(type, all.subspan(at + 7, length));
        at += 7 + length;
    }
    const auto& whole = file.finished();
    read(reinterpret_cast<const std::uint8_t*>(whole.data()), whole.size());
    return 0;
}
