#include "pipeline/reference.hpp"

#include "pipeline/draw_states.hpp"
#include "pipeline/functional/compose_pass.hpp"
#include "pipeline/functional/fragment_operations.hpp"
#include "pipeline/functional/parallel.hpp"
#include "pipeline/functional/pixel_lists.hpp"
#include "pipeline/functional/shade_pass.hpp"
#include "pipeline/functional/surface_texel.hpp"
#include "pipeline/functional/surface_values.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <atomic>
#include <fmt/format.h>

namespace pipeline {

namespace {

/// Sums over all fragments; all but the first of passes with a k-buffer alone.
struct Counts {
    std::atomic<std::uint64_t> passed{0}, accepted{0}, missed_reads{0}, missed_pixels{0};
};

/// A store on its way to the pixel.
struct PendingStore {
    QuadId quad = 0;
    std::vector<float> entries;
};

/// Of frames without a k-buffer: what is drawn for the eye, but for volumes that a shader only looks at surfaces
/// through.
bool counts_complexity(const Frame& frame, const Pass& pass) {
    if (pass.runs_program() || frame.program != nullptr) return pass.runs_program();
    return pass.kind == PassKind::draw && pass.view == 0 && (!pass.reads_surfaces() || pass.uses_depth());
}

/// Runs the fragments of one draw pass, pixel by pixel: a pixel's depth, stencil and colours are in hand while its
/// fragments come.
class PassRunner {
  public:
    PassRunner(const Frame& frame, const Pass& pass, const DrawStates& states, const FragmentStream& stream,
               QuadId delay, SurfaceStore& surfaces, ReferenceImage& image, Counts& counts)
        : frame_(frame),
          pass_(pass),
          states_(states),
          stream_(stream),
          delay_(delay),
          surfaces_(surfaces),
          image_(image),
          counts_(counts),
          floats_(pass.runs_program() ? frame.program->floats_per_pixel() : 0),
          uses_depth_(pass.uses_depth()),
          counts_complexity_(counts_complexity(frame, pass)) {
        if (uses_depth_) depth_format_ = surfaces.info(pass.depth).format;
        for (const SurfaceId target : pass.targets)
            formats_.push_back(target == no_surface ? SurfaceFormat::rgba32f : surfaces.info(target).format);
        colours_.resize(formats_.size());
    }

    /// Runs the quads of one pixel in raster order.
    void run_pixel(std::uint32_t x, std::uint32_t row, std::span<const QuadId> quads) {
        place_ = {x, row, 0};
        lane_ = (row & 1U) * 2 + (x & 1U);
        pixel_ = std::size_t{row} * stream_.width + x;
        head_ = tail_ = 0;
        missed_here_ = false;
        take();
        for (const QuadId quad : quads) run_fragment(quad);
        put();
        if (delay_ > 1 && pass_.runs_program()) store_until(~std::uint64_t{0});
        if (missed_here_) ++missed_pixels_;
    }

    void add_counts() {
        counts_.passed += passed_;
        counts_.accepted += accepted_;
        counts_.missed_reads += missed_reads_;
        counts_.missed_pixels += missed_pixels_;
    }

  private:
    void take() {
        if (uses_depth_) depth_ = before_ = unpack_depth_stencil(depth_format_, surfaces_.read(pass_.depth, place_));
        for (std::size_t i = 0; i < colours_.size(); ++i)
            if (pass_.targets[i] != no_surface)
                colours_[i] = unpack_texel(formats_[i], surfaces_.read(pass_.targets[i], place_));
        coloured_ = false;
        entries_ = nullptr;
    }
    void put() {
        if (uses_depth_ && depth_ != before_)
            pack_depth_stencil(depth_format_, depth_, surfaces_.written(pass_.depth, place_));
        for (std::size_t i = 0; coloured_ && i < colours_.size(); ++i)
            if (pass_.targets[i] != no_surface)
                pack_colour(formats_[i], colours_[i], surfaces_.written(pass_.targets[i], place_),
                            surfaces_.fp16_overflow());
    }

    void run_fragment(QuadId quad) {
        const RasterState& state = states_.of(stream_, quad);
        if (!tests_pass(state, quad)) return;
        ++passed_;
        if (counts_complexity_) ++image_.depth_complexity[pixel_];
        for (std::size_t i = 0; i < colours_.size(); ++i) store_colour(state, quad, i);
        if (pass_.runs_program()) insert(quad);
    }

    /// A failed fragment still counts in the depth complexity of frames without k-buffer.
    bool tests_pass(const RasterState& state, QuadId quad) {
        if (!uses_depth_) return true;
        const DepthCode incoming = depth_code(depth_format_, stream_.depths[quad][lane_]);
        const FragmentTest test = test_fragment(state, shows_front(state, stream_, quad), incoming,
                                                has_depth(depth_format_) ? &depth_.depth : nullptr,
                                                has_stencil(depth_format_) ? &depth_.stencil : nullptr);
        if (!test.passed() && !pass_.runs_program() && counts_complexity_) ++image_.depth_complexity[pixel_];
        return test.passed();
    }

    void store_colour(const RasterState& state, QuadId quad, std::size_t target) {
        if (state.write_mask[target] == 0) return;
        colours_[target] =
            write_colour(formats_[target], state.blend[target], state.write_mask[target],
                         stream_.output(target, quad, lane_), colours_[target], surfaces_.fp16_overflow());
        coloured_ = true;
    }

    void insert(QuadId quad) {
        frame_.program->make_entry(stream_.fragment(quad, lane_), entry_.data());
        if (entries_ == nullptr) entries_ = surfaces_.written_entries(pass_.kbuffer, place_);
        if (delay_ == 1) {
            if (frame_.program->insert(entries_, entry_.data())) ++accepted_;
        } else {
            insert_delayed(quad);
        }
    }

    void insert_delayed(QuadId quad) {
        store_until(quad >= delay_ ? std::uint64_t{quad} - delay_ + 1 : 0);
        if (head_ != tail_) {
            ++missed_reads_;
            missed_here_ = true;
        }
        if (tail_ == pending_.size()) pending_.emplace_back();
        PendingStore& store = pending_[tail_++];
        store.quad = quad;
        store.entries.assign(entries_, entries_ + floats_);
        if (frame_.program->insert(store.entries.data(), entry_.data())) ++accepted_;
    }

    /// Applies the pending stores of quads below `end`.
    void store_until(std::uint64_t end) {
        while (head_ != tail_ && pending_[head_].quad < end) {
            std::copy(pending_[head_].entries.begin(), pending_[head_].entries.end(), entries_);
            ++head_;
        }
        if (head_ == tail_) head_ = tail_ = 0;
    }

    const Frame& frame_;
    const Pass& pass_;
    const DrawStates& states_;
    const FragmentStream& stream_;
    QuadId delay_;
    SurfaceStore& surfaces_;
    ReferenceImage& image_;
    Counts& counts_;
    std::size_t floats_;
    bool uses_depth_;
    bool counts_complexity_;
    SurfaceFormat depth_format_ = SurfaceFormat::d24;
    std::vector<SurfaceFormat> formats_; ///< of the targets

    SurfacePlace place_;
    std::size_t pixel_ = 0; ///< number of the place
    std::size_t lane_ = 0;
    DepthStencil depth_, before_;
    std::vector<glm::vec4> colours_; ///< of the targets
    bool coloured_ = false;
    float* entries_ = nullptr; ///< of the k-buffer; null until something comes
    std::array<float, largest_entry> entry_{};
    std::vector<PendingStore> pending_; ///< of the current pixel: [head_, tail_), oldest first
    std::size_t head_ = 0, tail_ = 0;
    bool missed_here_ = false;
    std::uint64_t passed_ = 0, accepted_ = 0, missed_reads_ = 0, missed_pixels_ = 0;
};

template <class Visit>
void for_each_surface(const Pass& pass, Visit visit) {
    for (const SurfaceId target : pass.targets)
        if (target != no_surface) visit(target);
    if (pass.uses_depth()) visit(pass.depth);
    if (pass.runs_program()) visit(pass.kbuffer);
}

void draw_pass(const Frame& frame, const Pass& pass, const FragmentStream& unshaded, QuadId delay, unsigned threads,
               SurfaceStore& surfaces, ReferenceImage& image, Counts& counts) {
    FragmentStream shaded;
    const FragmentStream& stream = shade_pass(pass, unshaded, surfaces, shaded, threads);
    for_each_surface(pass, [&](SurfaceId surface) {
        const SurfaceInfo& info = surfaces.info(surface);
        CHECK_MSG(info.width == stream.width && info.height == stream.height && info.planes == stream.samples,
                  fmt::format("pass {}: surface {} has another size than what it draws", pass.name, info.name));
    });
    CHECK(!pass.writes_colour() || stream.colours.size() == stream.quads.size());
    CHECK_MSG(!pass.runs_program() || !pass.tests_stencil(), "a k-buffer pass does not test stencil");
    CHECK(!pass.runs_program() || frame.program != nullptr);
    const DrawStates states(pass, frame.draws.size());
    const TileLists tiles(stream);
    static_assert(TileLists::tile_width == SurfaceStore::page_size); // threads do not share pages
    parallel_for(threads, tiles.count(), [&](std::size_t tile) {
        PassRunner runner(frame, pass, states, stream, delay, surfaces, image, counts);
        tiles.for_each_pixel(tile, [&](std::uint32_t x, std::uint32_t y, std::span<const QuadId> quads) {
            runner.run_pixel(x, y, quads);
        });
        runner.add_counts();
    });
}

class Reference {
  public:
    Reference(const Frame& frame, std::span<const FragmentStream> streams, QuadId delay, unsigned threads,
              Fp16Overflow fp16_overflow)
        : frame_(frame),
          streams_(streams),
          delay_(delay),
          threads_(threads),
          surfaces_(frame.surfaces, 0, fp16_overflow) {
        frame.check_targets();
        image_.fp16_overflow = fp16_overflow;
        image_.depth_complexity.resize(frame_.view_of_kbuffer().places());
        for (const Pass& pass : frame.passes) {
            run(pass);
            keep_digests(pass);
        }
        finish();
    }

    ReferenceImage take() { return std::move(image_); }

  private:
    void run(const Pass& pass) {
        switch (pass.kind) {
        case PassKind::clear:
            for (const SurfaceId surface : pass.clears) surfaces_.clear(surface);
            break;
        case PassKind::draw:
        case PassKind::screen:
            draw(pass);
            break;
        case PassKind::compose:
            compose(pass, surfaces_, threads_);
            if (image_.composed.count() == 0) image_.composed = SurfaceStore(frame_.surfaces);
            for (const SurfaceId surface : written_surfaces(pass)) image_.composed.share(surfaces_, surface);
            break;
        }
    }

    void draw(const Pass& pass) {
        CHECK(next_stream_ < streams_.size());
        draw_pass(frame_, pass, streams_[next_stream_++], delay_, threads_, surfaces_, image_, counts_);
    }

    void keep_digests(const Pass& pass) {
        std::vector<std::uint64_t>& digests = image_.digests.emplace_back();
        for (const SurfaceId surface : written_surfaces(pass)) digests.push_back(surfaces_.digest(surface));
    }

    void finish() {
        CHECK(next_stream_ == streams_.size());
        const SurfaceId depth = frame_.main_depth();
        image_.kbuffer = entries_of(surfaces_, frame_.main_kbuffer());
        image_.colour = colours_of(surfaces_, frame_.main_colour());
        image_.depth = depths_of(surfaces_, depth);
        image_.stencil = stencils_of(surfaces_, depth);
        if (frame_.needs.kbuffer && frame_.output != no_surface) image_.picture = image_.colour;
        image_.shown = surfaces_.shown();
        image_.accepted_insertions = counts_.accepted;
        image_.missed_reads = counts_.missed_reads;
        image_.missed_pixels = counts_.missed_pixels;
    }

    const Frame& frame_;
    std::span<const FragmentStream> streams_;
    QuadId delay_;
    unsigned threads_;
    std::size_t next_stream_ = 0;
    SurfaceStore surfaces_;
    ReferenceImage image_;
    Counts counts_;
};

} // namespace

std::vector<SurfaceId> written_surfaces(const Pass& pass) {
    std::vector<SurfaceId> surfaces = pass.clears;
    if (!pass.writes_targets()) return surfaces;
    for (const SurfaceId target : pass.targets)
        if (target != no_surface) surfaces.push_back(target);
    if (pass.writes_depth() || pass.tests_stencil()) surfaces.push_back(pass.depth);
    if (pass.runs_program()) surfaces.push_back(pass.kbuffer);
    return surfaces;
}

std::vector<SurfaceId> surfaces_behind(const Pass& pass) {
    std::vector<SurfaceId> surfaces = pass.reads;
    if (pass.rasterizes()) for_each_surface(pass, [&](SurfaceId surface) { surfaces.push_back(surface); });
    return surfaces;
}

std::uint64_t run_reference_pass(const Frame& frame, const Pass& pass, const FragmentStream& stream,
                                 SurfaceStore& surfaces, unsigned threads) {
    ReferenceImage image;
    image.depth_complexity.resize(std::size_t{stream.width} * stream.rows());
    Counts counts;
    draw_pass(frame, pass, stream, 1, threads, surfaces, image, counts);
    return counts.passed;
}

ReferenceImage run_reference(const Frame& frame, std::span<const FragmentStream> streams, QuadId delay,
                             unsigned threads, Fp16Overflow fp16_overflow) {
    CHECK(delay >= 1);
    return Reference(frame, streams, delay, threads, fp16_overflow).take();
}

} // namespace pipeline
