#include "pipeline/reference.hpp"

#include "pipeline/draw_states.hpp"
#include "pipeline/functional/composite.hpp"
#include "pipeline/functional/fragment_operations.hpp"
#include "pipeline/functional/parallel.hpp"
#include "pipeline/functional/pixel_lists.hpp"
#include "pipeline/functional/surface_texel.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <atomic>
#include <fmt/format.h>

namespace pipeline {

namespace {

/// The surfaces in the form they have in memory.
struct Surfaces {
    std::vector<float> kbuffer;
    std::vector<DepthCode> depth;
    std::vector<std::uint8_t> stencil;
    std::vector<float> colour;

    std::vector<float> depth_values(SurfaceFormat format) const {
        std::vector<float> values(depth.size());
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = depth_value(format, depth[i]);
        return values;
    }
};

/// Sums over all fragments of the k-buffer passes.
struct Counts {
    std::atomic<std::uint64_t> accepted{0}, missed_reads{0}, missed_pixels{0};
};

/// A store on its way to the pixel.
struct PendingStore {
    QuadId quad = 0;
    std::vector<float> entries;
};

/// Runs the fragments of one draw pass, pixel by pixel.
class PassRunner {
  public:
    PassRunner(const Frame& frame, const Pass& pass, const DrawStates& states, const FragmentStream& stream,
               QuadId delay, Surfaces& surfaces, ReferenceImage& image, Counts& counts)
        : frame_(frame),
          pass_(pass),
          states_(states),
          stream_(stream),
          delay_(delay),
          surfaces_(surfaces),
          image_(image),
          counts_(counts),
          floats_(pass.kbuffer ? frame.program->floats_per_pixel() : 0),
          uses_depth_(pass.uses_depth()),
          counts_complexity_(pass.kbuffer || frame.program == nullptr) {}

    /// Runs the quads of one pixel in raster order.
    void run_pixel(std::uint32_t x, std::uint32_t y, std::span<const QuadId> quads) {
        pixel_ = std::size_t{y} * stream_.width + x;
        lane_ = (y & 1U) * 2 + (x & 1U);
        head_ = tail_ = 0;
        missed_here_ = false;
        for (const QuadId quad : quads) run_fragment(quad);
        if (delay_ > 1 && pass_.kbuffer) store_until(~std::uint64_t{0});
        if (missed_here_) ++missed_pixels_;
    }

    void add_counts() {
        counts_.accepted += accepted_;
        counts_.missed_reads += missed_reads_;
        counts_.missed_pixels += missed_pixels_;
    }

  private:
    void run_fragment(QuadId quad) {
        const RasterState& state = states_.of(stream_, quad);
        if (!tests_pass(state, quad)) return;
        if (counts_complexity_) ++image_.depth_complexity[pixel_];
        if (pass_.colour) store_colour(state, quad);
        if (pass_.kbuffer) insert(quad);
    }

    /// A failed fragment still counts in the depth complexity of frames without k-buffer.
    bool tests_pass(const RasterState& state, QuadId quad) {
        if (!uses_depth_) return true;
        const DepthCode incoming = depth_code(frame_.depth_format, stream_.depths[quad][lane_]);
        const FragmentTest test = test_fragment(state, shows_front(state, stream_, quad), incoming,
                                                surfaces_.depth.empty() ? nullptr : &surfaces_.depth[pixel_],
                                                surfaces_.stencil.empty() ? nullptr : &surfaces_.stencil[pixel_]);
        if (!test.passed() && !pass_.kbuffer && counts_complexity_) ++image_.depth_complexity[pixel_];
        return test.passed();
    }

    void store_colour(const RasterState& state, QuadId quad) {
        if (state.write_mask[0] == 0) return;
        float* stored = surfaces_.colour.data() + pixel_ * 4;
        glm::vec4 source = stream_.colours[quad][lane_];
        if (state.blend[0].enabled) source.a *= frame_.opacity;
        const glm::vec4 colour = write_colour(frame_.colour_format, state.blend[0], state.write_mask[0], source,
                                              {stored[0], stored[1], stored[2], stored[3]});
        for (int i = 0; i < 4; ++i) stored[i] = colour[i];
    }

    void insert(QuadId quad) {
        frame_.program->make_entry(stream_.fragment(quad, lane_), entry_.data());
        float* stored = surfaces_.kbuffer.data() + pixel_ * floats_;
        if (delay_ == 1) {
            if (frame_.program->insert(stored, entry_.data())) ++accepted_;
        } else {
            insert_delayed(quad, stored);
        }
    }

    void insert_delayed(QuadId quad, const float* stored) {
        store_until(quad >= delay_ ? std::uint64_t{quad} - delay_ + 1 : 0);
        if (head_ != tail_) {
            ++missed_reads_;
            missed_here_ = true;
        }
        if (tail_ == pending_.size()) pending_.emplace_back();
        PendingStore& store = pending_[tail_++];
        store.quad = quad;
        store.entries.assign(stored, stored + floats_);
        if (frame_.program->insert(store.entries.data(), entry_.data())) ++accepted_;
    }

    /// Applies the pending stores of quads below `end`.
    void store_until(std::uint64_t end) {
        while (head_ != tail_ && pending_[head_].quad < end) {
            std::copy(pending_[head_].entries.begin(), pending_[head_].entries.end(),
                      surfaces_.kbuffer.begin() + static_cast<std::ptrdiff_t>(pixel_ * floats_));
            ++head_;
        }
        if (head_ == tail_) head_ = tail_ = 0;
    }

    const Frame& frame_;
    const Pass& pass_;
    const DrawStates& states_;
    const FragmentStream& stream_;
    QuadId delay_;
    Surfaces& surfaces_;
    ReferenceImage& image_;
    Counts& counts_;
    std::size_t floats_;
    bool uses_depth_;
    bool counts_complexity_;

    std::size_t pixel_ = 0;
    std::size_t lane_ = 0;
    std::array<float, largest_entry> entry_{};
    std::vector<PendingStore> pending_; ///< of the current pixel: [head_, tail_), oldest first
    std::size_t head_ = 0, tail_ = 0;
    bool missed_here_ = false;
    std::uint64_t accepted_ = 0, missed_reads_ = 0, missed_pixels_ = 0;
};

class Reference {
  public:
    Reference(const Frame& frame, std::span<const FragmentStream> streams, QuadId delay, unsigned threads)
        : frame_(frame), streams_(streams), delay_(delay), threads_(threads) {
        allocate();
        for (const Pass& pass : frame.passes) run(pass);
        finish();
    }

    ReferenceImage take() { return std::move(image_); }

  private:
    void allocate() {
        const auto any = [&](auto member) { return std::any_of(frame_.passes.begin(), frame_.passes.end(), member); };
        image_.depth_complexity.resize(frame_.view_of_kbuffer().places());
        if (any([](const Pass& pass) { return pass.uses_depth(); })) {
            surfaces_.depth.resize(has_depth(frame_.depth_format) ? frame_.view.places() : 0);
            surfaces_.stencil.resize(has_stencil(frame_.depth_format) ? frame_.view.places() : 0);
        }
        if (any([](const Pass& pass) { return pass.colour; })) surfaces_.colour.resize(frame_.view.places() * 4);
        if (any([](const Pass& pass) { return pass.kbuffer; })) {
            CHECK(frame_.program != nullptr);
            surfaces_.kbuffer.resize(frame_.view_of_kbuffer().places() * frame_.program->floats_per_pixel());
        }
        for (const char* surface : {"depth", "colour", "kbuffer"}) clear(surface);
    }

    void clear(std::string_view surface) {
        if (surface == "depth") {
            std::fill(surfaces_.depth.begin(), surfaces_.depth.end(), farthest_depth(frame_.depth_format));
            std::fill(surfaces_.stencil.begin(), surfaces_.stencil.end(), std::uint8_t{0});
        } else if (surface == "colour") {
            const glm::vec4 colour = through_format(frame_.colour_format, frame_.background);
            for (std::size_t i = 0; i < surfaces_.colour.size(); ++i)
                surfaces_.colour[i] = colour[static_cast<int>(i % 4)];
        } else if (surface == "kbuffer" && !surfaces_.kbuffer.empty()) {
            const std::size_t floats = frame_.program->floats_per_pixel();
            for (std::size_t at = 0; at < surfaces_.kbuffer.size(); at += floats)
                frame_.program->clear(surfaces_.kbuffer.data() + at);
        }
    }

    void run(const Pass& pass) {
        switch (pass.kind) {
        case PassKind::clear:
            for (const std::string& surface : pass.writes) clear(surface);
            break;
        case PassKind::draw:
            draw(pass);
            break;
        case PassKind::resolve:
            if (!surfaces_.kbuffer.empty())
                image_.picture = composite(
                    frame_, {surfaces_.kbuffer, surfaces_.colour, surfaces_.depth_values(frame_.depth_format)});
            break;
        }
    }

    void draw(const Pass& pass) {
        CHECK(next_stream_ < streams_.size());
        const FragmentStream& stream = streams_[next_stream_++];
        const View& view = frame_.view_of(pass);
        CHECK(stream.width == view.width && stream.height == view.height && stream.samples == view.samples);
        // A k-buffer that a light sees is not tested against what the eye sees.
        CHECK(!(pass.kbuffer && frame_.kbuffer_view) || !(pass.uses_depth() || pass.colour));
        CHECK(!pass.colour || stream.colours.size() == stream.quads.size());
        CHECK_MSG(!pass.kbuffer || !pass.tests_stencil(), "a k-buffer pass does not test stencil");
        const DrawStates states(pass, frame_.draws.size());
        const TileLists tiles(stream);
        parallel_for(threads_, tiles.count(), [&](std::size_t tile) {
            PassRunner runner(frame_, pass, states, stream, delay_, surfaces_, image_, counts_);
            tiles.for_each_pixel(tile, [&](std::uint32_t x, std::uint32_t y, std::span<const QuadId> quads) {
                runner.run_pixel(x, y, quads);
            });
            runner.add_counts();
        });
    }

    void finish() {
        CHECK(next_stream_ == streams_.size());
        image_.kbuffer = std::move(surfaces_.kbuffer);
        image_.colour = std::move(surfaces_.colour);
        image_.depth = surfaces_.depth_values(frame_.depth_format);
        image_.stencil = std::move(surfaces_.stencil);
        image_.accepted_insertions = counts_.accepted;
        image_.missed_reads = counts_.missed_reads;
        image_.missed_pixels = counts_.missed_pixels;
    }

    const Frame& frame_;
    std::span<const FragmentStream> streams_;
    QuadId delay_;
    unsigned threads_;
    std::size_t next_stream_ = 0;
    Surfaces surfaces_;
    ReferenceImage image_;
    Counts counts_;
};

} // namespace

ReferenceImage run_reference(const Frame& frame, std::span<const FragmentStream> streams, QuadId delay,
                             unsigned threads) {
    CHECK(delay >= 1);
    return Reference(frame, streams, delay, threads).take();
}

} // namespace pipeline
