#include "tests/support/spirv_assembler.hpp"

#include <algorithm>
#include <bit>
#include <stdexcept>

namespace tests {

namespace {

// SPIR-V specification 1.6, section 3.20.
constexpr std::uint32_t block_decoration = 2, array_stride = 6, built_in_decoration = 11, location_decoration = 30;

} // namespace

SpirvAssembler::SpirvAssembler(Stage stage) : stage_(stage), std450_(id()), main_(id()), entry_(id()) {}

void SpirvAssembler::put(Words& to, Op op, const Words& operands) {
    to.push_back(static_cast<std::uint32_t>(operands.size() + 1) << 16U | static_cast<std::uint32_t>(op));
    to.insert(to.end(), operands.begin(), operands.end());
}

void SpirvAssembler::add_text(Words& to, const std::string& text) {
    for (std::size_t i = 0; i <= text.size(); i += 4) {
        std::uint32_t word = 0;
        for (std::size_t k = 0; k < 4 && i + k < text.size(); ++k)
            word |= static_cast<std::uint32_t>(static_cast<unsigned char>(text[i + k])) << (8 * k);
        to.push_back(word);
    }
}

SpirvAssembler::Id SpirvAssembler::declare(Op op, Id of, const Words& operands) {
    const Id made = id();
    Words words;
    if (of != 0) words.push_back(of);
    words.push_back(made);
    words.insert(words.end(), operands.begin(), operands.end());
    put(declarations_, op, words);
    return made;
}

SpirvAssembler::Id SpirvAssembler::type(Op op, const Words& operands, bool typed) {
    Words key{static_cast<std::uint32_t>(op)};
    key.insert(key.end(), operands.begin(), operands.end());
    const auto found = known_.find(key);
    if (found != known_.end()) return found->second;
    const Id made =
        typed ? declare(op, operands[0], Words(operands.begin() + 1, operands.end())) : declare(op, 0, operands);
    known_[key] = made;
    return made;
}

SpirvAssembler::Id SpirvAssembler::number(Id of, std::uint32_t bits) { return type(Op::constant, {of, bits}, true); }
SpirvAssembler::Id SpirvAssembler::constant(float value) { return number(real(), std::bit_cast<std::uint32_t>(value)); }

SpirvAssembler::Id SpirvAssembler::composite(Id of, const Words& parts) {
    Words operands{of};
    operands.insert(operands.end(), parts.begin(), parts.end());
    return type(Op::constant_composite, operands, true);
}

SpirvAssembler::Id SpirvAssembler::array_with_stride(Id element, std::uint32_t n, std::uint32_t bytes) {
    const Id made = declare(Op::type_array, 0, {element, constant(n)});
    decorate(made, array_stride, {bytes});
    return made;
}

SpirvAssembler::Id SpirvAssembler::sampled_image(std::uint32_t dimension, bool depth, bool arrayed, Id texel) {
    const Id image =
        type(Op::type_image, {texel == 0 ? real() : texel, dimension, depth ? 1U : 0U, arrayed ? 1U : 0U, 0, 1, 0});
    return type(Op::type_sampled_image, {image});
}

SpirvAssembler::Id SpirvAssembler::variable(Storage storage, Id of, Id initial) {
    Words operands{static_cast<std::uint32_t>(storage)};
    if (initial != 0) operands.push_back(initial);
    return declare(Op::variable, pointer(storage, of), operands);
}

SpirvAssembler::Id SpirvAssembler::global(Storage storage, Id of, Id initial) { return variable(storage, of, initial); }

SpirvAssembler::Id SpirvAssembler::input(Id of, std::uint32_t location) {
    const Id made = variable(Storage::input, of);
    interface_.push_back(made);
    decorate(made, location_decoration, {location});
    return made;
}

SpirvAssembler::Id SpirvAssembler::output(Id of, std::uint32_t location) {
    const Id made = variable(Storage::output, of);
    interface_.push_back(made);
    decorate(made, location_decoration, {location});
    return made;
}

SpirvAssembler::Id SpirvAssembler::built_in(Storage storage, Id of, std::uint32_t number) {
    const Id made = variable(storage, of);
    interface_.push_back(made);
    decorate(made, built_in_decoration, {number});
    return made;
}

SpirvAssembler::Id SpirvAssembler::uniform(Id of, const std::string& text) {
    const Id made = variable(Storage::uniform_constant, of);
    name(made, text);
    return made;
}

SpirvAssembler::Id SpirvAssembler::block(Id structure, const std::string& text) {
    decorate(structure, block_decoration);
    name(structure, text);
    return variable(Storage::uniform, structure);
}

SpirvAssembler::Id SpirvAssembler::local(Id of, Id initial) {
    const Id made = id();
    Words operands{pointer(Storage::function, of), made, static_cast<std::uint32_t>(Storage::function)};
    if (initial != 0) operands.push_back(initial);
    put(body_ == &main_body_ ? locals_ : function_locals_, Op::variable, operands);
    return made;
}

void SpirvAssembler::decorate(Id of, std::uint32_t decoration, const Words& operands) {
    Words words{of, decoration};
    words.insert(words.end(), operands.begin(), operands.end());
    put(annotations_, Op::decorate, words);
}

void SpirvAssembler::decorate_member(Id of, std::uint32_t member, std::uint32_t decoration, const Words& operands) {
    Words words{of, member, decoration};
    words.insert(words.end(), operands.begin(), operands.end());
    put(annotations_, Op::member_decorate, words);
}

void SpirvAssembler::name(Id of, const std::string& text) {
    Words words{of};
    add_text(words, text);
    put(annotations_, Op::name, words);
}

void SpirvAssembler::name_member(Id of, std::uint32_t member, const std::string& text) {
    Words words{of, member};
    add_text(words, text);
    put(annotations_, Op::member_name, words);
}

SpirvAssembler::Id SpirvAssembler::result(Op op, Id of, const Words& operands) {
    const Id made = id();
    Words words{of, made};
    words.insert(words.end(), operands.begin(), operands.end());
    put(*body_, op, words);
    return made;
}

void SpirvAssembler::write(Op op, const Words& operands) { put(*body_, op, operands); }

SpirvAssembler::Id SpirvAssembler::extended(traces::spirv::Std450 function, Id of, const Words& operands) {
    Words words{std450_, static_cast<std::uint32_t>(function)};
    words.insert(words.end(), operands.begin(), operands.end());
    return result(Op::ext_inst, of, words);
}

std::vector<SpirvAssembler::Id> SpirvAssembler::begin_function(Id function, Id returns, const Words& parameters) {
    Words signature{returns};
    signature.insert(signature.end(), parameters.begin(), parameters.end());
    put(functions_, Op::function, {returns, function, 0, type(Op::type_function, signature)});
    std::vector<Id> ids;
    for (const Id parameter : parameters) {
        ids.push_back(id());
        put(functions_, Op::function_parameter, {parameter, ids.back()});
    }
    put(functions_, Op::label, {id()});
    body_ = &pending_;
    return ids;
}

void SpirvAssembler::end_function() {
    functions_.insert(functions_.end(), function_locals_.begin(), function_locals_.end());
    functions_.insert(functions_.end(), pending_.begin(), pending_.end());
    put(functions_, Op::function_end, {});
    function_locals_.clear();
    pending_.clear();
    body_ = &main_body_;
}

SpirvAssembler::Words SpirvAssembler::module(bool returns) const {
    constexpr std::uint32_t magic = 0x07230203, logical = 0, glsl450 = 1, upper_left = 7, shader = 1;
    SpirvAssembler copy = *this;
    const Id function_type = copy.type(Op::type_function, {copy.nothing()});
    const Id nothing = copy.nothing();
    Words module{magic, 0x10000, 0, copy.next_, 0};
    put(module, Op::capability, {shader});
    Words import{std450_};
    add_text(import, "GLSL.std.450");
    put(module, Op::ext_inst_import, import);
    put(module, Op::memory_model, {logical, glsl450});
    Words entry{static_cast<std::uint32_t>(stage_), main_};
    add_text(entry, "main");
    entry.insert(entry.end(), interface_.begin(), interface_.end());
    put(module, Op::entry_point, entry);
    if (stage_ == Stage::fragment) put(module, Op::execution_mode, {main_, upper_left});
    const auto add = [&](const Words& words) { module.insert(module.end(), words.begin(), words.end()); };
    add(copy.annotations_);
    add(copy.declarations_);
    put(module, Op::function, {nothing, main_, 0, function_type});
    put(module, Op::label, {entry_});
    add(locals_);
    add(main_body_);
    if (returns) put(module, Op::return_nothing, {});
    put(module, Op::function_end, {});
    add(functions_);
    return module;
}

SpirvAssembler::Words SpirvAssembler::vertex_module() const {
    Words words = module();
    constexpr std::size_t head_words = 5;
    for (std::size_t at = head_words; at < words.size();) {
        const std::uint32_t length = words[at] >> 16U;
        const auto op = static_cast<Op>(words[at] & 0xFFFFU);
        const auto here = words.begin() + static_cast<std::ptrdiff_t>(at);
        if (op == Op::entry_point) words[at + 1] = 0; // the model, SPIR-V specification, section 3.3
        if (op == Op::execution_mode)
            words.erase(here, here + length); // of fragment shaders only
        else
            at += length;
    }
    return words;
}

traces::spirv::Texels RecordedTextures::sample(const traces::spirv::TextureSample& call) {
    sampled.push_back(call);
    return {call.place[0], call.place[1], call.place[2], {1, 2, 3, 4}};
}
traces::spirv::Texels RecordedTextures::fetch(const traces::spirv::TextureFetch& call) {
    fetched.push_back(call);
    traces::spirv::Texels texels{};
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t lane = 0; lane < 4; ++lane) texels[i][lane] = static_cast<float>(call.place[i][lane]);
    return texels;
}
traces::spirv::TextureSize RecordedTextures::size(std::uint32_t, std::uint32_t, std::int32_t level) {
    return {64 >> level, 32 >> level, 16 >> level, 5};
}
traces::spirv::Texels RecordedTextures::level(const traces::spirv::TextureSample& call) {
    levels_asked.push_back(call);
    return {pipeline::Lanes{1, 1, 1, 1}, {-2, -2, -2, -2}, {}, {}};
}

namespace {

const traces::spirv::InterfaceVariable& at(const std::vector<traces::spirv::InterfaceVariable>& list,
                                           std::uint32_t location) {
    const auto found = std::find_if(list.begin(), list.end(),
                                    [&](const auto& variable) { return variable.decorations.location == location; });
    if (found == list.end()) throw std::logic_error("no variable at this location");
    return *found;
}

} // namespace

const traces::spirv::InterfaceVariable& SpirvRun::input(std::uint32_t location) const {
    return at(program.inputs, location);
}
const traces::spirv::InterfaceVariable& SpirvRun::output(std::uint32_t location) const {
    return at(program.outputs, location);
}

} // namespace tests
