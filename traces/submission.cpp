#include "traces/submission.hpp"

#include "pipeline/functional/vertex_fetch.hpp"
#include "pipeline/vertex_program.hpp"
#include "sim/check.hpp"
#include "traces/screen_draw.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

namespace traces {

namespace {

using pipeline::Draw;
using pipeline::Frame;
using pipeline::Geometry;
using pipeline::Resources;

struct SortedTriangle {
    std::uint32_t draw = 0;
    std::uint32_t instance = 0;
    std::array<std::uint32_t, 3> vertices{};
    std::uint32_t key = 0; ///< grows with the distance from the eye
};

// Floats as integers in the same order: all bits of negative ones turned, the sign of the others (A8, step 2).
std::uint32_t ordered_bits(float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    return (bits & 0x80000000U) != 0 ? ~bits : bits | 0x80000000U;
}

// Least significant digit first, three digits of 11 bits: stable and linear (A8, step 3).
void radix_sort(std::vector<SortedTriangle>& triangles) {
    std::vector<SortedTriangle> other(triangles.size());
    for (std::uint32_t shift = 0; shift < 33; shift += 11) {
        std::array<std::size_t, 2049> begin{};
        for (const SortedTriangle& triangle : triangles) ++begin[(triangle.key >> shift & 2047U) + 1];
        for (std::size_t digit = 1; digit < begin.size(); ++digit) begin[digit] += begin[digit - 1];
        for (const SortedTriangle& triangle : triangles) other[begin[triangle.key >> shift & 2047U]++] = triangle;
        triangles.swap(other);
    }
}

/// Distances of centroids from the eye, of one instance of a draw. Where a program makes the positions, w of clip space
/// is the distance of a perspective projection; of a parallel one, whose w is 1 everywhere, z is.
class CentroidDistance {
  public:
    CentroidDistance(const Frame& frame, const Draw& draw, std::uint32_t instance)
        : to_eye_(glm::dmat4(frame.view_of_kbuffer().view) * glm::dmat4(draw.instances[instance])) {
        const Geometry& geometry = frame.resources->geometries[draw.geometry];
        if (draw.program == nullptr) {
            positions_.emplace(*frame.resources, *geometry.find(pipeline::Semantic::position));
            return;
        }
        const std::uint32_t varyings = draw.program->shape().varyings;
        clip_.resize(geometry.vertex_count);
        std::vector<glm::vec4> unused(std::size_t{geometry.vertex_count} * varyings);
        std::vector<float> sizes(geometry.vertex_count);
        draw.program->run(instance, 0, {.positions = clip_, .varyings = unused, .point_sizes = sizes, .distances = {}});
    }

    double operator()(const std::array<std::uint32_t, 3>& vertices) const {
        if (positions_) {
            glm::dvec3 sum(0.0);
            for (const std::uint32_t vertex : vertices) sum += glm::dvec3(glm::vec3((*positions_)(vertex)));
            return -(to_eye_ * glm::dvec4(sum / 3.0, 1.0)).z;
        }
        glm::dvec4 sum(0.0);
        bool parallel = true;
        for (const std::uint32_t vertex : vertices) {
            sum += glm::dvec4(clip_[vertex]);
            parallel &= clip_[vertex].w == 1.0F;
        }
        return (parallel ? sum.z : sum.w) / 3.0;
    }

  private:
    glm::dmat4 to_eye_;
    std::optional<pipeline::AttributeReader> positions_;
    std::vector<glm::vec4> clip_;
};

void add_triangles(std::vector<SortedTriangle>& triangles, const Frame& frame, std::uint32_t number) {
    const Draw& draw = frame.draws[number];
    const Geometry& geometry = frame.resources->geometries[draw.geometry];
    const pipeline::PrimitiveReader primitives(*frame.resources, geometry);
    for (std::uint32_t instance = 0; instance < draw.instances.size(); ++instance) {
        const CentroidDistance distance_of(frame, draw, instance);
        for (std::uint32_t i = 0; i < geometry.triangle_count(); ++i) {
            SortedTriangle triangle{number, instance, primitives(i), 0};
            const double distance = distance_of(triangle.vertices);
            // What has no place in space is culled later, wherever it stands.
            triangle.key = ordered_bits(std::isfinite(distance) ? static_cast<float>(distance) : 0.0F);
            triangles.push_back(triangle);
        }
    }
}

class Resubmission {
  public:
    Resubmission(const Frame& frame, const pipeline::SubmissionPlan& plan)
        : frame_(frame), plan_(plan), result_(frame), resources_(std::make_shared<Resources>(*frame.resources)) {
        if (plan.flush_draws) add_flush();
    }

    Frame frame() {
        for (std::size_t i = 0; i < frame_.passes.size(); ++i)
            if (frame_.passes[i].runs_program()) resubmit(result_.passes[i]);
        resources_->place();
        result_.resources = resources_;
        return std::move(result_);
    }

  private:
    void resubmit(pipeline::Pass& pass) {
        std::vector<SortedTriangle> triangles;
        for (const std::uint32_t draw : pass.draws) add_triangles(triangles, frame_, draw);
        if (plan_.sort_by_centroid) radix_sort(triangles);
        write_indices(triangles);
        const std::vector<std::uint32_t> lists = add_lists(pass.draws, triangles.size());
        for (std::size_t begin = 0; begin < triangles.size();) {
            const std::size_t end = end_of_draw(triangles, begin);
            const std::uint32_t draw = triangles[begin].draw;
            pass.parts.push_back({draw, triangles[begin].instance, lists[draw], static_cast<std::uint32_t>(begin),
                                  static_cast<std::uint32_t>(end - begin)});
            if (flush_) pass.parts.push_back(*flush_);
            begin = end;
        }
        pass.parts.shrink_to_fit();
        if (!flush_ || triangles.empty()) return;
        pass.draws.push_back(flush_->draw);
        if (!pass.state_of_draw.empty()) pass.state_of_draw.push_back(0);
    }

    // Triangles of one draw and one instance that follow each other, up to the size of a batch.
    std::size_t end_of_draw(const std::vector<SortedTriangle>& triangles, std::size_t begin) const {
        const std::size_t most = plan_.batch_triangles == 0 ? triangles.size() : plan_.batch_triangles;
        std::size_t end = begin + 1;
        while (end < triangles.size() && end - begin < most && triangles[end].draw == triangles[begin].draw &&
               triangles[end].instance == triangles[begin].instance)
            ++end;
        return end;
    }

    void write_indices(const std::vector<SortedTriangle>& triangles) {
        if (triangles.size() > std::numeric_limits<std::uint32_t>::max() / 3)
            throw sim::InputError(
                "the triangles of one pass need more than 2^32 - 1 indices when they are submitted anew");
        pipeline::Buffer buffer;
        buffer.name = "submitted indices";
        buffer.bytes.resize(triangles.size() * 12);
        for (std::size_t i = 0; i < triangles.size(); ++i)
            std::memcpy(buffer.bytes.data() + i * 12, triangles[i].vertices.data(), 12);
        index_buffer_ = static_cast<std::uint32_t>(resources_->buffers.size());
        resources_->buffers.push_back(std::move(buffer));
    }

    // A geometry for each draw: its vertices, and the list of the triangles of all draws, of which its parts are runs.
    // Returns their numbers, by draw.
    std::vector<std::uint32_t> add_lists(const std::vector<std::uint32_t>& draws, std::size_t triangles) {
        std::vector<std::uint32_t> numbers(frame_.draws.size());
        for (const std::uint32_t draw : draws) {
            Geometry geometry = frame_.resources->geometries[frame_.draws[draw].geometry];
            geometry.topology = pipeline::Topology::triangles;
            geometry.index_type = pipeline::IndexType::u32;
            geometry.index_buffer = index_buffer_;
            geometry.index_offset = 0;
            geometry.index_count = static_cast<std::uint32_t>(triangles * 3);
            geometry.primitive_restart = false;
            geometry.runs.clear();
            numbers[draw] = add_geometry(std::move(geometry));
        }
        return numbers;
    }

    std::uint32_t add_geometry(Geometry geometry) {
        resources_->geometries.push_back(std::move(geometry));
        return static_cast<std::uint32_t>(resources_->geometries.size() - 1);
    }

    // The flushing quad writes nothing, so what it costs is its draw call and the time it covers the screen, which the
    // fragment scheduler counts; its own triangle lies in one point.
    void add_flush() {
        BlankDraw blank = add_blank_draw(*resources_, "flush");
        blank.draw.geometry = add_geometry(std::move(blank.geometry));
        flush_ = {static_cast<std::uint32_t>(result_.draws.size()), 0, blank.draw.geometry, 0, 1};
        result_.draws.push_back(std::move(blank.draw));
    }

    const Frame& frame_;
    pipeline::SubmissionPlan plan_;
    Frame result_;
    std::shared_ptr<Resources> resources_;
    std::uint32_t index_buffer_ = 0;
    std::optional<pipeline::DrawPart> flush_; ///< the draw behind each part
};

} // namespace

Frame submitted(const Frame& frame, const pipeline::SubmissionPlan& plan) {
    if (!plan.changes()) return frame;
    return Resubmission(frame, plan).frame();
}

} // namespace traces
