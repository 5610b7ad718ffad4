// Draw traces (.rtrace): frames with all that they draw, in one self-contained file. FORMAT.md has it byte by byte.
#pragma once

#include "traces/recording/recording.hpp"
#include "traces/scene.hpp"
#include "traces/workloads.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace traces {

struct TraceMetadata {
    std::string writer;  ///< program and version
    std::string name;    ///< for people
    std::string licence; ///< under which the content may be passed on, and whose it is; empty: not known
    /// Scene::name and Scene::hash of what was captured; of what was recorded: program or file, and its hash if known.
    std::string scene, scene_hash;
};

/// A frame by the name of a rendering method, seen from a fixed place.
struct CapturedFrame {
    std::string camera = "auto"; ///< as it was asked for
    pipeline::View view;         ///< what that led to, bit for bit
    std::string workload;
    std::string options = "{}";     ///< JSON: the parameters that were given
    std::string parameters = "{}";  ///< JSON: all of them, so that a default may change; what a replay takes
    std::vector<std::string> notes; ///< of make_view()
};

/// A captured frame of a scene, or a recording of an application's frames.
struct Trace {
    TraceMetadata metadata;
    Scene scene; ///< of a captured frame; read from a file: name and hash are those of the trace, in either case
    CapturedFrame frame; ///< unused where there is a recording
    std::optional<Recording> recording;
};

/// What to capture; texts as the command line takes them.
struct CaptureRequest {
    std::string scene;
    std::string camera = "auto";
    std::uint32_t width = 512, height = 512, samples = 1;
    std::string workload = usual_workload();
    std::vector<std::string> settings; ///< "key=value" of the workload
    std::string writer, name, licence;
};

/// Reads the scene with all its textures, and makes sure that the workload can make a frame of it. Programs of the
/// user's become part of the parameters. Throws sim::InputError.
Trace capture(const CaptureRequest& request);

/// What of a recording is drawn, and how; captured frames know one way only.
struct ReplayOptions {
    std::string frames;  ///< "3", or "3:5" (3 and 4), of Recording::frames; empty: the last one
    std::string kbuffer; ///< KBufferChoice::of(); empty: all draws are blended as they were
    std::uint32_t k = 4;
    bool cold = false; ///< caches are empty when a frame begins
};

/// The captured frame of a trace, or those of a recording as one. Throws sim::InputError for a workload or parameters
/// that are none, and for what cannot be drawn.
pipeline::Frame frame_of(const Trace& trace, const ReplayOptions& options = {});

/// Throws sim::InputError when it cannot be written, or a text is not UTF-8.
void write_trace(const Trace& trace, const std::filesystem::path& path);

/// Throws sim::InputError of one line for anything that is not a trace: file, byte, what was expected.
Trace read_trace(const std::filesystem::path& path);

/// By its extension.
bool is_trace_file(const std::filesystem::path& path);

} // namespace traces
