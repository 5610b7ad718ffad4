#include "traces/texture_module/texture_module.h"

#include <OpenImageIO/imageio.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <sys/mman.h>
#include <unistd.h>
#include <vector>

namespace {

int fail(const std::string& message, char* error, std::size_t size) {
    std::snprintf(error, size, "%s", message.c_str());
    return 1;
}

/// A file in memory: not all readers of OpenImageIO take memory itself. It goes with the process.
class MemoryFile {
  public:
    MemoryFile(const std::uint8_t* bytes, std::size_t size) : descriptor_(::memfd_create("texture", MFD_CLOEXEC)) {
        while (size > 0) {
            const ssize_t written = ::write(descriptor_, bytes, size);
            if (written <= 0) throw std::runtime_error("no room for the file in memory");
            bytes += written;
            size -= static_cast<std::size_t>(written);
        }
    }
    std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

  private:
    int descriptor_;
};

int decode(const std::uint8_t* bytes, std::size_t size, const char* format, std::uint32_t width, std::uint32_t height,
           std::uint8_t* rgba, char* error, std::size_t error_size) {
    try {
        OIIO::attribute("threads", 1); // threads do not come along into a child process
        const MemoryFile file(bytes, size);
        OIIO::ImageSpec config, spec;
        config.attribute("oiio:UnassociatedAlpha", 1);
        const auto input = OIIO::ImageInput::create(format);
        if (!input) return fail(OIIO::geterror(), error, error_size);
        if (!input->open(file.path(), spec, config)) return fail(input->geterror(), error, error_size);
        if (spec.width != static_cast<int>(width) || spec.height != static_cast<int>(height) || spec.nchannels > 4 ||
            spec.nchannels < 1)
            return fail("its size is not that of its header", error, error_size);
        const auto channels = static_cast<std::size_t>(spec.nchannels);
        std::vector<std::uint8_t> texels(std::size_t{width} * height * channels);
        if (!input->read_image(0, 0, 0, -1, OIIO::TypeDesc::UINT8, texels.data()))
            return fail(input->geterror(), error, error_size);
        for (std::size_t i = 0; i < std::size_t{width} * height; ++i)
            for (std::size_t c = 0; c < 4; ++c) {
                const bool grey = channels < 3;
                const bool present = c < 3 || channels % 2 == 0;
                rgba[i * 4 + c] = !present ? 255 : texels[i * channels + (c == 3 ? channels - 1 : grey ? 0 : c)];
            }
        return 0;
    } catch (const std::exception& exception) {
        return fail(exception.what(), error, error_size);
    }
}

constexpr RopsimTextureModule texture_module{ROPSIM_TEXTURE_MODULE_VERSION, decode};

} // namespace

extern "C" __attribute__((visibility("default"))) const RopsimTextureModule* ropsim_texture_module() {
    return &texture_module;
}
