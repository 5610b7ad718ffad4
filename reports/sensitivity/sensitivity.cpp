#include "reports/sensitivity/sensitivity.hpp"

#include "pipeline/functional/parallel.hpp"
#include "reports/compared_designs.hpp"
#include "reports/remarks.hpp"
#include "reports/run_numbers.hpp"
#include "reports/sensitivity/parameters.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <mutex>
#include <numeric>

namespace reports {

namespace {

SensitivityRun numbers_of(const pipeline::RunResult& run) {
    return {run.cycles,       milliseconds(run), run.fragments,      run.hazards,
            run.wrong_pixels, run.tied_pixels,   run.lost_fragments, 0};
}

void rank(std::vector<SensitivityRun>& runs) {
    for (SensitivityRun& run : runs)
        run.rank = 1 + static_cast<std::uint32_t>(std::count_if(runs.begin(), runs.end(), [&](const auto& other) {
                       return other.milliseconds < run.milliseconds;
                   }));
}

/// A machine to be run: a design with one value of one parameter.
struct Job {
    SensitivityStep* step = nullptr;
    std::size_t design = 0;
    ComparedDesign hardware;
};

/// The compared designs on the GPU with one setting more; a design's own settings win over it.
std::vector<ComparedDesign> changed_designs(const ComparisonRequest& request, const std::string& setting,
                                            const ComparisonInput& input, const Supervision& supervision) {
    ComparisonRequest one = request;
    one.gpu_settings.push_back(setting);
    one.designs.clear();
    for (const ComparedDesign& row : input.designs) one.designs.push_back(row.variant.text);
    std::vector<ComparedDesign> designs = read_hardware(one).designs;
    submit(input, designs, supervision);
    return designs;
}

void add_jobs(std::vector<Job>& jobs, const SensitivityRequest& request, const ComparisonInput& input,
              SensitivityParameter& parameter, const Supervision& supervision) {
    for (SensitivityStep& step : parameter.steps) {
        try {
            std::vector<ComparedDesign> designs =
                changed_designs(request.comparison, parameter.path + "=" + step.value, input, supervision);
            step.runs.resize(designs.size());
            for (std::size_t i = 0; i < designs.size(); ++i) jobs.push_back({&step, i, std::move(designs[i])});
        } catch (const sim::InputError& error) {
            step.refused = error.what();
        }
    }
}

/// Counts finished runs for the progress line.
class Finished {
  public:
    Finished(const Supervision& supervision, std::size_t all) : supervision_(&supervision), all_(all) {}
    void one() {
        const std::lock_guard lock(mutex_);
        ++done_;
        if (supervision_->progress != nullptr)
            supervision_->progress->share = static_cast<double>(done_) / static_cast<double>(all_);
    }

  private:
    const Supervision* supervision_;
    std::mutex mutex_;
    std::size_t done_ = 0, all_;
};

// A value that a machine refuses only when it is built says so for all designs of the step.
void run_jobs(std::vector<Job>& jobs, const ComparisonInput& input, const Supervision& supervision) {
    const Supervision quiet{supervision.stop, nullptr, nullptr};
    Finished finished(supervision, jobs.size());
    std::vector<std::string> refused(jobs.size());
    pipeline::parallel_for(input.threads, jobs.size(), [&](std::size_t i) {
        Job& job = jobs[i];
        try {
            job.step->runs[job.design] = numbers_of(run_design(input, job.hardware, quiet));
        } catch (const sim::InputError& error) {
            refused[i] = error.what();
        }
        job.hardware = {};
        finished.one();
    });
    for (std::size_t i = 0; i < jobs.size(); ++i)
        if (!refused[i].empty() && jobs[i].step->refused.empty()) jobs[i].step->refused = refused[i];
    for (const Job& job : jobs)
        if (!job.step->refused.empty())
            job.step->runs.clear();
        else if (job.design == 0)
            rank(job.step->runs);
}

bool always_correct(const Sensitivity& result, std::size_t design) {
    if (!result.base[design].correct()) return false;
    for (const SensitivityParameter& parameter : result.parameters)
        for (const SensitivityStep& step : parameter.steps)
            if (!step.runs.empty() && !step.runs[design].correct()) return false;
    return true;
}

Conclusion conclude(const Sensitivity& result, std::size_t one, std::size_t other) {
    const bool first = result.base[one].milliseconds <= result.base[other].milliseconds;
    Conclusion conclusion{first ? one : other, first ? other : one, 1, 1, {}, {}};
    const auto ratio = [&conclusion](const std::vector<SensitivityRun>& runs) {
        return runs[conclusion.slower].milliseconds / runs[conclusion.faster].milliseconds;
    };
    conclusion.ratio = conclusion.worst_ratio = ratio(result.base);
    for (const SensitivityParameter& parameter : result.parameters)
        for (const SensitivityStep& step : parameter.steps)
            if (!step.runs.empty() && ratio(step.runs) < conclusion.worst_ratio) {
                conclusion.worst_ratio = ratio(step.runs);
                conclusion.worst_parameter = parameter.path;
                conclusion.worst_value = step.value;
            }
    return conclusion;
}

std::vector<std::string> units_of(const std::vector<pipeline::RunResult>& runs) {
    std::vector<std::string> built;
    for (const pipeline::RunResult& run : runs) built.insert(built.end(), run.built.begin(), run.built.end());
    return built;
}

std::vector<pipeline::RunResult> base_runs(const ComparisonInput& input, const Supervision& supervision) {
    const Supervision quiet{supervision.stop, nullptr, nullptr};
    std::vector<pipeline::RunResult> runs(input.designs.size());
    pipeline::parallel_for(input.threads, runs.size(),
                           [&](std::size_t i) { runs[i] = run_design(input, input.designs[i], quiet); });
    return runs;
}

} // namespace

std::vector<std::string> remarks(const Sensitivity& result) {
    std::vector<std::string> list;
    if (!result.nothing_drawn.empty()) list.push_back(result.nothing_drawn);
    list.insert(list.end(), result.scene.notes.begin(), result.scene.notes.end());
    return each_once(list);
}

double SensitivityParameter::largest_change(const std::vector<SensitivityRun>& base) const {
    double largest = 0;
    for (const SensitivityStep& step : steps)
        for (std::size_t i = 0; i < step.runs.size(); ++i)
            largest = std::max(largest, std::abs(step.runs[i].milliseconds / base[i].milliseconds - 1));
    return largest;
}

std::vector<std::size_t> Sensitivity::by_effect() const {
    std::vector<std::size_t> order(parameters.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [this](std::size_t a, std::size_t b) {
        return parameters[a].largest_change(base) > parameters[b].largest_change(base);
    });
    return order;
}

Sensitivity measure_sensitivity(const SensitivityRequest& request, const Supervision& supervision) {
    const ComparisonInput input = prepare(request.comparison, supervision);
    enter(supervision, Progress::Phase::measuring);
    Sensitivity result;
    result.scene = input.scene;
    result.gpu = input.gpu.name;
    result.workload = input.frame->workload;
    result.width = input.frame->view.width;
    result.height = input.frame->view.height;
    result.factor = request.factor;
    result.seed = input.seed;
    for (const ComparedDesign& row : input.designs) result.designs.push_back(facts_of(row));
    const std::vector<pipeline::RunResult> base = base_runs(input, supervision);
    for (const pipeline::RunResult& run : base) result.base.push_back(numbers_of(run));
    rank(result.base);
    result.nothing_drawn = nothing_drawn(base.front());
    ParameterChoice choice = choose_parameters(request, input, units_of(base));
    result.parameters = std::move(choice.chosen);
    result.skipped = std::move(choice.skipped);
    std::vector<Job> jobs;
    for (SensitivityParameter& parameter : result.parameters) add_jobs(jobs, request, input, parameter, supervision);
    enter(supervision, Progress::Phase::measuring);
    run_jobs(jobs, input, supervision);
    for (std::size_t one = 0; one < result.designs.size(); ++one)
        for (std::size_t other = one + 1; other < result.designs.size(); ++other)
            if (always_correct(result, one) && always_correct(result, other))
                result.conclusions.push_back(conclude(result, one, other));
    return result;
}

} // namespace reports
