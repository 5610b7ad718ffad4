#include "pipeline/functional/front_end.hpp"

#include "pipeline/functional/front_end_passes.hpp"
#include "pipeline/functional/sample_pattern.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <tuple>

namespace pipeline {

namespace {

constexpr std::uint32_t largest_rows = 65536;

bool finite(const glm::mat4& matrix) {
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            if (!std::isfinite(matrix[column][row])) return false;
    return true;
}

void check_view(const View& view) {
    if (view.width < 1 || view.width > largest_viewport || view.height < 1 || view.height > largest_viewport)
        throw sim::InputError(fmt::format("view: expected a width and a height of 1 to {} pixels, not {}x{}",
                                          largest_viewport, view.width, view.height));
    if (!is_sample_count(view.samples))
        throw sim::InputError(fmt::format("view: expected 1, 4 or 8 samples per pixel, not {}", view.samples));
    // Rows are numbers of 16 bits, and a surface has no more places than the largest of one sample has pixels.
    constexpr std::size_t most_places = std::size_t{largest_viewport} * largest_viewport;
    if (view.rows() > largest_rows || view.places() > most_places)
        throw sim::InputError(
            fmt::format("view: {} samples per pixel: expected at most {} rows and {} pixels, not {}x{}", view.samples,
                        largest_rows / view.samples, most_places / view.samples, view.width, view.height));
    if (!finite(view.view) || !finite(view.projection))
        throw sim::InputError("view: expected matrices of finite numbers");
}

void check_draw(const Resources& resources, const std::vector<Draw>& draws, std::uint32_t index) {
    if (index >= draws.size())
        throw sim::InputError(fmt::format("draw {}: expected one of {} draws", index, draws.size()));
    const Draw& draw = draws[index];
    const auto require = [&](bool good, const char* expected) {
        if (!good) throw sim::InputError(fmt::format("draw {} \"{}\": expected {}", index, draw.name, expected));
    };
    require(draw.geometry < resources.geometries.size(), "the number of an existing geometry");
    require(draw.material < resources.materials.size(), "the number of an existing material");
    require(!draw.instances.empty(), "at least one instance");
    for (const glm::mat4& model : draw.instances) require(finite(model), "model matrices of finite numbers");
    const Geometry& geometry = resources.geometries[draw.geometry];
    require(draw.program != nullptr || geometry.find(Semantic::position) != nullptr, "positions, or a vertex program");
    require(draw.program == nullptr || draw.program->shape().varyings <= most_varyings, "at most 64 varyings");
    for (const VertexAttribute& attribute : geometry.attributes)
        require(has_elements_for(resources, attribute, draw.instances.size()), "attributes for all its instances");
}

bool finite(const RasterState& state) {
    bool good = std::isfinite(state.depth.bias_slope) && std::isfinite(state.depth.bias_constant) &&
                std::isfinite(state.point_size) && std::isfinite(state.line_width);
    for (std::uint32_t i = 0; i < most_clip_distances; ++i)
        for (int axis = 0; axis < 4; ++axis) good &= std::isfinite(state.clip_plane[i][axis]);
    return good;
}

void check_states(const FrontEndOptions& options, std::size_t draws) {
    for (std::size_t i = 0; i < options.states.size(); ++i) {
        const RasterState& state = options.states[i];
        if (state.viewport && !is_usable(*state.viewport))
            throw sim::InputError(fmt::format("state {}: expected a viewport of 1 to {} pixels a side at {} to {}, not "
                                              "{}x{} at ({}, {})",
                                              i, largest_viewport, -farthest_viewport, farthest_viewport,
                                              state.viewport->width, state.viewport->height, state.viewport->x,
                                              state.viewport->y));
        if (!finite(state)) throw sim::InputError(fmt::format("state {}: expected finite numbers", i));
        if (!is_usable(state.depth))
            throw sim::InputError(fmt::format("state {}: expected a depth range within 0 to 1, not {} to {}", i,
                                              state.depth.range_near, state.depth.range_far));
    }
    if (options.state_of_draw.empty()) return;
    if (options.state_of_draw.size() != draws)
        throw sim::InputError(
            fmt::format("states: expected one of each of {} draws, not {}", draws, options.state_of_draw.size()));
    for (const std::uint32_t number : options.state_of_draw)
        if (number >= options.states.size())
            throw sim::InputError(fmt::format("state {}: expected one of {} states", number, options.states.size()));
}

/// Whether vertices become the same under both.
bool alike(const PlannedState& a, const PlannedState& b) {
    return a.viewport == b.viewport && a.state->clip_planes == b.state->clip_planes &&
           (a.state->clip_planes == 0 || a.state->clip_plane == b.state->clip_plane);
}

std::vector<PlannedState> plan_states(const View& view, std::span<const RasterState> states) {
    static const RasterState ordinary;
    if (states.empty()) states = {&ordinary, 1};
    std::vector<PlannedState> planned;
    for (const RasterState& state : states) {
        PlannedState next{&state, Viewport(view.width, view.height, state), 0};
        const auto first =
            std::find_if(planned.begin(), planned.end(), [&](const PlannedState& other) { return alike(other, next); });
        next.alike = static_cast<std::uint32_t>(first - planned.begin());
        planned.push_back(next);
    }
    return planned;
}

/// Finds the vertices of instances. Thousands of small draws may read the same ones: those are transformed once, or the
/// vertices would grow with the product of draws and index range.
class VertexRuns {
  public:
    explicit VertexRuns(std::vector<PlannedVertices>& runs) : runs_(runs) {}

    std::uint32_t run_of(const Geometry& geometry, const glm::mat4& model, std::uint32_t instance, std::uint32_t state,
                         const VertexRange& used) {
        const auto next = static_cast<std::uint32_t>(runs_.size());
        std::uint32_t& last = last_.try_emplace(key_of(geometry, model, instance, state), next).first->second;
        if (last < next && join(runs_[last].used, used)) return last;
        runs_.push_back({.geometry = &geometry, .model = &model, .used = used, .instance = instance, .state = state});
        return last = next;
    }
    /// Those of a vertex program: parts of a draw share them, other draws do not.
    std::uint32_t run_of(const VertexProgram& program, const Geometry& geometry, const glm::mat4& model,
                         std::uint32_t instance, std::uint32_t state, const VertexRange& used) {
        const auto next = static_cast<std::uint32_t>(runs_.size());
        const auto [known, added] = of_programs_.try_emplace({&program, instance, state, used.first, used.end}, next);
        if (!added) return known->second;
        runs_.push_back({.geometry = &geometry,
                         .model = &model,
                         .used = used,
                         .instance = instance,
                         .state = state,
                         .program = &program,
                         .shape = program.shape()});
        return next;
    }

  private:
    using Key = std::tuple<std::uint32_t, std::uint64_t, std::uint32_t, ComponentType, std::uint8_t, bool,
                           std::uint32_t, std::array<std::uint32_t, 16>>;

    // Bits of the matrix: what transforms alike in every bit.
    static Key key_of(const Geometry& geometry, const glm::mat4& model, std::uint32_t instance, std::uint32_t state) {
        const VertexAttribute& position = *geometry.find(Semantic::position);
        const bool advances = position.divisor != 0;
        return {position.buffer,
                position.offset + (advances ? instance / position.divisor * std::uint64_t{position.stride} : 0),
                advances ? 0 : position.stride,
                position.type,
                position.components,
                position.normalized,
                state,
                std::bit_cast<std::array<std::uint32_t, 16>>(model)};
    }

    // Ranges that overlap become one; ranges with a gap between them do not.
    static bool join(VertexRange& run, const VertexRange& used) {
        if (used.first > run.end || run.first > used.end) return false;
        run = {std::min(run.first, used.first), std::max(run.end, used.end)};
        return true;
    }

    std::vector<PlannedVertices>& runs_;
    std::map<Key, std::uint32_t> last_; ///< run that was found last, or as many as there were
    std::map<std::tuple<const VertexProgram*, std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>,
             std::uint32_t>
        of_programs_;
};

/// Lays out the instances or parts, their primitives and their vertices.
class Planner {
  public:
    Planner(FrontEndPlan& plan, FragmentStream& stream, const std::vector<Draw>& draws)
        : plan_(plan), stream_(stream), draws_(draws), checked_(draws.size()), runs_(plan.runs) {}

    void add_whole(std::uint32_t number, std::uint32_t state) {
        check(number);
        const Draw& draw = draws_[number];
        const Geometry& geometry = plan_.resources.geometries[draw.geometry];
        auto known = used_.find(draw.geometry);
        if (known == used_.end()) known = used_.emplace(draw.geometry, used_vertices(plan_.resources, geometry)).first;
        for (std::uint32_t i = 0; i < draw.instances.size(); ++i)
            add({.draw = number, .instance = i, .primitives = geometry.primitive_count()}, state, geometry,
                known->second);
    }

    void add_parts(std::span<const DrawPart> parts) {
        for (const DrawPart& part : parts) {
            check(part.draw);
            const Geometry& list = plan_.resources.geometries.at(part.geometry);
            VertexRange& used = used_.try_emplace(part.geometry, no_vertices).first->second;
            const VertexRange own = used_vertices(plan_.resources, list, 3 * part.first_triangle, 3 * part.triangles);
            if (own.end > own.first) used = {std::min(used.first, own.first), std::max(used.end, own.end)};
        }
        for (std::size_t i = 0; i < parts.size(); ++i) {
            const DrawPart& part = parts[i];
            add({.draw = part.draw,
                 .instance = part.instance,
                 .primitives = part.triangles,
                 .geometry = part.geometry,
                 .first_triangle = part.first_triangle},
                state_of(plan_.options, i), plan_.resources.geometries[part.geometry], used_.at(part.geometry));
        }
    }

    void finish() {
        stream_.draws.own().shrink_to_fit();
        stream_.primitives.own().resize(primitives_);
        std::uint64_t vertices = 0, distances = 0, varyings = 0, sizes = 0;
        for (PlannedVertices& run : plan_.runs) {
            const std::uint32_t count = run.used.end - run.used.first;
            run.first_vertex = vertices;
            run.first_distance = distances;
            vertices += count;
            if (plan_.states[run.state].state->clip_planes != 0) distances += count;
            run.first_varying = varyings;
            run.first_size = sizes;
            varyings += std::uint64_t{count} * run.shape.varyings;
            if (run.shape.point_size) sizes += count;
        }
        plan_.vertices.resize(vertices);
        plan_.distances.resize(distances);
        plan_.varyings.resize(varyings);
        plan_.point_sizes.resize(sizes);
    }

    static std::uint32_t state_of(const FrontEndOptions& options, std::size_t i) {
        return options.state_of_draw.empty() ? 0 : options.state_of_draw[i];
    }

  private:
    static constexpr VertexRange no_vertices{std::numeric_limits<std::uint32_t>::max(), 0};

    void check(std::uint32_t number) {
        if (number < checked_.size() && checked_[number]) return;
        check_draw(plan_.resources, draws_, number);
        checked_[number] = true;
    }

    void add(DrawRange range, std::uint32_t number, const Geometry& geometry, const VertexRange& used) {
        const PlannedState& state = plan_.states[number];
        const Draw& draw = draws_[range.draw];
        const Material& material = plan_.resources.materials[draw.material];
        const glm::mat4& model = draw.instances.at(range.instance);
        const VertexRange some = used.end == 0 ? VertexRange{} : used;
        const Culling culling = state.state->culling == FaceCulling::by_material
                                    ? culling_of(plan_.options.both_faces || material.double_sided, model)
                                    : culling_of(*state.state);
        const std::uint32_t run = draw.program == nullptr
                                      ? runs_.run_of(geometry, model, range.instance, state.alike, some)
                                      : runs_.run_of(*draw.program, geometry, model, range.instance, state.alike, some);
        plan_.instances.push_back({&geometry, &material, &model, &state, range.instance, run, culling});
        if (primitives_ + range.primitives > std::numeric_limits<std::uint32_t>::max())
            throw sim::InputError(
                fmt::format("draw {} \"{}\": expected at most 2^32 - 1 primitives in a pass", range.draw, draw.name));
        range.first_primitive = static_cast<std::uint32_t>(primitives_);
        primitives_ += range.primitives;
        stream_.draws.own().push_back(range);
    }

    FrontEndPlan& plan_;
    FragmentStream& stream_;
    const std::vector<Draw>& draws_;
    std::vector<bool> checked_;
    std::map<std::uint32_t, VertexRange> used_; ///< by geometry
    VertexRuns runs_;
    std::uint64_t primitives_ = 0;
};

void keep_instructions(const FrontEndPlan& plan, FragmentStream& stream) {
    for (std::size_t i = 0; i < plan.instances.size(); ++i) {
        const PlannedVertices& run = plan.runs[plan.instances[i].run];
        const std::uint64_t vertices = run.used.end - run.used.first;
        if (run.instructions != 0)
            stream.draws.own()[i].vertex_instructions =
                static_cast<std::uint32_t>(std::max<std::uint64_t>(1, (run.instructions + vertices / 2) / vertices));
    }
}

template <class Add>
FragmentStream rasterize_planned(const Resources& resources, const std::vector<Draw>& draws, const View& view,
                                 const FrontEndOptions& options, std::size_t parts, const Add& add) {
    check_view(view);
    check_states(options, parts);
    FragmentStream stream;
    stream.width = view.width;
    stream.height = view.height;
    stream.samples = view.samples;
    FrontEndPlan plan(resources, view, options);
    plan.states = plan_states(view, options.states);
    {
        Planner planner(plan, stream, draws);
        add(planner);
        planner.finish();
    }
    transform_pass(plan);
    keep_instructions(plan, stream);
    coverage_pass(plan, stream);
    shading_pass(plan, stream);
    return stream;
}

} // namespace

void FrontEndProgress::begin_pass(std::size_t pieces, double share_at_end) {
    pieces_ = pieces;
    done_ = 0;
    share_at_begin_ = share_at_end_;
    share_at_end_ = share_at_end;
}

void FrontEndProgress::begin_piece() const {
    if (options_.stop != nullptr && options_.stop->load(std::memory_order_relaxed)) throw sim::Interrupted();
}

void FrontEndProgress::end_piece() {
    if (!options_.progress) return;
    const std::lock_guard lock(mutex_);
    ++done_;
    const double share =
        share_at_begin_ + (share_at_end_ - share_at_begin_) * static_cast<double>(done_) / static_cast<double>(pieces_);
    if (share < last_told_ + 0.01 && share < 1.0) return;
    last_told_ = share;
    options_.progress(share);
}

FragmentStream rasterize(const Resources& resources, const std::vector<Draw>& draws,
                         std::span<const std::uint32_t> which, const View& view, const FrontEndOptions& options) {
    return rasterize_planned(resources, draws, view, options, which.size(), [&](Planner& planner) {
        for (std::size_t i = 0; i < which.size(); ++i) planner.add_whole(which[i], Planner::state_of(options, i));
    });
}

FragmentStream rasterize_parts(const Resources& resources, const std::vector<Draw>& draws,
                               std::span<const DrawPart> parts, const View& view, const FrontEndOptions& options) {
    return rasterize_planned(resources, draws, view, options, parts.size(),
                             [parts](Planner& planner) { planner.add_parts(parts); });
}

} // namespace pipeline
