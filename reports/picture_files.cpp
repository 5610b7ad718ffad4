#include "reports/picture_files.hpp"

#include "pipeline/functional/parallel.hpp"
#include "pipeline/functional/surface_values.hpp"
#include "reports/atomic_file.hpp"
#include "reports/pictures.hpp"
#include "sim/check.hpp"

#include <fmt/format.h>
#include <functional>
#include <optional>

namespace reports {

namespace fs = std::filesystem;

namespace {

// Collects what has to be written, so that it can be written on all cores.
class PictureWriter {
  public:
    PictureWriter(const Comparison& comparison, fs::path directory)
        : comparison_(comparison),
          directory_(std::move(directory)),
          size_{comparison.width(), comparison.height()},
          stored_{comparison.frame->view_of_kbuffer().width, comparison.frame->view_of_kbuffer().height} {
        if (!comparison.frame->program) return;
        layout_.emplace(*comparison.frame->program);
        range_ = depth_range(*layout_, comparison.reference.kbuffer, stored_.pixels());
    }

    void add_overlap() {
        add_png("overlap.png", "", "fragments per pixel",
                [this] { return overlap_picture(stored_, comparison_.depth_complexity); });
        add_exr("overlap.exr", [this] {
            const auto& counts = comparison_.depth_complexity;
            return Measurement{stored_.width, stored_.height, {"fragments"}, {counts.begin(), counts.end()}};
        });
    }

    void add_frame(const std::string& subject, const FramePixels& pixels) {
        add_png(fs::path(subject) / "composite.png", subject, "composite",
                [this, &pixels] { return composite_picture(size_, pixels.composite); });
        add_exr(fs::path(subject) / "composite.exr", [this, &pixels] {
            return Measurement{size_.width, size_.height, {"R", "G", "B", "A"}, pixels.composite};
        });
    }

    void add_layers(const std::string& subject, const FramePixels& pixels) {
        if (!layout_ || pixels.kbuffer.empty()) return;
        for (std::uint32_t layer = 0; layer < layout_->layers(); ++layer) {
            add_png(fs::path(subject) / fmt::format("layer{}.png", layer), subject, fmt::format("layer {}", layer),
                    [this, &pixels, layer] { return layer_picture(stored_, *layout_, pixels.kbuffer, layer, range_); });
            files_.back().layer = true;
        }
        add_exr(fs::path(subject) / "layers.exr", [this, &pixels] { return layers_measurement(pixels.kbuffer); });
    }

    void add_hazards(const pipeline::RunResult& run, const FramePixels& pixels) {
        add_png(fs::path(run.design) / "hazards.png", run.design, "hazards", [this, &run, &pixels] {
            return hazard_picture(stored_, comparison_.has_light_view() ? first_layer(pixels) : pixels.composite,
                                  run.hazard_mask, run.hazards, run.design);
        });
    }

    void add_difference(const pipeline::RunResult& run, const FramePixels& pixels, std::uint32_t factor) {
        const std::string name = fmt::format("difference_x{}.png", factor);
        add_png(fs::path(run.design) / name, run.design, fmt::format("difference to the reference x {}", factor),
                [this, &run, &pixels, factor] {
                    const std::vector<std::uint8_t> none;
                    return difference_picture(size_, pixels.composite, comparison_.reference.composite,
                                              comparison_.has_light_view() ? none : run.wrong_mask, factor, run.design);
                });
    }

    /// What the workload shows on the way to its picture.
    void add_steps(const std::string& subject, const FramePixels& pixels) {
        for (pipeline::SurfaceId id = 0; id < pixels.shown.count(); ++id) {
            const pipeline::SurfaceInfo& info = pixels.shown.info(id);
            for (const pipeline::SurfacePicture& step : info.shown) {
                const Size size{info.width, info.height};
                const auto values = [&pixels, id, &step] { return channel_of(pixels.shown, id, step.channel); };
                add_png(fs::path(subject) / (step.name + ".png"), subject, step.title,
                        [size, &step, values] { return value_picture(size, values(), step); });
                add_exr(fs::path(subject) / (step.name + ".exr"), [size, values] {
                    return Measurement{size.width, size.height, {"value"}, values()};
                });
            }
        }
    }

    std::uint32_t difference_factor() const {
        DifferenceScale scale;
        for (const FramePixels& pixels : comparison_.pixels)
            scale.note(size_, pixels.composite, comparison_.reference.composite);
        return scale.factor();
    }

    std::vector<PictureFile> write(const std::atomic<bool>* stop) {
        pipeline::parallel_for(0, jobs_.size(), [&](std::size_t job) {
            if (stop != nullptr && *stop) throw sim::Interrupted();
            jobs_[job]();
        });
        return std::move(files_);
    }

  private:
    void add_png(const fs::path& file, const std::string& subject, std::string title, std::function<Picture()> make) {
        files_.push_back({file, subject, std::move(title)});
        jobs_.emplace_back([path = directory_ / file, make = std::move(make)] { write_png(path, make()); });
    }

    void add_exr(const fs::path& file, std::function<Measurement()> make) {
        jobs_.emplace_back([path = directory_ / file, make = std::move(make)] { write_exr(path, make()); });
    }

    Measurement layers_measurement(std::span<const float> kbuffer) const {
        Measurement result{stored_.width, stored_.height, {}, {}};
        for (std::uint32_t layer = 0; layer < layout_->layers(); ++layer)
            for (std::uint32_t slot = 0; slot < layout_->entry_floats(); ++slot)
                result.channels.push_back(fmt::format("layer{}.{}", layer, channel_name(slot)));
        result.values.reserve(stored_.pixels() * result.channels.size());
        for (std::size_t pixel = 0; pixel < stored_.pixels(); ++pixel)
            for (std::uint32_t layer = 0; layer < layout_->layers(); ++layer) {
                const auto entry = layout_->entry(kbuffer, pixel, layer);
                result.values.insert(result.values.end(), entry.begin(), entry.end());
            }
        return result;
    }

    /// Grey, brighter where the first layer is nearer: behind hazards that no picture lies behind.
    std::vector<float> first_layer(const FramePixels& pixels) const {
        std::vector<float> rgba(4 * stored_.pixels());
        const float extent = std::max(range_.far - range_.near, 1e-30F);
        for (std::size_t pixel = 0; pixel < stored_.pixels(); ++pixel)
            if (!layout_->is_empty(pixels.kbuffer, pixel, 0))
                std::fill_n(&rgba[4 * pixel], 4,
                            1.0F - 0.8F * (layout_->depth(pixels.kbuffer, pixel, 0) - range_.near) / extent);
        return rgba;
    }

    std::string channel_name(std::uint32_t slot) const {
        if (slot == layout_->depth_slot()) return "Z";
        if (layout_->has_colour() && slot < 3) return std::string(1, "RGB"[slot]);
        return fmt::format("value{}", slot);
    }

    const Comparison& comparison_;
    fs::path directory_;
    Size size_;   ///< of the picture
    Size stored_; ///< of the k-buffer
    std::optional<KBufferLayout> layout_;
    DepthRange range_;
    std::vector<PictureFile> files_;
    std::vector<std::function<void()>> jobs_;
};

// "layer12.png" for the prefix "layer".
bool is_numbered_png(const fs::path& path, std::string_view prefix) {
    const std::string stem = path.stem().string();
    return path.extension() == ".png" && stem.size() > prefix.size() && stem.starts_with(prefix) &&
           stem.find_first_not_of("0123456789", prefix.size()) == std::string::npos;
}

// Pictures of an earlier comparison that this one may not have: another factor, more layers.
void remove_earlier(const fs::path& directory) {
    std::error_code ignored;
    std::vector<fs::path> earlier;
    for (const auto& entry : fs::directory_iterator(directory, ignored))
        if (is_numbered_png(entry.path(), "difference_x") || is_numbered_png(entry.path(), "layer") ||
            is_numbered_png(entry.path(), "light_layer"))
            earlier.push_back(entry.path());
    for (const fs::path& path : earlier) fs::remove(path, ignored);
}

} // namespace

std::vector<PictureFile> write_pictures(const Comparison& comparison, const fs::path& directory,
                                        const std::atomic<bool>* stop) {
    require_images();
    const auto prepare = [&directory](const std::string& subject) {
        make_directory(directory / subject);
        remove_earlier(directory / subject);
    };
    PictureWriter writer(comparison, directory);
    writer.add_overlap();
    prepare("reference");
    for (const pipeline::RunResult& run : comparison.runs) prepare(run.design);
    if (!comparison.reference.composite.empty()) {
        writer.add_frame("reference", comparison.reference);
        writer.add_layers("reference", comparison.reference);
        writer.add_steps("reference", comparison.reference);
        const std::uint32_t factor = writer.difference_factor();
        for (std::size_t i = 0; i < comparison.runs.size(); ++i) {
            const pipeline::RunResult& run = comparison.runs[i];
            writer.add_frame(run.design, comparison.pixels[i]);
            writer.add_hazards(run, comparison.pixels[i]);
            writer.add_difference(run, comparison.pixels[i], factor);
            writer.add_layers(run.design, comparison.pixels[i]);
            writer.add_steps(run.design, comparison.pixels[i]);
        }
    }
    return writer.write(stop);
}

} // namespace reports
