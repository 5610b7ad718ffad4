// Order-independent transparency: the k nearest fragments of each pixel, composited front to back.
//
// Source: Bavoil 2007, sections 4.4 and 6.1.1 (specification 004: workload W2, programs A6 and A11). Whether one pass
// with a k-buffer does it or k passes of depth peeling (W3) is the design's choice, so the graph is the same for both.
// Instead of A6 a program that composites may run: A7, multi-layer alpha blending, or one that the user wrote.
#include "models/programs/nearest_k.hpp"
#include "models/programs/pictures.hpp"
#include "models/programs/program_file.hpp"
#include "pipeline/format_choice.hpp"
#include "sim/check.hpp"
#include "sim/suggest.hpp"
#include "traces/loads.hpp"
#include "traces/pass_graph.hpp"
#include "traces/user_programs.hpp"
#include "traces/workloads/methods.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <string>

namespace traces {

enum class TransparentDraws : std::uint8_t { all, materials };
enum class Faces : std::uint8_t { both, material };

} // namespace traces

template <>
struct sim::EnumNames<traces::TransparentDraws> {
    static constexpr std::array<std::string_view, 2> names{"all", "materials"};
};
template <>
struct sim::EnumNames<traces::Faces> {
    static constexpr std::array<std::string_view, 2> names{"both", "material"};
};

namespace traces {

namespace {

struct TransparencyParams {
    std::uint32_t k = 4;
    std::string program = "nearest-k";
    models::EntryKind entry = models::EntryKind::rgbz;
    TransparentDraws transparent = TransparentDraws::all;
    Faces faces = Faces::both;
    float opacity = 0.5F;
    std::array<float, 3> background = {1.0F, 1.0F, 1.0F};
    Composite composite = Composite::free;
    pipeline::DepthChoice depth_format = pipeline::DepthChoice::d24;

    static constexpr auto fields() {
        using P = TransparencyParams;
        return std::tuple(
            sim::field<&P::k>("layers kept per pixel").unit("layers").range(1, 64),
            sim::field<&P::program>("what a fragment does to its pixel: nearest-k, order-and-blend, mlab, or a program "
                                    "of the user's (a file *.kb or *.glsl)"),
            sim::field<&P::entry>("what a layer of nearest-k keeps: colour and depth, depth, or depth and draw"),
            sim::field<&P::transparent>("which draws are transparent: all, or those whose material is (the others are "
                                        "drawn first, with a depth buffer)"),
            sim::field<&P::faces>(
                "which faces of transparent draws are layers: both, as one sees through the front ones, or "
                "those that the material shows"),
            sim::field<&P::opacity>("opacity of every layer").range(0.0F, 1.0F),
            sim::field<&P::background>("linear RGB behind everything").range(0.0F, 1.0F),
            sim::field<&P::depth_format>("format of the depth surface, where there is one"), composite_field<P>());
    }
};
static_assert(sim::fully_described<TransparencyParams>);

struct Split {
    std::vector<std::uint32_t> opaque, transparent;
};

Split split(const pipeline::Frame& frame, TransparentDraws which) {
    Split result;
    for (std::uint32_t i = 0; i < frame.draws.size(); ++i) {
        const bool transparent =
            which == TransparentDraws::all || frame.resources->materials[frame.draws[i].material].transparent();
        (transparent ? result.transparent : result.opaque).push_back(i);
    }
    return result;
}

constexpr std::array<std::string_view, 3> compositing_programs{"nearest-k", "order-and-blend", "mlab"};

models::ProgramChoice program_of(const TransparencyParams& params) {
    const auto& known = compositing_programs;
    const std::string name(models::program_name(params.program));
    if (!is_user_program(params.program) && std::find(known.begin(), known.end(), params.program) == known.end())
        throw sim::InputError(
            fmt::format("workload transparency: program: expected {} or a file *.kb or *.glsl, got '{}'{}",
                        fmt::join(known, ", "), name, sim::did_you_mean(name, {known.begin(), known.end()})));
    const bool usual = params.entry == models::EntryKind::rgbz;
    return chosen_program(
        params.program, {usual ? std::string() : std::string(sim::enum_name(params.entry)), params.k, params.opacity});
}

pipeline::Frame build(const Scene& scene, const pipeline::View& view, const TransparencyParams& params) {
    pipeline::Frame frame = frame_of(scene, view);
    const models::ProgramChoice choice = program_of(params);
    frame.program = choice.program;
    frame.background = {params.background[0], params.background[1], params.background[2], 1.0F};
    frame.depth_format = format_of(params.depth_format);
    Split draws = split(frame, params.transparent);

    const bool with_opaque = !draws.opaque.empty();
    const bool with_transparent = !draws.transparent.empty();
    const bool colours = frame.program->needs_colour();
    PassGraph graph(frame);
    if (with_opaque) {
        graph.add_clear("clear", {depth_surface, colour_surface});
        graph.add_draw("opaque", {depth_surface}, {depth_surface, colour_surface}, std::move(draws.opaque));
    } else {
        graph.leave_out("pass opaque", params.transparent == TransparentDraws::all
                                           ? "every draw is transparent by choice"
                                           : "every draw has a transparent material");
    }
    if (with_transparent) {
        graph.add_clear("clear k-buffer", {kbuffer_surface});
        graph.add_draw("geometry", with_opaque ? std::vector<std::string>{depth_surface} : std::vector<std::string>{},
                       {kbuffer_surface}, std::move(draws.transparent), params.faces == Faces::both);
        // Layers of depths alone are not laid over a colour, so the opaque pass then serves for its depth only.
        add_picture(graph, frame, choice.picture ? choice.picture : models::layers_picture(params.opacity),
                    params.composite, with_opaque && colours);
    } else {
        graph.leave_out("pass geometry", "no draw has a transparent material");
        graph.output(colour_surface);
    }
    return graph.lower();
}

TruthMethod truth(const Scene&, const pipeline::Frame& frame, const TransparencyParams& params) {
    if (frame.program != nullptr && std::find(compositing_programs.begin(), compositing_programs.end(),
                                              frame.program->id()) == compositing_programs.end())
        throw sim::InputError(fmt::format("truth: workload transparency: program: expected one of {}, got {}",
                                          fmt::join(compositing_programs, ", "), frame.program->id()));
    if (frame.program != nullptr && !frame.needs.colours)
        throw sim::InputError("truth: workload transparency: entry: expected rgbz, the one that has colours");
    return layered_truth(params.opacity);
}

} // namespace

Workload transparency_workload() {
    Workload workload =
        taking(make_workload<TransparencyParams>(
                   "transparency", "the k nearest fragments of each pixel, composited front to back with one opacity",
                   build, truth),
               own_k, "k");
    workload.program_parameters = {{"program", "k", "opacity"}};
    workload.quality = {{"k", {"1", "2", "4", "8", "16", "32"}}};
    workload.options = {
        {"k", "K", "Entries per pixel of the k-buffer (default 4)"},
        {"entry", "KIND", "What an entry holds: rgbz, z or zo (default rgbz)"},
        {"program", "NAME",
         "What a fragment does to its pixel: nearest-k, order-and-blend, mlab, or a file *.kb or *.glsl "
         "(default nearest-k)"}};
    workload.examples = {{"accuracy", "scene.glb --sweep k=1,2,4,8,16"}};
    return workload;
}

Load layers_load(std::uint32_t k, const std::string& entry) {
    return {"transparency", {fmt::format("k={}", k), "entry=" + entry}};
}

} // namespace traces
