// Error against run time of a rendering method: its pictures beside ray-traced truth, as its quality knobs turn.
//
// A workload declares its knobs once (traces::Workload::quality). Each point is a whole comparison of one design at one
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
#include <string>
#include <vector>

namespace reports {

struct AccuracyRequest {
    ComparisonRequest comparison;           ///< one design; its workload settings are those that all points share
    std::vector<traces::QualityKnob> sweep; ///< every combination; empty: each knob of the workload alone
    LightSampling sampling;                 ///< of the truth, where the workload has a light
    std::uint32_t averaged = 0; ///< largest number of point lights whose hard shadows are averaged; 0: no such points
    bool pictures = false;
    bool use_cache = true;
};

struct AccuracyPoint {
    std::vector<std::string> knobs; ///< "name=value", what differs from the shared settings
    double sim_ms = 0;              ///< of a frame on the simulated GPU
    double host_s = 0;              ///< of this machine: front end, reference and simulation
    std::uint64_t wrong_pixels = 0; ///< hazards: nothing that the error excuses
    ImageError error;
    bool pareto = false;      ///< no other point is at once faster on the GPU and nearer to the truth
    bool pareto_host = false; ///< the same on this machine
    Picture picture;          ///< beside the truth; of no size unless asked for

    std::string name() const; ///< its knobs
};

struct Accuracy {
    std::string workload, design, gpu;
    SceneFacts scene;
    std::uint32_t width = 0, height = 0;
    std::vector<std::string> settings; ///< shared by all points
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
