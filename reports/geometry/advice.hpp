// What limits the geometry feed of a scene on a GPU, and what preparing its meshes would win.
#pragma once

#include "reports/geometry/laboratory.hpp"
#include "reports/geometry/validation.hpp"
#include "traces/preparation/mesh_measure.hpp"

#include <string>
#include <vector>

namespace reports {

struct GeometryRequest {
    GeometryExperiment experiment; ///< its preparations are one case beside the scene as it is
    std::string gpu = "neutral";
    std::vector<std::string> gpu_settings; ///< "section.key=value"
    std::uint64_t seed = 1;
};

/// The scene as it is, or with some preparations.
struct GeometryCase {
    std::string name; ///< "as it is", "reorder"
    std::vector<std::string> prepare;
    std::vector<traces::PreparationStep> steps;
    traces::MeshMeasure measure;
    pipeline::VertexPathResult result;
};

struct GeometryAdvice {
    std::string scene, hash, gpu;
    pipeline::Submission submission = pipeline::Submission::buffers;
    Fidelity fidelity = Fidelity::detailed;
    std::uint64_t seed = 1;
    std::uint64_t triangles = 0; ///< drawn
    std::vector<std::string> notes;
    std::vector<pipeline::LeftOut> left_out; ///< of the scene as it is
    std::vector<GeometryCase> cases;         ///< the first is the scene as it is
    double core_mhz = 0;
    double seconds = 0; ///< host time of everything

    /// Number of the fastest case.
    std::size_t best() const;
    /// One or two sentences: what limits, what to do, what it wins.
    std::string recommendation() const;
};

/// Without preparations in the request, those that specification 004, sections 3.1 and 3.8 of the thesis name are
/// tried, each alone, and the recommended layout.
GeometryAdvice advise(const GeometryRequest& request, const GeometryRunOptions& options);

} // namespace reports
