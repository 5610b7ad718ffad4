#include "tests/replay_oracle/own_replay.hpp"

#include "pipeline/functional/frame_streams.hpp"
#include "pipeline/functional/surface_texel.hpp"
#include "pipeline/functional/vertex_fetch.hpp"
#include "pipeline/reference.hpp"
#include "pipeline/vertex_program.hpp"
#include "sim/check.hpp"
#include "traces/recording/lower.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace replay_oracle {

namespace {

using pipeline::SurfaceFormat;
using pipeline::SurfaceStore;

/// A vertex program that also measures how far vertices are within the sides of the view volume.
class ClippedAtSides final : public pipeline::VertexProgram {
  public:
    /// @param planes those of the user that cut already
    ClippedAtSides(std::shared_ptr<const pipeline::VertexProgram> program, std::uint8_t planes)
        : program_(std::move(program)), shape_(program_->shape()) {
        const auto taken = static_cast<unsigned>(shape_.clip_distances | planes);
        std::size_t found = 0;
        for (std::uint32_t i = 0; i < pipeline::most_clip_distances && found < sides_.size(); ++i)
            if ((taken >> i & 1U) == 0) sides_[found++] = i;
        CHECK(found == sides_.size());
        shape_.clip_distances = static_cast<std::uint8_t>(shape_.clip_distances | mask());
    }

    pipeline::VertexProgramShape shape() const override { return shape_; }
    std::uint8_t mask() const {
        unsigned mask = 0;
        for (const std::uint32_t side : sides_) mask |= 1U << side;
        return static_cast<std::uint8_t>(mask);
    }
    void run(std::uint32_t instance, std::uint32_t first, const pipeline::ProgramVertices& vertices) const override {
        program_->run(instance, first, vertices);
        for (std::size_t i = 0; i < vertices.distances.size(); ++i) {
            const glm::vec4& at = vertices.positions[i];
            const std::array<float, 4> distances{at.w + at.x, at.w - at.x, at.w + at.y, at.w - at.y};
            for (std::size_t side = 0; side < sides_.size(); ++side)
                vertices.distances[i][sides_[side]] = distances[side];
        }
    }

  private:
    std::shared_ptr<const pipeline::VertexProgram> program_;
    pipeline::VertexProgramShape shape_;
    std::array<std::uint32_t, 4> sides_{}; ///< planes that are free
};

std::uint8_t code_of(float value) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0F, 1.0F) * 255.0F));
}

/// A texel as glReadPixels gives it: what an sRGB surface holds is not decoded.
void read_pixel(SurfaceFormat format, const std::byte* texel, std::uint8_t* rgba) {
    if (format == SurfaceFormat::srgb8a8) {
        std::copy(texel, texel + 4, reinterpret_cast<std::byte*>(rgba));
        return;
    }
    const glm::vec4 colour = pipeline::unpack_texel(format, texel);
    for (int c = 0; c < 4; ++c) rgba[c] = code_of(colour[c]);
}

std::optional<Picture> picture_of(const SurfaceStore& surfaces, pipeline::SurfaceId surface,
                                  const traces::TargetSet::Target& target, const traces::TargetSet& targets) {
    const pipeline::SurfaceInfo& info = surfaces.info(surface);
    if (is_integer(info.format) || !is_colour(info.format) || target.level >= info.levels ||
        info.width_of(target.level) < targets.width || info.height_of(target.level) < targets.height)
        return std::nullopt;
    Picture picture{targets.width, targets.height, {}};
    picture.rgba.resize(std::size_t{targets.width} * targets.height * 4);
    const std::uint32_t first_row = target.plane * info.rows_between_planes(target.level);
    for (std::uint32_t row = 0; row < targets.height; ++row)
        for (std::uint32_t x = 0; x < targets.width; ++x) {
            const std::uint32_t from_top = targets.top_row_first ? row : targets.height - 1 - row;
            read_pixel(info.format, surfaces.read(surface, {x, first_row + row, target.level}),
                       &picture.rgba[(std::size_t{from_top} * targets.width + x) * 4]);
        }
    return picture;
}

} // namespace

OwnFrame::OwnFrame(const traces::Recording& recording, std::uint32_t frame)
    : recording_(recording),
      number_(frame),
      frame_(traces::lower(recording, {.first_frame = frame, .last_frame = frame}, "replay")),
      surfaces_(frame_.surfaces) {
    frame_.check_targets();
    std::vector<std::uint32_t> drawn; // of all frames up to this one; clears and copies draw a geometry of their own
    for (std::uint32_t i = 0; i < frame_.draws.size(); ++i)
        if (frame_.draws[i].geometry < recording.resources->geometries.size()) drawn.push_back(i);
    for (const traces::RecordedCommand& command : recording.frames[frame].commands)
        if (const auto* draw = std::get_if<traces::RecordedDraw>(&command)) recorded_.push_back(draw);
    CHECK(drawn.size() >= recorded_.size());
    lowered_.assign(drawn.end() - static_cast<std::ptrdiff_t>(recorded_.size()), drawn.end());
    for (const pipeline::Pass& pass : frame_.passes) add_step(pass);
    step_of_draw_.assign(frame_.draws.size(), steps_.size());
    for (std::size_t i = 0; i < steps_.size(); ++i)
        for (const std::uint32_t draw : steps_[i].draws) step_of_draw_[draw] = i;
}

void OwnFrame::add_step(const pipeline::Pass& pass) {
    if (pass.kind != pipeline::PassKind::draw) {
        steps_.push_back(pass);
        return;
    }
    for (std::size_t i = 0; i < pass.draws.size(); ++i) {
        pipeline::Pass& step = steps_.emplace_back(pass);
        step.draws = {pass.draws[i]};
        step.states = {pass.states[pass.state_of_draw.empty() ? 0 : pass.state_of_draw[i]]};
        step.state_of_draw.clear();
    }
}

std::uint64_t OwnFrame::run(std::size_t number) {
    const pipeline::Pass& step = steps_[number];
    if (step.kind == pipeline::PassKind::clear) {
        for (const pipeline::SurfaceId surface : step.clears) surfaces_.clear(surface);
        return 0;
    }
    before_ = surfaces_;
    frame_.passes = {step};
    return run_reference_pass(frame_, step, rasterize_frame(frame_).front(), surfaces_);
}

std::optional<std::uint64_t> OwnFrame::execute(std::size_t draw) {
    executed_ = draw;
    const std::size_t step = step_of_draw_[lowered_[draw]];
    if (step == steps_.size()) return std::nullopt;
    CHECK(step >= next_);
    std::uint64_t samples = 0;
    while (next_ <= step) samples = run(next_++);
    return samples;
}

std::uint64_t OwnFrame::samples_clipped_at_sides() const {
    pipeline::Frame clipped = frame_;
    pipeline::Pass& step = clipped.passes.front();
    pipeline::RasterState& state = step.states.front();
    pipeline::Draw& draw = clipped.draws[step.draws.front()];
    const auto program = std::make_shared<const ClippedAtSides>(draw.program, state.clip_planes);
    draw.program = program;
    state.clip_planes = static_cast<std::uint8_t>(state.clip_planes | program->mask());
    SurfaceStore surfaces = before_;
    return run_reference_pass(clipped, step, rasterize_frame(clipped).front(), surfaces);
}

std::optional<Picture> OwnFrame::picture() const {
    const std::size_t step = step_of_draw_[lowered_[executed_]];
    const traces::TargetSet& targets = recording_.targets[recorded_[executed_]->targets];
    if (step == steps_.size()) return std::nullopt;
    for (std::size_t i = 0; i < targets.colours.size(); ++i) {
        if (!targets.colours[i]) continue;
        const std::vector<pipeline::SurfaceId>& drawn = steps_[step].targets;
        if (i >= drawn.size() || drawn[i] == pipeline::no_surface) return std::nullopt;
        return picture_of(surfaces_, drawn[i], *targets.colours[i], targets);
    }
    return std::nullopt;
}

Picture OwnFrame::shown() {
    while (next_ < steps_.size()) run(next_++);
    const traces::TargetSet& targets = recording_.targets[recording_.frames[number_].shown];
    for (const auto& target : targets.colours)
        if (target && frame_.output != pipeline::no_surface)
            return picture_of(surfaces_, frame_.output, *target, targets).value_or(Picture{});
    return {};
}

const pipeline::Geometry& OwnFrame::geometry(std::size_t draw) const {
    return frame_.resources->geometries[recorded_[draw]->geometry];
}

std::uint64_t OwnFrame::vertices(std::size_t draw) const {
    return std::uint64_t{geometry(draw).index_count} * recorded_[draw]->instances;
}

std::uint64_t OwnFrame::primitives(std::size_t draw) const {
    return std::uint64_t{geometry(draw).primitive_count()} * recorded_[draw]->instances;
}

std::vector<glm::vec4> OwnFrame::positions(std::size_t draw) const {
    const pipeline::Geometry& of = geometry(draw);
    const pipeline::VertexProgram& program = *lowered(draw).program;
    const pipeline::VertexProgramShape shape = program.shape();
    const bool mirrored = !recording_.targets[recorded_[draw]->targets].top_row_first; // y is turned over for these
    const pipeline::IndexReader index_at(*frame_.resources, of);
    std::vector<glm::vec4> made(of.vertex_count), varyings(std::size_t{of.vertex_count} * shape.varyings), positions;
    std::vector<float> sizes(shape.point_size ? of.vertex_count : 0);
    std::vector<pipeline::ClipDistances> distances(shape.clip_distances != 0 ? of.vertex_count : 0);
    for (std::uint32_t instance = 0; instance < recorded_[draw]->instances; ++instance) {
        program.run(instance, 0,
                    {.positions = made, .varyings = varyings, .point_sizes = sizes, .distances = distances});
        for (std::uint32_t i = 0; i < of.index_count; ++i) {
            const std::uint32_t vertex = index_at(i);
            if (of.primitive_restart && vertex == restart_index(of.index_type)) continue;
            positions.push_back(made[vertex]);
            if (mirrored) positions.back().y = -positions.back().y;
        }
    }
    return positions;
}

} // namespace replay_oracle
