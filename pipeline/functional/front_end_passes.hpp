// The passes of the front end over a shared plan. Each is a loop over independent pieces of work.
#pragma once

#include "pipeline/fragment_stream.hpp"
#include "pipeline/functional/cull_and_clip.hpp"
#include "pipeline/functional/front_end.hpp"
#include "pipeline/functional/vertex_fetch.hpp"
#include "pipeline/vertex_program.hpp"

#include <mutex>

namespace pipeline {

/// State of some draws.
struct PlannedState {
    const RasterState* state = nullptr;
    Viewport viewport;
    std::uint32_t alike = 0; ///< number of the first state under which vertices become the same
};

/// Vertices that are transformed by one matrix under one state, for all instances whose indices lie among them.
struct PlannedVertices {
    const Geometry* geometry = nullptr; ///< one of those that read them
    const glm::mat4* model = nullptr;
    VertexRange used;
    std::uint32_t instance = 0;       ///< one of those that read them
    std::uint32_t state = 0;          ///< of FrontEndPlan::states
    std::uint64_t first_vertex = 0;   ///< where they lie in FrontEndPlan::vertices
    std::uint64_t first_distance = 0; ///< ... in FrontEndPlan::distances, where planes of the user cut
    const VertexProgram* program = nullptr;
    VertexProgramShape shape{};      ///< of the program
    std::uint64_t first_varying = 0; ///< in FrontEndPlan::varyings, where there is a program
    std::uint64_t first_size = 0;    ///< in FrontEndPlan::point_sizes, where it gives sizes
    std::uint64_t instructions = 0;  ///< that it took for all vertices; of no program 0
};

/// One instance of one draw.
struct PlannedInstance {
    const Geometry* geometry = nullptr;
    const Material* material = nullptr;
    const glm::mat4* model = nullptr;
    const PlannedState* state = nullptr;
    std::uint32_t instance = 0;
    std::uint32_t run = 0; ///< of FrontEndPlan::runs
    Culling culling = Culling::none;
};

/// Some vertices of one run, or primitives of one instance: one piece of work.
struct PlannedPiece {
    std::uint32_t of = 0; ///< number of the run or instance
    std::uint32_t first = 0;
    std::uint32_t count = 0;
};

/// Counts pieces of work done, tells the user, and stops when asked to.
class FrontEndProgress {
  public:
    explicit FrontEndProgress(const FrontEndOptions& options) : options_(options) {}

    /// A new pass of `pieces` pieces that ends when `share_at_end` of all work is done.
    void begin_pass(std::size_t pieces, double share_at_end);
    /// One piece is about to be done. Throws sim::Interrupted.
    void begin_piece() const;
    void end_piece();

  private:
    const FrontEndOptions& options_;
    std::mutex mutex_;
    std::size_t pieces_ = 0, done_ = 0;
    double share_at_begin_ = 0, share_at_end_ = 0, last_told_ = 0;
};

struct FrontEndPlan {
    const Resources& resources;
    const View& view;
    const FrontEndOptions& options;
    FrontEndProgress progress;
    std::vector<PlannedState> states;       ///< at least one; parallel to FrontEndOptions::states
    std::vector<PlannedInstance> instances; ///< parallel to FragmentStream::draws
    std::vector<PlannedVertices> runs;
    std::vector<ScreenVertex> vertices;
    std::vector<ClipDistances> distances;
    std::vector<glm::vec4> varyings;
    std::vector<float> point_sizes;

    FrontEndPlan(const Resources& resources_, const View& view_, const FrontEndOptions& options_)
        : resources(resources_), view(view_), options(options_), progress(options_) {}

    /// What becomes of a primitive of these vertices.
    void cull_and_clip(const PlannedInstance& instance, const std::array<std::uint32_t, 3>& vertices_of_primitive,
                       PrimitiveParts& parts) const {
        const PlannedState& state = *instance.state;
        const PrimitiveCorners whole = corners(instance, vertices_of_primitive);
        switch (corners_of(instance.geometry->topology)) {
        case 1:
            return cull_point(state.viewport, whole, parts);
        case 2:
            return cull_and_clip_line(state.viewport, *state.state, whole, parts);
        default:
            return pipeline::cull_and_clip(state.viewport, instance.culling, whole, parts);
        }
    }

    const ScreenVertex& vertex_of(const PlannedInstance& instance, std::uint32_t vertex) const {
        const PlannedVertices& run = runs[instance.run];
        return vertices[run.first_vertex + (vertex - run.used.first)];
    }
    /// Of a vertex of an instance that is drawn with a program.
    std::span<const glm::vec4> varyings_of(const PlannedInstance& instance, std::uint32_t vertex) const {
        const PlannedVertices& run = runs[instance.run];
        const std::size_t place = vertex - run.used.first;
        return std::span(varyings).subspan(run.first_varying + place * run.shape.varyings, run.shape.varyings);
    }

  private:
    PrimitiveCorners corners(const PlannedInstance& instance,
                             const std::array<std::uint32_t, 3>& vertices_of_primitive) const {
        const PlannedVertices& run = runs[instance.run];
        const bool cut = instance.state->state->clip_planes != 0;
        PrimitiveCorners result;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t place = vertices_of_primitive[i] - run.used.first;
            result.vertices[i] = vertices.data() + run.first_vertex + place;
            if (cut) result.distances[i] = distances.data() + run.first_distance + place;
        }
        const bool of_vertex = run.shape.point_size && instance.state->state->point_size_of_vertex;
        result.point_size = of_vertex ? point_sizes[run.first_size + vertices_of_primitive[0] - run.used.first]
                                      : instance.state->state->point_size;
        return result;
    }
};

/// Fills plan.vertices, plan.distances, plan.varyings and plan.point_sizes, and counts the instructions of the runs.
void transform_pass(FrontEndPlan& plan);

/// Fills the stream's primitives, triangles and quads (all but Quad::alive), and the quad counts of its draws.
void coverage_pass(FrontEndPlan& plan, FragmentStream& stream);

/// Fills depths, colours, texture lines and Quad::alive.
void shading_pass(FrontEndPlan& plan, FragmentStream& stream);

} // namespace pipeline
