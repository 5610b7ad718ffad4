#include "reports/images.hpp"

#include "reports/atomic_file.hpp"
#include "reports/image_module/image_module.h"
#include "ropsim_build.hpp"
#include "sim/check.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

namespace reports {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t error_size = 400;

[[noreturn]] void no_images(const std::string& reason) {
    throw sim::InputError(fmt::format(
        "pictures need ropsim_images.so and OpenImageIO (Debian: libopenimageio2.4); use --no-images to go without: {}",
        reason));
}

const RopsimImageModule* load_module() {
    const auto path = ropsim_build::find_module("ropsim_images.so");
    if (!path) no_images("ropsim_images.so was not found");
    void* library = ::dlopen(path->c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) no_images(::dlerror());
    const auto function = reinterpret_cast<RopsimImageModuleFunction>(::dlsym(library, ROPSIM_IMAGE_MODULE_FUNCTION));
    const RopsimImageModule* images = function == nullptr ? nullptr : function();
    if (images == nullptr || images->version != ROPSIM_IMAGE_MODULE_VERSION)
        no_images(path->string() + " is of another version of ropsim");
    return images;
}

const RopsimImageModule& image_module() {
    static const RopsimImageModule* const loaded = load_module(); // stays loaded; a failure is tried again
    return *loaded;
}

void collect(void* text, const std::uint8_t* bytes, std::size_t size) {
    static_cast<std::string*>(text)->assign(reinterpret_cast<const char*>(bytes), size);
}

// `encode(shape, file, error)` is one of the module's functions.
template <class Encode>
void write_encoded(const fs::path& path, const std::vector<std::string>& channels, std::uint32_t width,
                   std::uint32_t height, Encode encode) {
    std::vector<const char*> names;
    for (const std::string& name : channels) names.push_back(name.c_str());
    const RopsimImageShape shape{width, height, static_cast<std::uint32_t>(names.size()), names.data()};
    std::string file;
    std::array<char, error_size> error{};
    if (encode(&shape, &file, error) != 0)
        throw sim::InputError(fmt::format("{}: cannot be written: {}", path.string(), error.data()));
    write_file(path, file);
}

} // namespace

void require_images() { image_module(); }

void write_png(const fs::path& path, const Picture& picture) {
    CHECK(picture.pixels.size() == std::size_t{picture.width} * picture.height);
    static_assert(sizeof(Colour) == 3);
    const RopsimImageModule& images = image_module();
    write_encoded(path, {"R", "G", "B"}, picture.width, picture.height, [&](auto* shape, void* file, auto& error) {
        return images.encode_png(shape, picture.pixels.data()->data(), collect, file, error.data(), error.size());
    });
}

void write_exr(const fs::path& path, const Measurement& measurement) {
    CHECK(measurement.values.size() ==
          std::size_t{measurement.width} * measurement.height * measurement.channels.size());
    const RopsimImageModule& images = image_module();
    write_encoded(
        path, measurement.channels, measurement.width, measurement.height, [&](auto* shape, void* file, auto& error) {
            return images.encode_exr(shape, measurement.values.data(), collect, file, error.data(), error.size());
        });
}

Measurement read_image(const fs::path& path) {
    const RopsimImageModule& images = image_module();
    std::array<char, error_size> error{};
    std::uint32_t channels = 0;
    Measurement result;
    const auto read = [&](float* pixels) {
        if (images.read(path.c_str(), &result.width, &result.height, &channels, pixels, error.data(), error.size()) !=
            0)
            throw sim::InputError(fmt::format("{}: cannot be read: {}", path.string(), error.data()));
    };
    read(nullptr);
    result.channels.resize(channels);
    result.values.resize(std::size_t{result.width} * result.height * channels);
    read(result.values.data());
    return result;
}

} // namespace reports
