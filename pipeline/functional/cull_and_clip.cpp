#include "pipeline/functional/cull_and_clip.hpp"

#include "pipeline/functional/points_lines.hpp"
#include "pipeline/functional/raster_triangle.hpp"

#include <algorithm>

namespace pipeline {

namespace {

/// True when the rectangle around three vertices does not touch the pixels.
bool off_screen(const PixelBounds& pixels, const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c) {
    if (pixels.empty()) return true;
    // Positions count from the centre of pixel 0.
    const auto border = [](std::int32_t pixel) { return pixel * subpixel_one - subpixel_one / 2; };
    return std::max({a.x, b.x, c.x}) < border(pixels.left) || std::min({a.x, b.x, c.x}) > border(pixels.right) ||
           std::max({a.y, b.y, c.y}) < border(pixels.top) || std::min({a.y, b.y, c.y}) > border(pixels.bottom);
}

PrimitiveFate fate_of_part(const Viewport& viewport, Culling culling, const ScreenVertex& a, const ScreenVertex& b,
                           const ScreenVertex& c) {
    const std::int64_t area = signed_area(a, b, c);
    if (area == 0) return PrimitiveFate::culled_degenerate;
    if (off_screen(viewport.visible(), a, b, c)) return PrimitiveFate::culled_outside;
    const Culling facing = area > 0 ? Culling::clockwise : Culling::counter_clockwise;
    const bool culled = culling == facing || culling == Culling::both;
    return culled ? PrimitiveFate::culled_facing : PrimitiveFate::drawn;
}

void clip_into_parts(const Viewport& viewport, Culling culling, const PrimitiveCorners& triangle,
                     PrimitiveParts& parts) {
    const ClippedPolygon polygon = clip_triangle(viewport, triangle);
    std::array<ScreenVertex, most_clipped_corners> vertices;
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

Culling culling_of(const RasterState& state) {
    if (state.culling == FaceCulling::none) return Culling::none;
    if (state.culling == FaceCulling::both) return Culling::both;
    return (state.culling == FaceCulling::front) == state.front_is_clockwise ? Culling::clockwise
                                                                             : Culling::counter_clockwise;
}

void cull_and_clip(const Viewport& viewport, Culling culling, const PrimitiveCorners& triangle, PrimitiveParts& parts) {
    const ScreenVertex &a = *triangle.vertices[0], &b = *triangle.vertices[1], &c = *triangle.vertices[2];
    const std::uint32_t any = a.outside | b.outside | c.outside;
    const std::uint32_t all = a.outside & b.outside & c.outside;
    parts.count = 0;
    parts.clipped = false;
    if ((any & outside::not_finite) != 0) {
        parts.fate = PrimitiveFate::culled_degenerate;
    } else if ((all & (outside::view_volume | outside::user_planes)) != 0) {
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

void cull_point(const Viewport& viewport, const PrimitiveCorners& point, PrimitiveParts& parts) {
    const ScreenVertex& centre = *point.vertices[0];
    parts.count = 0;
    parts.clipped = false;
    if ((centre.outside & outside::not_finite) != 0) {
        parts.fate = PrimitiveFate::culled_degenerate;
    } else if ((centre.outside & (outside::view_volume | outside::user_planes)) != 0 || viewport.visible().empty()) {
        parts.fate = PrimitiveFate::culled_outside;
    } else {
        parts.fate = PrimitiveFate::drawn;
        parts.count = 1;
        parts.parts[0].corners = PointSquare(centre, point.point_size).corners(centre);
    }
}

void cull_and_clip_line(const Viewport& viewport, const RasterState& state, const PrimitiveCorners& line,
                        PrimitiveParts& parts) {
    const ScreenVertex &a = *line.vertices[0], &b = *line.vertices[1];
    const std::uint32_t any = a.outside | b.outside, all = a.outside & b.outside;
    PrimitivePart& part = parts.parts[0];
    parts.count = 0;
    parts.clipped = false;
    parts.fate = PrimitiveFate::culled_outside;
    if ((any & outside::not_finite) != 0) {
        parts.fate = PrimitiveFate::culled_degenerate;
        return;
    }
    if ((all & (outside::view_volume | outside::user_planes)) != 0) return;
    if ((any & outside::must_clip) != 0) {
        const ClippedPolygon ends = clip_line(viewport, line);
        parts.clipped = true;
        if (ends.count == 0) return;
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const ClippedCorner& end = ends.corners[corner == 0 ? 0 : 1];
            part.corners[corner] = screen_vertex(viewport, end);
            part.weights[corner] = glm::vec3(end.weights);
        }
    } else {
        part.corners = {a, b, b};
    }
    const ScreenVertex &from = part.corners[0], &to = part.corners[1];
    const std::int32_t reach = RasterLine(from, to, state.line_width).width();
    const PixelBounds& visible = viewport.visible();
    const PixelBounds touched{visible.left - reach, visible.top - reach, visible.right + reach, visible.bottom + reach};
    if (from.x == to.x && from.y == to.y) {
        parts.fate = PrimitiveFate::culled_degenerate;
    } else if (!visible.empty() && !off_screen(touched, from, to, to)) {
        parts.fate = PrimitiveFate::drawn;
        parts.count = 1;
    }
}

} // namespace pipeline
