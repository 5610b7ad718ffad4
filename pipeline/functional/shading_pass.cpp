// The last pass of the front end: depth, colour and alpha test of every quad.
//
// A piece of work is a run of quads; the triangle they belong to is set up again from its vertices, which is cheaper
// than keeping the setup of millions of triangles. A group of sample quads belongs to the piece in which it begins.
//
// Pixels of several samples are shaded at their centres, or, where the triangle does not cover the centre, at the first
// sample that it covers (centroid): colours stay within those of the corners. As on real hardware, a quad with such
// pixels then sees slightly wrong derivatives.
#include "pipeline/functional/front_end_passes.hpp"
#include "pipeline/functional/interpolation.hpp"
#include "pipeline/functional/parallel.hpp"
#include "pipeline/functional/points_lines.hpp"
#include "pipeline/functional/raster_triangle.hpp"
#include "pipeline/functional/shader.hpp"
#include "pipeline/functional/varyings.hpp"
#include "sim/large_pages.hpp"

#include <algorithm>
#include <atomic>
#include <optional>

namespace pipeline {

namespace {

constexpr std::size_t quads_per_piece = 8192;

bool has_sprites(const PlannedInstance& instance) {
    return instance.geometry->topology == Topology::points && instance.state->state->point_sprites;
}

ShaderOptions shader_options(const FrontEndPlan& plan, const PlannedInstance& instance) {
    const FrontEndOptions& options = plan.options;
    const bool flat = options.fragment_colour == FragmentColour::flat;
    return {.colours = options.colours,
            .normals = options.normals,
            .map_texcoords = options.map_texcoords,
            .fragment_colour = options.fragment_colour,
            .perspective = plan.view.projection[2][3] != 0.0F,
            .textures = options.textures && !flat,
            .alpha_test = options.alpha_test && !flat,
            .sprites = has_sprites(instance)};
}

FragmentShader make_shader(const FrontEndPlan& plan, const PlannedInstance& instance) {
    return {plan.resources,
            *instance.geometry,
            *instance.material,
            plan.view.view * *instance.model,
            shader_options(plan, instance),
            instance.instance};
}

/// True when some draw's shader reads a texture.
bool textures_are_read(const FrontEndPlan& plan) {
    return std::any_of(plan.instances.begin(), plan.instances.end(), [&](const PlannedInstance& instance) {
        return plan.runs[instance.run].program == nullptr && instance.material->base_texture >= 0 &&
               make_shader(plan, instance).samples();
    });
}

/// Shades a run of quads.
class Shading {
  public:
    Shading(const FrontEndPlan& plan, FragmentStream& stream) : plan_(plan), stream_(stream) {}

    /// Returns how many fragments were discarded.
    std::uint64_t run(std::size_t begin, std::size_t end) {
        std::uint64_t discarded = 0;
        while (begin < end && begin != 0 && stream_.quads[begin - 1].more != 0) ++begin;
        for (std::size_t i = begin; i < end;) {
            const std::uint32_t triangle = stream_.quads[i].triangle;
            if (i == begin || triangle != current_triangle_) enter_triangle(triangle);
            const std::span<Quad> group(stream_.quads.own().data() + i, stream_.quads[i].more + std::size_t{1});
            shade(i, group);
            for (const Quad& quad : group) discarded += pixels_in(static_cast<unsigned>(quad.covered ^ quad.alive));
            i += group.size();
        }
        return discarded;
    }

  private:
    void enter_instance(std::uint32_t primitive) {
        const std::uint32_t range = stream_.range_of(primitive);
        range_ = &stream_.draws[range];
        instance_ = &plan_.instances[range];
        program_ = plan_.runs[instance_->run].program != nullptr;
        shader_.reset();
        if (!program_) shader_.emplace(make_shader(plan_, *instance_));
        reader_.emplace(plan_.resources, *instance_->geometry, range_->first_triangle);
    }

    void enter_triangle(std::uint32_t number) {
        current_triangle_ = number;
        const std::uint32_t primitive = stream_.triangles[number].primitive;
        if (range_ == nullptr || primitive - range_->first_primitive >= range_->primitives) enter_instance(primitive);

        const auto vertices = (*reader_)(primitive - range_->first_primitive);
        plan_.cull_and_clip(*instance_, vertices, parts_);
        const PrimitivePart& part = parts_.parts[number - stream_.primitives[primitive].first_triangle];
        set_up_part(part);
        const RasterState& state = *instance_->state->state;
        const auto* clipped = parts_.clipped ? &part.weights : nullptr;
        const std::size_t provoking = reader_->provoking(primitive - range_->first_primitive, state.provoking);
        if (program_) enter_varyings(vertices, part, clipped, provoking);
        if (!shades()) return;
        triangle_ = shader_->triangle(vertices, clipped, provoking);
        if (!has_sprites(*instance_)) return;
        const std::array<glm::vec2, 3> sprite{{{0.0F, 0.0F}, {1.0F, 0.0F}, {0.0F, 1.0F}}};
        for (std::size_t i = 0; i < 3; ++i) triangle_.corners[i].texcoord = sprite[i];
    }

    bool shades() const { return shader_ && shader_->needed(); }

    void enter_varyings(const std::array<std::uint32_t, 3>& vertices, const PrimitivePart& part,
                        const std::array<glm::vec3, 3>* clipped, std::size_t provoking) {
        std::array<std::span<const glm::vec4>, 3> given;
        glm::vec3 w(0.0F);
        for (std::size_t i = 0; i < 3; ++i) {
            given[i] = plan_.varyings_of(*instance_, vertices[i]);
            w[static_cast<int>(i)] = plan_.vertex_of(*instance_, vertices[i]).clip.w;
        }
        varyings_.begin(plan_.runs[instance_->run].shape, given, w, part.corners, clipped, provoking);
    }

    void set_up_part(const PrimitivePart& part) {
        const PlannedState& state = *instance_->state;
        corners_ = corners_of(instance_->geometry->topology);
        if (corners_ == 2) {
            line_.emplace(RasterLine(part.corners[0], part.corners[1], state.state->line_width), part.corners[0],
                          part.corners[1], state.state->depth);
            return;
        }
        raster_ = set_up(part.corners[0], part.corners[1], part.corners[2], state.viewport);
        depth_.emplace(raster_, part.corners);
        depth_->bound(state.state->depth);
        if (corners_ == 3) depth_->add_bias(state.state->depth, plan_.options.depth_step);
        if (program_ || shades()) attributes_.emplace(raster_, part.corners);
    }

    Lanes depths(std::int32_t x, std::int32_t y, std::uint32_t sample) const {
        return corners_ == 2 ? line_->depths(x, y) : depth_->at(x, y, pattern_[sample]);
    }

    CornerWeights weights(std::int32_t x, std::int32_t y, unsigned covered, std::span<const Quad> group) const {
        if (corners_ == 2) return line_->weights(x, y);
        if (pattern_.size() == 1 || corners_ == 1) return attributes_->at(x, y, covered);
        return attributes_->at(x, y, covered, centroids(x, y, group));
    }

    void shade(std::size_t first, std::span<Quad> group) {
        const std::int32_t x = group[0].x;
        const auto y = static_cast<std::int32_t>(group[0].y - group[0].sample * plane_rows_);
        unsigned covered = 0;
        for (std::size_t n = 0; n < group.size(); ++n) {
            Quad& quad = group[n];
            stream_.depths.own()[first + n] = depths(x, y, quad.sample);
            quad.alive = quad.covered;
            covered |= quad.covered;
        }
        if (program_) {
            const auto of_first = stream_.varyings_of(static_cast<QuadId>(first));
            const std::size_t each = of_first.size();
            const std::span given(stream_.given_varyings.own().data() +
                                      (of_first.data() - stream_.given_varyings.data()),
                                  each * group.size());
            varyings_.interpolate(weights(x, y, covered, group), corners_ == 1, given);
            for (std::size_t n = 1; n < group.size(); ++n) std::copy_n(given.data(), each, given.data() + n * each);
        }
        if (!shades()) return;
        const FragmentShader::Output output = shader_->shade(triangle_, weights(x, y, covered, group), covered);
        for (std::size_t n = 0; n < group.size(); ++n) {
            group[n].alive &= output.alive;
            if (!stream_.colours.empty()) stream_.colours[first + n] = output.colours;
            if (!stream_.given_normals.empty()) stream_.given_normals.own()[first + n] = output.normals;
            if (!stream_.given_texcoords.empty()) {
                stream_.given_texcoords.own()[first + n] = output.texcoords;
                stream_.given_tangents.own()[first + n] = triangle_.tangent;
            }
            if (!stream_.texture_lines.empty()) stream_.texture_lines.own()[first + n] = output.texture_line;
        }
    }

    /// Where each pixel is shaded. Of pixels without a covered sample, their centres.
    std::array<SampleOffset, 4> centroids(std::int32_t x, std::int32_t y, std::span<const Quad> group) const {
        std::array<SampleOffset, 4> places{};
        for (std::int32_t pixel = 0; pixel < 4; ++pixel) {
            if (detail::EdgeValues::at(raster_, x + pixel % 2, y + pixel / 2).covered()) continue;
            const auto covering = std::find_if(group.begin(), group.end(),
                                               [pixel](const Quad& quad) { return (quad.covered >> pixel & 1) != 0; });
            if (covering != group.end()) places[static_cast<std::size_t>(pixel)] = pattern_[covering->sample];
        }
        return places;
    }

    const FrontEndPlan& plan_;
    FragmentStream& stream_;
    std::span<const SampleOffset> pattern_ = sample_pattern(plan_.view.samples);
    std::uint32_t plane_rows_ = plane_rows(plan_.view.height, plan_.view.samples);
    const DrawRange* range_ = nullptr;
    const PlannedInstance* instance_ = nullptr;
    std::optional<FragmentShader> shader_; ///< none where the draw has a program
    bool program_ = false;
    VaryingPlanes varyings_;
    std::optional<PrimitiveReader> reader_;
    RasterTriangle raster_{};
    std::optional<DepthPlane> depth_;
    std::optional<AttributePlanes> attributes_;
    std::optional<LinePlane> line_;
    std::uint32_t corners_ = 3; ///< of the present primitive
    PrimitiveParts parts_;
    ShaderTriangle triangle_;
    std::uint32_t current_triangle_ = 0;
};

/// What the quads of the stream take, the textures' lines aside.
std::uint64_t bytes_of_quads(const FrontEndOptions& options, const FragmentStream& stream, std::uint64_t varyings) {
    constexpr std::uint64_t value = sizeof(std::array<glm::vec4, 4>);
    const std::uint64_t values =
        (options.colours ? 1U : 0U) + (options.normals ? 1U : 0U) + (options.map_texcoords ? 1U : 0U);
    const std::uint64_t tangent = options.map_texcoords ? sizeof(glm::vec4) : 0;
    return stream.quads.size() * (sizeof(Quad) + sizeof(std::array<float, 4>) + tangent + values * value) +
           varyings * value;
}

/// Returns how many there are.
std::uint64_t lay_out_varyings(const FrontEndPlan& plan, FragmentStream& stream) {
    std::uint64_t all = 0;
    std::vector<VaryingRun> runs;
    for (std::size_t i = 0; i < plan.instances.size(); ++i) {
        const DrawRange& range = stream.draws[i];
        const PlannedVertices& vertices = plan.runs[plan.instances[i].run];
        const std::uint32_t each = vertices.program == nullptr ? 0 : vertices.shape.varyings + 1;
        if (range.quads == 0) continue;
        if (runs.empty() || runs.back().each != each) runs.push_back({range.first_quad, each, all});
        all += std::uint64_t{range.quads} * each;
    }
    if (all != 0) stream.varying_runs = std::move(runs);
    return all;
}

} // namespace

void shading_pass(FrontEndPlan& plan, FragmentStream& stream) {
    const std::size_t quads = stream.quads.size();
    const std::uint64_t varyings = lay_out_varyings(plan, stream);
    if (plan.options.about_to_shade)
        plan.options.about_to_shade(stream, bytes_of_quads(plan.options, stream, varyings));
    sim::resize_in_large_pages(stream.depths.own(), quads);
    if (plan.options.colours) sim::resize_in_large_pages(stream.colours, quads);
    if (plan.options.normals) sim::resize_in_large_pages(stream.given_normals.own(), quads);
    if (plan.options.map_texcoords) {
        sim::resize_in_large_pages(stream.given_texcoords.own(), quads);
        sim::resize_in_large_pages(stream.given_tangents.own(), quads);
    }
    sim::resize_in_large_pages(stream.given_varyings.own(), varyings);
    if (textures_are_read(plan)) stream.texture_lines.own().resize(quads, ~0U);

    const std::size_t pieces = (quads + quads_per_piece - 1) / quads_per_piece;
    plan.progress.begin_pass(pieces, 1.0);
    std::atomic<std::uint64_t> discarded{0};
    parallel_for(plan.options.threads, pieces, [&](std::size_t i) {
        plan.progress.begin_piece();
        Shading shading(plan, stream);
        discarded += shading.run(i * quads_per_piece, std::min((i + 1) * quads_per_piece, quads));
        plan.progress.end_piece();
    });
    stream.fragments_discarded = discarded;
}

} // namespace pipeline
