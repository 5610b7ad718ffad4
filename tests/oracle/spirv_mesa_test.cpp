// The SPIR-V interpreter against Mesa's llvmpipe: the same GLSL, compiled by glslang for the one and by Mesa for the
// other, over a picture of inputs that vary linearly, with the same uniforms and texels.
#include "tests/support/fixed_function_scene.hpp"
#include "tests/support/mesa_shaders.hpp"
#include "tests/support/oracle_textures.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/spirv_compiler.hpp"
#include "traces/glsl.hpp"
#include "traces/spirv/quad.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <regex>

namespace spirv_mesa_test {

namespace {

using pipeline::Lanes;
using tests::LinearInput;
using tests::MesaShaders;
using tests::OracleTextures;
using tests::random_of;
using traces::spirv::InterfaceVariable;
using traces::spirv::Kind;
using traces::spirv::LaneWords;
using traces::spirv::Module;
using traces::spirv::Program;
using traces::spirv::Quad;
using traces::spirv::UniformVariable;
namespace fs = std::filesystem;

std::string read(const fs::path& path) {
    std::ifstream stream(path);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// What glmark2 itself puts in front of its shaders and into them.
std::string completed_glmark2(std::string source) {
    const std::vector<std::pair<std::string, std::string>> parts{
        {"$CONVOLUTION$",
         "result = texture2D(Texture0, TextureCoord) * 0.5 + texture2D(Texture0, TextureCoord.yx) * 0.25;"},
        {"$PROCESS$", "d = fract(3.0 * d); if (d > 0.5) d = sqrt(d);"},
        {"$MAIN$", "for (int i = 0; i < FragmentLoops; i++) d = fract(3.0 * d + 0.1);"},
        {"$DO_LIGHTS$", "gl_FragColor = compute_color(LightSourcePosition, LightSourceDiffuse);"}};
    for (const auto& [mark, text] : parts)
        for (std::size_t at = source.find(mark); at != std::string::npos; at = source.find(mark))
            source.replace(at, mark.size(), text);
    std::string front;
    const std::vector<std::pair<std::string, std::string>> constants{
        {"float", "TextureStepX = 0.03"},
        {"float", "TextureStepY = 0.05"},
        {"vec2", "TextureSize = vec2(8.0, 8.0)"},
        {"vec4", "LightSourcePosition = vec4(2.0, 1.5, 1.0, 1.0)"},
        {"vec4", "LightSourceDiffuse = vec4(0.8, 0.7, 0.9, 1.0)"},
        {"vec3", "LightSourceHalfVector = vec3(0.3, 0.5, 0.8)"},
        {"vec4", "MaterialDiffuse = vec4(0.9, 0.6, 0.4, 1.0)"},
        {"float", "RefractiveIndex = 1.2"},
        {"int", "FragmentLoops = 5"}};
    for (const auto& [type, text] : constants) {
        const std::string name = text.substr(0, text.find(' '));
        const std::regex declared("\\b(const|uniform)\\s+\\w+\\s+" + name + "\\b"), used("\\b" + name + "\\b");
        if (std::regex_search(source, used) && !std::regex_search(source, declared))
            front += fmt::format("const {} {};\n", type, text);
    }
    return "#define HIGHP_OR_DEFAULT\n#define MEDIUMP_OR_DEFAULT\n" + front + source;
}

/// Inputs of a program as a vertex shader makes them; whole numbers are the same everywhere.
std::vector<LinearInput> linear_inputs(const Program& program) {
    std::vector<LinearInput> inputs;
    for (const InterfaceVariable& variable : program.inputs) {
        if (variable.decorations.built_in) continue;
        LinearInput input;
        const bool real = variable.kind == Kind::real;
        const std::string prefix = real ? "" : variable.kind == Kind::whole ? "i" : "u";
        const std::string scalar = real ? "float" : variable.kind == Kind::whole ? "int" : "uint";
        input.qualifier = variable.decorations.flat             ? "flat"
                          : variable.decorations.no_perspective ? "noperspective"
                                                                : "";
        input.type = variable.components == 1 ? scalar : fmt::format("{}vec{}", prefix, variable.components);
        input.components = variable.components;
        // Columns of a matrix are written like elements of an array.
        const std::uint32_t parts = variable.columns * variable.elements;
        const std::string whole_type = variable.columns == 1 ? input.type
                                       : variable.columns == variable.components
                                           ? fmt::format("mat{}", variable.columns)
                                           : fmt::format("mat{}x{}", variable.columns, variable.components);
        if (!variable.name.starts_with("gl_"))
            input.declaration = whole_type + " " + variable.name +
                                (variable.elements == 1 ? "" : fmt::format("[{}]", variable.elements));
        for (std::uint32_t part = 0; part < parts; ++part) {
            input.name = parts == 1 ? variable.name : fmt::format("{}[{}]", variable.name, part);
            for (std::uint32_t i = 0; i < variable.components; ++i) {
                const auto coefficient = [&](std::uint32_t which) { return random_of(input.name, 3 * i + which); };
                input.base[i] = real ? 0.2F + coefficient(0) : std::floor(1 + 5 * coefficient(0));
                input.right[i] = real && !variable.decorations.flat ? coefficient(1) - 0.5F : 0;
                input.up[i] = real && !variable.decorations.flat ? coefficient(2) - 0.5F : 0;
                if (input.name.starts_with("coordinate") && i == 3) input.base[i] = 2.0F; // a divisor, never 0
            }
            inputs.push_back(input);
            input.declaration.clear();
        }
    }
    return inputs;
}

constexpr double tolerance = 1e-4;

struct Difference {
    double worst = 0; ///< of the others
    int pixels = 0;   ///< that differ by more than the tolerance,
    int steps = 0;    ///< but for those at a step of the shader
};

class Comparison {
  public:
    explicit Comparison(std::string name) : name_(std::move(name)) {}

    /// Draws with both, and says how far apart they are.
    Difference run(MesaShaders& mesa, const std::string& source, const std::vector<std::uint32_t>& words) {
        const Module module(words);
        const Program program(module);
        Quad quad(program);
        const std::vector<LinearInput> inputs = linear_inputs(program);
        uniforms_.assign(program.uniform_words, 0);
        const auto value = [&](const tests::ActiveUniform& uniform, std::uint32_t i) {
            const float number = random_of(uniform.name, i);
            const float result = uniform.real ? 0.1F + number : std::floor(number * 3);
            put(program, module, uniform, i, result);
            return result;
        };
        const auto block = [&](const tests::ActiveBlock& of, std::uint32_t i) {
            const float number = random_of(of.name, i);
            for (const UniformVariable& uniform : program.uniforms)
                if (uniform.block && uniform.name == of.name && i < uniform.words)
                    uniforms_[uniform.first + i] = std::bit_cast<std::uint32_t>(number);
            return number;
        };
        const auto unit_of = [&](const std::string& name) {
            for (std::size_t i = 0; i < program.textures.size(); ++i)
                if (program.textures[i].name == name) return static_cast<std::uint32_t>(i);
            return 15U;
        };
        const auto version_end =
            source.find("#version") == std::string::npos ? 0 : source.find('\n', source.find("#version"));
        const std::string version =
            version_end == 0 ? "" : source.substr(source.find("#version"), version_end - source.find("#version"));
        const tests::ShaderPicture expected = mesa.draw(source, version, inputs, value, block,
                                                        [&](const tests::ActiveUniform& u) { return unit_of(u.name); });
        std::vector<std::uint32_t> units(program.textures.size());
        for (std::uint32_t i = 0; i < units.size(); ++i) units[i] = i;
        OracleTextures textures(units);
        quad.set_uniforms(uniforms_);
        return compare(program, quad, textures, inputs, expected);
    }

  private:
    void put(const Program& program, const Module& module, const tests::ActiveUniform& uniform, std::uint32_t i,
             float number) {
        const auto place = program.uniform(module, uniform.name);
        if (!place) return; // glslang may see that it is not used
        const std::uint32_t component = i % place->components, column = i / place->components % place->columns;
        const std::uint32_t element = i / (place->components * place->columns);
        std::uint32_t& word = uniforms_.at(place->first + element * place->element_stride +
                                           column * place->column_stride + component * place->stride);
        word = place->kind == Kind::real ? std::bit_cast<std::uint32_t>(number) : static_cast<std::uint32_t>(number);
    }

    static const InterfaceVariable* colour_of(const Program& program) {
        for (const InterfaceVariable& output : program.outputs)
            if (output.name == "gl_FragColor" || output.name == "gl_FragData" || output.decorations.location == 0U)
                return &output;
        return nullptr;
    }

    /// Where a quad's pixels are, and how far from there its inputs are taken, in pixels.
    struct Place {
        std::uint32_t x = 0, y = 0;
        float right = 0, up = 0;
    };

    static void set_inputs(const Program& program, Quad& quad, const std::vector<LinearInput>& inputs,
                           const Place& place) {
        constexpr std::uint32_t frag_coord = 15, front_facing = 17;
        constexpr float size = MesaShaders::size;
        Lanes x{}, y{};
        for (std::uint32_t lane = 0; lane < 4; ++lane) {
            x[lane] = static_cast<float>(place.x + lane % 2) + 0.5F;
            y[lane] = static_cast<float>(place.y + lane / 2) + 0.5F;
        }
        std::size_t next = 0;
        for (const InterfaceVariable& variable : program.inputs) {
            if (variable.decorations.built_in == frag_coord) {
                quad.set(variable, 0, x);
                quad.set(variable, 1, y);
                quad.set(variable, 2, {0.5F, 0.5F, 0.5F, 0.5F});
                quad.set(variable, 3, {1, 1, 1, 1});
            }
            if (variable.decorations.built_in == front_facing) quad.set_words(variable, 0, {~0U, ~0U, ~0U, ~0U});
            if (variable.decorations.built_in) continue;
            for (std::uint32_t part = 0; part < variable.columns * variable.elements; ++part, ++next)
                for (std::uint32_t i = 0; i < variable.components; ++i) {
                    const LinearInput& input = inputs[next];
                    Lanes lanes{};
                    LaneWords words{};
                    for (std::size_t lane = 0; lane < 4; ++lane) {
                        lanes[lane] = input.base[i] + (2 * (x[lane] + place.right) / size - 1) * input.right[i] +
                                      (2 * (y[lane] + place.up) / size - 1) * input.up[i];
                        words[lane] = variable.kind == Kind::real ? std::bit_cast<std::uint32_t>(lanes[lane])
                                                                  : static_cast<std::uint32_t>(lanes[lane]);
                    }
                    quad.set_words(variable, part * variable.components + i, words);
                }
        }
    }

    /// The largest difference of a lane to a pixel, relative where numbers are large.
    static double error_of(const Quad& quad, const InterfaceVariable& colour, std::size_t lane,
                           const std::array<float, 4>& pixel) {
        constexpr double other_fate = 1e9;
        if (((quad.alive() >> lane & 1U) != 0) != (pixel[0] != MesaShaders::untouched)) return other_fate;
        if ((quad.alive() >> lane & 1U) == 0) return 0;
        double worst = 0;
        for (std::uint32_t i = 0; i < std::min(4U, colour.components); ++i) {
            const double own = quad.get(colour, i)[lane], other = pixel[i];
            if (std::isnan(own) && std::isnan(other)) continue;
            const double error = own == other ? 0 : std::abs(own - other) / std::max(1.0, std::abs(other));
            worst = std::max(worst, std::isfinite(error) ? error : other_fate);
        }
        return worst;
    }

    /// Whether inputs that differ by rounding give the pixel: it lies at a step of the shader.
    static bool at_a_step(const Program& program, Quad& quad, OracleTextures& textures,
                          const std::vector<LinearInput>& inputs, Place place, std::size_t lane,
                          const InterfaceVariable& colour, const std::array<float, 4>& pixel) {
        constexpr float little = 2e-4F; // of a pixel: some units in the last place of an input
        for (const float right : {-little, 0.0F, little})
            for (const float up : {-little, 0.0F, little}) {
                place.right = right;
                place.up = up;
                set_inputs(program, quad, inputs, place);
                quad.run(textures);
                if (error_of(quad, colour, lane, pixel) <= tolerance) return true;
            }
        return false;
    }

    Difference compare(const Program& program, Quad& quad, OracleTextures& textures,
                       const std::vector<LinearInput>& inputs, const tests::ShaderPicture& expected) const {
        Difference difference;
        const InterfaceVariable* colour = colour_of(program);
        if (colour == nullptr) throw std::runtime_error("no colour is written");
        for (std::uint32_t y = 0; y < MesaShaders::size; y += 2)
            for (std::uint32_t x = 0; x < MesaShaders::size; x += 2)
                for (std::uint32_t lane = 0; lane < 4; ++lane) {
                    set_inputs(program, quad, inputs, {x, y});
                    quad.run(textures);
                    const auto& pixel = expected.colour[(y + lane / 2) * MesaShaders::size + x + lane % 2];
                    const double error = error_of(quad, *colour, lane, pixel);
                    if (error <= tolerance) {
                        difference.worst = std::max(difference.worst, error);
                    } else if (at_a_step(program, quad, textures, inputs, {x, y}, lane, *colour, pixel)) {
                        ++difference.steps;
                    } else if (++difference.pixels <= 2) {
                        set_inputs(program, quad, inputs, {x, y});
                        quad.run(textures);
                        std::string values;
                        for (std::uint32_t i = 0; i < std::min(4U, colour->components); ++i)
                            values += fmt::format(" {} ({})", quad.get(*colour, i)[lane], pixel[i]);
                        ADD_FAILURE() << fmt::format("{}: pixel {}, {} is{}, in brackets llvmpipe's", name_,
                                                     x + lane % 2, y + lane / 2, values);
                    }
                }
        return difference;
    }

    std::string name_;
    std::vector<std::uint32_t> uniforms_;
};

} // namespace

class SpirvMesa : public testing::Test {
  protected:
    static void SetUpTestSuite() { mesa_ = MesaShaders::create(reason_).release(); }
    static void TearDownTestSuite() {
        delete mesa_;
        mesa_ = nullptr;
    }
    void SetUp() override {
        if (!traces::can_compile_glsl()) GTEST_SKIP() << "built without glslang (packages glslang-dev and spirv-tools)";
        if (mesa_ == nullptr) GTEST_SKIP() << "no OpenGL to compare with: " << reason_;
    }

    /// As glslang writes it and optimised; false when it cannot be compiled.
    bool compare(const std::string& name, const std::string& source) {
        const tests::CompiledSpirv spirv = tests::compile_fragment_shader(source);
        if (!spirv.problem.empty()) {
            ADD_FAILURE() << name << ": " << spirv.problem;
            return false;
        }
        for (const auto* words : {&spirv.plain, &spirv.optimised}) {
            const std::string what = name + (words == &spirv.plain ? "" : " (optimised)");
            try {
                const Difference difference = Comparison(what).run(*mesa_, source, *words);
                EXPECT_EQ(difference.pixels, 0)
                    << what << ": pixels that differ; worst difference " << difference.worst << "\n"
                    << source;
                worst_ = std::max(worst_, difference.worst);
            } catch (const std::exception& error) {
                ADD_FAILURE() << what << ": " << error.what();
            }
        }
        return true;
    }

    static inline MesaShaders* mesa_ = nullptr;
    static inline std::string reason_;
    double worst_ = 0;
};

// Long, as it compiles some sixty shaders with two compilers each.
TEST_F(SpirvMesa, LongFragmentShadersGiveLlvmpipesColours) {
    std::vector<std::pair<std::string, std::string>> shaders;
    const fs::path glmark2 = "/usr/share/glmark2/shaders";
    std::vector<fs::path> files;
    if (fs::exists(glmark2))
        for (const auto& entry : fs::directory_iterator(glmark2))
            if (entry.path().extension() == ".frag") files.push_back(entry.path());
    for (const auto& entry : fs::directory_iterator(ropsim_test::source_dir() / "tests/oracle/shaders"))
        files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    int compared = 0;
    for (const fs::path& file : files) {
        const std::string name = file.filename().string(), text = read(file);
        compared += compare(name, file.parent_path() == glmark2 ? completed_glmark2(text) : text) ? 1 : 0;
    }
    EXPECT_GE(compared, 40);
    std::printf("%d fragment shaders, worst difference %.2g\n", compared, worst_);
}

TEST_F(SpirvMesa, LongShadersInPlaceOfFixedFunctionsGiveLlvmpipesColours) {
    int compared = 0;
    for (std::uint64_t seed = 0; seed < 64; ++seed) {
        sim::Random random(seed, "fragment shaders");
        traces::FixedFunctionState state = tests::random_fixed_function(random);
        state.points.drawn = false; // the harness draws triangles
        const std::string source = traces::fixed_function_program(state).fragment;
        // Nor has it textures of one row, in the middle of which these are read, or comparisons in rectangles.
        if (source.find("0.5 * coordinate") != std::string::npos) continue;
        if (source.find("sampler2DRectShadow") != std::string::npos) continue;
        compared += compare(fmt::format("fixed function {}", seed), source) ? 1 : 0;
    }
    EXPECT_GE(compared, 30);
    std::printf("%d fragment shaders, worst difference %.2g\n", compared, worst_);
}

} // namespace spirv_mesa_test
