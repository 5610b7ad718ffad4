// Fixed-function blending in submission order: what hardware without a k-buffer does with transparent draws that nobody
// sorted. The ROP's read-modify-write of the colour surface is safe, because it is fixed and in primitive order.
//
// Source: Bavoil 2007, sections 2.1.2 and 4.3.1 (specification 004, section 1, rules 1 and 2).
#include "pipeline/format_choice.hpp"
#include "traces/loads.hpp"
#include "traces/pass_graph.hpp"
#include "traces/workloads/methods.hpp"

#include <array>
#include <numeric>

namespace traces {

enum class BlendMode : std::uint8_t { replace, over, add, least, greatest };

} // namespace traces

template <>
struct sim::EnumNames<traces::BlendMode> {
    static constexpr std::array<std::string_view, 5> names{"replace", "over", "add", "least", "greatest"};
};

namespace traces {

namespace {

struct BlendedParams {
    BlendMode mode = BlendMode::over;
    float opacity = 0.5F;
    std::array<float, 3> background = {1.0F, 1.0F, 1.0F};
    pipeline::ColourChoice colour_format = pipeline::ColourChoice::rgba8;

    static constexpr auto fields() {
        using P = BlendedParams;
        return std::tuple(
            sim::field<&P::mode>("how a fragment's colour is combined with the stored one"),
            sim::field<&P::opacity>("scales the alpha of every fragment, where it is blended").range(0.0F, 1.0F),
            sim::field<&P::background>("linear RGB behind everything").range(0.0F, 1.0F),
            sim::field<&P::colour_format>("format of the colour surface"));
    }
};
static_assert(sim::fully_described<BlendedParams>);

pipeline::BlendState state_of(BlendMode mode) {
    switch (mode) {
    case BlendMode::replace:
        break;
    case BlendMode::over:
        return pipeline::blends::over();
    case BlendMode::add:
        return pipeline::blends::of(pipeline::blends::sum);
    case BlendMode::least:
        return pipeline::blends::of(pipeline::blends::least);
    case BlendMode::greatest:
        return pipeline::blends::of(pipeline::blends::greatest);
    }
    return {};
}

/// The colour of the material with its alpha scaled. The move that ends the material's shading multiplies instead, so
/// there is no instruction of its own.
class ScaledAlpha final : public pipeline::Shader {
  public:
    explicit ScaledAlpha(float opacity) : opacity_(opacity) {}

    pipeline::ShaderShape shape() const override { return {.registers = 1, .colour = pipeline::FragmentColour::lit}; }
    void shade(const pipeline::ShaderInput& input, pipeline::SurfaceAccess&,
               pipeline::ShaderOutput& output) const override {
        output.colours[0] = input.colour;
        for (glm::vec4& colour : output.colours[0]) colour.a *= opacity_;
    }

  private:
    float opacity_;
};

pipeline::Frame build(const Scene& scene, const pipeline::View& view, const BlendedParams& params) {
    pipeline::Frame frame = frame_of(scene, view);
    frame.background = {params.background[0], params.background[1], params.background[2], 1.0F};
    frame.colour_format = format_of(params.colour_format);
    ShadedPass pass;
    pass.name = "blended";
    pass.targets = {colour_surface};
    pass.both_faces = true;
    pass.shader = std::make_shared<const ScaledAlpha>(params.mode == BlendMode::replace ? 1.0F : params.opacity);
    pass.states[0].blend[0] = state_of(params.mode);
    pass.draws.resize(frame.draws.size());
    std::iota(pass.draws.begin(), pass.draws.end(), 0U);

    PassGraph graph(std::move(frame));
    graph.add_clear("clear", {colour_surface});
    graph.add_shaded(std::move(pass));
    graph.output(colour_surface);
    return graph.lower();
}

} // namespace

Workload blended_workload() {
    return make_workload<BlendedParams>("blended", "every draw blended in submission order by the fixed-function ROP",
                                        build);
}

Load blending_load(const std::string& colour_format) { return {"blended", {"colour_format=" + colour_format}}; }

} // namespace traces
