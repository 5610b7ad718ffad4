#include "reports/study_points.hpp"

#include "reports/atomic_file.hpp"
#include "reports/result.hpp"
#include "reports/study_runs.hpp"
#include "sim/check.hpp"
#include "sim/described_json.hpp"
#include "sim/read_file.hpp"
#include "traces/hash.hpp"
#include "traces/scene.hpp"

#include <cmath>
#include <fcntl.h>
#include <fmt/format.h>
#include <limits>
#include <nlohmann/json.hpp>
#include <sys/file.h>
#include <unistd.h>

namespace reports {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

namespace {

constexpr std::string_view format = "ropsim study point 2"; // the number is that of the file's form
constexpr std::uint64_t largest_file = std::uint64_t{1} << 26U;

std::string hash_of(std::string_view text) {
    traces::ContentHash hash;
    hash.add(std::as_bytes(std::span(text)));
    return hash.hex();
}

// What a setting names is read with it: a program, a description.
std::string with_content(const std::string& setting) {
    const std::string value = setting.substr(setting.find('=') + 1);
    std::error_code failed;
    if (!fs::is_regular_file(value, failed)) return setting;
    return setting + " " + hash_of(sim::read_file(value, largest_file));
}

ordered_json number_json(double number) { return std::isnan(number) ? ordered_json(nullptr) : ordered_json(number); }

double number_of(const ordered_json& json) {
    return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}

ordered_json value_json(const StudyValue& value) {
    ordered_json numbers = ordered_json::array();
    for (const StudyNumber& number : value.numbers)
        numbers.push_back({number.value, number_json(number.mean), number_json(number.low), number_json(number.high)});
    return {{"gpu", value.gpu},     {"series", value.series}, {"x", value.x},
            {"limit", value.limit}, {"drew", value.drew},     {"numbers", std::move(numbers)}};
}

StudyValue value_of(const ordered_json& json) {
    StudyValue value;
    value.gpu = json.at("gpu").get<std::string>();
    value.series = json.at("series").get<std::string>();
    value.x = json.at("x").get<std::string>();
    value.limit = json.at("limit").get<std::string>();
    value.drew = json.at("drew").get<bool>();
    for (const ordered_json& number : json.at("numbers"))
        value.numbers.push_back({number.at(0).get<std::string>(), number_of(number.at(1)), number_of(number.at(2)),
                                 number_of(number.at(3))});
    return value;
}

} // namespace

std::string StudyKeys::scene_hash(const std::string& scene) {
    if (scene.starts_with("gen:")) return scene;
    const std::lock_guard lock(mutex_);
    const auto [known, is_new] = scenes_.try_emplace(scene);
    if (is_new) known->second = traces::load_scene(scene).hash;
    return known->second;
}

std::string StudyKeys::key_of(const Study& study, const StudySeries& series, const StudyPoint& point,
                              const std::vector<std::string>& gpus, Fidelity fidelity) {
    ordered_json all = {{"format", format},
                        {"version", version_text()},
                        {"build", build_text()},
                        {"study", study.name},
                        {"series", series.name},
                        {"x", point.at("x")},
                        {"design", series.design},
                        {"submission", series.submission},
                        {"reads_all", series.reads_all},
                        {"prepare", series.prepare},
                        {"size", study.size},
                        {"samples", study.samples},
                        {"workload", study.workload},
                        {"seeds", study.seeds},
                        {"fidelity", sim::enum_name(fidelity)},
                        {"point", point}};
    for (std::uint32_t seed = 1; seed <= study.seeds; ++seed) {
        StudyPoint variables = point;
        variables["seed"] = std::to_string(seed);
        all["scenes"].push_back(scene_hash(filled(series.scene, variables, study)));
        for (const std::string& setting : filled(series.settings, variables, study))
            all["settings"].push_back(with_content(setting));
    }
    for (const StudyMeasure& measure : study.measures) all["measures"].push_back({measure.value, measure.optional});
    for (const std::string& gpu : gpus) all["gpus"].push_back({gpu, sim::to_json(gpu_params(gpu))});
    return hash_of(all.dump(-1, ' ', false, ordered_json::error_handler_t::replace));
}

PointLock::PointLock(const fs::path& file)
    : file_(file), descriptor_(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {
    if (descriptor_ < 0 || ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
    ::close(descriptor_);
    descriptor_ = -1;
}

PointLock::~PointLock() {
    if (descriptor_ < 0) return;
    ::unlink(file_.c_str()); // before others can have it: they make a new one
    ::close(descriptor_);
}

PointLock::PointLock(PointLock&& other) noexcept
    : file_(std::move(other.file_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

StudyPoints::StudyPoints(const fs::path& folder, bool resume) : folder_(folder / "points"), resume_(resume) {
    make_directory(folder_);
}

std::optional<std::vector<StudyValue>> StudyPoints::find(const std::string& key) const {
    {
        const std::lock_guard lock(mutex_);
        if (!resume_ && !kept_.contains(key)) return std::nullopt;
    }
    std::error_code failed;
    if (!fs::is_regular_file(file_of(key), failed)) return std::nullopt;
    try {
        const ordered_json json = ordered_json::parse(sim::read_file(file_of(key), largest_file));
        if (json.at("format").get<std::string>() != format || json.at("key").get<std::string>() != key)
            return std::nullopt;
        std::vector<StudyValue> values;
        for (const ordered_json& value : json.at("values")) values.push_back(value_of(value));
        return values;
    } catch (const nlohmann::json::exception&) {
        return std::nullopt; // it is written anew
    } catch (const sim::InputError&) {
        return std::nullopt;
    }
}

PointLock StudyPoints::lock(const std::string& key) const { return PointLock(folder_ / (key + ".lock")); }

void StudyPoints::keep(const std::string& key, const std::vector<StudyValue>& values) {
    ordered_json list = ordered_json::array();
    for (const StudyValue& value : values) list.push_back(value_json(value));
    write_file(file_of(key),
               ordered_json({{"format", format}, {"key", key}, {"values", std::move(list)}}).dump() + "\n", false);
    const std::lock_guard lock(mutex_);
    kept_.insert(key);
}

void StudyPoints::forget_others(const std::set<std::string>& keys) const {
    std::error_code failed;
    std::vector<fs::path> others;
    for (const auto& entry : fs::directory_iterator(folder_, failed))
        if (entry.path().extension() == ".json" && !keys.contains(entry.path().stem().string()))
            others.push_back(entry.path());
    for (const fs::path& other : others) fs::remove(other, failed);
}

} // namespace reports
