// Reads of textures: operands out of registers, the call, the result into registers.
#include "traces/spirv/component_wise.hpp"
#include "traces/spirv/texture_call.hpp"

#include <algorithm>
#include <cstring>

namespace traces::spirv {

namespace {

using IntegerLanes = std::array<std::int32_t, 4>;

template <class Lanes>
Lanes lanes_at(const Run& run, Slot slot) {
    Lanes lanes{};
    std::memcpy(&lanes, run.file + slot, sizeof lanes);
    return lanes;
}

const TextureCall& call_of(const Run& run, const Operation& operation) {
    return run.program->texture_calls[static_cast<std::size_t>(operation.a)];
}

/// One call for each element of an array that a lane wants.
template <class Call>
void each_element(const Run& run, const TextureReference& reference, Call call) {
    const auto elements = [&](std::uint32_t texture) { return run.program->textures[texture].elements; };
    const auto last = static_cast<std::int32_t>(elements(reference.texture) - 1);
    if (!reference.varying) return call(reference.element, run.lanes);
    const IntegerLanes index = lanes_at<IntegerLanes>(run, *reference.varying);
    for (unsigned left = run.lanes; left != 0;) {
        unsigned first = 0;
        while ((left >> first & 1U) == 0) ++first;
        const std::int32_t wanted = std::clamp(index[first], 0, last);
        unsigned lanes = 0;
        for (unsigned lane = first; lane < 4; ++lane)
            if ((left >> lane & 1U) != 0 && std::clamp(index[lane], 0, last) == wanted) lanes |= 1U << lane;
        call(static_cast<std::uint32_t>(wanted), lanes);
        left &= ~lanes;
    }
}

TextureSample sample_of(const Run& run, const TextureCall& call) {
    TextureSample sample;
    sample.texture = call.reference.texture;
    sample.sampler = call.reference.sampler;
    sample.image = &call.image;
    sample.level = call.level;
    sample.gathers = call.gathers;
    const Reals divisor = call.divisor ? reals(run.file[*call.divisor]) : same(1.0F);
    const auto divided = [&](Slot slot) {
        const Reals quotient = call.divisor ? reals(run.file[slot]) / divisor : reals(run.file[slot]);
        pipeline::Lanes lanes{};
        std::memcpy(&lanes, &quotient, sizeof lanes);
        return lanes;
    };
    for (std::uint32_t i = 0; i < call.coordinates; ++i) sample.place[i] = divided(call.place + static_cast<Slot>(i));
    if (call.lod) sample.lod = lanes_at<pipeline::Lanes>(run, *call.lod);
    const std::uint32_t plain = coordinates_of(call.image.dimension);
    for (std::uint32_t i = 0; i < plain; ++i) {
        if (call.dx) sample.dx[i] = lanes_at<pipeline::Lanes>(run, *call.dx + static_cast<Slot>(i));
        if (call.dy) sample.dy[i] = lanes_at<pipeline::Lanes>(run, *call.dy + static_cast<Slot>(i));
        if (call.offset[i]) sample.offset[i] = lanes_at<IntegerLanes>(run, *call.offset[i]);
    }
    sample.compares = call.reference_depth.has_value();
    if (call.reference_depth) sample.reference = divided(*call.reference_depth);
    if (call.component) sample.component = run.file[*call.component][0] & 3U;
    return sample;
}

/// Texels of the lanes into the result; a comparison has one component.
void write(Run& run, const Operation& operation, const Texels& texels, unsigned lanes) {
    const Words mask = mask_of(lanes);
    for (std::uint32_t i = 0; i < operation.count; ++i) {
        Words read{};
        std::memcpy(&read, &texels[i], sizeof read);
        Words& result = run.file[operation.result + static_cast<Slot>(i)];
        result = pick(mask, read, result);
    }
}

/// A gather whose four texels have offsets of their own: the lower left texel of each footprint.
Texels gather_offsets(Run& run, const TextureCall& call, TextureSample sample) {
    Texels result{};
    for (std::size_t texel = 0; texel < 4; ++texel) {
        for (std::size_t i = 0; i < 2; ++i)
            sample.offset[i] = lanes_at<IntegerLanes>(run, *call.offsets[2 * texel + i]);
        result[texel] = run.textures->sample(sample)[3]; // the texel at the floor of both coordinates
    }
    return result;
}

} // namespace

void sample_texture(Run& run, const Operation& operation) {
    const TextureCall& call = call_of(run, operation);
    TextureSample sample = sample_of(run, call);
    sample.sampler_element = call.reference.sampler_element; // of a sampler apart from its image, which does not vary
    each_element(run, call.reference, [&](std::uint32_t element, unsigned lanes) {
        sample.element = element;
        if (call.reference.sampler == call.reference.texture) sample.sampler_element = element;
        sample.lanes = lanes;
        write(run, operation, call.offsets[0] ? gather_offsets(run, call, sample) : run.textures->sample(sample),
              lanes);
    });
}

void texture_level(Run& run, const Operation& operation) {
    const TextureCall& call = call_of(run, operation);
    TextureSample sample = sample_of(run, call);
    each_element(run, call.reference, [&](std::uint32_t element, unsigned lanes) {
        sample.element = sample.sampler_element = element;
        sample.lanes = lanes;
        write(run, operation, run.textures->level(sample), lanes);
    });
}

void fetch_texture(Run& run, const Operation& operation) {
    const TextureCall& call = call_of(run, operation);
    TextureFetch fetch;
    fetch.texture = call.reference.texture;
    fetch.image = &call.image;
    for (std::uint32_t i = 0; i < call.coordinates; ++i) {
        fetch.place[i] = lanes_at<IntegerLanes>(run, call.place + static_cast<Slot>(i));
        if (i >= 3 || !call.offset[i]) continue;
        const Words moved = run.file[call.place + static_cast<Slot>(i)] + run.file[*call.offset[i]]; // it wraps
        std::memcpy(&fetch.place[i], &moved, sizeof moved);
    }
    if (call.lod) fetch.level = lanes_at<IntegerLanes>(run, *call.lod);
    if (call.sample) fetch.sample = lanes_at<IntegerLanes>(run, *call.sample);
    each_element(run, call.reference, [&](std::uint32_t element, unsigned lanes) {
        fetch.element = element;
        fetch.lanes = lanes;
        write(run, operation, run.textures->fetch(fetch), lanes);
    });
}

void texture_size(Run& run, const Operation& operation) {
    const TextureCall& call = call_of(run, operation);
    const IntegerLanes levels = call.lod ? lanes_at<IntegerLanes>(run, *call.lod) : IntegerLanes{};
    each_element(run, call.reference, [&](std::uint32_t element, unsigned lanes) {
        for (unsigned lane = 0; lane < 4; ++lane) {
            if ((lanes >> lane & 1U) == 0) continue;
            const TextureSize size = run.textures->size(call.reference.texture, element, levels[lane]);
            for (std::uint32_t i = 0; i < operation.count; ++i)
                run.file[operation.result + static_cast<Slot>(i)][lane] = static_cast<std::uint32_t>(size[i]);
        }
    });
}

namespace {

template <std::int32_t (ShaderTextures::*function)(std::uint32_t, std::uint32_t)>
void ask(Run& run, const Operation& operation) {
    const TextureCall& call = call_of(run, operation);
    each_element(run, call.reference, [&](std::uint32_t element, unsigned lanes) {
        const auto answer = static_cast<std::uint32_t>((run.textures->*function)(call.reference.texture, element));
        Words& result = run.file[operation.result];
        result = pick(mask_of(lanes), same(answer), result);
    });
}

} // namespace

void texture_levels(Run& run, const Operation& operation) { ask<&ShaderTextures::levels>(run, operation); }
void texture_samples(Run& run, const Operation& operation) { ask<&ShaderTextures::samples>(run, operation); }

} // namespace traces::spirv
