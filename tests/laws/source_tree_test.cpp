// What must hold for the source tree: who may include whom, how long files are, which words stand where.
#include "models/kbuffers/library.hpp"
#include "tests/support/paths.hpp"
#include "traces/workloads.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace {

namespace fs = std::filesystem;

/// Each may include itself and what stands to its left.
const std::array<std::string, 6> layers{"sim", "pipeline", "models", "traces", "reports", "cli"};

struct File {
    std::string name; ///< from the root of the tree
    std::vector<std::string> lines;
};

std::vector<std::string> lines_of(const fs::path& path) {
    std::ifstream stream(path);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

bool is_source(const fs::path& path) { return path.extension() == ".cpp" || path.extension() == ".hpp"; }

/// All files below a folder of the tree that `wanted` accepts.
template <class Wanted>
std::vector<File> files_below(const std::string& folder, Wanted wanted) {
    const fs::path root = ropsim_test::source_dir();
    std::vector<File> files;
    if (!fs::exists(root / folder)) return files;
    for (const auto& entry : fs::recursive_directory_iterator(root / folder))
        if (entry.is_regular_file() && wanted(entry.path()))
            files.push_back({fs::relative(entry.path(), root).generic_string(), lines_of(entry.path())});
    std::sort(files.begin(), files.end(), [](const File& a, const File& b) { return a.name < b.name; });
    return files;
}

std::vector<File> sources_below(const std::string& folder) { return files_below(folder, is_source); }

/// Every text of the project: sources, scripts, documents, data.
std::vector<File> all_texts() {
    const std::set<std::string> extensions{".cpp",  ".hpp",  ".h",   ".md", ".txt", ".cmake", ".in",   ".toml",
                                           ".json", ".html", ".css", ".js", ".sh",  ".py",    ".supp", ".csv"};
    const auto wanted = [&](const fs::path& path) { return extensions.contains(path.extension().string()); };
    std::vector<File> files;
    for (const char* folder : {"sim", "pipeline", "models", "traces", "reports", "cli", "tests", "cmake", "docs"})
        for (File& file : files_below(folder, wanted)) files.push_back(std::move(file));
    const fs::path root = ropsim_test::source_dir();
    for (const auto& entry : fs::directory_iterator(root))
        if (entry.is_regular_file() && entry.path().filename() != ".git")
            files.push_back({entry.path().filename().string(), lines_of(entry.path())});
    return files;
}

std::size_t position_of(const std::string& layer) {
    return static_cast<std::size_t>(std::find(layers.begin(), layers.end(), layer) - layers.begin());
}

} // namespace

TEST(SourceTree, FoldersIncludeOnlyFoldersToTheirLeft) {
    const std::regex include(R"(^\s*#\s*include\s*\"([^/\"]+)/[^\"]*\")");
    std::size_t seen = 0;
    for (std::size_t layer = 0; layer < layers.size(); ++layer)
        for (const File& file : sources_below(layers[layer]))
            for (const std::string& line : file.lines) {
                std::smatch match;
                if (!std::regex_search(line, match, include)) continue;
                ++seen;
                const std::size_t other = position_of(match[1]);
                EXPECT_TRUE(other == layers.size() || other <= layer) << file.name << ": " << line;
                EXPECT_NE(match[1], "tests") << file.name << ": " << line;
            }
    EXPECT_GT(seen, 200U);
}

TEST(SourceTree, EventCoreHasNoWordOfGraphics) {
    const std::regex words(
        R"(\b(pixels?|fragments?|quads?|triangles?|vertex|vertices|textures?|texels?|rasteri[sz]er?s?|)"
        R"(shaders?|blend(ing|er)?|stencil|framebuffers?|rops?|gpus?|graphics|k-?buffers?|tiles?|opengl|)"
        R"(rendering|polygons?|meshes)\b)",
        std::regex::icase);
    std::size_t lines = 0;
    for (const File& file :
         files_below("sim", [](const fs::path& path) { return is_source(path) || path.extension() == ".md"; }))
        for (const std::string& line : file.lines) {
            ++lines;
            std::smatch match;
            EXPECT_FALSE(std::regex_search(line, match, words)) << file.name << ": " << line;
        }
    EXPECT_GT(lines, 1000U);
}

TEST(SourceTree, FilesAreShort) {
    // A header is a data sheet and a source a page of a book.
    constexpr std::size_t longest_header = 250, longest_source = 400;
    for (const char* folder : {"sim", "pipeline", "models", "traces", "reports", "cli", "tests"})
        for (const File& file : sources_below(folder))
            EXPECT_LE(file.lines.size(), file.name.ends_with(".hpp") ? longest_header : longest_source) << file.name;
}

TEST(SourceTree, EveryDesignIsNamedInATest) {
    std::string tests;
    for (const char* folder : {"tests/pipeline", "tests/laws", "tests/component", "tests/unit"})
        for (const File& file : sources_below(folder)) {
            if (file.name.ends_with("source_tree_test.cpp")) continue;
            for (const std::string& line : file.lines) tests += line + "\n";
        }
    ASSERT_FALSE(models::designs().empty());
    for (const models::DesignInfo& design : models::designs())
        EXPECT_NE(tests.find(fmt::format("\"{}\"", design.id)), std::string::npos) << design.id;
}

TEST(SourceTree, EveryDesignIsAFileOfItsOwn) {
    for (const models::DesignInfo& design : models::designs()) {
        std::string name(design.id);
        std::replace(name.begin(), name.end(), '-', '_');
        EXPECT_TRUE(fs::exists(ropsim_test::source_dir() / "models/kbuffers" / (name + ".cpp"))) << name;
        EXPECT_FALSE(design.summary.empty());
        EXPECT_FALSE(design.parameters().empty()) << name;
    }
}

// A workload declares what others need to know of it (traces/workloads.hpp).
TEST(SourceTree, OnlyTracesNamesWorkloads) {
    // Words that also mean something else, and what.
    const std::map<std::pair<std::string, std::string>, std::string> allowed{
        {{"pipeline/functional/validate.cpp", "geometry"}, "a part of a draw"},
        {{"reports/geometry/measurements.cpp", "geometry"}, "what is calibrated and validated"},
        {{"reports/validation/choices.cpp", "geometry"}, "what is calibrated and validated"},
        {{"reports/peeling/published.hpp", "volume"}, "how a mesh grows"},
        {{"cli/calibrate.cpp", "geometry"}, "what is calibrated"},
        {{"cli/validate.cpp", "geometry"}, "what is validated"},
        {{"cli/validate.cpp", "deferred"}, "what is validated"},
        {{"cli/command_line.cpp", "geometry"}, "a subcommand"},
    };
    auto unused = allowed;
    const std::regex comment(R"((^|\s)//.*)"), own_files(R"(#include "traces/workloads/)");
    std::size_t seen = 0;
    for (const char* folder : {"pipeline", "reports", "cli"})
        for (const File& file : sources_below(folder))
            for (const std::string& line : file.lines) {
                ++seen;
                // The catalogue of stability counts the digits of formulas, wherever they stand.
                EXPECT_TRUE(file.name.starts_with("reports/stability/") || !std::regex_search(line, own_files))
                    << file.name << ": " << line;
                const std::string code = std::regex_replace(line, comment, "");
                for (const traces::Workload& workload : traces::workloads()) {
                    const bool one_word = workload.id.find('-') == std::string::npos;
                    const bool named = code.find(fmt::format("\"{}\"", workload.id)) != std::string::npos ||
                                       code.find(fmt::format("workload {}", workload.id)) != std::string::npos ||
                                       code.find(fmt::format("workload={}", workload.id)) != std::string::npos ||
                                       (!one_word && line.find(workload.id) != std::string::npos);
                    if (!named) continue;
                    EXPECT_TRUE(allowed.contains({file.name, workload.id})) << file.name << ": " << line;
                    unused.erase({file.name, workload.id});
                }
            }
    for (const auto& [place, meaning] : unused)
        ADD_FAILURE() << place.first << " no longer says '" << place.second << "': take it off the list";
    EXPECT_GT(seen, 20'000U);
}

TEST(SourceTree, TextSpeaksOfTheProjectOnly) {
    // Put together here, so that this file does not hold them.
    const std::string todo = std::string("TO") + "DO", fixme = std::string("FIX") + "ME";
    const std::regex machine_paths(R"((^|[^\w.])/(work|root)(/|\b)(?!loads))");
    const std::regex notes("\\b(" + todo + "|" + fixme + "|" + "XX" + "X)\\b");
    std::size_t lines = 0;
    for (const File& file : all_texts())
        for (const std::string& line : file.lines) {
            ++lines;
            EXPECT_FALSE(std::regex_search(line, machine_paths) && !file.name.ends_with("source_tree_test.cpp"))
                << file.name << ": " << line;
            EXPECT_FALSE(std::regex_search(line, notes)) << file.name << ": " << line;
        }
    EXPECT_GT(lines, 10'000U);
}

TEST(SourceTree, FilesAreTextWithUnixLineEnds) {
    for (const File& file : all_texts())
        for (const std::string& line : file.lines)
            EXPECT_TRUE(line.empty() || (line.back() != '\r' && line.back() != ' ')) << file.name << ": " << line;
}
