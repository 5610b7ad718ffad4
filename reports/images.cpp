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

// OpenImageIO's texts name the temporary file; the user knows the final one.
[[noreturn]] void cannot_write(const fs::path& path, const fs::path& temporary, std::string reason) {
    for (const std::string& name : {temporary.string(), temporary.filename().string()})
        for (std::size_t at = reason.find(name); at != std::string::npos; at = reason.find(name))
            reason.replace(at, name.size(), "it");
    throw sim::InputError(fmt::format("{}: cannot be written: {}", path.string(), reason));
}

template <class Write>
void write_atomically(const fs::path& path, const std::vector<std::string>& channels, std::uint32_t width,
                      std::uint32_t height, Write write) {
    std::vector<const char*> names;
    for (const std::string& name : channels) names.push_back(name.c_str());
    const RopsimImageShape shape{width, height, static_cast<std::uint32_t>(names.size()), names.data()};
    AtomicFile file(path);
    std::array<char, error_size> error{};
    if (write(file.temporary().c_str(), &shape, error) != 0) cannot_write(path, file.temporary(), error.data());
    file.commit();
}

} // namespace

void require_images() { image_module(); }

void write_png(const fs::path& path, const Picture& picture) {
    CHECK(picture.pixels.size() == std::size_t{picture.width} * picture.height);
    static_assert(sizeof(Colour) == 3);
    const RopsimImageModule& images = image_module();
    write_atomically(path, {"R", "G", "B"}, picture.width, picture.height,
                     [&](const char* name, const RopsimImageShape* shape, std::array<char, error_size>& error) {
                         return images.write_png(name, shape, picture.pixels.data()->data(), error.data(),
                                                 error.size());
                     });
}

void write_exr(const fs::path& path, const Measurement& measurement) {
    CHECK(measurement.values.size() ==
          std::size_t{measurement.width} * measurement.height * measurement.channels.size());
    const RopsimImageModule& images = image_module();
    write_atomically(path, measurement.channels, measurement.width, measurement.height,
                     [&](const char* name, const RopsimImageShape* shape, std::array<char, error_size>& error) {
                         return images.write_exr(name, shape, measurement.values.data(), error.data(), error.size());
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
