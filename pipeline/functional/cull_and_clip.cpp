#include "pipeline/functional/cull_and_clip.hpp"

#include "pipeline/functional/clip.hpp"
#include "pipeline/functional/raster_triangle.hpp"

#include <algorithm>

namespace pipeline {

namespace {

/// True when the rectangle around three vertices does not touch the viewport.
bool off_screen(const Viewport& viewport, const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c) {
    // Positions count from the centre of pixel 0.
    constexpr std::int32_t begin = -subpixel_one / 2;
    const auto end_x = begin + static_cast<std::int32_t>(viewport.width()) * subpixel_one;
    const auto end_y = begin + static_cast<std::int32_t>(viewport.height()) * subpixel_one;
    return std::max({a.x, b.x, c.x}) < begin || std::min({a.x, b.x, c.x}) > end_x ||
           std::max({a.y, b.y, c.y}) < begin || std::min({a.y, b.y, c.y}) > end_y;
}

PrimitiveFate fate_of_part(const Viewport& viewport, Culling culling, const ScreenVertex& a, const ScreenVertex& b,
                           const ScreenVertex& c) {
    const std::int64_t area = signed_area(a, b, c);
    if (area == 0) return PrimitiveFate::culled_degenerate;
    if (off_screen(viewport, a, b, c)) return PrimitiveFate::culled_outside;
    const bool culled = area > 0 ? culling == Culling::clockwise : culling == Culling::counter_clockwise;
    return culled ? PrimitiveFate::culled_facing : PrimitiveFate::drawn;
}

void clip_into_parts(const Viewport& viewport, Culling culling, const std::array<const ScreenVertex*, 3>& triangle,
                     PrimitiveParts& parts) {
    const ClippedPolygon polygon = clip_triangle(viewport, triangle);
    std::array<ScreenVertex, 9> vertices;
    for (std::uint32_t i = 0; i < polygon.count; ++i) vertices[i] = screen_vertex(viewport, polygon.corners[i]);

    parts.clipped = true;
    bool facing_away = false, beyond_screen = polygon.count == 0;
    for (std::uint32_t i = 2; i < polygon.count; ++i) {
        const std::array<std::uint32_t, 3> fan{0, i - 1, i};
        const PrimitiveFate fate =
            fate_of_part(viewport, culling, vertices[fan[0]], vertices[fan[1]], vertices[fan[2]]);
        facing_away |= fate == PrimitiveFate::culled_facing;
        beyond_screen |= fate == PrimitiveFate::culled_outside;
        if (fate != PrimitiveFate::drawn) continue;
        PrimitivePart& part = parts.parts[parts.count++];
        for (std::size_t corner = 0; corner < 3; ++corner) {
            part.corners[corner] = vertices[fan[corner]];
            part.weights[corner] = glm::vec3(polygon.corners[fan[corner]].weights);
        }
    }
    // The part that came farthest speaks for the primitive.
    parts.fate = parts.count > 0 ? PrimitiveFate::drawn
                 : facing_away   ? PrimitiveFate::culled_facing
                 : beyond_screen ? PrimitiveFate::culled_outside
                                 : PrimitiveFate::culled_degenerate;
}

} // namespace

Culling culling_of(bool double_sided, const glm::mat4& model) {
    if (double_sided) return Culling::none;
    const bool mirrored = glm::determinant(glm::dmat3(glm::dmat4(model))) < 0.0;
    return mirrored ? Culling::counter_clockwise : Culling::clockwise;
}

void cull_and_clip(const Viewport& viewport, Culling culling, const std::array<const ScreenVertex*, 3>& triangle,
                   PrimitiveParts& parts) {
    const ScreenVertex &a = *triangle[0], &b = *triangle[1], &c = *triangle[2];
    const std::uint32_t any = a.outside | b.outside | c.outside;
    const std::uint32_t all = a.outside & b.outside & c.outside;
    parts.count = 0;
    parts.clipped = false;
    if ((any & outside::not_finite) != 0) {
        parts.fate = PrimitiveFate::culled_degenerate;
    } else if ((all & outside::view_volume) != 0) {
        parts.fate = PrimitiveFate::culled_outside;
    } else if ((any & outside::must_clip) != 0) {
        clip_into_parts(viewport, culling, triangle, parts);
    } else {
        parts.fate = fate_of_part(viewport, culling, a, b, c);
        if (parts.fate != PrimitiveFate::drawn) return;
        parts.count = 1;
        parts.parts[0].corners = {a, b, c};
    }
}

} // namespace pipeline
