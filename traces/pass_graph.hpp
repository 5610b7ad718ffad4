// The passes of a rendering method, and what is left of them when those that nobody reads are taken out.
#pragma once

#include "pipeline/frame.hpp"

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace traces {

/// Names of the surfaces that need not be declared; depth and colours have the formats of the frame.
inline constexpr const char* depth_surface = "depth";
inline constexpr const char* colour_surface = "colour";
inline constexpr const char* kbuffer_surface = "kbuffer";
inline constexpr const char* picture_surface = "picture"; ///< of a k-buffer

/// A pass with a shader of its own. Surfaces are known by their names; those of add_surface() and the ones above.
struct ShadedPass {
    std::string name;
    std::shared_ptr<const pipeline::Shader> shader;
    std::vector<std::string> reads;   ///< in the order in which the shader knows them
    std::vector<std::string> targets; ///< one for each output of the shader, "" and behind the last one: none
    bool screen = false;              ///< draws every pixel of the targets instead of `draws`
    bool timed = true;                ///< else it takes no time; passes over the screen only
    std::vector<std::uint32_t> draws;
    std::string depth;   ///< tested and written as the states say, with its stencil; none: ""
    std::string kbuffer; ///< runs the program on output 0; none: ""
    std::vector<pipeline::RasterState> states = std::vector<pipeline::RasterState>(1);
    std::vector<std::uint32_t> state_of_draw; ///< one for each draw; empty: all the first
    bool both_faces = false;
    bool cold = false;                  ///< caches are empty when it begins
    std::optional<pipeline::View> view; ///< none: Frame::view
};

/// Passes in the order of submission. A pass names what it reads and writes; depth tests and writes of colours and of
/// the k-buffer follow from those names and from add_draw's arguments.
class PassGraph {
  public:
    /// `frame` holds what is common to all passes: scene, view, program, formats. Its passes, needs and left_out are
    /// replaced by lower().
    explicit PassGraph(pipeline::Frame frame);

    /// A surface that reports show is an output, too.
    void add_surface(pipeline::SurfaceInfo info);
    /// As large as what the first pass that writes it sees. Depth formats are cleared to the far plane.
    void add_surface(std::string name, pipeline::SurfaceFormat format, const glm::vec4& cleared = glm::vec4(0.0F));
    /// Throws sim::InputError where it reads what it writes.
    void add_shaded(ShadedPass pass);
    void add_clear(std::string name, std::vector<std::string> writes);
    /// `reads` and `writes` take depth, colour and kbuffer: reading depth tests against it, writing depth stores it,
    /// writing kbuffer runs the program (which reads the entries as well). `both_faces` turns face culling off; `blend`
    /// is how colours are written, and blending reads the colour surface.
    void add_draw(std::string name, std::vector<std::string> reads, std::vector<std::string> writes,
                  std::vector<std::uint32_t> draws, bool both_faces = false, const pipeline::BlendState& blend = {});
    /// The vertex shader of the pass added last reads these attributes beside what shading needs: bits as in
    /// pipeline::mask_of().
    void vertex_shader_reads(std::uint32_t attributes);
    /// The pass added last sees the scene from there instead of Frame::view.
    void see_from(const pipeline::View& view);
    /// The raster states of the pass added last, and which of them each of its draws has (none: all the first), instead
    /// of the one that add_draw() made. Tests and writes of surfaces that the pass does not name are switched off.
    void set_states(std::vector<pipeline::RasterState> states, std::vector<std::uint32_t> of_draw = {});
    /// Makes the targets anew without taking time; throws as add_shaded().
    void add_kernel(std::string name, std::shared_ptr<const pipeline::Kernel> kernel, std::vector<std::string> reads,
                    std::vector<std::string> targets);
    /// What colours all passes of the frame ask their fragments for.
    void use(pipeline::FragmentColour colour);
    /// This surface is what the frame is for.
    void output(std::string surface);
    /// Somebody reads it as the passes before leave it: what made it stays.
    void keep(std::string surface);
    /// Something the method could have had and does not use here.
    void leave_out(std::string unit, std::string reason);

    /// Takes out passes that draw nothing and passes (and writes of passes) that no later pass and no output reads,
    /// then collects Needs and left_out from what remains.
    pipeline::Frame lower() const;

  private:
    struct Node {
        pipeline::Pass pass;
        std::vector<std::string> reads, writes; ///< names of surfaces
        bool mark = false;                      ///< no pass: what keep() asks for
        // The same, by what they are for.
        std::vector<std::string> slots, targets;
        std::string depth, kbuffer;

        void check_slots() const;
    };
    struct Surface {
        pipeline::SurfaceInfo info;
        bool sized = false;
    };
    class Culling;

    /// The last pass, which draws.
    pipeline::Pass& last_draw();
    class Binding;

    pipeline::Frame frame_;
    pipeline::FragmentColour fragment_colour_ = pipeline::FragmentColour::lit;
    std::vector<Node> nodes_;
    std::map<std::string, Surface> surfaces_;
    std::vector<std::string> outputs_;
    std::vector<pipeline::LeftOut> left_out_;
};

} // namespace traces
