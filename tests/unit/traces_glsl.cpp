// GLSL to SPIR-V by the module.
#include "sim/check.hpp"
#include "traces/glsl.hpp"
#include "traces/spirv/program.hpp"

#include <gtest/gtest.h>

namespace glsl_test {

using traces::CompiledProgram;
using traces::GlslProgram;

class Glsl : public ::testing::Test {
  protected:
    void SetUp() override {
        if (!traces::can_compile_glsl()) GTEST_SKIP() << "built without glslang (packages glslang-dev and spirv-tools)";
    }
};

namespace {

std::string problem_of(const GlslProgram& program) {
    try {
        traces::compile_glsl(program);
    } catch (const sim::InputError& error) {
        return error.what();
    }
    return "none";
}

std::uint32_t location(const traces::spirv::InterfaceVariable* variable) {
    EXPECT_NE(variable, nullptr);
    return variable == nullptr ? 999 : variable->decorations.location.value_or(999);
}

} // namespace

TEST_F(Glsl, VaryingsHaveTheSameLocationInBothStages) {
    const CompiledProgram compiled = traces::compile_glsl({"p",
                                                           {"attribute vec4 a; varying vec2 one; varying mat3 two; "
                                                            "varying float three;\n"
                                                            "void main() { gl_Position = a; one = a.xy; "
                                                            "two = mat3(a.x); three = a.z; }"},
                                                           {"varying float three; varying vec2 one;\n"
                                                            "void main() { gl_FragColor = vec4(one, three, 1.0); }"},
                                                           {}});
    const traces::spirv::Module vertex_module(compiled.vertex), fragment_module(compiled.fragment);
    const traces::spirv::Program vertex(vertex_module), fragment(fragment_module);
    for (const char* name : {"one", "three"})
        EXPECT_EQ(location(fragment.input(name)), location(vertex.output(name))) << name;
    EXPECT_NE(location(vertex.output("one")), location(vertex.output("three")));
}

TEST_F(Glsl, OutputsHaveTheLocationsOfTheApplication) {
    const GlslProgram program{"p",
                              {},
                              {"#version 130\nout vec4 first, second;\n"
                               "void main() { first = vec4(1.0); second = vec4(0.5); }"},
                              {{"first", 3}, {"second", 1}}};
    const CompiledProgram compiled = traces::compile_glsl(program);
    EXPECT_TRUE(compiled.vertex.empty());
    const traces::spirv::Module module(compiled.fragment);
    const traces::spirv::Program fragment(module);
    EXPECT_EQ(location(fragment.output("first")), 3U);
    EXPECT_EQ(location(fragment.output("second")), 1U);
}

TEST_F(Glsl, SeveralShadersOfAStageAreOne) {
    const CompiledProgram compiled = traces::compile_glsl(
        {"p",
         {},
         {"vec4 shade() { return vec4(0.5); }", "vec4 shade();\nvoid main() { gl_FragColor = shade(); }"},
         {}});
    EXPECT_NO_THROW(traces::spirv::Module{compiled.fragment});
}

TEST_F(Glsl, OldFunctionsAndVersionsAreTaken) {
    const CompiledProgram compiled = traces::compile_glsl(
        {"p", {"#version 120\nvoid main() { gl_Position = ftransform(); gl_FrontColor = gl_Color; }"}, {}, {}});
    const traces::spirv::Module module(compiled.vertex);
    const traces::spirv::Program vertex(module);
    EXPECT_TRUE(vertex.uniform(module, "gl_ModelViewProjectionMatrix").has_value());
    EXPECT_NE(vertex.input("gl_Vertex"), nullptr);
}

TEST_F(Glsl, TruthsMayBePlainUniforms) {
    const CompiledProgram compiled = traces::compile_glsl(
        {"p", {}, {"uniform bool lit;\nvoid main() { gl_FragColor = vec4(lit ? 1.0 : 0.5); }"}, {}});
    const traces::spirv::Module module(compiled.fragment);
    const traces::spirv::Program fragment(module);
    EXPECT_TRUE(fragment.uniform(module, "lit").has_value());
}

TEST_F(Glsl, MistakesNameProgramStageAndLine) {
    EXPECT_EQ(problem_of({"lamp", {}, {"void main() {\n  gl_FragColor = colour;\n}"}, {}}),
              "lamp: expected GLSL that glslang compiles: fragment shader, line 2: 'colour' : undeclared identifier ");
    try {
        traces::compile_glsl({"lamp", {}, {"void main() {\n  gl_FragColor = colour;\n}"}, {}});
        FAIL();
    } catch (const traces::GlslError& error) {
        EXPECT_EQ(error.line, 2U);
        EXPECT_EQ(error.problem, "'colour' : undeclared identifier");
    }
    const std::string link = problem_of({"lamp",
                                         {"varying vec2 v; void main() { gl_Position = vec4(0.0); v = vec2(0.0); }"},
                                         {"varying vec3 v; void main() { gl_FragColor = v.xyzz; }"},
                                         {}});
    EXPECT_TRUE(link.starts_with("lamp: expected GLSL that glslang compiles: linking, ")) << link;
}

TEST(GlslErrors, TakeTheLineOutOfWhatTheModuleSays) {
    const auto error = [](const char* failure) { return traces::GlslError("lamp", failure); };
    EXPECT_EQ(error("fragment shader, line 12: 'x' : ").line, 12U);
    EXPECT_EQ(error("fragment shader, line 12: 'x' : ").problem, "'x' :");
    for (const char* failure :
         {"", "linking, no main", "fragment shader, line x: y", "vertex shader, line 3", "a, line "}) {
        EXPECT_EQ(error(failure).line, 0U) << failure;
        EXPECT_EQ(error(failure).problem, failure);
    }
}

} // namespace glsl_test
