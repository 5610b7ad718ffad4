#include "reports/image_module/image_module.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <memory>
#include <string>

namespace {

// The file stays the same when it is written again later; OpenImageIO would state the present time.
constexpr const char* fixed_time = "2000:01:01 00:00:00";

int fail(const std::string& message, char* error, std::size_t size) {
    const std::string line = message.substr(0, message.find('\n'));
    if (size > 0) {
        const std::size_t length = std::min(line.size(), size - 1);
        std::memcpy(error, line.data(), length);
        error[length] = '\0';
    }
    return 1;
}

OIIO::ImageSpec spec_of(const RopsimImageShape& shape, OIIO::TypeDesc type) {
    OIIO::ImageSpec spec(static_cast<int>(shape.width), static_cast<int>(shape.height),
                         static_cast<int>(shape.channels), type);
    for (std::uint32_t channel = 0; channel < shape.channels; ++channel)
        spec.channelnames[channel] = shape.names[channel];
    spec.attribute("DateTime", fixed_time);
    spec.attribute("Software", "ropsim");
    return spec;
}

int write(const char* format, const char* path, const OIIO::ImageSpec& spec, const void* pixels, char* error,
          std::size_t size) {
    try {
        const auto output = OIIO::ImageOutput::create(format);
        if (!output) return fail(OIIO::geterror(), error, size);
        const bool good = output->open(path, spec) && output->write_image(spec.format, pixels) && output->close();
        return good ? 0 : fail(output->geterror(), error, size);
    } catch (const std::exception& exception) {
        return fail(exception.what(), error, size);
    }
}

int write_png(const char* path, const RopsimImageShape* shape, const std::uint8_t* pixels, char* error,
              std::size_t size) {
    OIIO::ImageSpec spec = spec_of(*shape, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    return write("png", path, spec, pixels, error, size);
}

int write_exr(const char* path, const RopsimImageShape* shape, const float* pixels, char* error, std::size_t size) {
    OIIO::ImageSpec spec = spec_of(*shape, OIIO::TypeDesc::FLOAT);
    spec.attribute("compression", "zip");
    spec.attribute("oiio:ColorSpace", "Linear");
    return write("openexr", path, spec, pixels, error, size);
}

int read(const char* path, std::uint32_t* width, std::uint32_t* height, std::uint32_t* channels, float* pixels,
         char* error, std::size_t size) {
    try {
        const auto input = OIIO::ImageInput::open(path);
        if (!input) return fail(OIIO::geterror(), error, size);
        *width = static_cast<std::uint32_t>(input->spec().width);
        *height = static_cast<std::uint32_t>(input->spec().height);
        *channels = static_cast<std::uint32_t>(input->spec().nchannels);
        if (pixels == nullptr || input->read_image(0, 0, 0, -1, OIIO::TypeDesc::FLOAT, pixels)) return 0;
        return fail(input->geterror(), error, size);
    } catch (const std::exception& exception) {
        return fail(exception.what(), error, size);
    }
}

constexpr RopsimImageModule image_module{ROPSIM_IMAGE_MODULE_VERSION, write_png, write_exr, read};

} // namespace

extern "C" __attribute__((visibility("default"))) const RopsimImageModule* ropsim_image_module() {
    return &image_module;
}
