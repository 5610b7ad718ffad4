// What modify programs in GLSL declare, and the shaders that run them.
#include "sim/check.hpp"
#include "traces/shader_programs/task_text.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace shader_programs_text {

namespace {

using namespace traces::shader_programs;

const std::string functions = "Entry entry(Fragment f) { return Entry(f.colour.r, f.depth); }\n"
                              "Entry empty() { return Entry(0.0, largest); }\n"
                              "void modify(inout Entry e[k], Entry f) { e[0] = f; }\n";
const std::string smallest = "#pragma program \"mine\"\nstruct Entry { float r, z; };\n" + functions;

TEST(ShaderProgramText, DeclaresWhatPragmasAndStructuresSay) {
    const Declaration program = declaration_of(
        "mine.glsl",
        "/* struct Entry { int no; };\n */ // #pragma k 9\n"
        "#pragma program \"mine\" \"two moments\"\n#pragma k 3 from 2 to 8\n#pragma order any\n"
        "  #  pragma peeling nearest\n#pragma picture nodes\n#pragma depth far\n#pragma optimize(on)\n"
        "struct Entry { vec2 moments; float r, g, b, t, far; };\nstruct State { vec4 sum; float n; };\n"
        "State initial() { return State(vec4(0.0), 0.0); }\n"
        "Entry entry(Fragment f) { return Entry(vec2(0.0), 1.0, 1.0, 1.0, 1.0, f.depth); }\n"
        "Entry empty() { return Entry(vec2(0.0), 0.0, 0.0, 0.0, 0.0, largest); }\n"
        "void modify(inout Entry e[k], inout State s, Entry f) {}\nvoid drain (inout Entry e[k], inout State s) {}");
    EXPECT_EQ(program.id, "mine");
    EXPECT_EQ(program.summary, "two moments");
    EXPECT_EQ(program.default_k, 3U);
    EXPECT_EQ(program.least_k, 2U);
    EXPECT_EQ(program.most_k, 8U);
    EXPECT_EQ(program.entry, (Fields{"moments.x", "moments.y", "r", "g", "b", "t", "far"}));
    EXPECT_EQ(program.state, (Fields{"sum.x", "sum.y", "sum.z", "sum.w", "n"}));
    EXPECT_EQ(program.depth_slot(), 6U);
    EXPECT_EQ(program.order, pipeline::OrderNeed::any);
    EXPECT_EQ(program.peeling, pipeline::Peeling::nearest);
    EXPECT_EQ(program.picture, Picture::nodes);
    EXPECT_TRUE(program.drains());
    EXPECT_FALSE(program.needs_colour);
    EXPECT_EQ(program.lines, 16U);
    EXPECT_EQ(program.line_of(Function::entry), 13U);
    EXPECT_EQ(program.line_of(Function::drain), 16U);
    EXPECT_EQ(program.floats(3), 3U * 7U + 5U);
}

TEST(ShaderProgramText, HasUsualValuesForAllButNameAndEntry) {
    const Declaration program = declaration_of("mine.glsl", smallest);
    EXPECT_EQ(program.least_k, 1U);
    EXPECT_EQ(program.default_k, 4U);
    EXPECT_EQ(program.most_k, 64U);
    EXPECT_EQ(program.order, pipeline::OrderNeed::primitive_order);
    EXPECT_EQ(program.peeling, pipeline::Peeling::none);
    EXPECT_EQ(program.picture, Picture::layers);
    EXPECT_FALSE(program.drains());
    EXPECT_TRUE(program.needs_colour);
}

TEST(ShaderProgramText, ReadsAndWritesThePixelByRenderTargets) {
    const Declaration program = declaration_of("mine.glsl", smallest);
    const std::string text = task_text(program, Task::modify, 3, 0.5F);
    for (const char* line :
         {"const int k = 3;", "uniform vec4 kbuffer_before[2];", "out vec4 kbuffer_after[2];",
          "kbuffer_e[2].z = kbuffer_before[1].y;", "kbuffer_f.z = kbuffer_fragment[0].y;",
          "modify(kbuffer_e, kbuffer_f);", "kbuffer_after[1] = vec4(kbuffer_e[2].r, kbuffer_e[2].z, 0.0, 0.0);"})
        EXPECT_NE(text.find(line), std::string::npos) << line << "\n" << text;
    // Lines of messages are those of the user's file, or of the function there that a call does not fit.
    EXPECT_NE(text.find("#line 1\n" + smallest), std::string::npos);
    EXPECT_NE(text.find("#line 5\n    modify("), std::string::npos) << text;
    EXPECT_NE(task_text(program, Task::entry, 3, 0.5F).find("#line 3\n"), std::string::npos);
    EXPECT_NE(task_text(program, Task::clear, 3, 0.5F).find("#line 4\n"), std::string::npos);
}

std::string refused(const std::string& text) {
    try {
        declaration_of("mine.glsl", text);
    } catch (const sim::InputError& error) {
        return error.what();
    }
    return "";
}

TEST(ShaderProgramText, ErrorsNameTheLineAndWhatWasExpected) {
    EXPECT_EQ(refused("#version 330\n" + smallest),
              "mine.glsl:1: expected no version, as the program is put behind one, got '#version'");
    EXPECT_EQ(refused(functions), "mine.glsl:4: expected a line '#pragma program \"NAME\"', got the end");
    EXPECT_EQ(refused("#pragma program mine\n"), "mine.glsl:1: expected a name between quotes, got 'mine'");
    EXPECT_EQ(refused("\n#pragma k 65\n"), "mine.glsl:2: expected a number from 1 to 64, got '65'");
    EXPECT_EQ(refused("#pragma k 4 from 5 to 8\n"), "mine.glsl:1: expected 4 to lie from 5 to 8, got '4'");
    EXPECT_EQ(refused("#pragma order some\n"), "mine.glsl:1: expected any or primitive, got 'some'");
    EXPECT_EQ(refused("struct Entry {\n  int z;\n};"), "mine.glsl:2: expected float, vec2, vec3 or vec4, got 'int'");
    EXPECT_EQ(refused("struct Entry { float z[2]; };"), "mine.glsl:1: expected ';', got '['");
    EXPECT_EQ(refused("struct Entry { float"), "mine.glsl:1: expected the name of a field, got the end");
    EXPECT_EQ(refused("#pragma program \"mine\"\n" + functions),
              "mine.glsl:5: expected a structure 'struct Entry { ... };', got the end");
    EXPECT_EQ(refused("#pragma program \"mine\"\nstruct Entry { float r; };\n" + functions),
              "mine.glsl: expected a float 'z' in Entry, the depth; '#pragma depth NAME' names another");
    EXPECT_EQ(refused("#pragma program \"mine\"\nstruct Entry { vec4 a, b; float z; };\n" + functions),
              "mine.glsl: expected entries of 1 to 8 floats, got 9");
    EXPECT_EQ(refused("struct State { float n; };\n" + smallest),
              "mine.glsl:7: expected a function 'State initial()', got the end");
    EXPECT_EQ(refused("#pragma picture nodes\n" + smallest),
              "mine.glsl: expected floats r, g, b, t in Entry, of which the picture is made; got no g");
    EXPECT_EQ(refused("#pragma program \"mine\"\nstruct Entry { float z; };\n"),
              "mine.glsl:3: expected a function 'Entry entry(Fragment f)', got the end");
    EXPECT_EQ(refused("/* no end"), "mine.glsl:1: expected a line '#pragma program \"NAME\"', got the end");
}

} // namespace

} // namespace shader_programs_text
