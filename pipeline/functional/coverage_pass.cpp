// The first two passes of the front end: vertices to the screen, primitives to quads.
#include "pipeline/functional/front_end_passes.hpp"
#include "pipeline/functional/lanes.hpp"
#include "pipeline/functional/parallel.hpp"
#include "pipeline/functional/points_lines.hpp"
#include "pipeline/functional/raster_triangle.hpp"
#include "pipeline/functional/sample_walk.hpp"
#include "sim/check.hpp"
#include "sim/large_pages.hpp"

#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

namespace pipeline {

namespace {

constexpr std::uint32_t vertices_per_piece = 8192;
constexpr std::uint32_t primitives_per_piece = 2048;
constexpr std::uint64_t largest_count = std::numeric_limits<std::uint32_t>::max();

void cut_into_pieces(std::vector<PlannedPiece>& pieces, std::uint32_t of, std::uint32_t count, std::uint32_t size) {
    for (std::uint32_t first = 0; first < count; first += std::min(size, count - first))
        pieces.push_back({of, first, std::min(size, count - first)});
}

/// What a piece of primitives becomes. Numbers count from the piece's own first triangle and quad.
struct CoveredPiece {
    std::vector<Triangle> triangles;
    std::vector<Quad> quads;
    std::uint64_t groups = 0;
    std::uint64_t fragments = 0;
    std::uint32_t first_triangle = 0; ///< in the stream
    QuadId first_quad = 0;            ///< in the stream
};

class Coverage {
  public:
    Coverage(const FrontEndPlan& plan, FragmentStream& stream, const PlannedPiece& piece, CoveredPiece& output)
        : plan_(plan),
          stream_(stream),
          output_(output),
          range_(stream.draws[piece.of]),
          instance_(plan.instances[piece.of]),
          read_(plan.resources, *instance_.geometry, range_.first_triangle) {
        output_.triangles.reserve(piece.count);
        for (std::uint32_t i = 0; i < piece.count; ++i) cover(piece.first + i);
    }

  private:
    void cover(std::uint32_t primitive) {
        plan_.cull_and_clip(instance_, read_(primitive), parts_);
        Primitive& result = stream_.primitives.own()[range_.first_primitive + primitive];
        result.first_triangle = static_cast<std::uint32_t>(output_.triangles.size());
        result.triangles = static_cast<std::uint8_t>(parts_.count);
        result.fate = parts_.fate;
        result.clipped = parts_.clipped;
        for (std::uint32_t part = 0; part < parts_.count; ++part)
            rasterize_part(range_.first_primitive + primitive, parts_.parts[part]);
    }

    void rasterize_part(std::uint32_t primitive, const PrimitivePart& part) {
        const auto number = static_cast<std::uint32_t>(output_.triangles.size());
        const std::size_t first = output_.quads.size();
        const auto add = [&](std::int32_t x, std::int32_t y, std::uint32_t mask) { add_group(number, x, y, mask); };
        const std::uint32_t tiles = for_each_group(part, add);
        output_.triangles.push_back({range_.draw, primitive, static_cast<QuadId>(first),
                                     static_cast<std::uint32_t>(output_.quads.size() - first), tiles,
                                     signed_area(part.corners[0], part.corners[1], part.corners[2]) < 0});
    }

    // Returns the tiles that are visited.
    template <class Add>
    std::uint32_t for_each_group(const PrimitivePart& part, const Add& add) const {
        const std::uint32_t samples = plan_.view.samples;
        const Viewport& viewport = instance_.state->viewport;
        const std::uint32_t corners = corners_of(instance_.geometry->topology);
        if (corners == 3 && samples == 1)
            return for_each_quad(set_up(part.corners[0], part.corners[1], part.corners[2], viewport), add);
        if (corners == 3) return for_each_sampled_quad(part.corners, viewport, samples, add);
        const float width = instance_.state->state->line_width;
        const CoveredQuads covered =
            corners == 1 ? quads_of_rectangle(PointSquare::pixels(part.corners), viewport.scissored())
                         : quads_of_line(RasterLine(part.corners[0], part.corners[1], width), viewport.drawn());
        const std::uint32_t all_samples = 0x11111111U >> 4 * (most_samples - samples);
        for (const CoveredQuad& quad : covered.quads) add(quad.x, quad.y, quad.mask * all_samples);
        return covered.tiles;
    }

    // The quads of the samples that are covered; four bits of the mask for each sample.
    void add_group(std::uint32_t triangle, std::int32_t x, std::int32_t y, std::uint32_t mask) {
        const std::uint32_t plane = plane_rows(plan_.view.height, plan_.view.samples);
        ++output_.groups;
        for (std::uint32_t sample = 0; mask != 0; ++sample, mask >>= 4U) {
            if ((mask & 15U) == 0) continue;
            std::uint32_t more = 0;
            for (std::uint32_t left = mask >> 4U; left != 0; left >>= 4U) more += (left & 15U) != 0 ? 1U : 0U;
            output_.quads.push_back({static_cast<std::uint16_t>(x),
                                     static_cast<std::uint16_t>(static_cast<std::uint32_t>(y) + sample * plane),
                                     triangle, static_cast<std::uint8_t>(mask & 15U), 0,
                                     static_cast<std::uint8_t>(sample), static_cast<std::uint8_t>(more)});
            output_.fragments += pixels_in(mask);
        }
    }

    const FrontEndPlan& plan_;
    FragmentStream& stream_;
    CoveredPiece& output_;
    const DrawRange& range_;
    const PlannedInstance& instance_;
    PrimitiveReader read_;
    PrimitiveParts parts_;
};

void place(std::vector<CoveredPiece>& covered, FragmentStream& stream) {
    std::uint64_t triangles = 0, quads = 0;
    for (CoveredPiece& piece : covered) {
        piece.first_triangle = static_cast<std::uint32_t>(triangles);
        piece.first_quad = static_cast<QuadId>(quads);
        triangles += piece.triangles.size();
        quads += piece.quads.size();
        stream.groups += piece.groups;
        stream.fragments += piece.fragments;
        if (triangles > largest_count) throw sim::InputError("scene: expected at most 2^32 - 1 triangles in a pass");
    }
    sim::resize_in_large_pages(stream.triangles.own(), triangles);
    sim::resize_in_large_pages(stream.quads.own(), quads);
}

/// Moves a piece to its place in the stream.
void store(const PlannedPiece& piece, CoveredPiece& covered, FragmentStream& stream) {
    Triangle* triangle = stream.triangles.own().data() + covered.first_triangle;
    for (Triangle source : covered.triangles) {
        source.first_quad += covered.first_quad;
        *triangle++ = source;
    }
    Quad* quad = stream.quads.own().data() + covered.first_quad;
    for (Quad source : covered.quads) {
        source.triangle += covered.first_triangle;
        *quad++ = source;
    }
    Primitive* primitive = stream.primitives.own().data() + stream.draws[piece.of].first_primitive + piece.first;
    for (std::uint32_t i = 0; i < piece.count; ++i) primitive[i].first_triangle += covered.first_triangle;
    covered = CoveredPiece{};
}

void count_quads_of_draws(const std::vector<PlannedPiece>& pieces, const std::vector<CoveredPiece>& covered,
                          FragmentStream& stream) {
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        DrawRange& range = stream.draws.own()[pieces[i].of];
        if (pieces[i].first == 0) range.first_quad = covered[i].first_quad;
        range.quads += static_cast<std::uint32_t>(covered[i].quads.size());
    }
    // Instances without primitives have no piece.
    QuadId next = 0;
    for (DrawRange& range : stream.draws.own()) {
        if (range.primitives == 0) range.first_quad = next;
        next = range.first_quad + range.quads;
    }
}

/// Returns the instructions that it took.
std::uint64_t run_program(FrontEndPlan& plan, const PlannedVertices& run, const PlannedPiece& piece) {
    const PlannedState& state = plan.states[run.state];
    const auto part = [&piece](auto& list, std::uint64_t first, std::size_t of_each) {
        return std::span(list).subspan(first + piece.first * of_each, piece.count * of_each);
    };
    std::vector<glm::vec4> positions(piece.count);
    std::vector<std::uint32_t> instructions(piece.count);
    ProgramVertices made{.positions = positions,
                         .varyings = part(plan.varyings, run.first_varying, run.shape.varyings),
                         .point_sizes = part(plan.point_sizes, run.first_size, run.shape.point_size ? 1 : 0),
                         .distances = part(plan.distances, run.first_distance, state.state->clip_planes != 0 ? 1 : 0),
                         .instructions = instructions};
    run.program->run(run.instance, run.used.first + piece.first, made);
    for (std::uint32_t i = 0; i < piece.count; ++i) {
        ScreenVertex& vertex = plan.vertices[run.first_vertex + piece.first + i];
        vertex = place_vertex(state.viewport, positions[i]);
        if (made.distances.empty()) continue;
        for (std::uint32_t plane = 0; plane < most_clip_distances; ++plane) {
            const bool cuts = (state.state->clip_planes >> plane & 1U) != 0;
            float& distance = made.distances[i][plane];
            if (!cuts) distance = 0.0F;
            if (!std::isfinite(distance)) vertex.outside = outside::not_finite;
            if (distance < 0.0F) vertex.outside |= outside::user_plane(plane);
        }
    }
    return std::accumulate(instructions.begin(), instructions.end(), std::uint64_t{0});
}

} // namespace

void transform_pass(FrontEndPlan& plan) {
    std::vector<PlannedPiece> pieces;
    for (std::uint32_t i = 0; i < plan.runs.size(); ++i)
        cut_into_pieces(pieces, i, plan.runs[i].used.end - plan.runs[i].used.first, vertices_per_piece);
    std::vector<std::uint64_t> instructions(pieces.size());
    plan.progress.begin_pass(pieces.size(), 0.05);
    parallel_for(plan.options.threads, pieces.size(), [&](std::size_t i) {
        plan.progress.begin_piece();
        const PlannedPiece& piece = pieces[i];
        const PlannedVertices& run = plan.runs[piece.of];
        if (run.program != nullptr) {
            instructions[i] = run_program(plan, run, piece);
            plan.progress.end_piece();
            return;
        }
        const glm::mat4 matrix = clip_matrix(plan.view, *run.model);
        const AttributeReader position(plan.resources, *run.geometry->find(Semantic::position), run.instance);
        ScreenVertex* target = plan.vertices.data() + run.first_vertex + piece.first;
        const PlannedState& state = plan.states[run.state];
        for (std::uint32_t vertex = 0; vertex < piece.count; ++vertex)
            target[vertex] = transform_vertex(matrix, state.viewport, position(run.used.first + piece.first + vertex));
        if (state.state->clip_planes != 0) {
            const UserPlanes planes(*state.state, glm::dmat4(plan.view.view) * glm::dmat4(*run.model));
            ClipDistances* distances = plan.distances.data() + run.first_distance + piece.first;
            for (std::uint32_t vertex = 0; vertex < piece.count; ++vertex)
                distances[vertex] = planes.measure(position(run.used.first + piece.first + vertex), target[vertex]);
        }
        plan.progress.end_piece();
    });
    for (std::size_t i = 0; i < pieces.size(); ++i) plan.runs[pieces[i].of].instructions += instructions[i];
}

void coverage_pass(FrontEndPlan& plan, FragmentStream& stream) {
    std::vector<PlannedPiece> pieces;
    for (std::uint32_t i = 0; i < plan.instances.size(); ++i)
        cut_into_pieces(pieces, i, stream.draws[i].primitives, primitives_per_piece);
    plan.progress.begin_pass(pieces.size(), 0.4);
    std::vector<CoveredPiece> covered(pieces.size());
    std::atomic<std::uint64_t> quads{0};
    parallel_for(plan.options.threads, pieces.size(), [&](std::size_t i) {
        plan.progress.begin_piece();
        const Coverage coverage(plan, stream, pieces[i], covered[i]);
        if (quads.fetch_add(covered[i].quads.size()) + covered[i].quads.size() > largest_count)
            throw sim::InputError(
                "scene: expected at most 2^32 - 1 quads in a pass; a smaller picture or fewer draws have less");
        plan.progress.end_piece();
    });
    place(covered, stream);
    count_quads_of_draws(pieces, covered, stream);
    parallel_for(plan.options.threads, pieces.size(), [&](std::size_t i) { store(pieces[i], covered[i], stream); });
}

} // namespace pipeline
