#include "traces/recording/record_program.hpp"

#include "ropsim_build.hpp"
#include "sim/check.hpp"
#include "traces/glsl.hpp"
#include "traces/record_module/stream.hpp"
#include "traces/recording/import/import.hpp"
#include "traces/recording/virtual_display.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <memory>
#include <sys/mman.h>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>

namespace traces {

namespace {

constexpr std::chrono::milliseconds interval{20}; ///< between looks at the program

/// A file without a name, which another process opens by ropsim's number for it.
class StreamFile {
  public:
    StreamFile() {
        std::string name = (std::filesystem::temp_directory_path() / "ropsim.XXXXXX").string();
        descriptor_ = ::mkostemp(name.data(), O_CLOEXEC);
        if (descriptor_ < 0)
            throw sim::InputError(
                fmt::format("{}: expected a folder for a temporary file: {}", name, std::strerror(errno)));
        ::unlink(name.c_str());
    }
    ~StreamFile() {
        if (memory_ != MAP_FAILED) ::munmap(memory_, size_);
        ::close(descriptor_);
    }
    StreamFile(const StreamFile&) = delete;
    StreamFile& operator=(const StreamFile&) = delete;

    std::string path() const { return fmt::format("/proc/{}/fd/{}", ::getpid(), descriptor_); }

    std::span<const std::byte> bytes() {
        struct stat facts {};
        if (::fstat(descriptor_, &facts) != 0 || facts.st_size == 0) return {};
        size_ = static_cast<std::size_t>(facts.st_size);
        memory_ = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, descriptor_, 0);
        if (memory_ == MAP_FAILED) throw sim::InputError("no memory for what was recorded");
        return {static_cast<const std::byte*>(memory_), size_};
    }

  private:
    int descriptor_ = -1;
    void* memory_ = MAP_FAILED;
    std::size_t size_ = 0;
};

void wait_for(RunningProgram& program, const std::atomic<bool>& stop) {
    while (!program.ended()) {
        if (stop) throw sim::Interrupted();
        std::this_thread::sleep_for(interval);
    }
}

std::string module_path() {
    constexpr const char* file = "ropsim_record.so";
    const auto path = ropsim_build::find_module(file);
    if (!path)
        throw sim::InputError(
            fmt::format("recording needs {} and a build with libgl-dev (Debian): it was not found", file));
    return path->string();
}

std::string preloaded(const std::string& module) {
    const char* const before = std::getenv("LD_PRELOAD");
    return before == nullptr || *before == '\0' ? module : module + ":" + before;
}

/// Why there is nothing.
std::string complaint(const RecordRequest& request, const recorded::ImportedStream& stream, const std::string& end,
                      bool lacks_display) {
    std::string text = fmt::format("{}: expected frame {} to be drawn with OpenGL; the program ended {} before",
                                   request.command[0], request.first, end);
    for (const NotRecorded& one : stream.recording.not_recorded)
        text += fmt::format("; not recorded: {} ({})", one.call, one.times);
    if (lacks_display) text += "; there is no DISPLAY, and no Xvfb (Debian package xvfb) to make one";
    return text;
}

} // namespace

RecordedProgramRun record_program(const RecordRequest& request, const std::atomic<bool>& stop) {
    if (request.command.empty() || request.end <= request.first)
        throw sim::InputError(fmt::format("frames {}:{}: expected at least one frame", request.first, request.end));
    if (!can_compile_glsl())
        throw sim::InputError("recording needs ropsim_glsl.so and a build with glslang-dev and spirv-tools (Debian)");
    const std::string module = module_path();
    StreamFile file;
    RunningProgram::Environment environment{
        {"LD_PRELOAD", preloaded(module)},
        {"ROPSIM_RECORD", file.path()},
        {"ROPSIM_RECORD_FRAMES", fmt::format("{}:{}", request.first, request.end - 1)},
    };
    if (request.isotropic) environment.emplace_back("ROPSIM_RECORD_ISOTROPIC", "1");
    std::optional<VirtualDisplay> display;
    const bool lacks_display = !has_display() && find_program("Xvfb").empty();
    if (!has_display() && !lacks_display) {
        display.emplace(stop);
        environment.emplace_back("DISPLAY", display->name());
    }
    RunningProgram program(request.command, environment);
    wait_for(program, stop);
    if (program.ended_with(record_stream::status_no_room))
        throw sim::InputError(fmt::format("{}: expected room for all that is recorded (TMPDIR names another folder)",
                                          std::filesystem::temp_directory_path().string()));
    recorded::ImportedStream stream = recorded::import_stream(file.bytes());
    const auto& frames = stream.recording.frames;
    if (std::all_of(frames.begin(), frames.end(), [](const RecordedFrame& frame) { return frame.commands.empty(); }))
        throw sim::InputError(complaint(request, stream, program.ended().value_or(""), lacks_display));
    return {std::move(stream.recording), stream.context, stream.finished ? "" : program.ended().value_or("")};
}

RecordedProgramRun record_apitrace(const std::filesystem::path& file, RecordRequest request,
                                   const std::atomic<bool>& stop) {
    if (::access(file.c_str(), R_OK) != 0)
        throw sim::InputError(fmt::format("{}: expected a file that can be read", file.string()));
    if (find_program("glretrace").empty())
        throw sim::InputError("importing needs glretrace, which was not found: Debian package apitrace");
    if (!has_display() && find_program("Xvfb").empty())
        throw sim::InputError("importing without a DISPLAY needs Xvfb, which was not found: Debian package xvfb");
    request.command = {"glretrace", "-b", file.string()}; // -b: without asking for errors after each call
    return record_program(request, stop);
}

} // namespace traces
