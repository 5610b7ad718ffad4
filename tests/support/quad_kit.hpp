// A pass of quads made by hand, for tests of the units that rasterize, shade and store them.
//
//     tests::QuadPass pass(64, 64);
//     pass.triangle();
//     pass.quad(0, 0);
//     pipeline::Rasterizer rasterizer(rig.context("rasterizer"), params, pass.context);
#pragma once

#include "models/programs/library.hpp"
#include "pipeline/fragment/messages.hpp"
#include "pipeline/fragment/pass_context.hpp"
#include "pipeline/geometry/messages.hpp"
#include "pipeline/memory/messages.hpp"
#include "tests/support/counting.hpp"

#include <bit>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

namespace tests {

class QuadPass {
  public:
    pipeline::FragmentStream stream;
    pipeline::PassContext context; ///< ends in depth_colour, without depth test and colour write, unless changed

    /// A k-buffer of `k` entries of kind `entry` is there for whoever uses it.
    explicit QuadPass(std::uint32_t width = 64, std::uint32_t height = 64, std::uint32_t partitions = 1,
                      std::uint32_t k = 4, std::string_view entry = "z")
        : program_(models::make_program("nearest-k", entry, k)) {
        stream.width = width;
        stream.height = height;
        context.stream = &stream;
        context.program = program_.get();
        context.layout = {width, height, partitions};
        context.shader_costs = {{1, 0, 1}};
    }
    QuadPass(const QuadPass&) = delete;
    QuadPass& operator=(const QuadPass&) = delete;

    /// Begins a triangle of `draw`; besides the tiles of its quads it visits `empty_tiles`, at least one tile in all.
    std::uint32_t triangle(std::uint32_t draw = 0, std::uint32_t empty_tiles = 0) {
        const auto quads = static_cast<pipeline::QuadId>(stream.quads.size());
        stream.triangles.own().push_back({draw, 0, quads, 0, empty_tiles});
        if (context.shader_costs.size() <= draw) context.shader_costs.resize(draw + 1, {1, 0, 1});
        return static_cast<std::uint32_t>(stream.triangles.size() - 1);
    }

    /// Adds a quad to the last triangle; tiles come in the order of the stream.
    pipeline::QuadId quad(std::uint32_t x, std::uint32_t y, std::uint8_t mask = 15, float depth = 0.5F) {
        if (stream.triangles.empty()) triangle();
        pipeline::Triangle& owner = stream.triangles.own().back();
        const auto tile = [](const pipeline::Quad& quad) { return quad.y / 8 * 4096 + quad.x / 8; };
        const pipeline::Quad quad{static_cast<std::uint16_t>(x),
                                  static_cast<std::uint16_t>(y),
                                  static_cast<std::uint32_t>(stream.triangles.size() - 1),
                                  mask,
                                  mask,
                                  0};
        if (owner.quads == 0 || tile(quad) != tile(stream.quads.back())) ++owner.tiles;
        ++owner.quads;
        stream.quads.own().push_back(quad);
        stream.depths.own().push_back({depth, depth, depth, depth});
        stream.colours.push_back({});
        return static_cast<pipeline::QuadId>(stream.quads.size() - 1);
    }

    /// `count` quads of one triangle, row by row over the picture.
    void quads(std::uint32_t count, float depth = 0.5F) {
        for (std::uint32_t i = 0; i < count; ++i)
            quad(i * 2 % stream.width, i * 2 / stream.width * 2 % stream.height, 15, depth);
    }

    /// The pass writes one colour target of this format, as far as values go; its bytes are four a pixel.
    void write_colours(pipeline::SurfaceFormat format = pipeline::SurfaceFormat::rgba8) {
        context.targets = {format};
        context.colours = {{0, 4}};
    }

    const pipeline::ModifyProgram& program() const { return *program_; }

    std::vector<pipeline::TriangleTask> triangle_tasks() const {
        std::vector<pipeline::TriangleTask> tasks;
        for (std::uint32_t i = 0; i < stream.triangles.size(); ++i) tasks.push_back({i});
        return tasks;
    }
    /// One task per quad, as the rasterizer sends them; sequence is the quad's number.
    std::vector<pipeline::QuadTask> quad_tasks() const {
        std::vector<pipeline::QuadTask> tasks;
        for (std::uint32_t i = 0; i < stream.quads.size(); ++i) {
            pipeline::QuadTask task;
            task.quad = i;
            task.sequence = i;
            task.mask = stream.quads[i].alive;
            tasks.push_back(task);
        }
        return tasks;
    }

  private:
    std::shared_ptr<const pipeline::ModifyProgram> program_;
};

/// The quads of a list of messages.
template <class Message>
std::vector<pipeline::QuadId> quads_of(const std::vector<Message>& messages) {
    std::vector<pipeline::QuadId> quads;
    for (const Message& message : messages) quads.push_back(message.quad);
    return quads;
}

} // namespace tests
