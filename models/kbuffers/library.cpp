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
        peel_rop_design(),
        sorted_design(),
        batched_design(),
        sorted_batched_design(),
        multipass_design(),
        dual_peel_design(),
        interlock_design(),
        rov_design(),
        framebuffer_fetch_design(),
        cam_design(),
        hashed_design(),
        tile_ticket_design(),
        atomic_min_design(),
        linked_list_design(),
        stencil_routed_design(),
        detect_design(),
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
