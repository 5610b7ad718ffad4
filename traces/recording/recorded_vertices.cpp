#include "traces/recording/recorded_vertices.hpp"

#include "sim/check.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <fmt/format.h>

namespace traces {

namespace {

using pipeline::ComponentType;
using spirv::InterfaceVariable;
using spirv::LaneWords;

// Numbers that no whole number is near become 0.
std::uint32_t whole_word(float value) {
    return value > -0x1p31F && value < 0x1p32F ? static_cast<std::uint32_t>(static_cast<std::int64_t>(value)) : 0;
}

const ConstantInput* constant_of(const RecordedDraw& draw, const std::string& variable) {
    const auto found = std::find_if(draw.constants.begin(), draw.constants.end(),
                                    [&](const ConstantInput& one) { return one.variable == variable; });
    return found == draw.constants.end() ? nullptr : &*found;
}

std::vector<VertexInput> inputs_of(const spirv::Program& program, const RecordedProgram& recorded,
                                   const RecordedDraw& draw, const pipeline::Geometry& geometry) {
    std::vector<VertexInput> inputs;
    for (const InterfaceVariable& variable : program.inputs) {
        if (variable.decorations.built_in) continue;
        const auto source = std::find_if(recorded.inputs.begin(), recorded.inputs.end(),
                                         [&](const ShaderInputSource& one) { return one.variable == variable.name; });
        const ConstantInput* constant = constant_of(draw, variable.name);
        for (std::uint32_t i = 0; i < variable.columns * variable.elements; ++i) {
            VertexInput input{&variable, i * variable.components};
            if (constant != nullptr) input.constant = constant->value;
            if (source != recorded.inputs.end() && source->first + i < pipeline::semantics)
                input.attribute = geometry.find(static_cast<pipeline::Semantic>(source->first + i));
            inputs.push_back(input);
        }
    }
    return inputs;
}

} // namespace

/// Reads one vector of four vertices.
class RecordedVertices::InputReader {
  public:
    InputReader(const pipeline::Resources& resources, const VertexInput& input, std::uint32_t instance)
        : input_(input) {
        if (input.attribute == nullptr) return;
        read_.emplace(resources, *input.attribute, instance);
        bytes_ = resources.buffers[input.attribute->buffer].bytes.data() + input.attribute->offset;
        element_ = input.attribute->divisor == 0 ? 0 : instance / input.attribute->divisor;
    }

    void set(spirv::Quad& quad, const std::array<std::uint32_t, 4>& vertices) const {
        std::array<std::array<std::uint32_t, 4>, 4> words{}; // by component and lane
        for (std::size_t lane = 0; lane < 4; ++lane) {
            const std::array<std::uint32_t, 4> vector = words_of(vertices[lane]);
            for (std::size_t i = 0; i < 4; ++i) words[i][lane] = vector[i];
        }
        for (std::uint32_t i = 0; i < input_.variable->components; ++i)
            quad.set_words(*input_.variable, input_.scalar + i, words[i]);
    }

  private:
    bool whole() const {
        return input_.variable->kind == spirv::Kind::whole || input_.variable->kind == spirv::Kind::natural;
    }

    std::array<std::uint32_t, 4> words_of(std::uint32_t vertex) const {
        const glm::vec4 value = read_ ? (*read_)(vertex) : input_.constant;
        std::array<std::uint32_t, 4> words{};
        for (int i = 0; i < 4; ++i) {
            const auto place = static_cast<std::size_t>(i);
            words[place] = whole() ? whole_word(value[i]) : std::bit_cast<std::uint32_t>(value[i]);
        }
        // More bits than a float has.
        if (whole() && read_ && input_.attribute->type == ComponentType::u32) {
            const std::uint32_t element = input_.attribute->divisor == 0 ? vertex : element_;
            std::memcpy(words.data(), bytes_ + std::uint64_t{element} * input_.attribute->stride,
                        input_.attribute->bytes());
        }
        return words;
    }

    const VertexInput& input_;
    std::optional<pipeline::AttributeReader> read_;
    const std::byte* bytes_ = nullptr;
    std::uint32_t element_ = 0;
};

RecordedVertices::RecordedVertices(std::shared_ptr<const LinkedProgram> program, const RecordedProgram& recorded,
                                   std::shared_ptr<const std::vector<std::uint32_t>> uniforms, const RecordedDraw& draw,
                                   std::shared_ptr<const pipeline::Resources> resources,
                                   std::shared_ptr<const VertexTextures> textures, bool mirrored)
    : program_(std::move(program)),
      uniforms_(std::move(uniforms)),
      resources_(std::move(resources)),
      textures_(std::move(textures)),
      inputs_(inputs_of(program_->vertex->program, recorded, draw, resources_->geometries[draw.geometry])),
      base_vertex_(draw.base_vertex),
      first_instance_(draw.first_instance),
      mirrored_(mirrored) {
    const spirv::Program& shader = program_->vertex->program;
    shape_.varyings = static_cast<std::uint32_t>(program_->varyings.size());
    for (std::uint32_t i = 0; i < shape_.varyings; ++i) {
        const spirv::Decorations& decorations = program_->varyings[i].input->decorations;
        if (decorations.flat) shape_.flat |= std::uint64_t{1} << i;
        if (decorations.no_perspective) shape_.linear |= std::uint64_t{1} << i;
    }
    shape_.point_size = shader.built_in(built_in::point_size) != nullptr;
    if (const InterfaceVariable* distances = shader.built_in(built_in::clip_distance))
        shape_.clip_distances = static_cast<std::uint8_t>((1U << std::min(8U, distances->elements)) - 1U);
}

/// One for each call: the interpreter's registers.
class RecordedVertices::Runner {
  public:
    Runner(const RecordedVertices& of, std::uint32_t instance)
        : of_(of),
          program_(of.program_->vertex->program),
          quad_(program_),
          surfaces_(of.textures_->surfaces, of.textures_->slots),
          textures_(surfaces_, of.textures_->table) {
        readers_.reserve(of.inputs_.size());
        quad_.set_uniforms(*of.uniforms_);
        for (const VertexInput& input : of.inputs_) readers_.emplace_back(*of.resources_, input, instance);
        set_number(built_in::instance_id, instance);
        set_number(built_in::instance_index, of.first_instance_ + instance);
        set_number(built_in::base_vertex, static_cast<std::uint32_t>(of.base_vertex_));
        set_number(built_in::base_instance, of.first_instance_);
    }

    /// Up to four vertices, `number` of them.
    void run(std::uint32_t first, std::uint32_t number) {
        std::array<std::uint32_t, 4> vertices{};
        for (std::uint32_t lane = 0; lane < 4; ++lane) vertices[lane] = first + std::min(lane, number - 1);
        for (const InputReader& reader : readers_) reader.set(quad_, vertices);
        for (const std::uint32_t id : {built_in::vertex_id, built_in::vertex_index})
            if (const InterfaceVariable* variable = program_.built_in(id)) quad_.set_words(*variable, 0, vertices);
        quad_.run(textures_);
    }

    /// Of the vertex that lane `lane` ran.
    void store(std::size_t lane, std::size_t vertex, const pipeline::ProgramVertices& made) const {
        made.positions[vertex] = vector(program_.built_in(built_in::position), 0, 4, lane);
        if (!made.instructions.empty()) made.instructions[vertex] = quad_.instructions()[lane];
        if (of_.mirrored_) made.positions[vertex].y = -made.positions[vertex].y;
        if (!made.point_sizes.empty() && of_.shape_.point_size)
            made.point_sizes[vertex] = vector(program_.built_in(built_in::point_size), 0, 1, lane).x;
        if (const InterfaceVariable* distances = program_.built_in(built_in::clip_distance);
            distances != nullptr && !made.distances.empty())
            for (std::uint32_t i = 0; i < std::min(distances->elements, pipeline::most_clip_distances); ++i)
                made.distances[vertex][i] = vector(distances, i, 1, lane).x;
        const std::vector<LinkedVarying>& varyings = of_.program_->varyings;
        for (std::size_t i = 0; i < varyings.size(); ++i)
            made.varyings[vertex * varyings.size() + i] =
                vector(varyings[i].output, varyings[i].first, varyings[i].components, lane);
    }

  private:
    void set_number(std::uint32_t id, std::uint32_t number) {
        if (const InterfaceVariable* variable = program_.built_in(id))
            quad_.set_words(*variable, 0, {number, number, number, number});
    }
    glm::vec4 vector(const InterfaceVariable* output, std::uint32_t first, std::uint32_t components,
                     std::size_t lane) const {
        glm::vec4 value(0.0F);
        for (std::uint32_t i = 0; output != nullptr && i < components; ++i)
            value[static_cast<int>(i)] = std::bit_cast<float>(quad_.get_words(*output, first + i)[lane]);
        return value;
    }

    const RecordedVertices& of_;
    const spirv::Program& program_;
    spirv::Quad quad_;
    pipeline::SurfaceAccess surfaces_;
    BoundTextures textures_;
    std::vector<InputReader> readers_;
};

void RecordedVertices::run(std::uint32_t instance, std::uint32_t first,
                           const pipeline::ProgramVertices& vertices) const {
    Runner runner(*this, instance);
    const auto count = static_cast<std::uint32_t>(vertices.positions.size());
    for (std::uint32_t begin = 0; begin < count; begin += 4) {
        const std::uint32_t number = std::min(4U, count - begin);
        runner.run(first + begin, number);
        for (std::uint32_t lane = 0; lane < number; ++lane) runner.store(lane, begin + lane, vertices);
    }
}

} // namespace traces
