#include "pipeline/functional/shade_pass.hpp"

#include "pipeline/functional/lanes.hpp"
#include "pipeline/functional/parallel.hpp"
#include "pipeline/sample_planes.hpp"
#include "sim/check.hpp"
#include "sim/large_pages.hpp"

#include <algorithm>
#include <atomic>
#include <fmt/format.h>
#include <span>

namespace pipeline {

namespace {

constexpr std::size_t quads_of_piece = 4096;

/// Shades a run of quads; a group belongs to the piece in which it begins.
class GroupShading {
  public:
    GroupShading(const Pass& pass, FragmentStream& stream, const SurfaceStore& surfaces, const ShaderShape& shape)
        : shader_(*pass.shader),
          stream_(stream),
          quads_(stream.quads.own()),
          depths_(shape.sets_depth ? &stream.depths.own() : nullptr),
          access_(surfaces, pass.reads) {}

    /// Returns how many fragments were discarded.
    std::uint64_t run(std::size_t begin, std::size_t end) {
        while (begin < end && begin != 0 && stream_.quads[begin - 1].more != 0) ++begin;
        std::uint64_t discarded = 0;
        for (std::size_t first = begin; first < end;) {
            const std::size_t after = first + stream_.quads[first].more + 1;
            discarded += run_group(first, after);
            first = after;
        }
        return discarded;
    }

  private:
    std::uint64_t run_group(std::size_t first, std::size_t after) {
        const ShaderInput input = shader_input(stream_, static_cast<QuadId>(first));
        ShaderOutput output;
        output.alive = input.pixels;
        output.depth = input.depth;
        shader_.shade(input, access_, output);
        std::uint64_t discarded = 0;
        for (std::size_t quad = first; quad < after; ++quad) {
            const unsigned before = stream_.quads[quad].alive;
            quads_[quad].alive = static_cast<std::uint8_t>(before & output.alive);
            discarded += pixels_in(before & ~output.alive);
            if (depths_ != nullptr)
                for (std::size_t lane = 0; lane < 4; ++lane)
                    (*depths_)[quad][lane] = output.depth[lane] > 0.0F ? std::min(output.depth[lane], 1.0F) : 0.0F;
            keep_outputs(output, static_cast<QuadId>(quad), stream_);
        }
        return discarded;
    }

    const Shader& shader_;
    FragmentStream& stream_;
    std::vector<Quad>& quads_;                  ///< its own
    std::vector<std::array<float, 4>>* depths_; ///< its own, where the shader sets them
    SurfaceAccess access_;
};

} // namespace

ShaderInput shader_input(const FragmentStream& stream, QuadId first) {
    const Quad& quad = stream.quads[first];
    const Triangle& triangle = stream.triangles[quad.triangle];
    ShaderInput input;
    input.x = quad.x;
    input.y = quad.y - quad.sample * plane_rows(stream.height, stream.samples);
    input.pixels = 0;
    for (QuadId sample = first; sample <= first + quad.more; ++sample) input.pixels |= stream.quads[sample].covered;
    input.draw = triangle.draw;
    input.front = triangle.front;
    input.depth = stream.depths[first];
    if (!stream.given_colours.empty()) input.colour = stream.given_colours[first];
    if (!stream.given_normals.empty()) input.normal = stream.given_normals[first];
    if (!stream.given_texcoords.empty()) {
        input.texcoords = stream.given_texcoords[first];
        input.tangent = stream.given_tangents[first];
    }
    input.varyings = stream.varyings_of(first);
    return input;
}

void make_outputs(const ShaderShape& shape, FragmentStream& stream) {
    const std::size_t quads = stream.quads.size();
    sim::resize_in_large_pages(stream.colours, quads);
    stream.more_outputs.resize(shape.outputs - 1);
    for (auto& output : stream.more_outputs) sim::resize_in_large_pages(output, quads);
}

void keep_outputs(const ShaderOutput& output, QuadId quad, FragmentStream& stream) {
    stream.colours[quad] = output.colours[0];
    for (std::size_t i = 0; i < stream.more_outputs.size(); ++i) stream.more_outputs[i][quad] = output.colours[i + 1];
}

bool shades_late(const Pass& pass, const FragmentStream& stream) {
    if (pass.kind != PassKind::screen || pass.shader == nullptr || pass.runs_program() || stream.samples != 1)
        return false;
    const ShaderShape shape = pass.shader->shape();
    const auto is_written = [&pass](SurfaceId surface) {
        return surface == pass.depth ||
               std::find(pass.targets.begin(), pass.targets.end(), surface) != pass.targets.end();
    };
    return pass.reads_surfaces() && !shape.discards && !shape.sets_depth &&
           std::none_of(pass.reads.begin(), pass.reads.end(), is_written);
}

void shade(const Pass& pass, FragmentStream& stream, const SurfaceStore& surfaces, unsigned threads) {
    const ShaderShape shape = pass.shader->shape();
    CHECK_MSG(shape.outputs >= 1 && shape.outputs <= most_targets_of_pass && pass.targets.size() <= shape.outputs,
              fmt::format("pass {}: {} targets, and its shader has {} outputs", pass.name, pass.targets.size(),
                          shape.outputs));
    CHECK_MSG(pass.reads.size() == shape.reads, fmt::format("pass {}: {} surfaces to read, and its shader knows {}",
                                                            pass.name, pass.reads.size(), shape.reads));
    const std::size_t quads = stream.quads.size();
    stream.quads.own(); // before several threads ask for them
    if (shape.sets_depth) stream.depths.own();
    make_outputs(shape, stream);
    std::atomic<std::uint64_t> discarded{0};
    parallel_for(threads, (quads + quads_of_piece - 1) / quads_of_piece, [&](std::size_t piece) {
        GroupShading shading(pass, stream, surfaces, shape);
        discarded += shading.run(piece * quads_of_piece, std::min((piece + 1) * quads_of_piece, quads));
    });
    stream.fragments_discarded += discarded;
}

const FragmentStream& shade_pass(const Pass& pass, const FragmentStream& stream, const SurfaceStore& surfaces,
                                 FragmentStream& kept, unsigned threads) {
    if (pass.shader == nullptr || !pass.reads_surfaces()) return stream;
    kept = stream;
    shade(pass, kept, surfaces, threads);
    return kept;
}

} // namespace pipeline
