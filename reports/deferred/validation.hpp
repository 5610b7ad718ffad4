// The model of deferred shading beside what was published, number by number.
#pragma once

#include "reports/deferred/published.hpp"
#include "reports/frame_size.hpp"
#include "reports/validation/validation_row.hpp"

#include <atomic>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace reports {

/// What one frame took on the model.
struct DeferredRun {
    double milliseconds = 0;
    // Shares of the time: bytes over what memory can move, cycles in which pipes issued and their texture units worked,
    // and the wait for the next draw call.
    double memory = 0, arithmetic = 0, texture = 0, draw_calls = 0;
    double host_seconds = 0;

    std::string limit() const; ///< the largest of the shares: "arithmetic 61%"
};
using DeferredRuns = std::map<DeferredFrame, DeferredRun>;

struct DeferredOptions {
    std::vector<std::string> gpus;     ///< empty: all that were measured
    std::vector<std::uint32_t> lights; ///< empty: all numbers that were measured
    FrameSize size;                    ///< 0x0: that of the measurements; the maps shrink with the height
    std::vector<std::string> gpu_settings;
    unsigned threads = 1;
    const std::atomic<bool>* stop = nullptr;
    std::function<void(double)> progress; ///< share done, 0 to 1; never called by two threads at once
};

struct DeferredValidation {
    std::string source, parameter; ///< what the calibrated row decides
    FrameSize size;
    std::uint32_t map_size = 0;
    bool as_measured = true;         ///< the size is the published one; at another no row says how good the model is
    std::vector<ValidationRow> rows; ///< render targets, columns, what follows from them
    std::vector<ErrorSummary> summary;
    double host_seconds = 0; ///< of all runs, one after the other
};

/// Throws sim::InputError for a GPU or a number of lights that was not measured, and for no frame at all.
void check_deferred_options(const PublishedDeferred& published, const DeferredOptions& options);

/// The size of a picture and of its maps; nothing printed is comparable at another size than the published one.
FrameSize size_of(const PublishedDeferred& published, const DeferredOptions& options);
std::uint32_t map_size_of(const PublishedDeferred& published, const DeferredOptions& options);

/// Runs one frame, in full detail.
DeferredRun run_deferred(const PublishedDeferred& published, const DeferredFrame& frame,
                         const DeferredOptions& options);

/// The frames that the options ask for, each once.
std::vector<DeferredFrame> frames_of(const PublishedDeferred& published, const DeferredOptions& options);

/// Every number that these runs say something of; without what the null model says.
std::vector<ValidationRow> deferred_rows(const PublishedDeferred& published, const DeferredRuns& runs);

/// Render targets of each method beside the published ones: counted, not run.
std::vector<ValidationRow> deferred_target_rows(const PublishedDeferred& published);

DeferredValidation validate_deferred(const PublishedDeferred& published, const DeferredOptions& options);

} // namespace reports
