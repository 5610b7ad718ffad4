#include "tests/replay_oracle/mesa_replay.hpp"

#include "sim/check.hpp"
#include "traces/recording/running_program.hpp"

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fstream>
#include <sstream>
#include <system_error>
#include <thread>

namespace replay_oracle {

namespace {

constexpr std::chrono::minutes patience{20}; ///< with glretrace

std::string run_glretrace(const MesaRequest& request, const std::filesystem::path& folder) {
    const auto last = request.first + static_cast<std::uint32_t>(request.strides.size()) - 1;
    traces::RunningProgram::Environment environment{
        {"LD_PRELOAD", measuring_library().string()},
        {"MEASURE_MESA", folder.string()},
        {"MEASURE_MESA_FRAMES", fmt::format("{}:{}", request.first, last)},
        {"MEASURE_MESA_PICTURES", fmt::format("{}", fmt::join(request.strides, ","))},
    };
    if (request.isotropic) environment.emplace_back("MEASURE_MESA_ISOTROPIC", "1");
    traces::RunningProgram program({"glretrace", "-b", request.trace.string()}, environment);
    const auto begin = std::chrono::steady_clock::now();
    while (!program.ended() && std::chrono::steady_clock::now() - begin < patience)
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return program.ended().value_or("by not ending");
}

/// What the library wrote, in its order (measure_mesa/measurement.hpp).
class Results {
  public:
    explicit Results(const std::filesystem::path& folder)
        : positions_(folder / "positions.bin", std::ios::binary), pictures_(folder / "pictures.bin", std::ios::binary) {
        std::ifstream lines(folder / "calls.txt");
        for (std::string line; std::getline(lines, line);) take(line);
    }

    /// Of frames that came to their end.
    std::vector<MesaFrame> frames;

  private:
    void take(const std::string& line) {
        std::istringstream fields(line);
        std::string kind;
        std::uint32_t frame = 0, width = 0, height = 0;
        fields >> kind >> frame;
        if (kind == "frame") {
            fields >> width >> height;
            open_.shown = picture(width, height);
            frames.push_back(std::move(open_));
            open_ = {};
            return;
        }
        MesaCall& call = open_.calls.emplace_back();
        std::size_t positions = 0, draws = 0;
        fields >> call.name >> call.vertices >> call.primitives >> call.samples >> positions >> width >> height >>
            draws;
        for (std::size_t i = 0; i < draws && fields; ++i) {
            SubmittedDraw& draw = call.draws.emplace_back();
            fields >> draw.mode >> draw.vertices;
        }
        call.positions.resize(positions);
        positions_.read(reinterpret_cast<char*>(call.positions.data()),
                        static_cast<std::streamsize>(positions * sizeof(glm::vec4)));
        call.picture = picture(width, height);
        if (!fields || !positions_ || !pictures_)
            throw sim::InputError(fmt::format("measure_mesa: expected a call with its numbers, got '{}'", line));
    }

    std::optional<Picture> picture(std::uint32_t width, std::uint32_t height) {
        if (width == 0 || height == 0) return std::nullopt;
        Picture picture{width, height, {}};
        const std::size_t row = std::size_t{width} * 4;
        picture.rgba.resize(row * height);
        for (std::size_t y = height; y-- > 0;)
            pictures_.read(reinterpret_cast<char*>(&picture.rgba[y * row]), static_cast<std::streamsize>(row));
        return picture;
    }

    std::ifstream positions_, pictures_;
    MesaFrame open_;
};

} // namespace

std::filesystem::path measuring_library() { return MEASURE_MESA_LIBRARY; }

std::vector<MesaFrame> replay_by_mesa(const MesaRequest& request) {
    if (traces::find_program("glretrace").empty())
        throw sim::InputError("Mesa's replay needs glretrace, which was not found: Debian package apitrace");
    if (!std::filesystem::exists(measuring_library()))
        throw sim::InputError(fmt::format("{}: expected the library that measures", measuring_library().string()));
    const TemporaryFolder folder;
    const std::string end = run_glretrace(request, folder.path());
    Results results(folder.path());
    if (results.frames.size() != request.strides.size())
        throw sim::InputError(fmt::format("{}: expected {} frames from number {} on, got {}; glretrace ended {}",
                                          request.trace.string(), request.strides.size(), request.first,
                                          results.frames.size(), end));
    return std::move(results.frames);
}

SoftwareGraphics::SoftwareGraphics() {
    ::setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
    if (traces::has_display()) return;
    if (traces::find_program("Xvfb").empty())
        throw sim::InputError("glretrace without a DISPLAY needs Xvfb, which was not found: Debian package xvfb");
    static const std::atomic<bool> never{false};
    display_.emplace(never);
    ::setenv("DISPLAY", display_->name().c_str(), 1);
}

SoftwareGraphics::~SoftwareGraphics() {
    if (display_) ::unsetenv("DISPLAY");
}

TemporaryFolder::TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "replay_oracle.XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr)
        throw sim::InputError(fmt::format("{}: expected a folder that can be made", name));
    path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

} // namespace replay_oracle
