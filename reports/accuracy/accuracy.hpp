// Error against run time of a rendering method: its pictures beside ray-traced truth, as its quality knobs turn.
//
// A workload declares its knobs once (traces::Workload::quality). In place of the truth another setting or workload may
// stand: how far two methods are from each other. Each point is a whole comparison of one design at one
// setting; its time is that of the simulated GPU and, apart from it, that of this machine.
#pragma once

#include "reports/accuracy/image_error.hpp"
#include "reports/csv.hpp"
#include "reports/images.hpp"
#include "reports/terminal_table.hpp"
#include "reports/truth/truth_run.hpp"
#include "traces/workloads.hpp"

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace reports {

/// Another setting or workload, whose picture in submission order stands for the truth.
struct Rival {
    std::optional<traces::WorkloadChoice> workload; ///< nothing: the same
    std::vector<std::string> settings;              ///< of the same workload: over those that all points share
};

struct AccuracyRequest {
    ComparisonRequest
        comparison; ///< one design, or the first able of several; its workload settings are those that all points share
    std::vector<traces::QualityKnob> sweep; ///< every combination; empty: each knob of the workload alone
    LightSampling sampling;                 ///< of the truth, where the workload has a light
    std::optional<Rival> against;           ///< nothing: pictures are measured against ray-traced truth
    std::uint32_t averaged =
        0; ///< largest number of frames that traces::Averaging takes the mean of; 0: no such points
    bool pictures = false;
    bool use_cache = true;
};

struct AccuracyPoint {
    std::string workload;
    std::string design;             ///< that ran it
    bool rival = false;             ///< what the others are measured against
    std::vector<std::string> knobs; ///< "name=value", what differs from the shared settings
    double sim_ms = 0;              ///< of a frame on the simulated GPU
    double host_s = 0;              ///< of this machine: front end, reference and simulation
    std::uint64_t wrong_pixels = 0; ///< hazards: nothing that the error excuses
    ImageError error;
    bool pareto = false;      ///< no other point is at once faster on the GPU and nearer to the truth
    bool pareto_host = false; ///< the same on this machine
    Picture picture;          ///< beside the truth; of no size unless asked for

    std::string name() const; ///< its knobs; no two points share it
};

struct Accuracy {
    std::string workload, gpu;
    std::vector<std::string> designs; ///< that ran points, in their order
    SceneFacts scene;
    std::uint32_t width = 0, height = 0;
    std::vector<std::string> settings; ///< shared by all points
    std::string against;               ///< the rival that the pictures were measured against; its point is the last
    std::vector<AccuracyPoint> points;
    std::uint32_t rays = 0; ///< to the light from each point; 0 without a light
    double truth_seconds = 0;
    bool truth_cached = false;
    std::vector<std::string> notes;
};

/// Throws sim::InputError with one line for anything the user got wrong.
Accuracy measure_accuracy(const AccuracyRequest& request, const Supervision& supervision = {});

/// What has to be said behind the table: where nothing was compared, that; then the notes.
std::vector<std::string> remarks(const Accuracy& accuracy);

/// Marks the points that no other one beats in both.
void mark_pareto(std::vector<AccuracyPoint>& points);

/// Two documents of equal requests differ in host_s, pareto_host and below "host" only.
nlohmann::ordered_json accuracy_json(const Accuracy& accuracy);
std::string accuracy_text(const Accuracy& accuracy, TerminalStyle style);
Table accuracy_table(const Accuracy& accuracy);
std::string accuracy_page(const Accuracy& accuracy);
/// Writes the points' pictures, "knob=value.png", and returns their names in the order of the points.
std::vector<std::string> write_accuracy_pictures(const Accuracy& accuracy, const std::filesystem::path& directory);

} // namespace reports
