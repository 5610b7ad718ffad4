#include "tests/replay_oracle/measure_mesa/measurement.hpp"

#include "tests/replay_oracle/measure_mesa/pictures.hpp"

#include <cstdlib>
#include <sstream>
#include <string>
#include <unistd.h>

namespace measure {

namespace {

// GL_ARB_pipeline_statistics_query, which OpenGL 4.6 has under the same numbers.
constexpr GLenum vertices_submitted = 0x82EE, primitives_submitted = 0x82EF;

std::FILE* opened(const char* folder, const char* name) {
    return std::fopen((std::string(folder) + "/" + name).c_str(), "wb");
}

} // namespace

Counter::Counter(GLenum target) : target_(target) {
    GLint running = 0;
    REAL(glGetQueryiv)(target, GL_CURRENT_QUERY, &running);
    if (running != 0) return;
    REAL(glGenQueries)(1, &query_);
    REAL(glBeginQuery)(target, query_);
}

std::int64_t Counter::stop() {
    if (query_ == 0) return -1;
    REAL(glEndQuery)(target_);
    GLuint64 value = 0;
    REAL(glGetQueryObjectui64v)(query_, GL_QUERY_RESULT, &value);
    REAL(glDeleteQueries)(1, &query_);
    return static_cast<std::int64_t>(value);
}

Meter::Meter() : vertices_(vertices_submitted), primitives_(primitives_submitted), samples_(GL_SAMPLES_PASSED) {}

Counts Meter::stop() {
    Counts counts;
    counts.samples = samples_.stop();
    counts.primitives = primitives_.stop();
    counts.vertices = vertices_.stop();
    return counts;
}

Measurement& measurement() {
    static auto* const one = new Measurement;
    return *one;
}

Measurement::Measurement() {
    const char* const folder = std::getenv("MEASURE_MESA");
    const char* const frames = std::getenv("MEASURE_MESA_FRAMES");
    if (folder == nullptr || frames == nullptr || std::sscanf(frames, "%u:%u", &first_, &last_) != 2) return;
    if (const char* const pictures = std::getenv("MEASURE_MESA_PICTURES")) {
        std::istringstream list(pictures);
        for (std::string number; std::getline(list, number, ',');)
            strides_.push_back(static_cast<std::uint32_t>(std::strtoul(number.c_str(), nullptr, 10)));
    }
    isotropic_ = std::getenv("MEASURE_MESA_ISOTROPIC") != nullptr;
    positions_ = opened(folder, "positions.bin");
    pictures_ = opened(folder, "pictures.bin");
    if (positions_ != nullptr && pictures_ != nullptr) calls_ = opened(folder, "calls.txt");
}

void Measurement::measure(const DrawingCall& call, const std::function<void()>& perform,
                          const std::function<Positions(const Counts&)>& positions) {
    Meter meter;
    perform();
    const Counts counts = meter.stop();
    add(call, counts, positions(counts));
}

void Measurement::add(const DrawingCall& call, const Counts& counts, const Positions& positions) {
    const std::size_t number = frame_ - first_;
    const std::uint32_t stride = number < strides_.size() ? strides_[number] : 0;
    Picture picture;
    if (stride != 0 && ++calls_of_frame_ % stride == 0) picture = picture_of_draw_buffer();
    std::fprintf(calls_, "call %u %s %lld %lld %lld %zu %u %u %zu", frame_, call.name,
                 static_cast<long long>(counts.vertices), static_cast<long long>(counts.primitives),
                 static_cast<long long>(counts.samples), positions.size() / 4, picture.width, picture.height,
                 call.draws.size());
    for (const SubmittedDraw& draw : call.draws)
        std::fprintf(calls_, " %u %lld", draw.mode, static_cast<long long>(draw.vertices));
    std::fputc('\n', calls_);
    std::fwrite(positions.data(), sizeof(float), positions.size(), positions_);
    std::fwrite(picture.rgba.data(), 1, picture.rgba.size(), pictures_);
}

void Measurement::end_frame() {
    if (calls_ == nullptr) return;
    if (wanted()) {
        const Picture picture = picture_of_window();
        std::fprintf(calls_, "frame %u %u %u\n", frame_, picture.width, picture.height);
        std::fwrite(picture.rgba.data(), 1, picture.rgba.size(), pictures_);
        calls_of_frame_ = 0;
        if (frame_ == last_) {
            for (std::FILE* file : {positions_, pictures_, calls_}) std::fclose(file);
            ::_exit(0);
        }
    }
    ++frame_;
}

} // namespace measure
