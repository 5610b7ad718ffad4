// Small scenes for the functional front end, stated by the test.
#pragma once

#include "pipeline/draw.hpp"
#include "pipeline/frame.hpp"
#include "pipeline/functional/front_end.hpp"

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace tests {

/// A triangle list; attributes that are empty are left out. No indices: not indexed.
struct MeshData {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;
    std::vector<glm::vec4> colours;
    std::vector<glm::vec2> texcoords;
    std::vector<std::uint32_t> indices;
};

/// Resources, draws and a view. Material 0 is unlit white and double-sided.
struct FunctionalScene {
    pipeline::Resources resources;
    std::vector<pipeline::Draw> draws;
    pipeline::View view;

    /// A view of width x height pixels in which model coordinates are pixels (x right, y down) and window depth.
    FunctionalScene(std::uint32_t width, std::uint32_t height);

    /// Adds a geometry and a draw of it; returns the draw's number.
    std::uint32_t add(const MeshData& mesh, std::uint32_t material = 0, const glm::mat4& model = glm::mat4(1.0F));
    std::uint32_t add_material(const pipeline::Material& material);
    std::uint32_t add_texture(const pipeline::Texture& texture);

    /// Places and validates the resources and rasterizes all draws.
    pipeline::FragmentStream rasterize(const pipeline::FrontEndOptions& options = {});
    std::vector<std::uint32_t> all_draws() const;
};

/// Surfaces of frames that are put together by hand: the first two have the frame's formats and background, the third
/// runs its program.
enum FrameSurface : pipeline::SurfaceId { depth_surface, colour_surface, kbuffer_surface };
/// Gives the frame these surfaces, of the size of its view, and depth to the passes whose states use it.
void bind_surfaces(pipeline::Frame& frame);

pipeline::Buffer buffer_of(const void* data, std::size_t bytes);
template <class Element>
pipeline::Buffer buffer_of(const std::vector<Element>& elements) {
    return buffer_of(elements.data(), elements.size() * sizeof(Element));
}

/// One level of width x height texels of these RGBA codes, in row order.
pipeline::Texture texture_of(std::uint32_t width, std::uint32_t height, const std::vector<std::uint32_t>& rgba_codes);
/// 0xRRGGBBAA
pipeline::Texture texture_of_one_colour(std::uint32_t width, std::uint32_t height, std::uint32_t rgba_code);

/// Covered fragments per pixel.
std::vector<std::uint32_t> coverage_counts(const pipeline::FragmentStream& stream);

/// Two triangles over the rectangle [x0,x1] x [y0,y1] at a depth, with texcoords 0..1 and indices.
MeshData rectangle(float x0, float y0, float x1, float y1, float depth = 0.5F);

/// Both streams hold the same bytes.
bool equal(const pipeline::FragmentStream& a, const pipeline::FragmentStream& b);

} // namespace tests
