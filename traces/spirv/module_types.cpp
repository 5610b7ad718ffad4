// Types and constants of a module.
#include "sim/check.hpp"
#include "traces/spirv/module_reader.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace traces::spirv {

namespace {

constexpr std::uint32_t most_constant_scalars = 1U << 20;

void require(bool good, const Instruction& instruction, std::string_view problem) {
    if (!good) fail(instruction, problem);
}

} // namespace

const Type& ModuleReader::member_type(const Instruction& instruction, std::uint32_t i) const {
    const Type& type = module_.type(operand(instruction, i), instruction);
    require(type.scalars > 0, instruction, "expected a type that is made of 32-bit scalars");
    require(type.depth < deepest_type, instruction, "types are nested too deep");
    return type;
}

Type ModuleReader::scalar_type(const Instruction& instruction) {
    Type type;
    type.scalars = 1;
    if (instruction.op == Op::type_bool) {
        type.kind = Kind::truth;
        return type;
    }
    const std::uint32_t width = operand(instruction, 0);
    require(width == 32, instruction, fmt::format("expected a width of 32 bits, got {}", width));
    if (instruction.op == Op::type_float)
        type.kind = Kind::real;
    else
        type.kind = operand(instruction, 1) != 0 ? Kind::whole : Kind::natural;
    return type;
}

Type ModuleReader::composite_type(const Instruction& instruction) {
    Type type;
    type.element = operand(instruction, 0);
    if (instruction.op == Op::type_array) {
        const Type& element = module_.type(type.element, instruction);
        const Constant& length = module_.constant(operand(instruction, 1), instruction);
        require(length.scalars.size() == 1 && module_.type(length.type).number(), instruction,
                "expected a whole number for the length");
        type.kind = Kind::array;
        type.count = length.scalars[0];
        type.stride = module_.decorations(instruction.id).array_stride.value_or(0);
        require(element.scalars > 0 || element.opaque(), instruction, "expected elements that are values or textures");
        require(element.depth < deepest_type, instruction, "types are nested too deep");
        type.depth = element.depth + 1;
        const std::uint32_t size = std::max(1U, element.scalars);
        require(type.count > 0 && type.count <= largest_type / size, instruction,
                fmt::format("expected an array of 1 to {} elements, got {}", largest_type / size, type.count));
        type.scalars = element.scalars * type.count;
        return type;
    }
    const Type& element = member_type(instruction, 0);
    type.count = operand(instruction, 1);
    require(type.count >= 2 && type.count <= 4, instruction,
            fmt::format("expected a size of 2 to 4, got {}", type.count));
    const bool vector = instruction.op == Op::type_vector;
    require(vector ? element.scalar()
                   : element.kind == Kind::vector && module_.type(element.element).kind == Kind::real,
            instruction, vector ? "expected scalar components" : "expected columns that are vectors of floats");
    type.kind = vector ? Kind::vector : Kind::matrix;
    type.depth = element.depth + 1;
    type.scalars = element.scalars * type.count;
    return type;
}

Type ModuleReader::structure_type(const Instruction& instruction) {
    Type type;
    type.kind = Kind::structure;
    const Decorations& own = module_.decorations(instruction.id);
    type.block = own.block;
    type.buffer = own.buffer;
    require(instruction.operands > 0, instruction, "expected a member");
    for (std::uint32_t i = 0; i < instruction.operands; ++i) {
        const Type& member = member_type(instruction, i);
        type.depth = std::max(type.depth, member.depth + 1);
        const std::uint32_t first = type.scalars;
        type.scalars += member.scalars;
        require(type.scalars <= largest_type, instruction, fmt::format("larger than {} scalars", largest_type));
        Member made{operand(instruction, i), {}, {}, first};
        const std::pair<Id, std::uint32_t> key{instruction.id, i};
        if (const auto found = member_names_.find(key); found != member_names_.end()) made.name = found->second;
        if (const auto found = member_decorations_.find(key); found != member_decorations_.end())
            made.decorations = found->second;
        type.members.push_back(std::move(made));
    }
    type.count = instruction.operands;
    return type;
}

Type ModuleReader::image_type(const Instruction& instruction) {
    Type type;
    type.kind = Kind::image;
    const Type& texel = module_.type(operand(instruction, 0), instruction);
    require(texel.number(), instruction, "expected texels of floats or whole numbers");
    const std::uint32_t dimension = operand(instruction, 1), sampled = operand(instruction, 5);
    require(dimension <= static_cast<std::uint32_t>(ImageDimension::buffer), instruction,
            fmt::format("expected an image of dimension 0 to 5, got {}", dimension));
    require(sampled != 2, instruction, "expected an image that is read as a texture, got a storage image");
    type.image = {static_cast<ImageDimension>(dimension), operand(instruction, 2) == 1, operand(instruction, 3) != 0,
                  operand(instruction, 4) != 0, texel.kind};
    return type;
}

Type ModuleReader::other_type(const Instruction& instruction) {
    Type type;
    switch (instruction.op) {
    case Op::type_sampler:
        type.kind = Kind::sampler;
        break;
    case Op::type_sampled_image: {
        const Type& image = module_.type(operand(instruction, 0), instruction);
        require(image.kind == Kind::image, instruction, "expected an image");
        type = image;
        type.kind = Kind::sampled_image;
        type.element = operand(instruction, 0);
        break;
    }
    case Op::type_pointer: {
        type.kind = Kind::pointer;
        type.storage = static_cast<Storage>(operand(instruction, 0));
        type.element = operand(instruction, 1);
        const Type& target = module_.type(type.element, instruction);
        require(target.scalars > 0 || target.opaque() || target.kind == Kind::array, instruction,
                "expected a pointer to a value or a texture");
        break;
    }
    default: // a function
        type.kind = Kind::function;
        type.element = operand(instruction, 0);
        module_.type(type.element, instruction);
        for (std::uint32_t i = 1; i < instruction.operands; ++i) {
            module_.type(operand(instruction, i), instruction);
            type.members.push_back({operand(instruction, i)});
        }
        break;
    }
    return type;
}

bool ModuleReader::type_or_constant(const Instruction& instruction) {
    Type type;
    switch (instruction.op) {
    case Op::type_void:
        break;
    case Op::type_bool:
    case Op::type_int:
    case Op::type_float:
        type = scalar_type(instruction);
        break;
    case Op::type_vector:
    case Op::type_matrix:
    case Op::type_array:
        type = composite_type(instruction);
        break;
    case Op::type_struct:
        type = structure_type(instruction);
        break;
    case Op::type_image:
        type = image_type(instruction);
        break;
    case Op::type_sampler:
    case Op::type_sampled_image:
    case Op::type_pointer:
    case Op::type_function:
        type = other_type(instruction);
        break;
    case Op::constant_true:
    case Op::constant_false:
    case Op::constant:
    case Op::constant_composite:
    case Op::constant_null:
    case Op::spec_constant_true:
    case Op::spec_constant_false:
    case Op::spec_constant:
    case Op::spec_constant_composite:
        constant(instruction);
        return true;
    default:
        return false;
    }
    define(instruction, Names::type, module_.types_.size());
    module_.types_.push_back(std::move(type));
    return true;
}

std::vector<std::uint32_t> ModuleReader::composite(const Instruction& instruction, const Type& type) {
    std::vector<std::uint32_t> scalars;
    const auto element = [&](std::uint32_t i) {
        return type.kind == Kind::structure ? type.members[i].type : type.element;
    };
    require(!type.scalar() && instruction.operands == type.count, instruction,
            fmt::format("expected {} parts, got {}", type.count, instruction.operands));
    for (std::uint32_t i = 0; i < instruction.operands; ++i) {
        const Constant& part = module_.constant(operand(instruction, i), instruction);
        require(part.type == element(i), instruction, fmt::format("expected part {} to be of the declared type", i));
        scalars.insert(scalars.end(), part.scalars.begin(), part.scalars.end());
    }
    return scalars;
}

void ModuleReader::constant(const Instruction& instruction) {
    const Type& type = module_.type(instruction.type, instruction);
    require(type.scalars > 0, instruction, "expected the type of a value");
    scalars_ += type.scalars;
    require(scalars_ <= most_constant_scalars, instruction,
            fmt::format("expected constants of {} scalars or fewer in all", most_constant_scalars));
    Constant made{instruction.type, {}};
    switch (instruction.op) {
    case Op::constant_true:
    case Op::spec_constant_true:
    case Op::constant_false:
    case Op::spec_constant_false: {
        require(type.kind == Kind::truth, instruction, "expected the type bool");
        const bool value = instruction.op == Op::constant_true || instruction.op == Op::spec_constant_true;
        made.scalars = {value ? ~0U : 0U};
        break;
    }
    case Op::constant:
    case Op::spec_constant:
        require(type.number() && instruction.operands == 1, instruction, "expected a number of 32 bits");
        made.scalars = {operand(instruction, 0)};
        break;
    case Op::constant_composite:
    case Op::spec_constant_composite:
        made.scalars = composite(instruction, type);
        break;
    default:
        made.scalars.assign(type.scalars, 0);
        break; // null, undefined
    }
    define(instruction, Names::constant, module_.constants_.size());
    module_.constants_.push_back(std::move(made));
}

} // namespace traces::spirv
