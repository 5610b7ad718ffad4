#include "models/kbuffers/design_support.hpp"

#include "models/programs/library.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace models {

nlohmann::ordered_json support_of(const pipeline::KBufferDesign& design) {
    nlohmann::ordered_json names = nlohmann::ordered_json::array();
    for (const Program& program : programs())
        for (const std::string& entry : program.entries)
            if (design.refuses(*make_program(program.id, entry, std::min(program.most_k, 4U))).empty())
                names.push_back(fmt::format("{} {}", program.id, entry));
    // Where and how it updates does not depend on the program.
    const pipeline::KBufferPlan plan = design.plan(*make_program("nearest-k", "z", 4), {});
    return {{"programs", std::move(names)},
            {"antialiasing", plan.works_per_sample() ? "per sample" : "supersampling"},
            {"early_reject",
             plan.site == pipeline::UpdateSite::blender && plan.blender.early_reject != pipeline::EarlyReject::none}};
}

} // namespace models
