// The list of k-buffer designs. A new one is a file in this folder and a line in library.cpp.
#pragma once

#include "pipeline/output/kbuffer_design.hpp"
#include "sim/config.hpp"
#include "sim/described.hpp"

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace models {

struct DesignInfo {
    std::string_view id; ///< also the name of its section in a configuration
    std::string_view summary;
    std::unique_ptr<pipeline::KBufferDesign> (*make)(sim::Config& config); ///< reads the section `id`
    std::vector<sim::FieldInfo> (*parameters)();
};

/// All designs, in the order of the specification (D0, D1, ...).
const std::vector<DesignInfo>& designs();

/// Throws sim::InputError with a suggestion for an unknown id, and for bad parameters in the section `id` of `config`.
std::unique_ptr<pipeline::KBufferDesign> make_design(std::string_view id, sim::Config& config);

/// Reads the sections of all designs, so that those of designs that do not run are checked, too.
void check_design_sections(sim::Config& config);

// The makers of the list, one per file.
DesignInfo existing_design();
DesignInfo scoreboard_design();
DesignInfo blender_design();
DesignInfo multipass_design();
DesignInfo peel_rop_design();
DesignInfo sorted_design();
DesignInfo batched_design();
DesignInfo sorted_batched_design();
DesignInfo interlock_design();
DesignInfo rov_design();
DesignInfo framebuffer_fetch_design();
DesignInfo cam_design();
DesignInfo hashed_design();
DesignInfo tile_ticket_design();
DesignInfo detect_design();
DesignInfo atomic_min_design();
DesignInfo linked_list_design();
DesignInfo stencil_routed_design();
DesignInfo dual_peel_design();

} // namespace models
