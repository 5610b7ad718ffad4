// The truth of a scene, as a user asks for it: from the scene's file or rule to counts, errors and pictures.
#pragma once

#include "reports/comparison.hpp"
#include "reports/text_table.hpp"
#include "reports/truth/against_truth.hpp"
#include "reports/truth/truth.hpp"
#include "traces/workloads.hpp"

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace reports {

struct TruthRequest {
    std::string scene;           ///< as traces::load_scene takes it
    std::string camera = "auto"; ///< as traces::make_view takes it
    std::uint32_t width = 512, height = 512;
    traces::WorkloadChoice workload;
    std::vector<std::string> workload_settings; ///< "key=value"
    TruthPlan plan;
    bool check = false;    ///< also rasterize the frame in submission order and compare
    bool use_cache = true; ///< see TruthCache
    unsigned threads = 0;  ///< 0 = all cores
};

struct TruthRun {
    SceneFacts scene;
    std::shared_ptr<const pipeline::Frame> frame; ///< whose surfaces were traced
    TruthPlan plan;
    traces::TruthMethod method;
    Truth truth;
    std::vector<TruthError> errors; ///< of the frame in submission order, where that was asked for
    std::vector<std::string> notes; ///< about the cache
    bool cached = false;
    double build_seconds = 0;   ///< host time of making the rays' scene; 0 when cached
    double tracing_seconds = 0; ///< of the rays, with shading; 0 when cached
    double seconds = 0;         ///< host time of everything
    unsigned threads = 1;

    double rays_per_second() const; ///< 0 when cached
    /// Something was compared, and every comparison holds.
    bool holds() const;
};

/// Throws sim::InputError with one line for anything the user got wrong.
TruthRun run_truth(const TruthRequest& request, const Supervision& supervision = {});

/// What has to be said behind the tables: where nothing was seen or compared, that; then notes on scene and cache.
std::vector<std::string> remarks(const TruthRun& run);

/// Two runs differ below "host" only.
nlohmann::ordered_json truth_json(const TruthRun& run);

/// Tables for the terminal.
std::string truth_text(const TruthRun& run, TerminalStyle style);

/// Writes truth.json and, unless `images` is false, the pictures (see README.md) into `directory`; returns the line
/// that says so.
std::string write_truth(const TruthRun& run, const std::filesystem::path& directory, bool images);

} // namespace reports
