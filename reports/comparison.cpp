#include "reports/comparison.hpp"

#include "models/kbuffers/design_support.hpp"
#include "pipeline/functional/number_formats.hpp"
#include "pipeline/functional/parallel.hpp"
#include "pipeline/functional/sample_pattern.hpp"
#include "pipeline/machine.hpp"
#include "reports/compared_designs.hpp"
#include "reports/memory_limit.hpp"
#include "reports/numbers.hpp"
#include "reports/stopwatch.hpp"
#include "sim/counted.hpp"
#include "sim/described_json.hpp"
#include "traces/camera.hpp"
#include "traces/trace.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>
#include <thread>

namespace reports {

namespace {

// Draws are those of the frame, with what it clears and copies by drawing.
SceneFacts facts_of_recording(const traces::Trace& trace, const pipeline::Frame& frame) {
    SceneFacts facts;
    facts.name = trace.scene.name;
    facts.hash = trace.scene.hash;
    facts.camera = facts.view = "as recorded";
    for (const pipeline::Geometry& geometry : frame.resources->geometries) {
        facts.triangles += geometry.triangle_count();
        facts.vertices += geometry.vertex_count;
    }
    for (const pipeline::Pass& pass : frame.passes) {
        facts.draws += pass.draws.size();
        for (const std::uint32_t draw : pass.draws)
            facts.triangles_drawn +=
                std::uint64_t{frame.resources->geometries[frame.draws[draw].geometry].triangle_count()} *
                frame.draws[draw].instances.size();
    }
    facts.textures = static_cast<std::uint64_t>(
        std::count_if(trace.recording->surfaces.begin(), trace.recording->surfaces.end(),
                      [](const traces::RecordedSurface& surface) { return !surface.levels.front().empty(); }));
    facts.notes = frame.notes;
    for (const traces::NotRecorded& call : trace.recording->not_recorded)
        facts.notes.push_back(fmt::format("not recorded: {}: {}", call.call, sim::counted(call.times, "call")));
    return facts;
}

void read_trace(const ComparisonRequest& request, ComparisonInput& input) {
    const traces::Trace trace = traces::read_trace(request.scene);
    input.frame = std::make_shared<const pipeline::Frame>(traces::frame_of(trace, request.replayed));
    input.scene = trace.recording ? facts_of_recording(trace, *input.frame)
                                  : facts_of(trace.scene, trace.frame.camera, *input.frame, trace.frame.notes);
    input.scene.captured = SceneFacts::Captured{trace.metadata.scene, trace.metadata.scene_hash};
}

void read_scene(const ComparisonRequest& request, ComparisonInput& input) {
    if (request.replay) {
        read_trace(request, input);
        return;
    }
    const auto options = traces::WorkloadOptions::of(request.workload_settings);
    const traces::Scene scene = traces::load_scene(request.scene);
    std::vector<std::string> notes;
    pipeline::View view = traces::make_view(scene, request.camera, request.width, request.height, &notes);
    view.samples = request.samples;
    input.frame = std::make_shared<const pipeline::Frame>(traces::build_frame(scene, view, request.workload, options));
    input.scene = facts_of(scene, request.camera, *input.frame, notes);
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
    const MemoryLimit limit = memory_limit();
    if (needed > limit.bytes)
        throw sim::InputError(
            fmt::format("{}{}x{}{}: these designs need at least {} of memory, {} {}",
                        request.replay ? request.scene + ": " : "--size ", frame.view.width, frame.view.height,
                        frame.view.samples == 1 ? "" : fmt::format(" --samples {}", frame.view.samples),
                        bytes_text(needed), limit.whose, bytes_text(limit.bytes)));
}

// In linear light.
std::vector<float> picture_of(const pipeline::Frame& frame, std::vector<float> colour) {
    if (colour.size() == frame.view.places() * 4) colour = pipeline::mean_of_samples(frame.view, colour, 4);
    for (std::size_t i = 0; frame.output_is_encoded && i < colour.size(); ++i)
        if (i % 4 != 3) colour[i] = pipeline::srgb_decode(colour[i]);
    return colour;
}

// What is shown of several samples is the first one's.
void keep_first_sample(std::vector<float>& surface, const pipeline::View& view) {
    surface.resize(surface.size() / view.places() * view.pixels());
    surface.shrink_to_fit();
}

void keep_first_sample(FramePixels& pixels, const pipeline::Frame& frame) {
    keep_first_sample(pixels.kbuffer, frame.view_of_kbuffer());
    if (pixels.colour.size() == frame.view.places() * 4) keep_first_sample(pixels.colour, frame.view);
    keep_first_sample(pixels.depth, frame.view);
}

// Where no pixel is wrong, the picture is that of the reference, if it is of the same submission.
FramePixels run_pixels(const ComparisonInput& input, const std::vector<float>& reference, const ComparedDesign& design,
                       pipeline::RunResult& run) {
    FramePixels pixels{std::move(run.kbuffer), {}, std::move(run.colour), std::move(run.depth), std::move(run.shown)};
    pixels.composite =
        run.wrong_pixels == 0 && design.submitted == nullptr ? reference : picture_of(*input.frame, pixels.colour);
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

// Before the first run starts: quads of all runs, so that the time left can be estimated.
std::uint64_t all_quads(const ComparisonInput& input) {
    std::uint64_t sum = 0;
    for (const ComparedDesign& row : input.designs)
        sum += pipeline::Machine::total_quads(*input.frame, input.streams, *row.design);
    return sum;
}

// Of runs that all store the same colours.
std::vector<std::string> overflow_notes(const std::vector<pipeline::RunResult>& runs, pipeline::Fp16Overflow overflow) {
    std::uint64_t channels = 0;
    for (const pipeline::RunResult& run : runs)
        channels = std::max(channels, run.stages->at("rop")["counters"]["fp16_overflows"].get<std::uint64_t>());
    if (channels == 0) return {};
    return {fmt::format("{} left the range of 16-bit floats and {} (rop.fp16_overflow)",
                        sim::counted(channels, "stored colour channel"),
                        overflow == pipeline::Fp16Overflow::saturate ? "were saturated" : "became infinite")};
}

// By design the number of the one that is run for it. Where no pass has a k-buffer, a design changes nothing but the
// numbers of the GPU that it was given.
std::vector<std::size_t> same_machines(const ComparisonInput& input) {
    std::vector<std::size_t> run_as(input.designs.size());
    for (std::size_t i = 0; i < run_as.size(); ++i) {
        run_as[i] = i;
        for (std::size_t before = 0; !input.frame->program && before < i; ++before)
            if (input.designs[before].gpu_changes == input.designs[i].gpu_changes) {
                run_as[i] = before;
                break;
            }
    }
    return run_as;
}

std::string same_runs_text(const Comparison& comparison, const std::vector<std::size_t>& run_as) {
    std::vector<std::string> others;
    for (std::size_t i = 0; i < run_as.size(); ++i)
        if (run_as[i] != i)
            others.push_back(fmt::format("{} as {}", comparison.runs[i].design, comparison.runs[run_as[i]].design));
    return others.empty() ? ""
                          : fmt::format("no pass has a k-buffer, so equal machines were run once: {} {} the numbers of "
                                        "the other",
                                        fmt::join(others, ", "), others.size() == 1 ? "has" : "have");
}

std::uint64_t peak_memory() {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024; // Linux counts KiB
}

} // namespace

std::size_t Comparison::base_run() const {
    for (std::size_t i = 0; i < runs.size(); ++i)
        if (variants.at(i).design == "existing" && design_parameters.at(i)->value("visibility", "") == "writeback")
            return i;
    return 0;
}

SceneFacts facts_of(const traces::Scene& scene, const std::string& camera, const pipeline::Frame& frame,
                    const std::vector<std::string>& notes) {
    SceneFacts facts{scene.name,
                     scene.hash,
                     scene.triangles,
                     scene.triangles_drawn,
                     scene.vertices,
                     scene.draws.size(),
                     scene.resources->textures.size(),
                     camera,
                     traces::view_text(frame.view),
                     scene.notes,
                     {}};
    for (const auto* more : {&notes, &frame.notes}) facts.notes.insert(facts.notes.end(), more->begin(), more->end());
    return facts;
}

namespace {

// Of the process, for the last words when memory runs out.
std::atomic<Progress::Phase> latest_phase{Progress::Phase::reading};

} // namespace

std::string_view latest_activity() {
    static constexpr std::array<std::string_view, 7> names{
        "reading the scene", "shading the frame", "computing the reference", "simulating", "writing files",
        "measuring",         "tracing rays"};
    return names.at(static_cast<std::size_t>(latest_phase.load()));
}

void enter(const Supervision& supervision, Progress::Phase phase) {
    latest_phase = phase;
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
    Hardware hardware = read_hardware(request);
    input.gpu = std::move(hardware.gpu);
    input.designs = std::move(hardware.designs);
    read_scene(request, input);
    check_designs(input, request.only_able_designs || request.first_able_design);
    if (request.first_able_design) input.designs.erase(input.designs.begin() + 1, input.designs.end());
    if (request.equal_area) fit_to_area(input, *request.equal_area);
    check_memory(input, request);
    enter(supervision, Progress::Phase::shading);
    const Stopwatch front_end;
    input.streams = shade(*input.frame, input.threads, supervision);
    enter(supervision, Progress::Phase::reference);
    input.reference = pipeline::run_reference(*input.frame, input.streams, 1, input.threads,
                                              input.designs.front().gpu.rop.fp16_overflow); // that of all designs
    submit(input, input.designs, supervision);
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
    for (const ComparedDesign& row : input.designs) {
        comparison.variants.push_back(facts_of(row));
        comparison.design_parameters.push_back(sim::to_json(row.design->parameters()));
        comparison.design_support.push_back(models::support_of(*row.design));
    }
    comparison.runs.resize(input.designs.size());
    comparison.pixels.resize(input.designs.size());
    pipeline::ReferenceImage& reference = input.reference;
    comparison.reference.composite =
        picture_of(*input.frame, reference.picture.empty() ? reference.colour : std::move(reference.picture));
    const std::vector<std::size_t> run_as = same_machines(input);
    pipeline::parallel_for(input.threads, input.designs.size(), [&](std::size_t i) {
        if (run_as[i] == i) comparison.runs[i] = run_design(input, input.designs[i], supervision);
    });
    for (std::size_t i = 0; i < run_as.size(); ++i)
        if (run_as[i] != i) comparison.runs[i] = run_again(input, input.designs[i], comparison.runs[run_as[i]]);
    comparison.same_runs = same_runs_text(comparison, run_as);
    pipeline::parallel_for(input.threads, input.designs.size(), [&](std::size_t i) {
        comparison.pixels[i] = run_pixels(input, comparison.reference.composite, input.designs[i], comparison.runs[i]);
    });
    comparison.reference.kbuffer = std::move(reference.kbuffer);
    comparison.reference.colour = std::move(reference.colour);
    comparison.reference.depth = std::move(reference.depth);
    comparison.reference.shown = std::move(reference.shown);
    keep_first_sample(comparison.reference, *input.frame);
    comparison.depth_complexity = most_of_samples(input.frame->view_of_kbuffer(), input.reference.depth_complexity);
    comparison.scene = std::move(input.scene);
    for (std::string& note : overflow_notes(comparison.runs, input.designs.front().gpu.rop.fp16_overflow))
        comparison.scene.notes.push_back(std::move(note));
    comparison.gpu = std::move(input.gpu);
    comparison.equal_area = std::move(input.equal_area);
    comparison.frame = std::move(input.frame);
    comparison.seed = input.seed;
    comparison.host = {input.seconds + watch.seconds(), input.front_end_seconds, peak_memory(), input.threads};
    return comparison;
}

} // namespace reports
