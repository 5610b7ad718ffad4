#include "models/kbuffers/library.hpp"

#include "sim/check.hpp"
#include "sim/suggest.hpp"

#include <fmt/format.h>

namespace models {

const std::vector<DesignInfo>& designs() {
    static const std::vector<DesignInfo> list{
        existing_design(),
        scoreboard_design(),
        blender_design(),
        multipass_design(),
    };
    return list;
}

std::unique_ptr<pipeline::KBufferDesign> make_design(std::string_view id, sim::Config& config) {
    std::vector<std::string> known;
    for (const DesignInfo& design : designs()) {
        if (design.id == id) return design.make(config);
        known.emplace_back(design.id);
    }
    throw sim::InputError(fmt::format("unknown design '{}'{}; the designs are {}", id, sim::did_you_mean(id, known),
                                      fmt::join(known, ", ")));
}

void check_design_sections(sim::Config& config) {
    for (const DesignInfo& design : designs()) design.make(config);
}

} // namespace models
