#include "pipeline/functional/quad_sampler.hpp"

#include "pipeline/functional/cube_faces.hpp"
#include "pipeline/functional/surface_texel.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace pipeline {

namespace {

template <class Use>
void for_each_lane(unsigned lanes, Use use) {
    for (std::size_t lane = 0; lane < 4; ++lane)
        if (((lanes >> lane) & 1U) != 0) use(lane);
}

/// Exactly `a` where both are equal.
glm::vec4 mix_texels(const glm::vec4& a, const glm::vec4& b, float share) { return a + (b - a) * share; }

/// Whole numbers as the bits that a lane of floats carries.
glm::vec4 as_lanes(const glm::uvec4& words) {
    glm::vec4 lanes;
    for (int i = 0; i < 4; ++i) lanes[i] = std::bit_cast<float>(words[i]);
    return lanes;
}

bool has_fixed_point_depth(SurfaceFormat format) { return has_depth(format) && format != SurfaceFormat::d32f; }

std::uint32_t whole_bits(float value, bool has_sign) {
    constexpr float largest = 0x1.fffffep30F; // below 2^31
    if (has_sign) return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::clamp(value, -0x1p31F, largest)));
    return static_cast<std::uint32_t>(std::clamp(value, 0.0F, 2 * largest));
}

/// A border's colour as the format would give it: sections 8.14.2 and 8.14.3.
glm::vec4 border_texel(SurfaceFormat format, const glm::vec4& border) {
    const SurfaceFormatInfo& info = info_of(format);
    glm::vec4 texel(0.0F, 0.0F, 0.0F, 1.0F);
    const int channels = has_depth(format) ? 1 : info.channels;
    for (int i = 0; i < channels; ++i) {
        const float value = std::isnan(border[i]) ? 0.0F : border[i];
        const bool fixed_point =
            info.kind == ChannelKind::unorm || info.kind == ChannelKind::srgb || has_fixed_point_depth(format);
        texel[i] = fixed_point                       ? std::clamp(value, 0.0F, 1.0F)
                   : info.kind == ChannelKind::snorm ? std::clamp(value, -1.0F, 1.0F)
                                                     : value;
    }
    if (!is_integer(format)) return texel;
    glm::uvec4 words;
    for (int i = 0; i < 4; ++i) words[i] = whole_bits(texel[i], info.kind == ChannelKind::signed_integer);
    return as_lanes(words);
}

double squared(double value) { return value * value; }

} // namespace

QuadSampler::QuadSampler(SurfaceAccess& surfaces, const TextureView& view, const SamplerState& sampler)
    : surfaces_(surfaces),
      view_(view),
      sampler_(sampler),
      info_(surfaces.info(view.slot)),
      base_(0),
      last_(std::min(view.last_level, info_.levels - 1)),
      integers_(is_integer(info_.format)),
      outside_(border_texel(info_.format, sampler.border)) {
    CHECK(info_.program == nullptr);
    base_ = std::min(view.base_level, last_);
}

/// From a pixel to the next.
std::array<float, 3> QuadSampler::change(const TextureLookup& lookup, std::size_t lane, bool down) const {
    std::array<float, 3> change{};
    for (std::size_t i = 0; i < coordinates_of(view_.kind); ++i) {
        if (lookup.level == LevelOfDetail::gradients)
            change[i] = (down ? lookup.dy : lookup.dx)[i][lane];
        else
            change[i] = lookup.place[i][down ? 2 : 1] - lookup.place[i][0];
    }
    return change;
}

PixelFootprint QuadSampler::footprint(const TextureLookup& lookup, std::size_t lane) const {
    const double width = info_.width_of(base_), height = info_.height_of(base_), depth = info_.planes_of(base_);
    const auto length = [&](bool down) {
        const std::array<float, 3> way = change(lookup, lane, down);
        switch (view_.kind) {
        case TextureKind::cube: {
            const std::array<float, 3> direction{lookup.place[0][lane], lookup.place[1][lane], lookup.place[2][lane]};
            const std::array<double, 2> moved = cube_derivative(cube_place(direction).face, direction, way);
            return squared(moved[0] * width) + squared(moved[1] * height);
        }
        case TextureKind::rectangle:
            return squared(way[0]) + squared(way[1]);
        case TextureKind::volume:
            return squared(way[0] * width) + squared(way[1] * height) + squared(way[2] * depth);
        default:
            return squared(way[0] * width) + squared(way[1] * height); // of lines way[1] is 0
        }
    };
    return {length(false), length(true)};
}

std::array<QuadSampler::LaneLevel, 4> QuadSampler::lane_levels(const TextureLookup& lookup) const {
    std::array<LaneLevel, 4> levels;
    FootprintLevel of_quad;
    if (lookup.level == LevelOfDetail::implicit) of_quad = footprint_level(footprint(lookup, 0), sampler_.anisotropy);
    for_each_lane(lookup.lanes, [&](std::size_t lane) {
        FootprintLevel own = of_quad;
        if (lookup.level == LevelOfDetail::gradients)
            own = footprint_level(footprint(lookup, lane), sampler_.anisotropy);
        else
            own.lod += lookup.lod[lane];
        const LevelReads reads = reads_of_levels(sampler_, bounded_lod(sampler_, own.lod), base_, last_);
        levels[lane] = {reads, own.probes, own.probes_down};
    });
    return levels;
}

std::array<glm::vec2, 4> QuadSampler::levels(const TextureLookup& lookup) const {
    std::array<glm::vec2, 4> result{};
    const std::array<LaneLevel, 4> levels = lane_levels(lookup);
    const float lod = footprint_level(footprint(lookup, 0), sampler_.anisotropy).lod + sampler_.lod_bias;
    for_each_lane(lookup.lanes, [&](std::size_t lane) {
        const LevelReads& reads = levels[lane].reads;
        result[lane] = {static_cast<float>(reads.level - base_) + reads.blend, lod};
    });
    return result;
}

QuadTexels QuadSampler::sample(const TextureLookup& lookup) {
    if (lookup.gathers) return gather(lookup);
    const std::array<LaneLevel, 4> levels = lane_levels(lookup);
    QuadTexels result{};
    for (unsigned left = lookup.lanes & 15U; left != 0;) {
        const LaneLevel& level = levels[static_cast<std::size_t>(std::countr_zero(left))];
        unsigned lanes = 0; // all that read the same levels
        for_each_lane(left, [&](std::size_t lane) { lanes |= levels[lane] == level ? 1U << lane : 0U; });
        const QuadTexels texels = probe(lookup, level, lanes);
        for_each_lane(lanes, [&](std::size_t lane) {
            for (std::size_t i = 0; i < 4; ++i)
                result[lane][static_cast<int>(i)] = swizzled(texels[lane], view_.swizzle[i]);
        });
        left &= ~lanes;
    }
    return result;
}

QuadTexels QuadSampler::probe(const TextureLookup& lookup, const LaneLevel& level, unsigned lanes) {
    QuadTexels sum{};
    Place place = lookup.place;
    for (std::uint32_t i = 1; i <= level.probes; ++i) {
        if (level.probes > 1) {
            const float share = static_cast<float>(i) / static_cast<float>(level.probes + 1) - 0.5F;
            for_each_lane(lanes, [&](std::size_t lane) {
                const std::array<float, 3> way = change(lookup, lane, level.probes_down);
                for (std::size_t c = 0; c < coordinates_of(view_.kind); ++c)
                    place[c][lane] = lookup.place[c][lane] + share * way[c];
            });
        }
        surfaces_.begin_read(view_.slot);
        const LevelReads& reads = level.reads;
        QuadTexels texels = filtered(lookup, place, reads.level, reads.linear, lanes);
        if (reads.blend != 0.0F) {
            const QuadTexels coarse = filtered(lookup, place, reads.level + 1, reads.linear, lanes);
            for_each_lane(
                lanes, [&](std::size_t lane) { texels[lane] = mix_texels(texels[lane], coarse[lane], reads.blend); });
        }
        if (level.probes == 1) return texels;
        for_each_lane(lanes, [&](std::size_t lane) { sum[lane] += texels[lane]; });
    }
    for (glm::vec4& texel : sum) texel /= static_cast<float>(level.probes);
    return sum;
}

LaneIndices QuadSampler::layers(const Lanes& layer) const {
    const std::uint32_t count = std::max(1U, info_.planes / (view_.kind == TextureKind::cube ? 6U : 1U));
    LaneIndices result{};
    for (std::size_t lane = 0; lane < 4; ++lane)
        if (layer[lane] >= 0.5F) // so that what is no number is layer 0
            result[lane] = static_cast<std::int32_t>(std::min(layer[lane] + 0.5F, static_cast<float>(count - 1)));
    return result;
}

AxisReads QuadSampler::axis(const TextureLookup& lookup, const Lanes& values, std::size_t coordinate,
                            std::uint32_t size, Wrap wrap, bool linear) const {
    const auto texels = static_cast<float>(size);
    const bool in_texels = view_.kind == TextureKind::rectangle;
    Lanes places{};
    for (std::size_t lane = 0; lane < 4; ++lane) {
        const auto offset = static_cast<float>(lookup.offset[coordinate][lane]);
        places[lane] = std::isnan(values[lane]) ? 0.0F : values[lane];
        if (offset != 0.0F) places[lane] += in_texels ? offset : offset / texels;
        if (in_texels) places[lane] = std::clamp(places[lane], -1.0F, texels + 1.0F) - (linear ? 0.5F : 0.0F);
    }
    return in_texels ? reads_at(wrap, places, size) : reads_along(wrap, linear, wrapped(wrap, places), size);
}

QuadSampler::Reads QuadSampler::reads_of(const TextureLookup& lookup, const Place& place, std::uint32_t level,
                                         bool linear) const {
    Reads reads{lookup, level, {}, {}, {}, {}};
    if (view_.arrayed) reads.plane = layers(place[coordinates_of(view_.kind)]);
    const std::uint32_t width = info_.width_of(level), height = info_.height_of(level);
    if (view_.kind == TextureKind::cube) {
        Lanes s{}, t{};
        for (std::size_t lane = 0; lane < 4; ++lane) {
            const CubePlace at = cube_place({place[0][lane], place[1][lane], place[2][lane]});
            reads.plane[lane] = reads.plane[lane] * 6 + static_cast<std::int32_t>(at.face);
            s[lane] = at.s;
            t[lane] = at.t;
        }
        // Seamless filters go on where a border would lie.
        const Wrap seamless = linear ? Wrap::border : Wrap::clamp;
        reads.x = axis(lookup, s, 0, width, sampler_.seamless ? seamless : sampler_.wrap_u, linear);
        reads.y = axis(lookup, t, 1, height, sampler_.seamless ? seamless : sampler_.wrap_v, linear);
        return reads;
    }
    reads.x = axis(lookup, place[0], 0, width, sampler_.wrap_u, linear);
    if (coordinates_of(view_.kind) > 1) reads.y = axis(lookup, place[1], 1, height, sampler_.wrap_v, linear);
    if (view_.kind == TextureKind::volume)
        reads.z = axis(lookup, place[2], 2, info_.planes_of(level), sampler_.wrap_w, linear);
    return reads;
}

QuadTexels QuadSampler::filtered(const TextureLookup& lookup, const Place& place, std::uint32_t level, bool linear,
                                 unsigned lanes) {
    linear &= !integers_;
    const Reads reads = reads_of(lookup, place, level, linear);
    const AxisReads &x = reads.x, &y = reads.y, &z = reads.z;
    QuadTexels result{};
    for_each_lane(lanes, [&](std::size_t lane) {
        const auto at = [&](std::int32_t column, std::int32_t row, std::int32_t slice) {
            return texel(reads, lane, column, row, slice);
        };
        const auto slice = [&](std::int32_t k) {
            if (!linear) return at(x.low[lane], y.low[lane], k);
            const float share = x.share[lane];
            const glm::vec4 top = mix_texels(at(x.low[lane], y.low[lane], k), at(x.high[lane], y.low[lane], k), share);
            if (coordinates_of(view_.kind) == 1) return top;
            return mix_texels(top,
                              mix_texels(at(x.low[lane], y.high[lane], k), at(x.high[lane], y.high[lane], k), share),
                              y.share[lane]);
        };
        result[lane] = slice(z.low[lane]);
        if (linear && view_.kind == TextureKind::volume)
            result[lane] = mix_texels(result[lane], slice(z.high[lane]), z.share[lane]);
    });
    return result;
}

QuadTexels QuadSampler::gather(const TextureLookup& lookup) {
    const Swizzle channel = view_.swizzle[lookup.component & 3U];
    const Reads reads = reads_of(lookup, lookup.place, base_, true);
    const AxisReads &x = reads.x, &y = reads.y;
    QuadTexels result{};
    surfaces_.begin_read(view_.slot);
    for_each_lane(lookup.lanes, [&](std::size_t lane) {
        const auto at = [&](std::int32_t column, std::int32_t row) {
            return swizzled(texel(reads, lane, column, row, 0), channel);
        };
        result[lane] = {at(x.low[lane], y.high[lane]), at(x.high[lane], y.high[lane]), at(x.high[lane], y.low[lane]),
                        at(x.low[lane], y.low[lane])};
    });
    return result;
}

glm::vec4 QuadSampler::texel(const Reads& reads, std::size_t lane, std::int32_t column, std::int32_t row,
                             std::int32_t slice) {
    const auto beyond = [](std::int32_t index, std::uint32_t size) {
        return index < 0 || index >= static_cast<std::int32_t>(size);
    };
    const bool volume = view_.kind == TextureKind::volume;
    if (beyond(column, info_.width_of(reads.level)) || beyond(row, info_.height_of(reads.level)) ||
        (volume && beyond(slice, info_.planes_of(reads.level)))) {
        if (view_.kind == TextureKind::cube && sampler_.seamless) return over_edge(reads, lane, column, row);
        return compared(reads.lookup, lane, outside_);
    }
    return stored(reads, lane, column, row, static_cast<std::uint32_t>(volume ? slice : reads.plane[lane]));
}

/// A texel of a cube's next face; at a corner, where there is none, the mean of the three that meet there.
glm::vec4 QuadSampler::over_edge(const Reads& reads, std::size_t lane, std::int32_t column, std::int32_t row) {
    const auto size = static_cast<std::int32_t>(info_.width_of(reads.level));
    const auto plane = static_cast<std::uint32_t>(reads.plane[lane]);
    const std::uint32_t first = plane / 6 * 6;
    const auto next = [&](std::int32_t at_column, std::int32_t at_row) {
        const CubeTexel found = beyond_edge({plane - first, at_column, at_row}, size);
        return stored(reads, lane, found.column, found.row, first + found.face);
    };
    const std::int32_t inner_column = std::clamp(column, 0, size - 1), inner_row = std::clamp(row, 0, size - 1);
    if (inner_column == column || inner_row == row) return next(column, row);
    return (stored(reads, lane, inner_column, inner_row, plane) + next(column, inner_row) + next(inner_column, row)) /
           3.0F;
}

glm::vec4 QuadSampler::stored(const Reads& reads, std::size_t lane, std::int32_t column, std::int32_t row,
                              std::uint32_t plane) {
    return compared(reads.lookup, lane, stored(column, row, plane, reads.level));
}

// A surface that is no cube may be read as one: what it does not have is the border.
glm::vec4 QuadSampler::stored(std::int32_t column, std::int32_t row, std::uint32_t plane, std::uint32_t level) {
    if (plane >= info_.planes_of(level) || static_cast<std::uint32_t>(row) >= info_.height_of(level)) return outside_;
    const auto x = static_cast<std::uint32_t>(column), y = static_cast<std::uint32_t>(row);
    const auto part = std::find_if(view_.parts.begin(), view_.parts.end(),
                                   [&](const TexturePart& one) { return one.level == level && one.plane == plane; });
    const std::byte* bytes =
        part != view_.parts.end()
            ? surfaces_.read_texel(part->slot, {x, y, 0})
            : surfaces_.read_texel(view_.slot, {x, plane * info_.rows_between_planes(level) + y, level});
    return integers_ ? as_lanes(unpack_integers(info_.format, bytes)) : unpack_texel(info_.format, bytes);
}

glm::vec4 QuadSampler::compared(const TextureLookup& lookup, std::size_t lane, const glm::vec4& texel) const {
    if (!lookup.compares) return texel;
    float reference = lookup.reference[lane];
    if (has_fixed_point_depth(info_.format)) reference = std::clamp(reference, 0.0F, 1.0F);
    return glm::vec4(passes(sampler_.compare, reference, texel.r) ? 1.0F : 0.0F);
}

float QuadSampler::swizzled(const glm::vec4& texel, Swizzle channel) const {
    if (channel == Swizzle::zero) return 0.0F;
    if (channel == Swizzle::one) return integers_ ? std::bit_cast<float>(1U) : 1.0F;
    return texel[static_cast<int>(channel)];
}

QuadTexels QuadSampler::fetch(const TexelLookup& lookup) {
    const std::uint32_t coordinates = coordinates_of(view_.kind);
    QuadTexels result{};
    surfaces_.begin_read(view_.slot);
    for_each_lane(lookup.lanes, [&](std::size_t lane) {
        const auto index = [&](std::int32_t value) { return static_cast<std::uint32_t>(value); }; // < 0: too large
        const std::uint32_t above = index(lookup.level[lane]);
        if (above > last_ - base_) return;
        const std::uint32_t level = base_ + above;
        const std::uint32_t column = index(lookup.place[0][lane]);
        const std::uint32_t row = coordinates > 1 ? index(lookup.place[1][lane]) : 0;
        const std::uint32_t plane = view_.multisampled                  ? index(lookup.sample[lane])
                                    : view_.kind == TextureKind::volume ? index(lookup.place[2][lane])
                                    : view_.arrayed                     ? index(lookup.place[coordinates][lane])
                                                                        : 0;
        if (column >= info_.width_of(level) || row >= info_.height_of(level) || plane >= info_.planes_of(level)) return;
        const glm::vec4 texel = stored(static_cast<std::int32_t>(column), static_cast<std::int32_t>(row), plane, level);
        for (std::size_t i = 0; i < 4; ++i) result[lane][static_cast<int>(i)] = swizzled(texel, view_.swizzle[i]);
    });
    return result;
}

std::array<std::int32_t, 4> QuadSampler::size(std::int32_t level) const {
    std::array<std::int32_t, 4> result{};
    const auto above = static_cast<std::uint32_t>(level);
    if (above > last_ - base_) return result;
    std::size_t next = 0;
    const auto add = [&](std::uint32_t value) { result[next++] = static_cast<std::int32_t>(value); };
    const bool cube = view_.kind == TextureKind::cube;
    add(info_.width_of(base_ + above));
    if (coordinates_of(view_.kind) > 1) add(info_.height_of(base_ + above));
    if (view_.kind == TextureKind::volume) add(info_.planes_of(base_ + above));
    if (view_.arrayed) add(info_.planes / (cube ? 6 : 1));
    return result;
}

} // namespace pipeline
