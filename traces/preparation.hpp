// Preparing meshes for the geometry feed: reordering, batching, formats, strips (specification 004, section 3.1).
//
// A preparation turns a scene into one that draws the same triangles, and asserts that it does. `NAME?key=value&...`
// names one with its parameters. What becomes of a mesh does not depend on the number of threads or the machine.
#pragma once

#include "sim/described.hpp"
#include "traces/preparation/mesh_measure.hpp"
#include "traces/scene.hpp"

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace traces {

/// A scene after one preparation.
struct Applied {
    Scene scene;
    std::string spec; ///< the preparation with all its parameters
    /// Largest distance of a drawn position from where it was, in scene units; where positions change at all.
    std::optional<double> position_error;
    std::vector<std::string> notes; ///< one line each
};

struct Preparation {
    std::string id;
    std::string summary; ///< one line
    std::vector<sim::FieldInfo> parameters;
    /// `values` overrides parameters by name; throws sim::InputError for unknown names and values out of range.
    std::function<Applied(Scene scene, const nlohmann::ordered_json& values)> apply;
};

/// All preparations, in the order in which help lists them.
const std::vector<Preparation>& preparations();

struct PreparationStep {
    std::string id; ///< with all its parameters: "shuffle?seed=1"
    MeshMeasure before, after;
    std::optional<double> position_error; ///< as in Applied
    std::vector<std::string> notes;
};

struct PreparedScene {
    Scene scene; ///< named as before; its hash is that of the scene and the steps
    std::vector<PreparationStep> steps;
};

/// Applies `specs` in order; `reuse` and `pre_transform` are what is measured with (see measure_meshes()). Geometries
/// that draws share stay shared. Throws sim::InputError, naming what is near to a mistyped name.
PreparedScene prepare_scene(Scene scene, std::span<const std::string> specs,
                            const pipeline::VertexReuseParams& reuse = {},
                            const pipeline::CacheParams& pre_transform = {});

} // namespace traces
