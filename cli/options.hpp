// What the user typed, parsed but not yet checked against what there is.
#pragma once

#include "reports/accuracy/accuracy.hpp"
#include "reports/comparison.hpp"
#include "reports/frame_size.hpp"
#include "reports/geometry/advice.hpp"
#include "reports/peeling/validation.hpp"
#include "reports/sensitivity/sensitivity.hpp"
#include "reports/truth/truth_run.hpp"
#include "traces/recording/cut.hpp"
#include "traces/trace.hpp"

#include <list>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace cli {

/// Of options that stand for parameters of workloads (traces::ParameterOption): name and value, "" where not given.
using ParameterValues = std::list<std::pair<std::string, std::string>>;

/// What to draw on what; common to several subcommands. Empty texts stand for the default.
struct FrameOptions {
    std::string scene;
    std::string gpu = "neutral";
    std::string workload = traces::usual_workload();
    ParameterValues parameters;
    std::string size = "512x512";
    std::string samples = "1";
    std::string camera = "auto";
    std::string seed = "1";
    std::string threads;
    std::vector<std::string> settings; ///< of --set
};

struct OutputOptions {
    std::string directory; ///< of --out; empty: no files
    bool json = false;
    bool no_images = false;
    bool timeline = false; ///< of ropsim run
};

struct CompareCommand {
    FrameOptions frame;
    OutputOptions output;
    std::string equal_area; ///< bytes, or "largest"; empty: every design as large as it is
    std::string designs; ///< variants, or "all"; empty: the usual ones. Of those two, the ones that can run the program
};

struct RunCommand {
    FrameOptions frame;
    OutputOptions output;
    std::string design = "existing";
};

struct ReplayCommand : CompareCommand { ///< its scene is the trace; camera, size, samples, workload are unused
    std::string frames, kbuffer;        ///< as of traces::ReplayOptions
    std::string k = "4";
    bool cold = false; ///< of --cold-caches
};

struct CaptureCommand {
    FrameOptions frame; ///< GPU, seed and threads are unused
    std::string file;   ///< of --output
    std::string name, licence;
    bool json = false;
};

/// What record and import share.
struct RecordingOptions {
    std::string frames; ///< FIRST:END; empty: the first ten
    std::string file;   ///< of --output
    std::string name, licence;
    bool isotropic = false, json = false;
};
struct RecordCommand : RecordingOptions {
    std::vector<std::string> program; ///< and its arguments
};
struct ImportCommand : RecordingOptions {
    std::string trace; ///< an apitrace file
};

struct TraceCommand {
    std::string action; ///< info, dump, validate, diff or cut
    std::string file, other;
    std::string frames, draws, output; ///< of cut: "first:end"; the file to write
    bool json = false;
};

struct DescribeCommand {
    std::string topic;
    bool json = false;
    bool names = false; ///< nothing but the names, one a line
};

struct GeometryCommand {
    std::string scene;
    std::string gpu = "neutral";
    std::vector<std::string> prepare;
    std::string submission = "buffers";
    std::string reads = "all";
    std::string fidelity = "detailed";
    std::string seed = "1";
    std::vector<std::string> settings; ///< of --set
    std::string export_to;             ///< a .glb file; empty: none
    std::string directory;             ///< of --out
    bool json = false;
};

struct TruthCommand {
    std::string scene;
    std::string workload = traces::usual_workload();
    ParameterValues parameters;
    std::string size = "512x512";
    std::string camera = "auto";
    std::vector<std::string> settings; ///< of --set
    std::string layers = "8";
    std::string light; ///< nine numbers; empty: none
    std::string rays = "1000";
    std::string seed = "1";
    std::string threads;
    std::string directory; ///< of --out
    bool check = false;
    bool json = false;
    bool no_images = false;
    bool no_cache = false;
};

struct AccuracyCommand {
    FrameOptions frame;
    OutputOptions output;
    std::string design;             ///< empty: the first of some that can run a frame
    std::vector<std::string> sweep; ///< KNOB=VALUE,VALUE
    std::string rays = "1000";
    std::string against;  ///< "KEY=VALUE KEY=VALUE"; empty: ray-traced truth
    std::string averaged; ///< number of frames; empty: none
    bool no_cache = false;
};

struct SensitivityCommand {
    FrameOptions frame;
    std::string designs;    ///< as of CompareCommand
    std::string parameters; ///< separated by commas; empty: all that are assumed
    std::string factor = "2";
    std::string directory; ///< of --out
    bool json = false;
};

struct StabilityCommand {
    std::string filter;    ///< patterns of ids, separated by commas; empty: all
    std::string directory; ///< of --out
    bool json = false;
    bool no_images = false;
};

/// validate, calibrate and study: what to do it with, and on which GPUs.
struct MeasureCommand {
    std::string target;
    std::string gpus; ///< separated by commas; empty: all
    std::string fidelity = "detailed";
    std::string threads;
    std::string directory; ///< of --out, or of --write
    bool json = false;
};
struct ValidateCommand : MeasureCommand {
    ValidateCommand() { fidelity.clear(); } ///< the usual one depends on the target
    bool leave_one_out = false;
    std::string lights, size; ///< of --lights and --size; empty: as measured
};
struct CalibrateCommand : MeasureCommand {
    CalibrateCommand() { fidelity.clear(); } ///< the usual one depends on the target
    std::string folds;                       ///< empty: write down what the plan's rows determine
    std::string seed = "1";
    std::string out; ///< of --out
};
struct StudyCommand : MeasureCommand {
    bool resume = true; ///< take finished points from the folder
};

/// A text asked for with --help or --version.
struct ShowText {
    std::string text;
};

using Command =
    std::variant<CompareCommand, RunCommand, TruthCommand, AccuracyCommand, GeometryCommand, SensitivityCommand,
                 ValidateCommand, CalibrateCommand, StudyCommand, StabilityCommand, CaptureCommand, RecordCommand,
                 ImportCommand, ReplayCommand, TraceCommand, DescribeCommand, ShowText>;

/// The request that the options stand for; for `designs` see CompareCommand. Throws sim::InputError when a number or
/// size is none.
reports::ComparisonRequest request_of(const FrameOptions& options, const std::string& designs);

/// The same with what only comparisons have.
reports::ComparisonRequest request_of(const CompareCommand& command);

/// The same for the frame of a trace.
reports::ComparisonRequest request_of(const ReplayCommand& command);
traces::CaptureRequest request_of(const CaptureCommand& command);

reports::TruthRequest request_of(const TruthCommand& command);
reports::AccuracyRequest request_of(const AccuracyCommand& command);
reports::SensitivityRequest request_of(const SensitivityCommand& command);

/// The same for geometry feed.
reports::GeometryRequest request_of(const GeometryCommand& command);

/// "estimate" or "detailed"; a number of threads, "" for all cores; a list separated by commas. Throw sim::InputError.
reports::Fidelity fidelity_of(const std::string& text);
/// "sampled", which "" stands for, or "detailed".
reports::PeelingFidelity peeling_fidelity_of(const std::string& text);
unsigned threads_of(const std::string& text);
/// Of --folds: 2 or more; of --seed.
unsigned folds_of(const std::string& text);
std::uint64_t seed_of(const std::string& text);
std::vector<std::string> list_of(const std::string& text);
/// Of --lights: numbers of lights, separated by commas.
std::vector<std::uint32_t> lights_of(const std::string& text);
/// FIRST:END, two numbers; `option` is for the message. Throws UsageError.
traces::CutRange range_of(const std::string& option, const std::string& text);
/// Of --size: WxH.
reports::FrameSize size_of(const std::string& text);

} // namespace cli
