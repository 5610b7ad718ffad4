#include "reports/catalogue.hpp"

#include "models/gpu_library.hpp"
#include "models/kbuffers/design_support.hpp"
#include "models/kbuffers/library.hpp"
#include "models/programs/language/user_program.hpp"
#include "models/programs/library.hpp"
#include "pipeline/gpu_params.hpp"
#include "reports/counter_reference.hpp"
#include "reports/stability/catalogue.hpp"
#include "reports/study.hpp"
#include "ropsim_build.hpp"
#include "traces/generators.hpp"
#include "traces/preparation.hpp"
#include "traces/user_programs.hpp"
#include "traces/workloads.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>

namespace reports {

using nlohmann::ordered_json;

namespace {

// What distinguishes a GPU is in its numbers: those of its file that are not the defaults.
std::vector<sim::FieldInfo> gpu_numbers(const std::string& name) {
    sim::Config config = models::load_gpu(name);
    pipeline::GpuParams params;
    config.read("", params);
    const auto origins = config.origins();
    std::vector<sim::FieldInfo> fields = sim::describe<pipeline::GpuParams>();
    const auto values = config.effective();
    for (sim::FieldInfo& field : fields) {
        std::string pointer = "/" + field.path;
        for (char& c : pointer)
            if (c == '.') c = '/';
        const ordered_json& value = values.at(ordered_json::json_pointer(pointer));
        field.default_value = value.is_string() ? value.get<std::string>() : value.dump();
        if (const auto origin = origins.find(field.path); origin != origins.end())
            field.text += fmt::format(" ({}: {})", origin->second.origin, origin->second.source);
    }
    return fields;
}

// The file's first line is a comment that says which GPU it is.
std::string gpu_summary(const std::string& name) {
    const auto path = ropsim_build::find_data(fmt::format("models/gpus/{}.toml", name));
    std::string line;
    if (path) std::getline(std::ifstream(*path) >> std::ws, line);
    return line.substr(std::min(line.find_first_not_of("# "), line.size()));
}

std::vector<CatalogueEntry> gpus() {
    std::vector<CatalogueEntry> entries;
    for (const std::string& name : models::gpu_names())
        entries.push_back({"gpus", name, gpu_summary(name), gpu_numbers(name)});
    return entries;
}

std::string support_text(const models::DesignInfo& info) {
    sim::Config defaults;
    const nlohmann::ordered_json support = models::support_of(*info.make(defaults));
    return fmt::format("runs {}; antialiasing {}{}",
                       fmt::join(support.at("programs").get<std::vector<std::string>>(), ", "),
                       support.at("antialiasing").get<std::string>(),
                       support.at("early_reject").get<bool>() ? "; rejects fragments early" : "");
}

std::vector<CatalogueEntry> designs() {
    std::vector<CatalogueEntry> entries;
    for (const models::DesignInfo& design : models::designs())
        entries.push_back({"designs", std::string(design.id), std::string(design.summary), design.parameters(),
                           support_text(design)});
    return entries;
}

std::string program_numbers(const pipeline::ModifyProgram& program) {
    return fmt::format("k = {}: {} operations per fragment, {} bytes per pixel, {}{}", program.k(),
                       program.cost().operations, program.bytes_per_pixel(),
                       program.order_need() == pipeline::OrderNeed::any ? "any order" : "primitive order",
                       program.needs_texture() ? ", fetches a table" : "");
}

// Not compiled: that takes glslang, and a second.
CatalogueEntry glsl_program(const std::string& file) {
    const traces::shader_programs::Declaration program = traces::glsl_declaration(file);
    const std::uint32_t k = program.default_k;
    return {"programs",
            file,
            fmt::format("{}; k = {}: {} floats per pixel, {}; operations are counted when it is compiled",
                        program.summary, k, program.floats(k),
                        program.order == pipeline::OrderNeed::any ? "any order" : "primitive order"),
            {},
            fmt::format("program \"{}\" in GLSL", program.id)};
}

// Cost and size grow with k; they are told for the usual one.
std::vector<CatalogueEntry> programs() {
    std::vector<CatalogueEntry> entries;
    for (const models::Program& program : models::programs()) {
        std::string summary = program.summary;
        for (const std::string& entry : program.entries)
            summary +=
                fmt::format("; {}, {}", entry,
                            program_numbers(*models::make_program(program.id, entry, std::min(program.most_k, 4U))));
        entries.push_back({"programs", program.id, std::move(summary), {}});
    }
    for (const std::string& file : models::shipped_user_programs()) {
        const auto program = models::load_user_program(file, 0).program;
        entries.push_back({"programs",
                           file,
                           fmt::format("{}; {}", program->summary(), program_numbers(*program)),
                           {},
                           fmt::format("program \"{}\" in the k-buffer language", program->id())});
    }
    for (const std::string& file : traces::shipped_glsl_programs()) entries.push_back(glsl_program(file));
    return entries;
}

std::vector<CatalogueEntry> workloads() {
    std::vector<CatalogueEntry> entries;
    for (const traces::Workload& workload : traces::workloads())
        entries.push_back({"workloads", workload.id, workload.summary, workload.parameters});
    return entries;
}

std::vector<CatalogueEntry> generators() {
    std::vector<CatalogueEntry> entries;
    for (const traces::Generator& generator : traces::generators())
        entries.push_back({"generators", "gen:" + generator.id, generator.summary, generator.parameters});
    return entries;
}

std::vector<CatalogueEntry> preparations() {
    std::vector<CatalogueEntry> entries;
    for (const traces::Preparation& preparation : traces::preparations())
        entries.push_back({"preparations", preparation.id, preparation.summary, preparation.parameters});
    return entries;
}

std::vector<CatalogueEntry> studies() {
    std::vector<CatalogueEntry> entries;
    for (const std::string& name : study_names()) entries.push_back({"studies", name, load_study(name).question, {}});
    return entries;
}

std::vector<CatalogueEntry> stability_cases() {
    std::vector<CatalogueEntry> entries;
    for (const stability::Case& one : stability::catalogue())
        entries.push_back({"stability", one.id, one.subject, {}, "expected: " + one.expectation});
    return entries;
}

CatalogueEntry field_entry(std::string topic, std::string name, const sim::FieldInfo& field) {
    CatalogueEntry entry{std::move(topic), std::move(name), detail_text(field), {}};
    return entry;
}

// Workloads share names; each name is listed once, with the workloads that have it and what it means to them.
std::vector<CatalogueEntry> workload_parameters() {
    std::vector<CatalogueEntry> entries;
    for (const traces::Workload& workload : traces::workloads())
        for (const sim::FieldInfo& field : workload.parameters) {
            CatalogueEntry entry = field_entry("params", fmt::format("workload.{}", field.path), field);
            entry.summary = fmt::format("{}: {}", workload.id, entry.summary);
            const auto known = std::find_if(entries.begin(), entries.end(),
                                            [&entry](const CatalogueEntry& other) { return other.name == entry.name; });
            if (known == entries.end())
                entries.push_back(std::move(entry));
            else
                known->summary += " | " + entry.summary;
        }
    return entries;
}

std::vector<CatalogueEntry> parameters() {
    std::vector<CatalogueEntry> entries;
    for (const sim::FieldInfo& field : sim::describe<pipeline::GpuParams>())
        entries.push_back(field_entry("params", field.path, field));
    for (const models::DesignInfo& design : models::designs())
        for (const sim::FieldInfo& field : design.parameters())
            entries.push_back(field_entry("params", field.path, field));
    for (CatalogueEntry& entry : workload_parameters()) entries.push_back(std::move(entry));
    return entries;
}

std::vector<CatalogueEntry> counters() {
    std::vector<CatalogueEntry> entries;
    for (const StageReference& stage : stage_reference())
        for (const sim::FieldInfo& field : stage.counters)
            entries.push_back(field_entry("stats", fmt::format("{}.{}", stage.stage, field.path), field));
    return entries;
}

template <class List>
std::vector<std::string> ids_of(const List& list, const char* prefix = "") {
    std::vector<std::string> names;
    for (const auto& one : list) names.push_back(prefix + std::string(one.id));
    return names;
}

std::vector<std::string> design_names() { return ids_of(models::designs()); }
std::vector<std::string> workload_names() { return ids_of(traces::workloads()); }
std::vector<std::string> generator_names() { return ids_of(traces::generators(), "gen:"); }
std::vector<std::string> preparation_names() { return ids_of(traces::preparations()); }

std::vector<std::string> program_names() {
    std::vector<std::string> names = ids_of(models::programs());
    for (const std::string& file : models::shipped_user_programs()) names.push_back(file);
    for (const std::string& file : traces::shipped_glsl_programs()) names.push_back(file);
    return names;
}

std::vector<std::string> names_of(const std::vector<CatalogueEntry>& entries) {
    std::vector<std::string> names;
    for (const CatalogueEntry& entry : entries) names.push_back(entry.name);
    return names;
}

std::vector<std::string> parameter_names() { return names_of(parameters()); }
std::vector<std::string> stability_names() { return names_of(stability_cases()); }
std::vector<std::string> counter_names() { return names_of(counters()); }

} // namespace

const std::vector<CatalogueTopic>& catalogue_topics() {
    static const std::vector<CatalogueTopic> topics{
        {"gpus", "simulated GPUs (--gpu)", true, gpus, models::gpu_names},
        {"designs", "k-buffer designs (--designs, --design)", true, designs, design_names},
        {"programs", "what a fragment does to the entries of its pixel (--program)", true, programs, program_names},
        {"workloads", "rendering methods (--workload)", true, workloads, workload_names},
        {"generators", "scenes made by rule (SCENE)", true, generators, generator_names},
        {"preparations", "what can be done to meshes (--prepare of ropsim geometry)", true, preparations,
         preparation_names},
        {"studies", "questions with a sweep, a table and a plot (ropsim study)", true, studies, study_names},
        {"stability", "stiff and extreme cases (ropsim stability)", false, stability_cases, stability_names},
        {"params", "every number of GPU, designs and workloads (--set)", false, parameters, parameter_names},
        {"stats", "every counter of every stage", false, counters, counter_names}};
    return topics;
}

std::vector<CatalogueEntry> catalogue_find(std::string_view name) {
    std::vector<CatalogueEntry> exact, below;
    for (const CatalogueTopic& topic : catalogue_topics())
        for (CatalogueEntry& entry : topic.entries()) {
            const std::string_view path = entry.name;
            if (path == name || path == fmt::format("gen:{}", name))
                exact.push_back(std::move(entry));
            else if (path.size() > name.size() && path.starts_with(name) && path[name.size()] == '.')
                below.push_back(std::move(entry));
        }
    return exact.empty() ? below : exact;
}

ordered_json catalogue_json(const std::vector<CatalogueEntry>& entries) {
    ordered_json list = ordered_json::array();
    for (const CatalogueEntry& entry : entries) {
        ordered_json json = {{"topic", entry.topic}, {"name", entry.name}, {"summary", entry.summary}};
        for (const sim::FieldInfo& field : entry.details)
            json["details"].push_back({{"path", field.path},
                                       {"type", field.type},
                                       {"unit", field.unit},
                                       {"text", field.text},
                                       {"default", field.default_value},
                                       {"range", field.range}});
        list.push_back(std::move(json));
    }
    return list;
}

std::string detail_text(const sim::FieldInfo& field) {
    std::string text = field.text;
    if (!field.unit.empty()) text += fmt::format(" [{}]", field.unit);
    if (!field.range.empty()) text += "; " + field.range;
    const bool counts =
        field.type.find("counter") != std::string::npos || field.type == "high water" || field.type == "histogram";
    if (!counts && !field.default_value.empty()) text += "; " + field.default_value + " by default";
    return text;
}

} // namespace reports
