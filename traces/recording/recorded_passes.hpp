// The passes of a recording: its commands, put together by their targets.
#pragma once

#include "traces/pass_graph.hpp"
#include "traces/recording/drawn_parts.hpp"
#include "traces/recording/lower.hpp"
#include "traces/recording/recorded_shader.hpp"
#include "traces/recording/recorded_vertices.hpp"

#include <map>
#include <set>
#include <tuple>

namespace traces {

/// Shaders and uniforms of a recording, each made once.
class RecordedPrograms {
  public:
    explicit RecordedPrograms(const Recording& recording) : recording_(recording) {}

    using Words = std::shared_ptr<const std::vector<std::uint32_t>>;
    std::shared_ptr<const LinkedProgram> program(std::uint32_t number);
    /// Of one of its stages.
    Words words(const ShaderStage& stage, std::uint32_t values);
    /// What is not drawn as it was recorded.
    std::vector<std::string> notes() const;

  private:
    const Recording& recording_;
    std::map<std::uint32_t, std::shared_ptr<const LinkedProgram>> programs_;
    std::map<std::tuple<const ShaderStage*, std::uint32_t>, Words> words_;
};

/// A step of a frame, in the order of the recording.
struct RecordedStep {
    std::vector<std::string> cleared; ///< surfaces, all of each; else the pass
    ShadedPass pass;
    std::string shown; ///< else: this surface is a picture now
};

/// Makes steps of commands, one after the other.
class RecordedPasses {
  public:
    /// @param resources with a geometry of three vertices without attributes, `screen_geometry`
    RecordedPasses(const Recording& recording, std::shared_ptr<const pipeline::Resources> resources,
                   std::uint32_t screen_geometry, const std::optional<KBufferChoice>& kbuffer);

    void add(const RecordedFrame& frame);

    std::vector<RecordedStep> steps;
    std::vector<pipeline::Draw> draws;
    std::vector<pipeline::SurfaceInfo> surfaces; ///< those of DrawnParts
    std::vector<std::string> notes() const;
    /// What the k-buffer runs; null where no draw goes through it.
    std::shared_ptr<const pipeline::ModifyProgram> program() const { return kbuffer_used_ ? program_ : nullptr; }

  private:
    struct Open;

    void add(const RecordedDraw& draw);
    void add(const RecordedClear& clear);
    void add(const RecordedCopy& copy);
    void add(const RecordedBlit& blit);
    void enter_run(std::uint32_t targets);
    std::string pass_name();
    void open(std::uint32_t targets, bool kbuffer = false);
    void open(const TargetSet& targets, bool kbuffer);
    void expect_size_of(const TargetSet& targets, std::uint32_t surface) const;
    void close();
    void lay_nodes(const Open& open);
    bool chosen(const RecordedDraw& draw);
    void add_screen_draw(const std::string& name, const pipeline::RasterState& state, float depth, FragmentUse use);
    void push(pipeline::Draw draw, std::uint32_t state, FragmentUse use);
    using Texel = std::array<std::byte, pipeline::largest_texel>;
    std::map<std::uint32_t, Texel> whole_clears(const RecordedClear& clear) const;
    RecordedClear clear_whole(const RecordedClear& clear);
    std::uint32_t slot_of(std::uint32_t surface);
    std::vector<TextureBinding> bindings_of(const RecordedDraw& draw, const spirv::Program& program) const;
    std::shared_ptr<const TextureTable> fragment_textures(const RecordedDraw& draw, const spirv::Program& program);
    std::shared_ptr<const VertexTextures> vertex_textures(const RecordedDraw& draw, const spirv::Program& program);
    void note_unbound(const RecordedDraw& draw, const TextureTable& table);
    std::uint32_t state_of(const RecordedDraw& draw);
    std::string name_of(std::uint32_t surface) const { return surfaces[surface].name; }

    const Recording& recording_;
    DrawnParts drawn_parts_;
    std::vector<TargetSet> targets_; ///< of the recording, as sets of `surfaces`
    std::shared_ptr<const pipeline::Resources> resources_;
    std::uint32_t screen_geometry_;
    RecordedPrograms programs_;
    std::set<std::uint32_t> cleared_;          ///< surfaces whose cleared value is known
    std::set<std::uint32_t> stencil_tested_;   ///< by any draw
    std::string frame_;                        ///< its name, in front of those of its passes
    std::uint32_t draws_ = 0;                  ///< of the frame so far
    std::uint32_t run_ = 0, parts_ = 0;        ///< of commands with the same targets, and its passes
    std::optional<std::uint32_t> run_targets_; ///< none: there was no command
    std::uint32_t copies_ = 0;
    std::optional<KBufferChoice> kbuffer_;
    std::shared_ptr<const pipeline::ModifyProgram> program_;
    bool kbuffer_used_ = false;
    glm::uvec2 kbuffer_size_{0};
    std::map<std::string, std::uint64_t> not_kept_; ///< blended draws that no k-buffer can keep, by reason
    std::shared_ptr<Open> open_;
    std::set<std::uint32_t> written_; ///< surfaces, so far
    std::vector<std::string> notes_;
};

/// The pass that draws are added to.
struct RecordedPasses::Open {
    std::uint32_t number = ~0U; ///< of the recording's target sets; of none where it is made for a copy
    TargetSet targets;
    bool kbuffer = false;
    ShadedPass pass;
    std::uint32_t first_draw = 0;
    std::vector<FragmentUse> uses;
    std::vector<std::uint32_t> reads;              ///< surfaces, by slot
    std::map<std::uint32_t, std::uint32_t> states; ///< of the recording: state of the pass

    bool writes(std::uint32_t surface) const {
        return (targets.depth && targets.depth->surface == surface) ||
               std::any_of(targets.colours.begin(), targets.colours.end(),
                           [surface](const auto& one) { return one && one->surface == surface; });
    }
};

} // namespace traces
