#include "models/gpu_library.hpp"

#include "ropsim_build.hpp"
#include "sim/suggest.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace models {

namespace fs = std::filesystem;

std::vector<std::string> gpu_names() {
    std::vector<std::string> names = ropsim_build::data_files("models/gpus", ".toml");
    for (std::string& name : names) name = fs::path(name).stem().string();
    return names;
}

namespace {

sim::Config load_one(std::string_view name_or_path) {
    const bool is_path = name_or_path.find('/') != std::string_view::npos || name_or_path.ends_with(".toml");
    if (is_path) return sim::Config::from_toml_file(name_or_path);
    const std::vector<std::string> names = gpu_names();
    if (std::find(names.begin(), names.end(), name_or_path) == names.end())
        throw sim::InputError(fmt::format("unknown GPU '{}'{}; expected a file (.toml) or one of: {}", name_or_path,
                                          sim::did_you_mean(name_or_path, names), fmt::join(names, ", ")));
    return sim::Config::from_toml_file(*ropsim_build::find_data(fmt::format("models/gpus/{}.toml", name_or_path)));
}

} // namespace

std::string base_of(std::string_view name_or_path) { return load_one(name_or_path).take_text("base"); }

sim::Config load_gpu(std::string_view name_or_path) {
    constexpr std::size_t longest_chain = 8;
    sim::Config config = load_one(name_or_path);
    std::vector<std::string> bases;
    for (std::string base = config.take_text("base"); !base.empty();) {
        if (bases.size() == longest_chain)
            throw sim::InputError(fmt::format("{}: base: expected a GPU that ends in one without a base, got {}",
                                              name_or_path, fmt::join(bases, " -> ")));
        bases.push_back(base);
        sim::Config next = load_one(base);
        base = next.take_text("base");
        config.complete_from(next);
    }
    return config;
}

} // namespace models
