// The folder of a truth.
#include "models/programs/nearest_k.hpp"
#include "pipeline/functional/eye_depth.hpp"
#include "reports/atomic_file.hpp"
#include "reports/images.hpp"
#include "reports/pictures.hpp"
#include "reports/result.hpp"
#include "reports/truth/truth_run.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace reports {

namespace fs = std::filesystem;

namespace {

Size size_of(const Truth& truth) { return {truth.width, truth.height}; }

void write_numbers(const fs::path& path, const Truth& truth, std::vector<std::string> channels,
                   std::vector<float> values) {
    write_exr(path, {truth.width, truth.height, std::move(channels), std::move(values)});
}

/// Layers that any pixel has.
std::uint32_t used_layers(const Truth& truth) {
    std::uint32_t used = 0;
    for (std::size_t pixel = 0; pixel < truth.pixels(); ++pixel)
        used = std::max(used, std::min(truth.layers_at(pixel), truth.layers));
    return used;
}

/// Window depths as a k-buffer, for the pictures that k-buffers have.
std::vector<float> as_kbuffer(const TruthRun& run, const pipeline::ModifyProgram& program) {
    const Truth& truth = run.truth;
    const pipeline::EyeDepth eye(run.frame->view.projection);
    const std::size_t floats = program.floats_per_pixel();
    std::vector<float> kbuffer(truth.pixels() * floats);
    for (std::size_t pixel = 0; pixel < truth.pixels(); ++pixel) {
        program.clear(kbuffer.data() + pixel * floats);
        for (std::uint32_t layer = 0; layer < std::min(program.k(), truth.layers_at(pixel)); ++layer)
            kbuffer[pixel * floats + layer] =
                eye.window(static_cast<double>(truth.depths[pixel * truth.layers + layer]));
    }
    return kbuffer;
}

void write_layers(const TruthRun& run, const fs::path& directory) {
    const Truth& truth = run.truth;
    const std::uint32_t layers = std::min(used_layers(truth), 64U);
    if (layers == 0) return;
    const auto program = models::make_nearest_k(models::EntryKind::z, layers);
    const KBufferLayout layout(*program);
    const std::vector<float> kbuffer = as_kbuffer(run, *program);
    const DepthRange range = depth_range(layout, kbuffer, truth.pixels());
    std::vector<std::string> channels;
    for (std::uint32_t layer = 0; layer < layers; ++layer) {
        write_png(directory / fmt::format("layer{}.png", layer),
                  layer_picture(size_of(truth), layout, kbuffer, layer, range));
        channels.push_back(fmt::format("layer{}.Z", layer));
        channels.push_back(fmt::format("layer{}.distance", layer));
    }
    std::vector<float> values;
    values.reserve(truth.pixels() * channels.size());
    for (std::size_t pixel = 0; pixel < truth.pixels(); ++pixel)
        for (std::uint32_t layer = 0; layer < layers; ++layer) {
            values.push_back(layout.depth(kbuffer, pixel, layer));
            values.push_back(truth.depths[pixel * truth.layers + layer]);
        }
    write_numbers(directory / "layers.exr", truth, std::move(channels), std::move(values));
}

void write_visibility(const Truth& truth, const fs::path& directory) {
    std::vector<float> grey;
    grey.reserve(truth.pixels() * 4);
    for (const float share : truth.visibility) grey.insert(grey.end(), {share, share, share, 1.0F});
    write_png(directory / "visibility.png", composite_picture(size_of(truth), grey));
    write_numbers(directory / "visibility.exr", truth, {"visibility"}, truth.visibility);
}

void write_images(const TruthRun& run, const fs::path& directory) {
    const Truth& truth = run.truth;
    write_png(directory / "composite.png", composite_picture(size_of(truth), truth.colours));
    write_numbers(directory / "composite.exr", truth, {"R", "G", "B", "A"}, truth.colours);
    write_png(directory / "overlap.png", overlap_picture(size_of(truth), truth.surfaces));
    write_numbers(directory / "overlap.exr", truth, {"fragments"}, {truth.surfaces.begin(), truth.surfaces.end()});
    write_layers(run, directory);
    for (const traces::TruthChannel& channel : truth.channels)
        write_numbers(directory / (channel.name + ".exr"), truth, {channel.quantity}, channel.values);
    if (!truth.visibility.empty()) write_visibility(truth, directory);
}

} // namespace

std::string write_truth(const TruthRun& run, const fs::path& directory, bool images) {
    begin_report_folder(directory);
    write_file(directory / "truth.json", result_text(truth_json(run)));
    if (images) write_images(run, directory);
    return fmt::format("Written to {}: truth.json{}\n", directory.string(),
                       images ? ", PNG to look at, EXR to measure" : "");
}

} // namespace reports
