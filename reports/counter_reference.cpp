#include "reports/counter_reference.hpp"

#include "pipeline/fragment/fragment_pipeline.hpp"
#include "pipeline/fragment/fragment_scheduler.hpp"
#include "pipeline/fragment/lock_table.hpp"
#include "pipeline/gpu_params.hpp"
#include "pipeline/memory/memory_system.hpp"
#include "pipeline/output/crossbar.hpp"

#include <algorithm>
#include <charconv>

namespace reports {

namespace {

template <sim::Described Stats>
StageReference stage(std::string_view name, std::string_view text) {
    return {name, text, sim::describe<Stats>()};
}

std::vector<StageReference> make_reference() {
    using namespace pipeline;
    return {stage<CommandProcessorStats>("command_processor", "Command processor"),
            stage<IndexFetchStats>("index_fetch", "Index fetch unit"),
            stage<IndexFetchStats>("primitive_counter", "Primitive counter, in place of index fetch"),
            stage<VertexReuseStats>("vertex_reuse", "Post-transform cache"),
            stage<VertexFetchStats>("vertex_fetch", "Vertex fetch unit and pre-transform cache"),
            stage<VertexShaderStats>("vertex_shader", "Vertex shader units"),
            stage<PrimitiveAssemblyStats>("primitive_assembly", "Primitive assembly"),
            stage<ClipCullStats>("clip_cull", "Clipping and culling"),
            stage<TriangleSetupStats>("triangle_setup", "Triangle setup"),
            stage<RasterizerStats>("rasterizer", "Rasterizer"),
            stage<EarlyDepthStats>("early_depth_test", "Early depth test"),
            stage<FragmentSchedulerStats>("fragment_scheduler", "Fragment scheduler"),
            stage<FragmentPipelineStats>("fragment_pipeline", "Fragment pipelines with their texture L1 caches"),
            stage<LockTableStats>("lock_table", "Lock table of the shaders' critical sections"),
            stage<ReorderBufferStats>("reorder_buffer", "Reorder buffer"),
            stage<CrossbarStats>("crossbar", "Crossbar to the ROP groups"),
            stage<RopStats>("rop", "ROP groups with their tile caches"),
            stage<MemoryHubStats>("memory_hub", "Crossbar to the memory partitions"),
            stage<MemoryControllerStats>("memory_partition", "Memory partitions")};
}

} // namespace

const std::vector<StageReference>& stage_reference() {
    static const std::vector<StageReference> reference = make_reference();
    return reference;
}

const sim::FieldInfo* find_counter(std::string_view stage, std::string_view path) {
    const auto& all = stage_reference();
    const auto found = std::find_if(all.begin(), all.end(), [stage](const auto& each) { return each.stage == stage; });
    if (found == all.end()) return nullptr;
    // Elements of arrays and parts of histograms lie below their field.
    for (;;) {
        for (const sim::FieldInfo& counter : found->counters)
            if (counter.path == path) return &counter;
        const std::size_t dot = path.rfind('.');
        if (dot == std::string_view::npos) return nullptr;
        path = path.substr(0, dot);
    }
}

std::string counter_name(std::string_view stage, std::string_view path) {
    constexpr std::string_view by_client = "bytes.";
    std::size_t client = 0;
    if (stage == "memory_partition" && path.starts_with(by_client)) {
        const std::string_view number = path.substr(by_client.size());
        const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), client);
        if (error == std::errc() && client < pipeline::memory_client_count)
            return std::string(by_client) + std::string(pipeline::memory_client_names[client]);
    }
    return std::string(path);
}

} // namespace reports
