#include "tests/replay_oracle/programs.hpp"

#include "sim/check.hpp"
#include "tests/replay_oracle/mesa_replay.hpp"
#include "traces/recording/running_program.hpp"

#include <chrono>
#include <fmt/format.h>
#include <system_error>
#include <thread>

namespace replay_oracle {

namespace {

/// A scene of glmark2 that ends behind its third frame.
DebianProgram scene(const std::string& name, const std::string& options = "") {
    return {"glmark2_" + name, "glmark2-x11", {"glmark2", "-s", "320x240", "-b", name + ":nframes=3" + options}};
}

} // namespace

const std::vector<DebianProgram>& debian_programs() {
    static const std::vector<DebianProgram> programs{
        {"glxgears", "mesa-utils", {"glxgears", "-geometry", "300x300"}, 2, 5, 5},
        scene("build"),
        scene("texture", ":texture-filter=mipmap"),
        scene("shading", ":shading=phong"),
        scene("bump", ":bump-render=height"),
        scene("effect2d", ":kernel=0,1,0;1,-4,1;0,1,0;"),
        scene("pulsar"),
        scene("desktop", ":effect=blur:windows=2"),
        scene("buffer"),
        scene("ideas"),
        scene("jellyfish"),
        scene("shadow"),
        scene("refract"),
        scene("terrain"),
        scene("conditionals", ":fragment-steps=5:vertex-steps=5"),
        scene("function"),
        scene("loop"),
        {"neverball", "neverball", {"neverball"}, 60, 62, 60},
        {"extremetuxracer", "extremetuxracer", {"etr"}, 60, 62, 60},
    };
    return programs;
}

bool is_installed(const DebianProgram& program) { return !traces::find_program(program.command.front()).empty(); }

void trace_program(const DebianProgram& program, const std::filesystem::path& file) {
    if (traces::find_program("apitrace").empty())
        throw sim::InputError("tracing a program needs apitrace, which was not found: Debian package apitrace");
    if (!is_installed(program))
        throw sim::InputError(
            fmt::format("{} was not found: Debian package {}", program.command.front(), program.package));
    const TemporaryFolder home;
    std::vector<std::string> command{
        "apitrace", "trace", "--api", "gl", "-o", file.string(), traces::find_program(program.command.front())};
    command.insert(command.end(), program.command.begin() + 1, program.command.end());
    {
        traces::RunningProgram running(
            command, {{"HOME", home.path().string()}, {"SDL_AUDIODRIVER", "dummy"}, {"vblank_mode", "0"}});
        const auto begin = std::chrono::steady_clock::now();
        while (!running.ended() && std::chrono::steady_clock::now() - begin < std::chrono::seconds(program.seconds))
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    std::error_code none;
    if (std::filesystem::file_size(file, none) == 0 || none)
        throw sim::InputError(fmt::format("{}: expected it to draw with OpenGL", program.name));
}

} // namespace replay_oracle
