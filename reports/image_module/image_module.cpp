#include "reports/image_module/image_module.h"

#include <OpenImageIO/filesystem.h>
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

OIIO::ImageSpec spec_of(const RopsimImageShape& shape, const OIIO::TypeDesc& type) {
    OIIO::ImageSpec spec(static_cast<int>(shape.width), static_cast<int>(shape.height),
                         static_cast<int>(shape.channels), type);
    for (std::uint32_t channel = 0; channel < shape.channels; ++channel)
        spec.channelnames[channel] = shape.names[channel];
    spec.attribute("DateTime", fixed_time);
    spec.attribute("Software", "ropsim");
    return spec;
}

struct Sink {
    RopsimImageSink take;
    void* data;
};

int encode(const char* format, const OIIO::ImageSpec& spec, const void* pixels, Sink sink, char* error,
           std::size_t size) {
    try {
        OIIO::Filesystem::IOVecOutput memory;
        const auto output = OIIO::ImageOutput::create(format, &memory);
        if (!output) return fail(OIIO::geterror(), error, size);
        // The name tells nothing but the format.
        const bool good = output->open(std::string("memory.") + format, spec) &&
                          output->write_image(spec.format, pixels) && output->close();
        if (!good) return fail(output->geterror(), error, size);
        sink.take(sink.data, memory.buffer().data(), memory.buffer().size());
        return 0;
    } catch (const std::exception& exception) {
        return fail(exception.what(), error, size);
    }
}

int encode_png(const RopsimImageShape* shape, const std::uint8_t* pixels, RopsimImageSink sink, void* sink_data,
               char* error, std::size_t size) {
    OIIO::ImageSpec spec = spec_of(*shape, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    return encode("png", spec, pixels, {sink, sink_data}, error, size);
}

int encode_exr(const RopsimImageShape* shape, const float* pixels, RopsimImageSink sink, void* sink_data, char* error,
               std::size_t size) {
    OIIO::ImageSpec spec = spec_of(*shape, OIIO::TypeDesc::FLOAT);
    spec.attribute("compression", "zip");
    spec.attribute("oiio:ColorSpace", "Linear");
    return encode("exr", spec, pixels, {sink, sink_data}, error, size);
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

constexpr RopsimImageModule image_module{ROPSIM_IMAGE_MODULE_VERSION, encode_png, encode_exr, read};

} // namespace

extern "C" __attribute__((visibility("default"))) const RopsimImageModule* ropsim_image_module() {
    return &image_module;
}
