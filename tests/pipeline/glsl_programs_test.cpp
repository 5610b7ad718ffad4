// Modify programs in GLSL by their files: on the command line, in every design, in draw traces.
// Source: specification 004, programs A6 and A7.
#include "sim/check.hpp"
#include "tests/support/program_run.hpp"
#include "tests/support/replay.hpp"
#include "traces/glsl.hpp"
#include "traces/user_programs.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <utility>

namespace glsl_programs_test {

using nlohmann::json;
using ropsim_test::run_program;
using ropsim_test::TemporaryFolder;
using ropsim_test::write_text;
using support::Replay;

class GlslPrograms : public ::testing::Test {
  protected:
    void SetUp() override {
        if (!traces::can_compile_glsl()) GTEST_SKIP() << "built without glslang (packages glslang-dev and spirv-tools)";
    }
};

/// The nearest fragment; `body` is that of the function modify(), which begins in line 5.
std::string with_body(const std::string& body) {
    return "#pragma program \"one\" \"the nearest fragment\"\n#pragma k 1 from 1 to 4\n"
           "struct Entry { float r, g, b, z; };\nEntry empty() { return Entry(0.0, 0.0, 0.0, largest); }\n"
           "void modify(inout Entry e[k], Entry f) {\n" +
           body + "\n}\nEntry entry(Fragment f) { return Entry(f.colour.r, f.colour.g, f.colour.b, f.depth); }\n";
}
const std::string nearest = with_body("    if (f.z < e[0].z) e[0] = f;");
const std::string farthest = with_body("    if (e[0].z == largest || f.z > e[0].z) e[0] = f;");

std::vector<std::string> with(std::vector<std::string> arguments, const std::vector<std::string>& more) {
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}
const std::vector<std::string> small_run{"run", "gen:stack?n=4", "--size", "16x16", "--no-images", "--json"};

Replay replay_of(const std::string& program) {
    return Replay("gen:discs?n=120&overlap=8&width=32&height=32",
                  {.width = 32, .height = 32, .knobs = {"program=" + program, "k=3", "opacity=0.3"}});
}

TEST_F(GlslPrograms, A6AndA7GiveTheImagesOfTheBuiltInOnesInEveryProtectedDesign) {
    for (const auto& [name, file] : {std::pair<std::string, std::string>{"nearest-k", "nearest_k.glsl"},
                                     {"order-and-blend", "order_and_blend.glsl"}}) {
        const Replay built_in = replay_of(name), written = replay_of(file);
        EXPECT_FALSE(built_in.reference.picture.empty());
        EXPECT_TRUE(written.reference.picture == built_in.reference.picture) << file;
        EXPECT_TRUE(written.reference.kbuffer == built_in.reference.kbuffer) << file;
        std::size_t compared = 0;
        for (const std::string& design : built_in.designs()) {
            if (!support::protects(design) || !support::holds_everything(design)) continue;
            const pipeline::RunResult run = written.run(design);
            EXPECT_EQ(run.hazards.total(), 0U) << design;
            EXPECT_EQ(run.wrong_pixels, 0U) << design;
            EXPECT_TRUE(run.kbuffer == built_in.run(design).kbuffer) << design << " " << file;
            ++compared;
        }
        EXPECT_GT(compared, 4U) << file;
        EXPECT_EQ(written.designs(), built_in.designs());
    }
}

TEST_F(GlslPrograms, ACommandRunsThatOfAFile) {
    const TemporaryFolder folder;
    const std::string file = (folder.path() / "one.glsl").string();
    write_text(file, nearest);
    const auto outcome = run_program(with(small_run, {"--program", file}));
    ASSERT_EQ(outcome.status, 0) << outcome.error;
    const json result = json::parse(outcome.out);
    EXPECT_EQ(result["scene"]["kbuffer"]["program"], "one");
    EXPECT_EQ(result["scene"]["kbuffer"]["k"], 1);
    const auto shipped = run_program(with(small_run, {"--program", "nearest_k.glsl", "--k", "2"}));
    ASSERT_EQ(shipped.status, 0) << shipped.error;
    EXPECT_EQ(json::parse(shipped.out)["scene"]["kbuffer"]["program"], "nearest-k");
}

TEST_F(GlslPrograms, ErrorsAreOneLineWithTheFileAndItsLine) {
    const TemporaryFolder folder;
    const std::string file = (folder.path() / "one.glsl").string();
    const auto error = [&](const std::string& text, const std::vector<std::string>& more = {}) {
        write_text(file, text);
        const auto outcome = run_program(with(with(small_run, {"--program", file}), more));
        EXPECT_EQ(outcome.status, 1);
        EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
        return outcome.error;
    };
    const auto expect = [&](const std::string& got, const std::string& part) {
        EXPECT_NE(got.find(file + part), std::string::npos) << got;
    };
    expect(error(with_body("\n    e[0].z = nothing;")),
           ":7: expected GLSL that glslang compiles: 'nothing' : undeclared identifier");
    expect(error(with_body("    e[0] = f")), ":7: expected GLSL that glslang compiles: '' :  syntax error");
    std::string other = nearest;
    other.replace(other.find("Entry f) {\n"), 7, "float f");
    other.replace(other.find("    if"), 31, "");
    expect(error(other), ":5: expected GLSL that glslang compiles: 'modify' : no matching overloaded function found");
    expect(error("#pragma k 0\n" + nearest), ":1: expected a number from 1 to 64, got '0'");
    expect(error(nearest, {"--k", "5"}), ": k: expected 1 to 4, got 5");
    expect(error(nearest, {"--entry", "z"}), ": it declares its entries; expected no kind, got 'z'");
    expect(error(with_body("    if (f.z > 0.5) discard;")), ": expected a program without discard");
    expect(error(with_body("    while (f.z < 2.0) e[0].r = 1.0 - e[0].r;")),
           ": a fragment takes more than 65536 instructions; expected loops that end");
    expect(error(std::string((1U << 20U) + 1, ' ')), ": expected a file of at most 1,048,576 bytes");
}

TEST(GlslProgramFiles, ThatAreMissingAreToldSoWithoutACompiler) {
    const auto outcome = run_program(with(small_run, {"--program", "missing.glsl"}));
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.error.find("missing.glsl: there is no such file"), std::string::npos) << outcome.error;
}

TEST_F(GlslPrograms, TravelInTheTrace) {
    const TemporaryFolder folder;
    const std::string program = (folder.path() / "one.glsl").string(), file = (folder.path() / "x.rtrace").string();
    write_text(program, nearest);
    const auto captured =
        run_program({"capture", "gen:stack?n=4", "--size", "16x16", "--program", program, "-o", file});
    ASSERT_EQ(captured.status, 0) << captured.error;
    std::filesystem::remove(program);
    const auto replay = run_program({"replay", file, "--designs", "blender", "--json"});
    ASSERT_EQ(replay.status, 0) << replay.error;
    EXPECT_EQ(json::parse(replay.out)["scene"]["kbuffer"]["program"], "one");
    EXPECT_EQ(run_program({"trace", "validate", file}).status, 0);
}

/// As a trace has it.
std::string in_a_trace(const std::string& text, std::uint32_t k = 1) {
    const TemporaryFolder folder;
    const std::string file = (folder.path() / "one.glsl").string();
    write_text(file, text);
    return traces::self_contained(file, k, 0.5F);
}
std::string modules_of(const std::string& program) { return program.substr(program.rfind('\n')); }

float kept_of_two(const pipeline::ModifyProgram& program) {
    std::vector<float> pixel(program.floats_per_pixel());
    program.clear(pixel.data());
    for (const float depth : {0.25F, 0.75F}) {
        const std::array<float, 4> entry{0.0F, 0.0F, 0.0F, depth};
        program.insert(pixel.data(), entry.data());
    }
    return pixel[3];
}

TEST_F(GlslPrograms, OfATraceAreRunAsItsModulesSayAndCompileNothing) {
    const std::string one = in_a_trace(nearest), other = in_a_trace(farthest);
    EXPECT_TRUE(one.starts_with("one.glsl\n" + nearest + "\n// SPIR-V 07230203"));
    EXPECT_EQ(traces::self_contained(one, 1, 0.5F), one);
    EXPECT_EQ(traces::usual_entries(one), 1U);
    EXPECT_EQ(kept_of_two(*traces::chosen_program(one, {"", 1, 0.5F}).program), 0.25F);
    const std::string changed = one.substr(0, one.rfind('\n')) + modules_of(other);
    EXPECT_EQ(kept_of_two(*traces::chosen_program(changed, {"", 1, 0.5F}).program), 0.75F);
    const std::string wrong = "one.glsl\n" + with_body("    no GLSL") + modules_of(one);
    EXPECT_EQ(kept_of_two(*traces::chosen_program(wrong, {"", 1, 0.5F}).program), 0.25F);
}

std::string refusal(const std::string& program, std::uint32_t k = 1) {
    try {
        traces::chosen_program(program, {"", k, 0.5F});
    } catch (const sim::InputError& error) {
        return error.what();
    }
    return "none";
}

TEST_F(GlslPrograms, OfATraceAreNotTrusted) {
    const std::string one = in_a_trace(nearest), text = "one.glsl\n" + nearest;
    const std::string no_modules =
        "one.glsl: expected the program's text and a last line '// SPIR-V ...' with its modules";
    EXPECT_EQ(refusal("one.glsl\n"), no_modules);
    EXPECT_EQ(refusal(text), no_modules);
    EXPECT_EQ(refusal("one.glsl" + modules_of(one)), no_modules);
    const std::string count = "one.glsl: expected 4 modules behind the program's text";
    EXPECT_EQ(refusal(text + "\n// SPIR-V"), count);
    EXPECT_EQ(refusal(text + "\n// SPIR-Vx"), count);
    EXPECT_EQ(refusal(one + " 00000000"), count);
    EXPECT_EQ(refusal(one.substr(0, one.rfind(' '))), count);
    const std::string digits = "one.glsl: expected modules of 1 to 1048576 words, 8 hexadecimal digits each";
    EXPECT_EQ(refusal(one.substr(0, one.size() - 1)), digits);
    EXPECT_EQ(refusal(one.substr(0, one.size() - 1) + "x"), digits);
    EXPECT_EQ(refusal(text + "\n// SPIR-V  "), digits);
    EXPECT_TRUE(refusal(text + "\n// SPIR-V 1 2 3 4").starts_with(digits));
    EXPECT_TRUE(refusal(text + "\n// SPIR-V 00000001 00000001 00000001 00000001").starts_with("one.glsl: SPIR-V"));
    EXPECT_EQ(refusal(one, 2), "one.glsl: expected kbuffer_after as an array of 2 vec4 or more");
    EXPECT_EQ(
        refusal(text + std::string(1U << 20U, ' ') + modules_of(one)),
        fmt::format("one.glsl: expected a program of at most 1048576 bytes, got {}", nearest.size() + (1U << 20U)));
}

TEST_F(GlslPrograms, AnyWordOfATracesModulesMayBeAnother) {
    const std::string good = in_a_trace(nearest);
    const std::size_t first = good.rfind('\n') + 1;
    std::size_t refused = 0, run = 0;
    for (std::size_t at = first; at < good.size(); at += 37) {
        std::string program = good;
        program[at] = program[at] == '1' ? 'f' : '1';
        try {
            const auto made = traces::chosen_program(program, {"", 1, 0.5F}).program;
            kept_of_two(*made);
            ++run;
        } catch (const sim::InputError&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 20U);
    EXPECT_GT(run, 0U);
}

} // namespace glsl_programs_test
