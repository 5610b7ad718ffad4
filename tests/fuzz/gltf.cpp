// The reader of .gltf and .glb files.
#include "sim/check.hpp"
#include "tests/fuzz/expect_input_error.hpp"
#include "traces/gltf_import.hpp"

#include <cstddef>
#include <cstdint>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

namespace {

/// A file in memory: the reader takes paths.
class MemoryFile {
  public:
    MemoryFile(const std::uint8_t* bytes, std::size_t size) : descriptor_(::memfd_create("scene.glb", 0)) {
        CHECK(descriptor_ >= 0 && ::write(descriptor_, bytes, size) == static_cast<ssize_t>(size));
    }
    ~MemoryFile() { ::close(descriptor_); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;
    std::string path() const { return fmt::format("/proc/self/fd/{}", descriptor_); }

  private:
    int descriptor_;
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    const MemoryFile file(bytes, size);
    fuzz::expect_result_or_input_error([&] { traces::import_gltf(file.path()); });
    return 0;
}
