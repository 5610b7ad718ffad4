// Instructions that read textures.
#include "traces/spirv/resolver.hpp"

#include <fmt/format.h>

namespace traces::spirv {

namespace {

/// SPIR-V specification 1.6, section 3.14. Operands follow in the order of the bits.
constexpr std::uint32_t bias_bit = 1, lod_bit = 2, gradients_bit = 4, const_offset_bit = 8, offset_bit = 16,
                        const_offsets_bit = 32, sample_bit = 64;

} // namespace

const TextureReference& Resolver::reference(const Instruction& instruction, std::uint32_t i) const {
    const Id id = operand(instruction, i);
    if (id >= values_.size() || values_[id].is != Is::texture)
        fail(instruction, fmt::format("expected id {} to be a texture", id));
    return references_[values_[id].index];
}

bool Resolver::texture(const Instruction& instruction) {
    switch (instruction.op) {
    case Op::sampled_image:
        sampled_image(instruction);
        return true;
    case Op::image:
        image_of(instruction);
        return true;
    case Op::image_fetch:
        fetch(instruction);
        return true;
    case Op::image_query_size:
    case Op::image_query_size_lod:
    case Op::image_query_levels:
    case Op::image_query_samples:
        query(instruction);
        return true;
    case Op::image_sample_implicit_lod:
    case Op::image_sample_explicit_lod:
    case Op::image_sample_dref_implicit_lod:
    case Op::image_sample_dref_explicit_lod:
    case Op::image_sample_proj_implicit_lod:
    case Op::image_sample_proj_explicit_lod:
    case Op::image_sample_proj_dref_implicit_lod:
    case Op::image_sample_proj_dref_explicit_lod:
    case Op::image_gather:
    case Op::image_dref_gather:
    case Op::image_query_lod:
        sample(instruction);
        return true;
    default:
        return false;
    }
}

void Resolver::sampled_image(const Instruction& instruction) {
    TextureReference made = reference(instruction, 0);
    const TextureReference& sampler = reference(instruction, 1);
    require(type(made.type).kind == Kind::image && type(sampler.type).kind == Kind::sampler &&
                type(instruction.type).kind == Kind::sampled_image && type(instruction.type).element == made.type,
            instruction, "expected an image and a sampler");
    require(!sampler.varying, instruction, "expected a sampler with an index that is constant");
    made.type = instruction.type;
    made.sampler = sampler.sampler;
    made.sampler_element = sampler.sampler_element;
    references_.push_back(made);
    define_as(instruction, {Is::texture, instruction.type, 0, static_cast<std::uint32_t>(references_.size() - 1)});
}

void Resolver::image_of(const Instruction& instruction) {
    TextureReference made = reference(instruction, 0);
    require(type(made.type).kind == Kind::sampled_image && type(made.type).element == instruction.type, instruction,
            "expected a sampled image of this type");
    made.type = instruction.type;
    references_.push_back(made);
    define_as(instruction, {Is::texture, instruction.type, 0, static_cast<std::uint32_t>(references_.size() - 1)});
}

void Resolver::image_operands(const Instruction& instruction, std::uint32_t at, TextureCall& call,
                              std::uint32_t coordinates) {
    if (at >= instruction.operands) return;
    const std::uint32_t mask = operand(instruction, at++);
    require((mask & ~127U) == 0, instruction, fmt::format("image operands {:#x} are not modelled", mask));
    if ((mask & bias_bit) != 0) call.lod = lanes(instruction, at++, 'r', 1);
    if ((mask & lod_bit) != 0) {
        const bool real = scalar_kind(type(registers(instruction, at).type)) == Kind::real;
        call.lod = lanes(instruction, at++, real ? 'r' : 'i', 1);
        require(real == (instruction.op != Op::image_fetch), instruction,
                "expected a level of the other kind of number");
        call.level = LevelOfDetail::given;
    }
    if ((mask & gradients_bit) != 0) {
        call.dx = lanes(instruction, at++, 'r', coordinates);
        call.dy = lanes(instruction, at++, 'r', coordinates);
        call.level = LevelOfDetail::gradients;
    }
    for (const std::uint32_t kind : {const_offset_bit, offset_bit})
        if ((mask & kind) != 0) {
            const Slot first = lanes(instruction, at++, 'i', coordinates);
            for (std::uint32_t i = 0; i < coordinates; ++i) call.offset[i] = first + static_cast<Slot>(i);
        }
    if ((mask & const_offsets_bit) != 0) {
        const Value offsets = registers(instruction, at++);
        const Type& of = type(offsets.type);
        require(of.kind == Kind::array && of.count == 4 && of.scalars == 8 &&
                    scalar_kind(type(of.element)) != Kind::real && call.gathers,
                instruction, "expected four offsets of a gather");
        for (std::uint32_t i = 0; i < 8; ++i) call.offsets[i] = offsets.slot + static_cast<Slot>(i);
    }
    if ((mask & sample_bit) != 0) call.sample = lanes(instruction, at++, 'i', 1);
}

void Resolver::add_call(const Instruction& instruction, const TextureCall& call, Handler handler) {
    const std::uint32_t count = components(instruction, instruction.type);
    program_.texture_calls.push_back(call);
    emit(instruction, {handler, define(instruction), count, static_cast<Slot>(program_.texture_calls.size() - 1)});
}

void Resolver::sample(const Instruction& instruction) {
    const Op op = instruction.op;
    TextureCall call;
    call.reference = reference(instruction, 0);
    const Type& of = type(call.reference.type);
    require(of.kind == Kind::sampled_image && !of.image.multisampled && of.image.dimension != ImageDimension::buffer,
            instruction, "expected a sampled image with one sample a texel");
    call.image = of.image;
    const bool compares = op == Op::image_sample_dref_implicit_lod || op == Op::image_sample_dref_explicit_lod ||
                          op == Op::image_sample_proj_dref_implicit_lod ||
                          op == Op::image_sample_proj_dref_explicit_lod || op == Op::image_dref_gather;
    const bool divides = op == Op::image_sample_proj_implicit_lod || op == Op::image_sample_proj_explicit_lod ||
                         op == Op::image_sample_proj_dref_implicit_lod || op == Op::image_sample_proj_dref_explicit_lod;
    const std::uint32_t plain = coordinates_of(of.image.dimension);
    const bool levels = op == Op::image_query_lod;
    call.coordinates = plain + (of.image.arrayed && !levels ? 1 : 0);
    const Value place = registers(instruction, 1);
    const std::uint32_t given = components(instruction, place.type);
    require(scalar_kind(type(place.type)) == Kind::real && given >= call.coordinates + (divides ? 1 : 0), instruction,
            fmt::format("expected {} coordinates or more", call.coordinates + (divides ? 1 : 0)));
    call.place = place.slot;
    if (divides) call.divisor = place.slot + static_cast<Slot>(call.coordinates);
    if (levels) {
        check_kind(instruction, instruction.type, 'r', 2, "the result");
        return add_call(instruction, call, texture_level);
    }
    call.gathers = op == Op::image_gather || op == Op::image_dref_gather;
    if (compares) call.reference_depth = lanes(instruction, 2, 'r', 1);
    if (op == Op::image_gather) call.component = lanes(instruction, 2, 'i', 1);
    image_operands(instruction, compares || call.gathers ? 3 : 2, call, plain);
    check_kind(instruction, instruction.type, of.image.texel == Kind::real ? 'r' : 'i',
               compares && !call.gathers ? 1 : 4, "the result");
    add_call(instruction, call, sample_texture);
}

void Resolver::fetch(const Instruction& instruction) {
    TextureCall call;
    call.reference = reference(instruction, 0);
    const Type& of = type(call.reference.type);
    require(of.kind == Kind::image && of.image.dimension != ImageDimension::cube, instruction,
            "expected an image that is no cube");
    call.image = of.image;
    const std::uint32_t plain = coordinates_of(of.image.dimension);
    call.coordinates = plain + (of.image.arrayed ? 1 : 0);
    call.place = lanes(instruction, 1, 'i', call.coordinates);
    image_operands(instruction, 2, call, plain);
    require(call.level != LevelOfDetail::gradients && (!call.lod || call.level == LevelOfDetail::given), instruction,
            "expected a level at most");
    check_kind(instruction, instruction.type, of.image.texel == Kind::real ? 'r' : 'i', 4, "the result");
    add_call(instruction, call, fetch_texture);
}

void Resolver::query(const Instruction& instruction) {
    TextureCall call;
    call.reference = reference(instruction, 0);
    const Type& of = type(call.reference.type);
    require(of.kind == Kind::image, instruction, "expected an image");
    call.image = of.image;
    const bool of_level = instruction.op == Op::image_query_size_lod;
    if (of_level) call.lod = lanes(instruction, 1, 'i', 1);
    if (of_level || instruction.op == Op::image_query_size) {
        const std::uint32_t flat = of.image.dimension == ImageDimension::cube ? 2 : coordinates_of(of.image.dimension);
        check_kind(instruction, instruction.type, 'i', flat + (of.image.arrayed ? 1 : 0), "the result");
        return add_call(instruction, call, texture_size);
    }
    check_kind(instruction, instruction.type, 'i', 1, "the result");
    add_call(instruction, call, instruction.op == Op::image_query_levels ? texture_levels : texture_samples);
}

} // namespace traces::spirv
