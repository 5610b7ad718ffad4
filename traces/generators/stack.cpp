// Layers that cover the same pixels: the chain of updates of a pixel in its purest form (specification 004, K1).
#include "traces/generators/screen.hpp"
#include "traces/generators/table.hpp"

namespace traces {

namespace {

struct StackParams {
    std::uint32_t n = 64;
    std::uint32_t x = 8;
    std::uint32_t y = 8;
    std::uint32_t w = 2;
    std::uint32_t h = 2;
    DepthOrder order = DepthOrder::front_to_back;
    std::uint64_t seed = 1;

    static constexpr auto fields() {
        using P = StackParams;
        return std::tuple(sim::field<&P::n>("layers").range(1, 4'000'000),
                          sim::field<&P::x>("left edge of the rectangle").unit("px").range(0, 16384),
                          sim::field<&P::y>("top edge of the rectangle").unit("px").range(0, 16384),
                          sim::field<&P::w>("width of the rectangle").unit("px").range(1, 16384),
                          sim::field<&P::h>("height of the rectangle").unit("px").range(1, 16384),
                          sim::field<&P::order>("order in which the layers are drawn"),
                          sim::field<&P::seed>("of the random order"));
    }
};
static_assert(sim::fully_described<StackParams>);

Scene build(const StackParams& params) {
    // A 2x2 block at even coordinates is one quad of the rasterizer.
    const bool one_quad = params.w == 2 && params.h == 2 && params.x % 2 == 0 && params.y % 2 == 0;
    const auto corner = glm::vec2(params.x, params.y);
    Mesh mesh;
    mesh.name = "stack";
    std::uint64_t layer = 0;
    for (const float depth : layer_depths(params.n, params.order, params.seed)) {
        const Colour colour = colour_of(layer++);
        if (one_quad)
            add_one_quad_triangle(mesh, corner.x, corner.y, depth, colour, false);
        else
            add_rectangle(mesh, corner, glm::vec2(params.w, params.h), depth, colour);
    }
    return screen_scene(mesh);
}

struct QuadsParams {
    std::uint32_t n = 100;
    DepthOrder order = DepthOrder::front_to_back;
    std::uint64_t seed = 1;

    static constexpr auto fields() {
        using P = QuadsParams;
        return std::tuple(sim::field<&P::n>("layers").range(1, 100'000),
                          sim::field<&P::order>("order in which the layers are drawn"),
                          sim::field<&P::seed>("of the random order"));
    }
};
static_assert(sim::fully_described<QuadsParams>);

Scene build_quads(const QuadsParams& params) {
    Mesh mesh;
    mesh.name = "quads";
    std::uint64_t layer = 0;
    for (const float depth : layer_depths(params.n, params.order, params.seed))
        add_rectangle(mesh, glm::vec2(0.0F), glm::vec2(1.0F), depth, colour_of(layer++));
    Scene scene = screen_scene(mesh);
    scene.screen_extent = glm::vec2(1.0F);
    return scene;
}

} // namespace

Generator stack_generator() {
    return make_generator<StackParams>(
        "stack", "n layers over one rectangle; 2x2 pixels at even coordinates are one triangle and one quad per layer",
        build);
}

Generator quads_generator() {
    return make_generator<QuadsParams>(
        "quads", "n layers of two triangles each over the whole screen, whatever its size", build_quads);
}

} // namespace traces
