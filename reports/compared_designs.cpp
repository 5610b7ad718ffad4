#include "reports/compared_designs.hpp"

#include "models/gpu_library.hpp"
#include "pipeline/functional/frame_streams.hpp"
#include "pipeline/machine.hpp"
#include "pipeline/on_chip_area.hpp"
#include "reports/flatten.hpp"
#include "reports/memory_limit.hpp"
#include "reports/stopwatch.hpp"
#include "sim/counted.hpp"
#include "sim/described_json.hpp"
#include "traces/submission.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <nlohmann/json.hpp>

namespace reports {

namespace {

// Of the GPU, by path: what `own` has otherwise than `shared`.
nlohmann::ordered_json changed_parameters(const pipeline::GpuParams& own, const pipeline::GpuParams& shared) {
    nlohmann::ordered_json changes = nlohmann::ordered_json::object();
    const FlatValues before = flatten(sim::to_json(shared)), after = flatten(sim::to_json(own));
    for (std::size_t i = 0; i < after.size() && i < before.size(); ++i)
        if (after[i] != before[i]) changes[after[i].first] = after[i].second;
    return changes;
}

ComparedDesign read_design(const DesignVariant& variant, sim::Config config, const pipeline::GpuParams& shared) {
    for (const auto& [path, value] : variant.settings)
        config.set(fmt::format("{}={}", path, value), fmt::format("design '{}'", variant.text));
    ComparedDesign row;
    row.variant = variant;
    config.read("", row.gpu);
    row.design = models::make_design(variant.design, config);
    // A misspelt key of any design is found, whichever designs run.
    models::check_design_sections(config);
    config.expect_all_used();
    row.gpu_changes = changed_parameters(row.gpu, shared);
    if (row.gpu.rop.fp16_overflow != shared.rop.fp16_overflow)
        throw sim::InputError(
            fmt::format("design '{}': 'rop.fp16_overflow' decides what the picture is, and all designs "
                        "of a comparison share one: set it for all of them",
                        variant.text));
    return row;
}

void leave_out(ComparisonInput& input, std::size_t design, const std::string& reason) {
    pipeline::Frame frame = *input.frame;
    frame.left_out.push_back({fmt::format("design {}", input.designs[design].variant.text),
                              fmt::format("it cannot run the program {}: {}", frame.program->id(), reason)});
    input.frame = std::make_shared<const pipeline::Frame>(std::move(frame));
    input.designs.erase(input.designs.begin() + static_cast<std::ptrdiff_t>(design));
}

std::shared_ptr<const SubmittedFrame> known_frame(const std::vector<ComparedDesign>& designs,
                                                  const pipeline::SubmissionPlan& plan) {
    for (const ComparedDesign& row : designs)
        if (row.submitted && row.submitted->plan == plan) return row.submitted;
    return nullptr;
}

} // namespace

Hardware read_hardware(const ComparisonRequest& request) {
    sim::Config config = models::load_gpu(request.gpu);
    for (const std::string& setting : request.gpu_settings) config.set(setting);
    Hardware hardware;
    pipeline::GpuParams shared;
    std::vector<DesignVariant> variants;
    for (const std::string& text : request.designs) variants.push_back(parse_variant(text));
    const std::vector<std::string> names = variant_names(variants);
    {
        sim::Config alone = config;
        alone.read("", shared);
        hardware.gpu.parameters = alone.effective();
    }
    for (std::size_t i = 0; i < variants.size(); ++i) {
        hardware.designs.push_back(read_design(variants[i], config, shared));
        hardware.designs.back().name = names[i];
    }
    hardware.gpu.name = request.gpu;
    hardware.gpu.origins = config.origins();
    return hardware;
}

void check_designs(ComparisonInput& input, bool only_able) {
    if (!input.frame->program) return;
    for (std::size_t i = input.designs.size(); i-- > 0;) {
        const std::string reason = input.designs[i].design->refuses(*input.frame->program);
        if (reason.empty()) continue;
        if (!only_able || input.designs.size() == 1)
            throw sim::InputError(fmt::format("--designs: '{}' cannot run the program {}: {}",
                                              input.designs[i].variant.text, input.frame->program->id(), reason));
        leave_out(input, i, reason);
    }
}

VariantFacts facts_of(const ComparedDesign& row) {
    return {row.variant.design, row.variant.text, row.variant.label(), row.gpu_changes};
}

void fit_to_area(ComparisonInput& input, std::uint64_t bytes) {
    EqualArea equal{bytes, {}};
    if (bytes == 0)
        for (const ComparedDesign& row : input.designs)
            equal.bytes =
                std::max(equal.bytes, pipeline::on_chip_area(row.gpu, *input.frame, *row.design).total_bytes());
    std::vector<ComparedDesign> fitting;
    std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
    for (ComparedDesign& row : input.designs) {
        const auto fitted = pipeline::fit_caches(row.gpu, *input.frame, *row.design, equal.bytes);
        least = std::min(least, fitted.needed);
        if (!fitted.fits) {
            equal.does_not_fit.push_back({row.name, facts_of(row), fitted.needed});
            continue;
        }
        const pipeline::GpuParams before = row.gpu;
        row.gpu.rop = fitted.rop;
        const auto changes = changed_parameters(row.gpu, before);
        row.gpu_changes->update(changes);
        for (const auto& change : changes.items()) row.variant.replace(change.key(), change.value().dump());
        fitting.push_back(std::move(row));
    }
    if (fitting.empty())
        throw sim::InputError(fmt::format("--equal-area: no design fits into {}; the smallest needs {}",
                                          sim::counted(equal.bytes, "byte"), sim::counted(least, "byte")));
    input.designs = std::move(fitting);
    input.equal_area = std::move(equal);
}

std::vector<pipeline::FragmentStream> shade(const pipeline::Frame& frame, unsigned threads,
                                            const Supervision& supervision) {
    pipeline::FrontEndOptions options;
    options.threads = threads;
    options.stop = supervision.stop;
    if (supervision.progress != nullptr)
        options.progress = [progress = supervision.progress](double share) { progress->share = share; };
    const MemoryLimit limit = memory_limit();
    return pipeline::rasterize_frame(frame, options, {static_cast<std::uint64_t>(limit.bytes), limit.whose});
}

void submit(const ComparisonInput& input, std::vector<ComparedDesign>& designs, const Supervision& supervision) {
    if (!input.frame->program) return;
    for (ComparedDesign& row : designs) {
        const pipeline::SubmissionPlan plan = row.design->submission();
        if (!plan.changes()) continue;
        row.submitted = known_frame(designs, plan);
        if (!row.submitted) row.submitted = known_frame(input.designs, plan);
        if (row.submitted) continue;
        auto own = std::make_shared<SubmittedFrame>();
        own->plan = plan;
        own->frame = traces::submitted(*input.frame, plan);
        own->streams = shade(own->frame, input.threads, supervision);
        own->reference = pipeline::run_reference(own->frame, own->streams, 1, input.threads, row.gpu.rop.fp16_overflow);
        row.submitted = std::move(own);
    }
}

pipeline::RunResult run_design(const ComparisonInput& input, const ComparedDesign& design,
                               const Supervision& supervision) {
    const SubmittedFrame* submitted = design.submitted.get();
    pipeline::MachineOptions options;
    options.seed = input.seed;
    options.stop = supervision.stop;
    options.observer = supervision.observer;
    if (supervision.progress != nullptr) options.quads_done = &supervision.progress->quads_done;
    const Stopwatch watch;
    const double cpu_begin = Stopwatch::thread_seconds();
    pipeline::Machine machine(design.gpu, submitted != nullptr ? submitted->frame : *input.frame,
                              submitted != nullptr ? submitted->streams : input.streams, *design.design, options);
    pipeline::RunResult result = machine.run(submitted != nullptr ? submitted->reference : input.reference);
    result.design = design.name;
    result.sort_milliseconds =
        design.design->submission().sort_ns_per_triangle * static_cast<double>(input.scene.triangles_drawn) / 1e6;
    result.host_seconds = watch.seconds();
    result.cpu_seconds = Stopwatch::thread_seconds() - cpu_begin;
    return result;
}

pipeline::RunResult run_again(const ComparisonInput& input, const ComparedDesign& design,
                              const pipeline::RunResult& run) {
    pipeline::RunResult result = run;
    result.design = design.name;
    result.area = pipeline::area_json(pipeline::on_chip_area(design.gpu, *input.frame, *design.design));
    result.sort_milliseconds =
        design.design->submission().sort_ns_per_triangle * static_cast<double>(input.scene.triangles_drawn) / 1e6;
    result.host_seconds = result.cpu_seconds = 0;
    result.host_ticks = 0;
    return result;
}

} // namespace reports
