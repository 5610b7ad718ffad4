#include "reports/comparison.hpp"

#include "models/gpu_library.hpp"
#include "models/kbuffers/design_support.hpp"
#include "pipeline/functional/composite.hpp"
#include "pipeline/functional/frame_streams.hpp"
#include "pipeline/functional/parallel.hpp"
#include "pipeline/functional/sample_pattern.hpp"
#include "pipeline/machine.hpp"
#include "reports/numbers.hpp"
#include "reports/stopwatch.hpp"
#include "traces/camera.hpp"
#include "traces/submission.hpp"
#include "traces/workloads.hpp"

#include <fmt/format.h>
#include <set>
#include <sys/resource.h>
#include <thread>
#include <unistd.h>

namespace reports {

namespace {

// GPU and designs read one configuration, so that a misspelt key of either is found.
void read_hardware(const ComparisonRequest& request, ComparisonInput& input) {
    sim::Config config = models::load_gpu(request.gpu);
    for (const std::string& setting : request.gpu_settings) config.set(setting);
    config.read("", input.gpu_params);
    input.gpu.parameters = config.effective();
    std::set<std::string> seen;
    for (const std::string& design : request.designs) {
        if (!seen.insert(design).second) throw sim::InputError(fmt::format("--designs: '{}' is named twice", design));
        input.designs.push_back(models::make_design(design, config));
    }
    input.gpu.name = request.gpu;
    input.gpu.origins = config.origins();
    models::check_design_sections(config);
    config.expect_all_used();
}

void read_scene(const ComparisonRequest& request, ComparisonInput& input) {
    traces::WorkloadOptions options;
    for (const std::string& setting : request.workload_settings) options.set(setting);
    const traces::Scene scene = traces::load_scene(request.scene);
    pipeline::View view = traces::make_view(scene, request.camera, request.width, request.height);
    view.samples = request.samples;
    input.frame = std::make_shared<const pipeline::Frame>(traces::build_frame(scene, view, request.workload, options));
    input.scene = facts_of(scene, request.camera);
}

void leave_out(ComparisonInput& input, std::size_t design, const std::string& reason) {
    pipeline::Frame frame = *input.frame;
    frame.left_out.push_back({fmt::format("design {}", input.designs[design]->id()),
                              fmt::format("it cannot run the program {}: {}", frame.program->id(), reason)});
    input.frame = std::make_shared<const pipeline::Frame>(std::move(frame));
    input.designs.erase(input.designs.begin() + static_cast<std::ptrdiff_t>(design));
}

void check_designs(ComparisonInput& input, bool only_able) {
    if (!input.frame->program) return;
    for (std::size_t i = input.designs.size(); i-- > 0;) {
        const std::string reason = input.designs[i]->refuses(*input.frame->program);
        if (reason.empty()) continue;
        if (!only_able || input.designs.size() == 1)
            throw sim::InputError(fmt::format("--designs: '{}' cannot run the program {}: {}", input.designs[i]->id(),
                                              input.frame->program->id(), reason));
        leave_out(input, i, reason);
    }
}

// A frame that cannot fit would be ended by the system without a word.
void check_memory(const ComparisonInput& input, const ComparisonRequest& request) {
    const pipeline::Frame& frame = *input.frame;
    const auto pixels = static_cast<double>(frame.view.places());
    const double kbuffer = frame.program ? static_cast<double>(frame.program->bytes_per_pixel()) *
                                               static_cast<double>(frame.view_of_kbuffer().places()) / pixels
                                         : 0;
    constexpr double colour = 16, depth = 12;
    // One k-buffer, colour and depth surface for the reference and each design; those that run also hold older
    // versions.
    const double running = std::min<double>(input.threads, static_cast<double>(input.designs.size()));
    const double needed =
        pixels * ((kbuffer + colour + depth) * (1 + static_cast<double>(input.designs.size())) + running * kbuffer);
    const double here = static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE));
    if (needed > here)
        throw sim::InputError(
            fmt::format("--size {}x{}{}: these designs need at least {} of memory, this machine has {}", request.width,
                        request.height, request.samples == 1 ? "" : fmt::format(" --samples {}", request.samples),
                        bytes_text(needed), bytes_text(here)));
}

std::vector<pipeline::FragmentStream> shade(const pipeline::Frame& frame, unsigned threads,
                                            const Supervision& supervision) {
    pipeline::FrontEndOptions options;
    options.threads = threads;
    options.stop = supervision.stop;
    if (supervision.progress != nullptr)
        options.progress = [progress = supervision.progress](double share) { progress->share = share; };
    return pipeline::rasterize_frame(frame, options);
}

// Designs with equal wishes share a frame.
std::shared_ptr<const SubmittedFrame> submit(const ComparisonInput& input, const pipeline::KBufferDesign& design,
                                             const Supervision& supervision) {
    const pipeline::SubmissionPlan plan = design.submission();
    if (!plan.changes() || !input.frame->program) return nullptr;
    for (const auto& earlier : input.submitted)
        if (earlier && earlier->plan == plan) return earlier;
    auto result = std::make_shared<SubmittedFrame>();
    result->plan = plan;
    result->frame = traces::submitted(*input.frame, plan);
    result->streams = shade(result->frame, input.threads, supervision);
    result->reference = pipeline::run_reference(result->frame, result->streams, 1, input.threads);
    return result;
}

std::vector<float> picture_of(const pipeline::Frame& frame, const std::vector<float>& kbuffer,
                              const std::vector<float>& colour, const std::vector<float>& depth) {
    if (!kbuffer.empty()) return pipeline::composite(frame, {kbuffer, colour, depth});
    return colour.empty() ? colour : pipeline::mean_of_samples(frame.view, colour, 4);
}

// What is shown of several samples is the first one's.
void keep_first_sample(std::vector<float>& surface, const pipeline::View& view) {
    surface.resize(surface.size() / view.places() * view.pixels());
    surface.shrink_to_fit();
}

void keep_first_sample(FramePixels& pixels, const pipeline::Frame& frame) {
    keep_first_sample(pixels.kbuffer, frame.view_of_kbuffer());
    keep_first_sample(pixels.colour, frame.view);
    keep_first_sample(pixels.depth, frame.view);
}

// Where no pixel is wrong, the picture is that of the reference, if it is of the same submission.
FramePixels run_pixels(const ComparisonInput& input, const std::vector<float>& reference, std::size_t number,
                       pipeline::RunResult& run) {
    FramePixels pixels{std::move(run.kbuffer), {}, std::move(run.colour), std::move(run.depth)};
    const bool submitted_anew = number < input.submitted.size() && input.submitted[number] != nullptr;
    pixels.composite = run.wrong_pixels == 0 && !submitted_anew
                           ? reference
                           : picture_of(*input.frame, pixels.kbuffer, pixels.colour, pixels.depth);
    keep_first_sample(pixels, *input.frame);
    return pixels;
}

std::vector<std::uint32_t> most_of_samples(const pipeline::View& view, const std::vector<std::uint32_t>& places) {
    std::vector<std::uint32_t> most(std::size_t{view.width} * view.height);
    for (std::uint32_t sample = 0; sample < view.samples; ++sample) {
        const auto plane = pipeline::plane_of_sample(view, sample, std::span(places), 1);
        for (std::size_t pixel = 0; pixel < most.size(); ++pixel) most[pixel] = std::max(most[pixel], plane[pixel]);
    }
    return most;
}

pipeline::RunResult run_design(const ComparisonInput& input, std::size_t number, const Supervision& supervision) {
    const pipeline::KBufferDesign& design = *input.designs[number];
    const SubmittedFrame* submitted = number < input.submitted.size() ? input.submitted[number].get() : nullptr;
    pipeline::MachineOptions options;
    options.seed = input.seed;
    options.stop = supervision.stop;
    options.observer = supervision.observer;
    if (supervision.progress != nullptr) options.quads_done = &supervision.progress->quads_done;
    const Stopwatch watch;
    pipeline::Machine machine(input.gpu_params, submitted != nullptr ? submitted->frame : *input.frame,
                              submitted != nullptr ? submitted->streams : input.streams, design, options);
    pipeline::RunResult result = machine.run(submitted != nullptr ? submitted->reference : input.reference);
    result.sort_milliseconds =
        design.submission().sort_ns_per_triangle * static_cast<double>(input.scene.triangles_drawn) / 1e6;
    result.host_seconds = watch.seconds();
    return result;
}

// Before the first run starts: quads of all runs, so that the time left can be estimated.
std::uint64_t all_quads(const ComparisonInput& input) {
    std::uint64_t sum = 0;
    for (const auto& design : input.designs)
        sum += pipeline::Machine::total_quads(*input.frame, input.streams, *design);
    return sum;
}

std::uint64_t peak_memory() {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024; // Linux counts KiB
}

} // namespace

SceneFacts facts_of(const traces::Scene& scene, const std::string& camera) {
    return {scene.name,
            scene.hash,
            scene.triangles,
            scene.triangles_drawn,
            scene.vertices,
            scene.draws.size(),
            scene.resources->textures.size(),
            camera,
            scene.notes};
}

void enter(const Supervision& supervision, Progress::Phase phase) {
    if (supervision.stop != nullptr && *supervision.stop) throw sim::Interrupted();
    if (supervision.progress == nullptr) return;
    supervision.progress->share = 0.0;
    supervision.progress->phase = phase;
}

unsigned core_count() { return std::max(1U, std::thread::hardware_concurrency()); }

ComparisonInput prepare(const ComparisonRequest& request, const Supervision& supervision) {
    const Stopwatch watch;
    ComparisonInput input;
    input.seed = request.seed;
    input.threads = request.threads == 0 ? core_count() : request.threads;
    enter(supervision, Progress::Phase::reading);
    read_hardware(request, input);
    read_scene(request, input);
    check_designs(input, request.only_able_designs);
    check_memory(input, request);
    enter(supervision, Progress::Phase::shading);
    const Stopwatch front_end;
    input.streams = shade(*input.frame, input.threads, supervision);
    enter(supervision, Progress::Phase::reference);
    input.reference = pipeline::run_reference(*input.frame, input.streams, 1, input.threads);
    for (const auto& design : input.designs) input.submitted.push_back(submit(input, *design, supervision));
    input.front_end_seconds = front_end.seconds();
    input.seconds = watch.seconds();
    return input;
}

Comparison compare(ComparisonInput input, const Supervision& supervision) {
    const Stopwatch watch;
    CHECK(supervision.observer == nullptr || input.designs.size() == 1);
    enter(supervision, Progress::Phase::simulating);
    Comparison comparison;
    if (supervision.progress != nullptr) supervision.progress->quads_total = all_quads(input);
    for (const auto& design : input.designs) {
        comparison.design_parameters.push_back(design->parameters());
        comparison.design_support.push_back(models::support_of(*design));
    }
    comparison.runs.resize(input.designs.size());
    comparison.pixels.resize(input.designs.size());
    pipeline::ReferenceImage& reference = input.reference;
    comparison.reference.composite =
        reference.picture.empty() ? picture_of(*input.frame, reference.kbuffer, reference.colour, reference.depth)
                                  : std::move(reference.picture);
    pipeline::parallel_for(input.threads, input.designs.size(), [&](std::size_t i) {
        comparison.runs[i] = run_design(input, i, supervision);
        comparison.pixels[i] = run_pixels(input, comparison.reference.composite, i, comparison.runs[i]);
    });
    comparison.reference.kbuffer = std::move(reference.kbuffer);
    comparison.reference.colour = std::move(reference.colour);
    comparison.reference.depth = std::move(reference.depth);
    keep_first_sample(comparison.reference, *input.frame);
    comparison.depth_complexity = most_of_samples(input.frame->view_of_kbuffer(), input.reference.depth_complexity);
    comparison.scene = std::move(input.scene);
    comparison.gpu = std::move(input.gpu);
    comparison.frame = std::move(input.frame);
    comparison.seed = input.seed;
    comparison.host = {input.seconds + watch.seconds(), input.front_end_seconds, peak_memory(), input.threads};
    return comparison;
}

} // namespace reports
