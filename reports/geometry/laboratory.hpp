// Draws the experiments of geometry feed on the model, each scene made once.
#pragma once

#include "pipeline/vertex_path.hpp"
#include "reports/geometry/measurements.hpp"
#include "sim/config.hpp"
#include "traces/preparation.hpp"

#include <atomic>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace reports {

enum class Fidelity : std::uint8_t { estimate, detailed };

/// A scene ready to be drawn, and what its preparations did.
struct PreparedFrame {
    std::shared_ptr<const pipeline::Frame> frame;
    std::vector<traces::PreparationStep> steps;
    traces::MeshMeasure measure; ///< with the caches of the GPU
    std::uint64_t triangles = 0; ///< drawn
    std::uint64_t vertices = 0;
    std::string scene; ///< as asked for
    std::string hash;
    std::vector<std::string> notes;
};

/// Loads and prepares a scene and builds the frame that loads its geometry feed. `reuse` and `cache` only measure.
PreparedFrame prepare_frame(const GeometryExperiment& experiment, const pipeline::GpuParams& gpu);

pipeline::VertexPathResult run_geometry(const pipeline::GpuParams& gpu, const pipeline::Frame& frame, Fidelity fidelity,
                                        const std::atomic<bool>* stop = nullptr, std::uint64_t seed = 1);

/// The parameters of a GPU with settings "section.key=value", or with values by path. Throw sim::InputError as
/// models::load_gpu does, and for a key that nothing reads.
pipeline::GpuParams configured_gpu(const std::string& gpu, const std::vector<std::string>& settings);
pipeline::GpuParams gpu_params(const std::string& gpu, const std::map<std::string, double>& values = {});

} // namespace reports

template <>
struct sim::EnumNames<reports::Fidelity> {
    static constexpr std::array<std::string_view, 2> names{"estimate", "detailed"};
};
