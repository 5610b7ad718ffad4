// What programmable blenders with different interlocks share. Three ways are known to find out that a quad's pixel is
// still inside: compare with all quads inside (exact), counters by a hash of the pixel, a ticket per 4x4 tile. Whoever
// is mistaken for a conflict waits, and no pixel is ever wrong.
//
// Source: specification 004, sections 7.3 and 8; descriptions of ROPs that do it (exact: ATTILA; hashed: Vortex; tile:
// Emerald), which have not been compared before.
#pragma once

#include "models/kbuffers/configured_design.hpp"

namespace models {

/// Of parameters with lanes, port_bytes and latency.
template <class Params>
constexpr auto blender_fields() {
    return std::tuple{sim::field<&Params::lanes>("Scalar operations per cycle of one ROP's blender")
                          .unit("operations")
                          .range(1, 1024),
                      sim::field<&Params::port_bytes>("Bytes per cycle between one ROP's blender and the tile cache")
                          .unit("bytes")
                          .range(1, 4096),
                      sim::field<&Params::latency>("From read to write (L_b)").unit("cycles").range(1, 1000)};
}

template <class Params>
pipeline::KBufferPlan blender_with(pipeline::InterlockTest test, const Params& params) {
    pipeline::KBufferPlan plan;
    plan.site = pipeline::UpdateSite::blender;
    plan.blender = {pipeline::BlendInterlock::stall, params.lanes, params.port_bytes, params.latency, test};
    return plan;
}

inline std::string blender_refuses(const pipeline::ModifyProgram& program) {
    return program.needs_texture() ? "it fetches a table, which a blender cannot" : "";
}

/// One pixel for every stage of every ROP's blender.
inline std::uint64_t pipeline_bits(const pipeline::ModifyProgram& program, std::uint32_t latency,
                                   const pipeline::GpuShape& shape) {
    return std::uint64_t{latency} * program.bytes_per_pixel() * 8 * shape.rops;
}

} // namespace models
