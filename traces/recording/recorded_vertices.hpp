// The vertex program of a draw of a recording.
#pragma once

#include "pipeline/functional/vertex_fetch.hpp"
#include "pipeline/vertex_program.hpp"
#include "traces/recording/linked_program.hpp"
#include "traces/recording/textures.hpp"

namespace traces {

/// What a vertex shader's input is fed with.
struct VertexInput {
    const spirv::InterfaceVariable* variable = nullptr;
    std::uint32_t scalar = 0;                             ///< of the variable, where the vector begins
    const pipeline::VertexAttribute* attribute = nullptr; ///< null: the constant
    glm::vec4 constant{0.0F, 0.0F, 0.0F, 1.0F};
};

/// Textures that a vertex shader reads, in surfaces of their own: no pass writes them.
struct VertexTextures {
    pipeline::SurfaceStore surfaces;
    std::vector<pipeline::SurfaceId> slots;
    TextureTable table;
};

class RecordedVertices final : public pipeline::VertexProgram {
  public:
    /// @param mirrored the targets' row 0 is the bottom
    RecordedVertices(std::shared_ptr<const LinkedProgram> program, const RecordedProgram& recorded,
                     std::shared_ptr<const std::vector<std::uint32_t>> uniforms, const RecordedDraw& draw,
                     std::shared_ptr<const pipeline::Resources> resources,
                     std::shared_ptr<const VertexTextures> textures, bool mirrored);

    pipeline::VertexProgramShape shape() const override { return shape_; }
    void run(std::uint32_t instance, std::uint32_t first, const pipeline::ProgramVertices& vertices) const override;

  private:
    class InputReader;
    class Runner;

    std::shared_ptr<const LinkedProgram> program_;
    std::shared_ptr<const std::vector<std::uint32_t>> uniforms_;
    std::shared_ptr<const pipeline::Resources> resources_;
    std::shared_ptr<const VertexTextures> textures_;
    std::vector<VertexInput> inputs_;
    pipeline::VertexProgramShape shape_;
    std::int32_t base_vertex_;
    std::uint32_t first_instance_;
    bool mirrored_;
};

} // namespace traces
