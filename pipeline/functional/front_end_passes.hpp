// The passes of the front end over a shared plan. Each is a loop over independent pieces of work.
#pragma once

#include "pipeline/fragment_stream.hpp"
#include "pipeline/functional/cull_and_clip.hpp"
#include "pipeline/functional/front_end.hpp"
#include "pipeline/functional/vertex_fetch.hpp"

#include <mutex>

namespace pipeline {

/// Vertices that are transformed by one matrix, for all instances whose indices lie among them.
struct PlannedVertices {
    const Geometry* geometry = nullptr; ///< one of those that read them
    const glm::mat4* model = nullptr;
    VertexRange used;
    std::uint64_t first_vertex = 0; ///< where they lie in FrontEndPlan::vertices
};

/// One instance of one draw.
struct PlannedInstance {
    const Geometry* geometry = nullptr;
    const Material* material = nullptr;
    const glm::mat4* model = nullptr;
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
    Viewport viewport;
    FrontEndProgress progress;
    std::vector<PlannedInstance> instances; ///< parallel to FragmentStream::draws
    std::vector<PlannedVertices> runs;
    std::vector<ScreenVertex> vertices;

    FrontEndPlan(const Resources& resources_, const View& view_, const FrontEndOptions& options_)
        : resources(resources_),
          view(view_),
          options(options_),
          viewport(view_.width, view_.height),
          progress(options_) {}

    /// The three transformed vertices of a primitive.
    std::array<const ScreenVertex*, 3> corners(const PlannedInstance& instance,
                                               const std::array<std::uint32_t, 3>& vertices_of_primitive) const {
        const ScreenVertex* base = vertices.data() + runs[instance.run].first_vertex;
        const std::uint32_t first = runs[instance.run].used.first;
        return {base + (vertices_of_primitive[0] - first), base + (vertices_of_primitive[1] - first),
                base + (vertices_of_primitive[2] - first)};
    }
};

/// Fills plan.vertices.
void transform_pass(FrontEndPlan& plan);

/// Fills the stream's primitives, triangles and quads (all but Quad::alive), and the quad counts of its draws.
void coverage_pass(FrontEndPlan& plan, FragmentStream& stream);

/// Fills depths, colours, texture lines and Quad::alive.
void shading_pass(FrontEndPlan& plan, FragmentStream& stream);

} // namespace pipeline
