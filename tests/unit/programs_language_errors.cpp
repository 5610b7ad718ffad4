// The k-buffer language and hostile input: one line that says where and what was expected, and never a crash.
#include "models/programs/language/user_program.hpp"
#include "sim/check.hpp"
#include "sim/random.hpp"
#include "tests/support/program_run.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <utility>
#include <vector>

namespace programs_language_errors_test {

std::string error_of(const std::string& text, std::uint32_t k = 0) {
    try {
        models::user_program("p.kb", text, k);
    } catch (const sim::InputError& error) {
        return error.what();
    }
    return {};
}

/// The message for a program with this body; it stands on line 2.
std::string body_error(const std::string& body) {
    return error_of(
        fmt::format("program \"p\"; k 2; entry r, z; state x = 0; constant c = 1.5;\nfragment {{{}}}", body));
}

std::string many(std::size_t count, std::string_view text) {
    std::string result;
    for (std::size_t i = 0; i < count; ++i) result += text;
    return result;
}

TEST(LanguageErrors, SayWhereAndWhatWasExpected) {
    const std::vector<std::pair<std::string, std::string>> cases{
        {"s.x = ;", "2:17: expected an expression, got ';'"},
        {"s.x = 1", "2:18: expected ';', got '}'"},
        {"s.y = 1;", "2:11: expected a field of the state (x), got 's.y'"},
        {"f.b = 1;", "2:11: expected a field of the entry (r, z), got 'f.b'"},
        {"float zeta = 1; s.x = zet;", "2:33: expected a name that is declared, got 'zet'; did you mean 'zeta'?"},
        {"c = 1;", "2:11: expected a variable, an entry, the fragment or a field of the state, got 'c'"},
        {"for i in 0..2 { i = 1; }",
         "2:27: expected a variable, an entry, the fragment or a field of the state, got 'i'"},
        {"s.x = f;", "2:17: expected a number, got an entry"},
        {"e[0] = 1;", "2:18: expected an entry, got a whole number"},
        {"s.x = true;", "2:17: expected a number, got true or false"},
        {"if f.r { s.x = 1; }", "2:14: expected true or false, got a number"},
        {"int n = 1.5;", "2:19: expected a whole number, got a number"},
        {"s.x = e[0.5].z;", "2:19: expected a whole number, got a number"},
        {"s.x = e[2].z;", "2:17: expected an index from 0 to 1 (k is 2), got 2"},
        {"s.x = e[k - 3].z;", "2:17: expected an index from 0 to 1 (k is 2), got -1"},
        {"for i in 0..3 { s.x = e[i].z; }", "2:33: expected an index from 0 to 1 (k is 2), got 2"},
        {"for i in 0..int(f.r) { s.x = 1; }",
         "2:23: expected a bound that is known before the program runs, got a value that is not"},
        {"swap f, f.r;", "2:19: expected an entry, got a number"},
        {"swap 1, f;", "2:16: expected a name, got '1'"},
        {"float if = 1;", "2:17: expected a name that is not a word of the language, got 'if'"},
        {"float a = 1; float a = 2;", "2:30: expected a name that is not taken, got 'a'"},
        {"if true { float a = 1; } s.x = a;", "2:42: expected a name that is declared, got 'a'"},
        {"s.x = 1 < 2 < 3;", "2:23: expected ';', got '<'"},
        {"s.x = min(1);", "2:22: expected ',', got ')'"},
        {"s.x = 1e99;", "2:17: expected a number that a float can hold, got '1e99'"},
        {"s.x = 99999999;", "2:17: expected a whole number up to 16777216, got '99999999'"},
        {"s.x = 1e;", "2:17: expected a number that a float can hold, got '1e'"},
        {"s.x = $;", "2:17: expected a word, a number or a sign, got '$'"},
        {"s.x = \x01;", "2:17: expected a word, a number or a sign, got '\\x01'"},
        {"5 = s.x;", "2:11: expected a statement or '}', got '5'"},
    };
    for (const auto& [body, message] : cases) EXPECT_EQ(body_error(body), "p.kb:" + message) << body;
    EXPECT_EQ(body_error("s.x = c + f.r;"), "");
}

TEST(LanguageErrors, OfHeaders) {
    const std::vector<std::pair<std::string, std::string>> cases{
        {"", "1:1: expected 'program', got the end of the file"},
        {"program;", "1:8: expected the program's name in quotes, got ';'"},
        {"program \"a", "1:9: expected a text that ends on its line, got '\"a'"},
        {"program \"a\"; fragment {", "1:24: expected a statement or '}', got the end of the file"},
        {"program \"a\"; fragment {}", "1:1: expected an entry of 1 to 8 fields, got 0"},
        {"program \"a\"; entry z; fragment {} x", "1:35: expected 'drain' or the end of the file, got 'x'"},
        {"program \"a\"; entry z; fragment {} drain { s.x = 1; }",
         "1:43: expected no field: the program declares no state, got 's.x'"},
        {"program \"a\"; entry z; fragment {} drain { e[0].z = f.z; }",
         "1:52: expected an entry or the state: there is no fragment in a drain, got 'f'"},
        {"program \"a\"; entry r; fragment {}", "1:1: expected a field of the entry, got 'z'"},
        {"program \"a\"; entry z, z; fragment {}", "1:23: expected each field of the entry once, got 'z' again"},
        {"program \"a\"; entry w; fragment {}",
         "1:20: expected a field of the shaded fragment (r, g, b, a, z, object), got 'w'"},
        {"program \"a\"; entry z = e[0].z; fragment {}",
         "1:24: expected a field of the shaded fragment or a constant, got 'e'"},
        {"program \"a\"; entry z; empty q = 1; fragment {}", "1:29: expected a field of the entry, got 'q'"},
        {"program \"a\"; entry z; state x = f.z; fragment {}", "1:33: expected a constant, got 'f.z'"},
        {"program \"a\"; k 0; entry z; fragment {}", "1:16: expected 1 to 64, got '0'"},
        {"program \"a\"; k 4 from 1 to 3; entry z; fragment {}", "1:16: expected 1 to 3, got '4'"},
        {"program \"a\"; order sorted; entry z; fragment {}", "1:20: expected 'any' or 'primitive', got 'sorted'"},
        {"program \"a\"; picture state; entry z; state r = 0; fragment {}",
         "1:14: expected fields r, g, b and t in the state, got none called 'g'"},
        {"program \"a\"; k 4 from 1 to 64; entry r, g, b, a, z; fragment {}",
         "1:38: expected at most 64 render targets of four floats for k = 64, got 80"},
        {"program \"a\"; colour z; fragment {}",
         "1:14: expected 'program', 'k', 'entry', 'empty', 'state', 'constant', 'depth', 'order', 'peeling', 'picture' "
         "or 'fragment', got 'colour'"},
    };
    for (const auto& [text, message] : cases) EXPECT_EQ(error_of(text), "p.kb:" + message) << text;
    EXPECT_EQ(error_of("program \"a\"; k 4 from 2 to 8; entry z; fragment {}", 9), "p.kb: k: expected 2 to 8, got 9");
    EXPECT_EQ(error_of("program \"a\"; k 4 from 2 to 8; entry z; fragment {}", 8), "");
}

TEST(LanguageErrors, EndlessNestingIsRefused) {
    const std::vector<std::string> bodies{
        "s.x = " + many(100000, "(") + "1;",
        "s.x = " + many(100000, "-") + "1;",
        "s.x = 1" + many(100000, " + 1") + ";",
        "bool b = " + many(100000, "not ") + "true;",
        "s.x = " + many(100000, "e["),
        "s.x = " + many(100000, "abs("),
        many(100000, "if true {"),
        "if true {} " + many(50000, "else if true {}"),
        many(50000, "for i in 0..2 {"),
    };
    for (const std::string& body : bodies) {
        const std::string error = body_error(body);
        EXPECT_NE(error.find(": expected "), std::string::npos) << body.substr(0, 30);
        EXPECT_NE(error.find("at most 64"), std::string::npos) << error;
        EXPECT_LT(error.size(), 200U);
    }
}

TEST(LanguageErrors, UnrollingHasAnEnd) {
    EXPECT_NE(body_error("for i in 0..16777216 { }").find("expected at most 262144 rounds of loops"),
              std::string::npos);
    EXPECT_NE(body_error("for i in 0..500 { for j in 0..500 { s.x = f.r + 1; } }").find("at most 65535 instructions"),
              std::string::npos);
    std::string variables;
    for (int i = 0; i < 300; ++i) variables += fmt::format("float v{} = f.r;", i);
    EXPECT_NE(body_error(variables).find("at most 256 variables"), std::string::npos);
    std::string constants;
    for (int i = 0; i < 5000; ++i) constants += fmt::format("s.x = {}.5;", i);
    EXPECT_NE(body_error(constants).find("at most 512 constants"), std::string::npos);
}

TEST(LanguageErrors, GarbageGivesOneClearLine) {
    sim::Random random(5, "garbage");
    for (const std::size_t size : {std::size_t{1}, std::size_t{100}, std::size_t{1} << 20}) {
        std::string bytes, words;
        for (std::size_t i = 0; i < size; ++i) bytes += static_cast<char>(random.below(256));
        while (words.size() + 8 < size)
            words += std::vector{"if ", "e[", "0..", "} ", "f.z ", "= ", "for "}[random.below(7)];
        for (const std::string& text : {bytes, words, "program \"p\"; entry z; fragment {" + words}) {
            const std::string error = error_of(text);
            EXPECT_TRUE(error.starts_with("p.kb:")) << error;
            EXPECT_NE(error.find("expected "), std::string::npos) << error;
            EXPECT_LT(error.size(), 300U);
            for (const char c : error) EXPECT_TRUE(c >= ' ' && c <= '~');
        }
    }
}

// Programs made of random pieces either compile or are refused; those that compile run without storing an infinity.
TEST(LanguageErrors, RandomProgramsAreRefusedOrRun) {
    const std::vector<std::string> pieces{"s.x = ",
                                          "f.r",
                                          "f.z",
                                          "1.5",
                                          "+",
                                          "*",
                                          "/",
                                          "-",
                                          ";",
                                          "e[0].z",
                                          "e[n].r",
                                          "= ",
                                          "if ",
                                          "f.r < 1 ",
                                          "{ ",
                                          "} ",
                                          "swap ",
                                          ", ",
                                          "e[1]",
                                          "f",
                                          "int n = 1;",
                                          "largest",
                                          "for i in 0..k {",
                                          "e[i]",
                                          "min(",
                                          ")",
                                          "float a = f.r;",
                                          "a",
                                          "s.x = s.x * a / f.z;",
                                          "s.x = largest * largest - a / 0.0;",
                                          "swap e[0], f;"};
    sim::Random random(6, "pieces");
    int compiled = 0;
    for (int round = 0; round < 20000; ++round) {
        std::string body = "int n = int(f.z * 9.0); float a = f.r * largest;";
        for (std::uint64_t i = random.below(6); i > 0; --i) body += pieces[random.below(pieces.size())];
        const std::string text = "program \"p\"; k 2; entry r, z; state x = 0; fragment {" + body + "}";
        models::ProgramChoice choice;
        try {
            choice = models::user_program("p.kb", text, 0);
        } catch (const sim::InputError&) {
            continue;
        }
        ++compiled;
        std::vector<float> pixel(choice.program->floats_per_pixel());
        choice.program->clear(pixel.data());
        for (const float depth : {0.0F, 1.0F, std::numeric_limits<float>::infinity()}) {
            const std::array<float, 4> rgba{std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F, 1.0F};
            std::array<float, 2> entry{};
            choice.program->make_entry({rgba.data(), depth, 0}, entry.data());
            choice.program->insert(pixel.data(), entry.data());
        }
        for (const float value : pixel) ASSERT_TRUE(std::isfinite(value)) << text;
    }
    EXPECT_GT(compiled, 500);
}

TEST(LanguageErrors, FilesThatAreNone) {
    const auto load_error = [](const std::string& path) -> std::string {
        try {
            models::load_user_program(path, 0);
        } catch (const sim::InputError& error) {
            return error.what();
        }
        return {};
    };
    const ropsim_test::TemporaryFolder folder;
    EXPECT_EQ(load_error("no_such.kb"), "no_such.kb: there is no such file");
    EXPECT_EQ(load_error(folder.path().string()), folder.path().string() + ": expected a file, got a folder");
    const std::string large = (folder.path() / "large.kb").string();
    ropsim_test::write_text(large, std::string((1U << 20) + 1, '#'));
    EXPECT_EQ(load_error(large), large + ": expected a file of at most 1,048,576 bytes");
}

} // namespace programs_language_errors_test
